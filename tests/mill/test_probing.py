"""G31 on a card: which input captures which axis, and what is watched by polling."""

from collections.abc import Iterable

import pytest
from tests.mill.shop import Shop, at, end, src

from openacr.cnc import canonical as c
from openacr.mill.config.capture import Capture, capture_of
from openacr.mill.config.overrides import Override
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.estimate.preflight import Preflight
from openacr.mill.run.lifecycle import State
from openacr.protocol.move import Move

PROBE, EDGE, SOFTWARE, EACH = "P600_000", "P600_001", "P600_002", "P600_006"
FEED = 60.0  # 1 inch per second
BLIND_S = 0.05  # between the contact and the next poll


def actual(shop: Shop) -> c.Point:
    return tuple(shop.controller.axis(axis).actual_cnt / 1e4 for axis in range(3))


def touched(shop: Shop, target: c.Point, wires: tuple[int, ...], *, on: bool = True) -> c.Point:
    """Where the axes were at the contact; the host polls `BLIND_S` later."""
    shop.start(c.Probe(src(1), target, c.Pace(FEED)), c.Sync(src(1)), end())
    shop.pass_time(0.5)
    assert shop.runner.reason == "probing"
    shop.controller.advance(seconds=0.001)
    contact = actual(shop)
    for wire in wires:
        shop.controller.set_input(wire, on)
    shop.controller.advance(seconds=BLIND_S)
    return contact


def tripped(shop: Shop) -> c.Point:
    shop.until(State.IDLE)
    point = shop.runner.stream.host.tripped()
    assert point is not None
    assert shop.place() == pytest.approx(point[:3], abs=1.01e-4)  # back where it tripped
    return point[:3]


@pytest.mark.parametrize(
    ("wire", "target"),
    [
        (24, at(5)), (25, at(0, 5)), (26, at(0, 0, 5)), (18, at(0, 0, -5)), (10, at(0, 0, 5)),
        (2, at(0, 0, 5)), (24, at(5, 5)), (24, at(-5, 2.5)), (0, at(5)),
    ],
)  # fmt: skip
def test_the_axis_of_the_input_captures_where_it_makes_the_longest_travel(
    wire: int, target: c.Point
) -> None:
    shop = Shop(**{PROBE: wire})
    contact = touched(shop, target, (wire,))
    assert tripped(shop) == pytest.approx(contact, abs=2e-3)  # not 0.05: nothing polled yet
    assert shop.said == []


@pytest.mark.parametrize(
    ("wire", "target", "reason"),
    [
        (24, at(0, 0, -5), "input 24 captures X, and Z one of 26, 18, 10, 2"),
        (24, at(0.01, 5), "input 24 captures X, and Y one of 25, 17, 9, 1"),
        (5, at(5), "input 5 captures no axis"),
        (29, at(5), "input 29 captures no axis"),
    ],
)
def test_an_input_that_does_not_capture_the_move_is_polled_and_that_is_said(
    wire: int, target: c.Point, reason: str
) -> None:
    shop = Shop(**{PROBE: wire})
    contact = touched(shop, target, (wire,))
    point = tripped(shop)
    late = max(abs(a - b) for a, b in zip(point, contact, strict=True))
    assert late == pytest.approx(BLIND_S * FEED / 60.0, abs=0.01)
    assert shop.said == [f"{reason}: the probe is polled, which is less accurate"]


def test_what_is_polled_is_said_once() -> None:
    shop = Shop(**{PROBE: 5})
    for target in (at(0.1), at(0.2)):
        shop.start(c.Probe(src(1), target, c.Pace(FEED)), c.Sync(src(1)), end())
        shop.until(State.IDLE)
    assert len(shop.said) == 1


def test_a_probe_wired_to_each_axis_captures_them_all() -> None:
    shop = Shop(**{PROBE: 24, EACH: 1})
    contact = touched(shop, at(0.5, 1, -5), (24, 25, 26))
    assert tripped(shop) == pytest.approx(contact, abs=2e-3)
    assert shop.said == []


def test_a_contact_that_nothing_captures_stops_the_machine_at_once() -> None:
    shop = Shop(**{PROBE: 24, EACH: 1})  # but the wires to 25 and 26 are broken
    contact = touched(shop, at(0, 0, -5), (24,))
    assert shop.until(State.ALARM) is State.ALARM
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [36]
    assert abs(shop.place()[2] - contact[2]) < 2 * BLIND_S + 0.02  # and the scan of the card


def test_a_short_contact_between_two_polls_counts_where_it_is_captured() -> None:
    shop = Shop(**{PROBE: 24})
    contact = touched(shop, at(5), (24,))
    shop.controller.set_input(24, False)
    assert tripped(shop) == pytest.approx(contact, abs=2e-3)


def test_a_contact_seen_once_counts_although_it_is_lost_again() -> None:
    shop = Shop(**{PROBE: 5})
    touched(shop, at(5), (5,))
    shop.runner.step()
    shop.controller.set_input(5, False)
    assert tripped(shop)[0] < 1.0


@pytest.mark.parametrize(("edge", "inverted"), [(0, 1), (1, 0)])
def test_a_contact_that_opens_is_captured_at_the_falling_edge(edge: int, inverted: int) -> None:
    shop = Shop(**{PROBE: 24, EDGE: edge, "P251_024": inverted})
    shop.controller.set_input(24, True)
    contact = touched(shop, at(5), (24,), on=False)
    assert tripped(shop) == pytest.approx(contact, abs=2e-3)


def test_a_probe_that_is_away_already_does_not_move_away() -> None:
    shop = Shop(**{PROBE: 24})
    shop.start(c.Probe(src(1), at(1), c.Pace(FEED), is_away=True), c.Sync(src(1)), end())
    shop.until(State.ALARM)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [37]
    assert shop.pulses() == (0, 0, 0)


def test_a_move_away_ends_where_the_contact_is_lost() -> None:
    shop = Shop(**{PROBE: 24})
    shop.controller.set_input(24, True)
    shop.start(c.Probe(src(1), at(5), c.Pace(FEED), is_away=True), c.Sync(src(1)), end())
    shop.pass_time(0.5)
    contact = actual(shop)
    shop.controller.set_input(24, False)
    assert tripped(shop) == pytest.approx(contact, abs=2e-3)


def armed(travel: tuple[float, ...], cells: dict[str, float], *, rising: bool = True) -> Capture:
    shop = Shop(**cells)
    travel_u = (*travel, *(0.0,) * (8 - len(travel)))
    return capture_of(Settings(shop.store), travel_u, is_rising=rising)


@pytest.mark.parametrize(
    ("wire", "rising", "mode"),
    [
        (24, True, 2), (16, True, 3), (8, True, 8), (0, True, 9),
        (24, False, 6), (16, False, 7), (8, False, 12), (0, False, 13),
    ],
)  # fmt: skip
def test_each_bank_of_inputs_has_its_mode(wire: int, rising: bool, mode: int) -> None:
    capture = armed((1.0,), {PROBE: wire}, rising=rising)
    assert ([axis.name for axis in capture.axes], capture.mode) == (["X"], mode)


def test_software_capture_is_polled_because_it_was_chosen() -> None:
    capture = armed((1.0,), {PROBE: 24, SOFTWARE: 1})
    assert (capture.is_polled, capture.mode, capture.reason) == (True, 11, "")


def test_an_input_of_a_module_captures_nothing() -> None:
    capture = armed((1.0,), {"P250_124": 1, PROBE: 256})
    assert (capture.is_polled, capture.reason) == (True, "input 256 captures no axis")


def test_the_check_warns_of_what_the_card_does_not_capture() -> None:
    shop = Shop(**{PROBE: 24})
    preflight = Preflight(Settings(shop.store))
    predictor = Predictor(Settings(shop.store), at(), reader=preflight)
    for number, target in ((3, at(1)), (5, at(1, 0, -1)), (6, at(1, 0, -2))):
        predictor.add(c.Probe(src(number), target, c.Pace(FEED)))
    predictor.rest()
    assert [
        str(finding) for finding in preflight.findings(lambda _: "") if finding.code == "W404"
    ] == [
        "TEST.TXT:5:1: W404 probe not captured by the card: input 24 captures X, and Z one of"
        " 26, 18, 10, 2 (the probe is polled, which is less accurate)"
    ]


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def passed_until(shop: Shop, code: int, *, limit_s: float = 30.0) -> float:
    """Seconds of card time until an alarm is up."""
    for step in range(round(limit_s / 0.005)):
        if code in codes(shop):
            return step * 0.005
        shop.pass_time(0.005)
    raise AssertionError(f"{shop.runner.state.name} {shop.runner.reason} {codes(shop)}")


def test_a_probing_move_that_does_not_stop_loses_its_drives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop(**{PROBE: 24})
    monkeypatch.setattr(shop.runner.machine, "stop", lambda: None)
    touched(shop, at(50), (24,))
    limit_s = shop.runner.settings.rest_s
    assert passed_until(shop, 15) == pytest.approx(limit_s, abs=0.02)
    assert 5.0 < limit_s < 10.0
    shop.pass_time(1.0)
    place = shop.place()
    shop.pass_time(0.5)
    assert (shop.place(), shop.runner.state) == (place, State.ALARM)


def test_a_kill_that_stays_after_the_contact_ends_the_program(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop(**{PROBE: 24})
    monkeypatch.setattr(shop.runner.machine, "clear_kill", lambda: None)
    touched(shop, at(50), (24,))
    while shop.runner.reason != "kill is cleared":
        shop.pass_time(0.005)
    assert passed_until(shop, 14) == pytest.approx(2.0, abs=0.01)
    assert shop.runner.stream.host.tripped() is None  # and it does not go back to a point


@pytest.mark.parametrize("which", [1, 2])
def test_a_probing_move_that_the_card_does_not_begin_ends_the_program(
    monkeypatch: pytest.MonkeyPatch, which: int
) -> None:
    """The move itself, and the one back to where the probe tripped."""
    shop, sent = Shop(**{PROBE: 24}), 0
    send = shop.runner.machine.send

    def lose(moves: Iterable[Move]) -> None:
        nonlocal sent
        sent += 1
        if sent != which:
            send(moves)

    monkeypatch.setattr(shop.runner.machine, "send", lose)
    if which == 1:
        shop.start(c.Probe(src(1), at(5), c.Pace(FEED)), end())
    else:
        touched(shop, at(5), (24,))
    while sent < which:
        shop.pass_time(0.005)
    assert passed_until(shop, 18) == pytest.approx(3.0, abs=0.02)
    assert shop.until(State.ALARM) is State.ALARM
    assert [alarm.text for alarm in shop.runner.alarms.active] == [
        "Card does not make the moves it was sent"
    ]


def test_a_probing_move_takes_as_long_as_its_override_makes_it() -> None:
    """Standing still at an override of 0 is no fault."""
    shop = Shop(**{PROBE: 24, "P450_000": 0.0})
    shop.start(c.Probe(src(1), at(1), c.Pace(FEED)), end())
    shop.pass_time(0.2)
    shop.runner.overrides.choose(Override.FEED, 0)
    shop.pass_time(0.5)
    place = shop.place()
    shop.pass_time(10.0)
    assert (shop.place(), codes(shop)) == (place, [])
    shop.runner.overrides.choose(Override.FEED, 10)
    shop.until(State.IDLE)
    assert shop.pulses() == (10_000, 0, 0)
