"""The soft limits on the card: what they stop when the host has not, and when they are off."""

import re
from pathlib import Path

import pytest
from tests.mill.shop import PULSES, Shop, at, end, line

from openacr.client import Card
from openacr.controller import Controller
from openacr.mill.card import homed, soft_limits
from openacr.mill.card.setup import lines
from openacr.mill.config.settings import Settings
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import Store

# X is limited to -1.5 .. 2 and homed, Y has limits too, Z has none.
LIMITED = {
    "P200_000": 2.0, "P200_001": -1.5, "P200_002": 0, "P201_000": 5.0, "P201_002": 0,
    "P271": 5, "P650_008": 50.0, "P350_003": 150.0, "P350_000": 60.0,
}  # fmt: skip
KEY = 6


def limited(**cells: float) -> Shop:
    shop = Shop(**(LIMITED | cells))
    shop.pass_time(0.02)
    return shop


def modes(shop: Shop) -> list[str]:
    """SLIM of X Y Z."""
    return [shop.card.command(f"AXIS{n} SLIM", program=0)[0] for n in range(3)]


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def x_u(shop: Shop) -> float:
    return shop.controller.axis(0).commanded_cnt / PULSES


def test_the_set_up_sends_the_limits_one_pulse_farther_out_with_the_feed_ramp() -> None:
    store = Store()
    for name, value in LIMITED.items():
        store.write(int(name.removeprefix("P")), value)
    store.write(200_006, -10_000.0)  # pulses per unit of X, turned
    sent = [text for text in lines(Settings(store)) if re.match(r"AXIS\d SL", text)]
    assert sent == [
        "AXIS0 SLIM 0", "AXIS0 SLM (2.0001,-1.5001)", "AXIS0 SLDEC 50.0",
        "AXIS1 SLIM 0", "AXIS1 SLM (5.0001,-0.0001)", "AXIS1 SLDEC 50.0",
        "AXIS2 SLIM 0",
    ]  # fmt: skip


def test_only_homed_axes_with_limits_have_them_on_the_card() -> None:
    shop = limited()
    assert modes(shop) == ["3", "0", "0"]
    homed.note(shop.runner.io, 1, True)
    homed.note(shop.runner.io, 0, False)
    assert modes(shop)[0] == "0"  # at once: homing moves the axis next
    shop.pass_time(0.01)
    assert modes(shop) == ["0", "3", "0"]


@pytest.mark.parametrize("direction", [1, -1])
def test_a_move_past_the_host_is_stopped_on_the_feed_ramp_and_is_an_alarm(direction: int) -> None:
    shop = limited()
    shop.card.command(f"VEL 5 ACC 100 DEC 100 STP 100 X{9 * direction}", program=0)
    shop.pass_time(2.0)
    assert codes(shop) == [22]
    assert shop.runner.alarms.active[0].text == "Card stopped axis X beyond its soft limit"
    limit = 2.0001 if direction > 0 else -1.5001
    assert (x_u(shop) - limit) * direction == pytest.approx(5.0**2 / (2 * 50.0), abs=0.01)


@pytest.mark.parametrize("direction", [1, -1])
def test_after_the_alarm_the_axis_goes_back_inside_and_is_stopped_again(direction: int) -> None:
    shop = limited()
    shop.card.command(f"VEL 5 ACC 100 DEC 100 STP 100 X{9 * direction}", program=0)
    shop.pass_time(2.0)
    assert shop.runner.acknowledge() == []
    assert shop.runner.state is State.IDLE
    shop.runner.jog(lambda jog: jog.move(0, -direction))
    shop.until(State.IDLE)
    shop.start(line(1, at(0)), end())
    assert shop.until(State.IDLE, State.ALARM) is State.IDLE
    shop.card.command(f"X{9 * direction}", program=0)
    shop.pass_time(2.0)
    assert codes(shop) == [22]


def test_a_program_whose_move_is_stopped_by_the_card_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    shop = limited()
    monkeypatch.setattr("openacr.mill.run.feeding.first_excess", lambda _job, _settings: None)
    shop.start(line(1, at(0, 1)), line(2, at(9, 1)), end())
    assert shop.until(State.ALARM) is State.ALARM
    assert codes(shop) == [22]
    assert x_u(shop) > 2.0
    assert shop.runner.acknowledge() == []
    monkeypatch.undo()
    shop.finish(line(1, at(1, 1)), end())
    assert shop.place() == (1.0, 1.0, 0.0)


@pytest.mark.parametrize("limit", [2.0, -1.5])
def test_a_move_and_a_jog_exactly_to_the_limit_do_not_meet_it(limit: float) -> None:
    shop = limited()
    shop.finish(line(1, at(limit)), line(2, at(0)), end())
    shop.runner.jog(lambda jog: jog.move(0, limit))
    shop.until(State.IDLE)
    assert (x_u(shop), codes(shop)) == (limit, [])
    shop.runner.jog(lambda jog: jog.move(0, -limit))
    shop.until(State.IDLE)
    shop.runner.jog(lambda jog: jog.hold(0, 1 if limit > 0 else -1))
    shop.pass_time(8.0)
    assert x_u(shop) == pytest.approx(limit)
    assert codes(shop) == []


def test_the_maintenance_key_takes_the_limits_off_the_card_while_it_is_turned() -> None:
    shop = Shop(**(LIMITED | {"P400_005": KEY, "P350_000": 60.0}))
    shop.controller.set_input(KEY, True)
    shop.pass_time(0.02)
    assert modes(shop) == ["3", "0", "0"]
    shop.controller.set_input(KEY, False)  # turned, and the very next thing is a jog
    shop.runner.jog(lambda jog: jog.move(0, 2.5))
    assert modes(shop) == ["0", "0", "0"]
    shop.until(State.IDLE)
    assert (x_u(shop), codes(shop)) == (2.5, [])
    shop.controller.set_input(KEY, True)
    shop.pass_time(0.02)
    assert modes(shop) == ["3", "0", "0"]
    assert codes(shop) == []  # beyond the limit, at rest


def test_the_limits_found_on_the_card_are_given_back_at_the_end(tmp_path: Path) -> None:
    with Store(tmp_path / "sysvar.db") as store:
        for name, value in LIMITED.items():
            store.write(int(name.removeprefix("P")), value)
        controller = Controller()
        card = Card.open(controller)
        for text in ("SLM (24,-1)", "SLDEC 7", "SLIM 1"):
            card.command(f"AXIS0 {text}", program=0)
        before = soft_limits.found(card, Settings(store))
        assert before[:4] == ["AXIS0 SLM (24,-1)", "AXIS0 SLDEC 7", "AXIS0 SLIM 1",
                              "AXIS1 SLM (0,0)"]  # fmt: skip
        shop = MillSession.real(controller, store, lambda _text: None)
        homed.note(shop.runner.io, 0, True)
        shop.step()
        assert soft_limits.found(shop.card, Settings(store))[:3] == [
            "AXIS0 SLM (2.0001,-1.5001)", "AXIS0 SLDEC 50", "AXIS0 SLIM 3",
        ]  # fmt: skip
        shop.close()
        assert soft_limits.found(card, Settings(store)) == before
