"""Every ending of a program: everything off first, and no wait without a limit."""

import pytest
from tests.mill.shop import Shop

from openacr.client import Card
from openacr.errors import UserError
from openacr.mill.card import alarms
from openacr.mill.run.lifecycle import State

SPINDLE = {"P800_005": 40, "P800_007": 43, "P800_010": 41, "P800_002": 3, "P800_001": 0.01}
BEAM = {"P650_017": 44, "P250_014": 45}
KILLED = 8467
DAC3 = 6448


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def cutting(**cells: float) -> Shop:
    shop = Shop(**SPINDLE, **BEAM, **cells)
    shop.load("M3 S500\nM8\nG1 F600 X300\nM2\n")
    shop.pass_time(0.5)
    assert shop.outputs([40, 41, 43, 44, 45]) == [True, True, False, True, True]
    assert shop.controller.p[DAC3] == 5.0
    return shop


@pytest.mark.parametrize("phase", range(4))
def test_a_kill_of_another_terminal_ends_a_run_at_any_moment(phase: int) -> None:
    shop = Shop(**SPINDLE)
    shop.load("M3 S500\nM8\nF600\n" + "G1 X1\nX0\n" * 20 + "M2\n")
    shop.pass_time(0.5 + 0.017 * phase)
    Card.open(shop.controller).kill_all()
    shop.until(State.ALARM, limit_s=10.0)
    assert (codes(shop), shop.outputs([40, 41])) == ([14], [False, False])
    assert shop.runner.acknowledge() == []
    shop.pass_time(0.2)
    shop.run_text("G1 F600 X0\nM2\n")
    assert shop.pulses() == (0, 0, 0)


def test_an_abort_switches_everything_off_before_the_machine_is_at_rest() -> None:
    shop = cutting()
    shop.runner.abort()
    shop.controller.advance(seconds=0.005)
    assert shop.outputs([40, 41, 43, 44, 45]) == [False, False, True, False, False]
    assert shop.controller.p[DAC3] == 0.0
    assert shop.runner.is_busy


@pytest.mark.parametrize("kind", [None, alarms.TARGET_BEYOND])
def test_a_machine_that_does_not_come_to_rest_loses_its_drives(
    monkeypatch: pytest.MonkeyPatch, kind: alarms.Kind | None
) -> None:
    """A card that heeds neither feed hold nor stop, but a kill."""
    shop = cutting()
    monkeypatch.setattr(shop.runner.machine, "hold", lambda: None)
    monkeypatch.setattr(shop.runner.machine, "stop", lambda: None)
    if kind is None:
        shop.runner.abort()
    else:
        shop.runner._supervision.raise_alarm(kind, "X")
    begin_s = shop.controller.time_s
    shop.until(State.ALARM)
    limit_s = shop.runner.settings.rest_s
    assert limit_s - 0.1 < shop.controller.time_s - begin_s < limit_s + 1.0
    assert codes(shop) == [*([21] if kind else []), 15]
    shop.pass_time(0.5)
    assert [shop.controller.bit[KILLED + 32 * axis] for axis in range(3)] == [True] * 3
    assert shop.card.command("DRIVE X", program=0) == ["DRIVE OFF X"]


def test_a_jog_that_does_not_come_to_rest_loses_its_drives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop()
    shop.runner.jog(lambda jog: jog.move(0, 50.0))
    shop.pass_time(0.3)
    monkeypatch.setattr(shop.runner.jogging, "release", lambda _axis: None)
    shop.runner.stop()
    shop.until(State.ALARM)
    assert codes(shop) == [15]
    shop.pass_time(0.5)
    assert shop.controller.bit[KILLED]


def test_an_abort_of_what_is_being_ended_is_not_refused() -> None:
    shop = cutting()
    shop.runner.abort()
    shop.pass_time(0.01)
    shop.runner.abort()
    shop.until(State.IDLE)
    assert codes(shop) == []
    with pytest.raises(UserError, match="no program runs"):
        shop.runner.abort()
