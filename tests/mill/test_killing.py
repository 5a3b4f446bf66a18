"""Killed motion: everything off at once, and what the machine knows of its position after it."""

from collections.abc import Iterable

import pytest
from tests.mill.shop import PULSES, Shop

from openacr.client.errors import RefusedError
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.card import alarms
from openacr.mill.card.alarms import AlarmError
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import Store

ESTOP, SPINDLE_CW = "P400_004", "P800_005"
KILLED = 8467  # of axis 0; axis n is 32 n higher


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def killed(shop: Shop) -> list[bool]:
    return [shop.controller.bit[KILLED + 32 * axis] for axis in range(3)]


def emergency_stop(shop: Shop) -> None:
    shop.controller.set_input(5, True)
    shop.pass_time(2.0)
    shop.controller.set_input(5, False)
    shop.pass_time(0.1)


def test_the_distance_of_the_kill_ramp_becomes_position() -> None:
    shop = Shop()
    shop.card.command("HLDEC X50", program=0)
    shop.load("G1 F600 X50\nM2\n")
    shop.pass_time(1.0)
    before = shop.place()[0]
    shop.runner._supervision.raise_alarm(alarms.HARDWARE_LIMIT, "X")
    shop.pass_time(2.0)
    assert shop.controller.axis(0).actual_cnt / PULSES > before + 0.9
    assert shop.runner.acknowledge() == []
    assert shop.place()[0] == pytest.approx(shop.controller.axis(0).actual_cnt / PULSES, abs=1e-3)
    shop.pass_time(0.1)
    shop.run_text("G1 F600 X0\nM2\n")
    assert shop.controller.axis(0).actual_cnt == pytest.approx(0, abs=100)


def test_an_alarm_is_not_acknowledged_before_the_axes_are_at_rest() -> None:
    shop = Shop(**{ESTOP: 5})
    shop.card.command("HLDEC X1", program=0)
    shop.load("G1 F600 X50\nM2\n")
    shop.pass_time(1.0)
    shop.controller.set_input(5, True)
    shop.pass_time(0.1)
    shop.controller.set_input(5, False)
    with pytest.raises(UserError, match="not come to rest"):
        shop.runner.acknowledge()


def test_a_card_that_refuses_lines_is_killed_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    shop = Shop(**{ESTOP: 5, SPINDLE_CW: 40, "P800_002": 3})
    shop.load("M3 S500\nM0\nM2\n")
    shop.until(State.HOLD)
    shop.runner.jog(lambda jog: jog.move(0, 5.0))
    shop.pass_time(0.1)

    def refuse(_lines: Iterable[str]) -> None:
        raise RefusedError("JOG OFF X", "Unknown command")

    monkeypatch.setattr(shop.runner.machine, "type", refuse)
    monkeypatch.setattr(shop.runner.machine, "write", lambda *_: refuse(()))
    shop.controller.set_input(5, True)
    with pytest.raises(RefusedError):
        shop.pass_time(0.1)
    shop.controller.advance(seconds=0.1)
    assert killed(shop) == [True, True, True]
    assert shop.outputs([40]) == [False]
    assert shop.runner.state is State.ALARM


def test_a_kill_by_another_host_is_taken_back_by_an_acknowledgement() -> None:
    shop = Shop()
    shop.controller.bit[KILLED] = True
    shop.pass_time(0.1)
    assert codes(shop) == [14]
    assert shop.runner.acknowledge() == []
    shop.pass_time(0.1)
    assert killed(shop) == [False, False, False]
    shop.run_text("G1 F600 X1\nM2\n")
    assert shop.pulses()[0] == 10000


def test_an_axis_on_its_limit_switch_is_acknowledged_and_jogged_away() -> None:
    shop = Shop()
    shop.card.command("HLBIT X 8", program=0)
    shop.card.command("HLIM X 3", program=0)
    shop.load("G1 F60 X50\nM2\n")
    shop.pass_time(0.5)
    shop.controller.set_input(8, True)
    shop.until(State.ALARM)
    shop.pass_time(0.5)
    assert shop.runner.acknowledge() == []
    shop.pass_time(0.1)
    at = shop.pulses()[0]
    shop.runner.jog(lambda jog: jog.move(0, -0.2))
    shop.pass_time(3.0)
    assert (shop.pulses()[0], codes(shop)) == (at - 2000, [])
    with pytest.raises(AlarmError, match="Hardware limit axis X"):  # the switch is still on
        shop.runner.jog(lambda jog: jog.move(0, 0.2))
    assert shop.pulses()[0] == at - 2000
    shop.controller.set_input(8, False)
    shop.pass_time(0.1)
    assert shop.runner.acknowledge() == []
    shop.pass_time(0.1)
    shop.runner.jog(lambda jog: jog.move(0, 0.2))
    shop.pass_time(3.0)
    assert (shop.pulses()[0], codes(shop)) == (at, [])


def test_a_jog_that_lost_its_host_becomes_position_at_the_next_set_up() -> None:
    before = Shop()
    before.runner.jog(lambda jog: jog.move(0, 0.5))
    before.controller.advance(seconds=5.0)  # without a host the axis ends its leash
    assert before.pulses()[0] == 0
    reached_cnt = before.controller.axis(0).actual_cnt
    assert 0 < reached_cnt < 5000
    assert Shop.on(before.controller, {}).pulses()[0] == reached_cnt


def test_a_machine_that_is_jogged_by_another_program_is_not_set_up() -> None:
    controller = Controller()
    other = Shop.on(controller, {})
    other.runner.jog(lambda jog: jog.move(0, 5.0))
    other.pass_time(0.1)
    with pytest.raises(UserError, match="another program runs it"):
        MillSession.real(controller, Store())
