"""The motion after a host is lost is bounded, and what others do to a machine is noticed."""

import re

import pytest
from tests.mill.shop import PULSES, Shop

from openacr.controller import Controller
from openacr.map.numbers import P_GLOBAL_SYSTEM_CLOCK
from openacr.mill.config.settings import HOMED
from openacr.mill.manual.jogging import LEASH_S
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.protocol.move import Move
from openacr.sysvar import Store
from openacr.sysvar.tabs import SPEEDS


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def details(shop: Shop) -> list[str]:
    return [alarm.text for alarm in shop.runner.alarms.active]


def test_the_card_never_holds_much_more_motion_than_the_link_timeout() -> None:
    """Moves of 1 s each: 2 s of link timeout and 2 s more wait after the executed one."""
    shop = Shop()
    shop.load("F60\n" + "G1 X1\nX0\n" * 10 + "M2\n")
    most = 0
    for _ in range(20):
        shop.pass_time(0.2)
        most = max(most, shop.runner.stream.tracker.waiting)
        assert shop.runner.stream.tracker.waiting_s <= 5.0
    assert most == 4


def test_a_trace_is_bounded_like_the_program() -> None:
    """Moves of 1 s each back along the path: the same 4 s wait at most, and all are made."""
    shop = Shop(P650_006=60.0)
    shop.load("F600\n" + "G1 X1\nX0\n" * 4 + "X5\nM2\n")
    while shop.place()[0] < 2.0:
        shop.pass_time(0.005)
    shop.runner.stop()
    shop.pass_time(0.6)
    shop.runner.trace(-1)
    most = 0
    while shop.runner.retrace.is_active:
        shop.pass_time(0.05)
        most = max(most, shop.runner.retrace.tracker.waiting)
    assert (most, shop.pulses()) == (4, (0, 0, 0))


@pytest.mark.parametrize("direction", [0, -1])
def test_moves_the_card_does_not_begin_end_the_program(
    monkeypatch: pytest.MonkeyPatch, direction: int
) -> None:
    """Those of the program, and those of a trace in a pause."""
    shop = Shop()
    shop.load("F60\nG1 X1\nG4 F.1\nG1 X9\nM2\n")
    shop.pass_time(1.5 if direction else 0.5)
    if direction:
        shop.runner.stop()
        shop.pass_time(0.6)
        monkeypatch.setattr(shop.runner.machine, "send", lambda _moves: None)
        shop.runner.trace(direction)
        while not shop.runner.retrace.tracker.sent:
            shop.pass_time(0.005)
    else:
        monkeypatch.setattr(shop.runner.machine, "send", lambda _moves: None)
        while shop.runner.stream.tracker.sent < 2:
            shop.pass_time(0.005)
    shop.pass_time(2.98)
    assert codes(shop) == []
    shop.pass_time(0.04)
    assert codes(shop) == [18]


def test_a_card_that_begins_late_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """2 s before the first move, and 2 s before the second: neither is too long."""
    shop, kept = Shop(), list[list[Move]]()
    shop.load("F600\nG1 X1\nG4 F.1\nX2\nM2\n")
    send = shop.runner.machine.send
    monkeypatch.setattr(shop.runner.machine, "send", lambda moves: kept.append(list(moves)))
    for count in (1, 2):
        while len(kept) < count:
            shop.pass_time(0.005)
        shop.pass_time(2.0)
        send(kept[-1])
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((20_000, 0, 0), [])


def test_a_machine_without_a_program_has_no_moves_to_make() -> None:
    shop = Shop()
    shop.run_text("F600\nG1 X1\nM2\n")
    shop.runner.machine.reset_counter()  # by another host
    shop.pass_time(4.0)
    assert codes(shop) == []


def test_a_long_move_has_none_but_one_after_it() -> None:
    shop = Shop()
    shop.load("F60\nG1 X20\nX0\nX20\nX0\nM2\n")
    shop.pass_time(1.0)
    assert (shop.runner.stream.tracker.waiting, shop.runner.stream.moves) == (1, 2)


def test_a_move_typed_by_another_host_ends_a_run_under_way() -> None:
    shop = Shop()
    shop.load("F60\nG1 X2\nX0\nX2\nX0\n" + "X2\nX0\n" * 20 + "M2\n")
    shop.pass_time(0.3)
    shop.card.command("VEL 5 X9", program=0)  # comes after what waits, four moves of 2 s
    shop.until(State.ALARM)
    assert codes(shop) == [16]
    assert re.fullmatch(
        r"Machine was moved by another program: it is at X2\.\d+ Y0 Z0, off the path of line \d",
        details(shop)[0],
    )
    place = shop.pulses()[0]
    assert 20_200 < place < 40_000
    shop.pass_time(2.0)
    assert shop.pulses()[0] == place


@pytest.mark.parametrize("planned", [False, True])
def test_corners_arcs_and_pauses_are_no_motion_of_others(planned: bool) -> None:
    cells = {f"P{SPEEDS.path_jerk}": 2_000.0, f"P{SPEEDS.path_tolerance}": 0.05}
    shop = Shop(**cells if planned else {})
    shop.load(
        "F600\nG1 X2\nG2 X4 Y2 I4 J0\nG1 Y0\nG3 X2 Y0 I3 J0\n"
        "G0 Z1\nG1 X0 Y0 Z0\nG4 F1\nX.2\nX0\nM2\n"
    )
    shop.pass_time(0.31)
    shop.runner.stop()
    shop.pass_time(1.0)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((0, 0, 0), [])


def test_moves_typed_by_another_host_are_noticed_at_the_end() -> None:
    shop = Shop()
    shop.load("F600\nG1 X.5\nX.9\nG4 F1\nM2\n")
    shop.pass_time(0.3)
    shop.card.command("X.91", program=0)
    shop.until(State.ALARM)
    assert details(shop)[0] == (
        "Machine was moved by another program: axis X is at 0.91, its program position is 0.9"
    )
    assert codes(shop)[0] == 16


def test_a_jog_of_another_host_is_noticed_at_the_next_halt() -> None:
    shop = Shop()
    shop.load("F60\nG1 X.5\nM8\nG1 X1\nM2\n")
    shop.pass_time(0.2)
    shop.card.command("AXIS1 JOG VEL 10", program=0)
    shop.card.command("AXIS1 JOG INC 0.01", program=0)
    shop.until(State.ALARM)
    assert codes(shop) == [16]
    assert "axis Y is at 0.01, its program position is 0" in details(shop)[0]


def test_a_poll_gap_longer_than_the_link_timeout_pauses_the_program() -> None:
    shop = Shop()
    shop.load("F60\nG1 X20\nM2\n")
    shop.pass_time(0.5)
    shop.controller.advance(seconds=1.9)
    shop.pass_time(0.005)
    assert shop.runner.state is State.RUN
    shop.controller.advance(seconds=2.1)
    shop.pass_time(0.005)
    assert (shop.runner.state, codes(shop)) == (State.PAUSED, [7])
    assert details(shop) == ["Host did not watch the machine for 2.1 s"]
    shop.pass_time(1.0)
    place = shop.place()
    shop.pass_time(1.0)
    assert shop.place() == place
    assert shop.runner.acknowledge() == []
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (200_000, 0, 0)


def test_an_increment_ends_soon_when_no_program_polls() -> None:
    shop = Shop()
    shop.runner.jog(lambda jog: jog.move(0, 17.0))
    shop.pass_time(0.3)
    row = shop.runner.settings.axis(0)
    before = shop.controller.axis(0).actual_cnt / PULSES
    shop.controller.advance(seconds=30.0)
    travel = shop.controller.axis(0).actual_cnt / PULSES - before
    brake_u = 0.5 * row.jog_ups**2 / row.jog_dec_ups2
    assert 0.0 < travel <= LEASH_S * row.jog_ups + brake_u + 0.1


@pytest.mark.parametrize("travel", [3.0, -3.0, 0.001])
def test_an_increment_ends_exactly(travel: float) -> None:
    shop = Shop(P351_000=600.0)
    shop.runner.jog(lambda jog: jog.move(1, travel))
    for _ in range(4000):
        if not shop.runner.is_busy:
            break
        shop.pass_time(0.02)
    assert shop.pulses() == (0, round(travel * PULSES), 0)


def test_a_card_that_was_reset_ends_the_program_and_its_axes_are_not_homed() -> None:
    shop = Shop()
    shop.store.write(HOMED, 7)
    shop.load("F60\nG1 X20\nM2\n")
    shop.pass_time(0.5)
    shop.controller.p[P_GLOBAL_SYSTEM_CLOCK] = 3
    shop.until(State.ALARM)
    assert codes(shop) == [17]
    assert shop.store.read(HOMED) == 0
    assert shop.runner.run_s < 2.0  # the clock of the run does not jump


def test_axes_that_lost_their_reference_points_are_named() -> None:
    store, said = Store(), list[str]()
    store.write(HOMED, 5)
    shop = MillSession.real(Controller(), store, said.append)
    shop.close()
    assert said == [
        "axis X Z is no longer homed: the card was switched off or reset, and positions"
        " count from where it was switched on"
    ]
    assert store.read(HOMED) == 0


def test_the_state_is_published_at_the_end_of_a_run() -> None:
    shop = Shop()
    shop.load("F60\nG1 X1\nM2\n")
    shop.pass_time(0.7)
    assert (shop.store.read(244), shop.controller.p[95]) == (1.0, 1.0)
    while shop.runner.is_busy:
        shop.pass_time(0.005)
    assert (shop.store.read(244), shop.controller.p[95]) == (0.0, 0.0)


def test_an_aborted_run_is_known_as_such() -> None:
    shop = Shop()
    shop.load("F60\nG1 X20\nM2\n")
    shop.pass_time(0.2)
    shop.runner.abort()
    shop.until(State.IDLE)
    assert shop.runner.was_aborted
    shop.run_text("F600\nG1 X0\nM2\n")
    assert not shop.runner.was_aborted
