"""Feed hold while a tap is in its hole: it comes out first, with the spindle turning."""

import pytest
from tests.mill.shop import Shop

from openacr.mill.run.lifecycle import Options, State

CW, CCW, DAC3, HOLD_INPUT = 40, 41, 6448, 5
CELLS = {
    "P800_000": 1, "P800_001": 0.01, "P800_002": 3, "P800_005": CW, "P800_006": CCW,
    "P400_002": HOLD_INPUT,
}  # fmt: skip
DEPTH, LEVEL = -5000, 1000


def tapping(code: str = "M3 S500\nG84 Z-.5 R.1 P.2 F60", **cells: float) -> Shop:
    shop = Shop(**(CELLS | cells))
    shop.load(f"G0 Z1\n{code}\nG80\nG0 X1\nM2\n$I CYCLES.TXT\n")
    return shop


def steps_until_paused(shop: Shop) -> list[tuple[int, float]]:
    """Z in pulses and volts of the spindle, every 5 ms; the feed never moves without it."""
    seen = []
    while shop.runner.state is not State.PAUSED:
        before = shop.pulses()[2]
        shop.pass_time(0.005)
        seen.append((shop.pulses()[2], shop.card.read(DAC3)))
        if shop.pulses()[2] != before and before < LEVEL:
            assert abs(seen[-1][1]) == 5.0
            assert shop.outputs([CW, CCW]) in ([True, False], [False, True])
    return seen


AT_SPEED = 11


@pytest.mark.req("MILL-G74-SYNC", "MILL-G84")
@pytest.mark.parametrize(("code", "into"), [("M4 S500\nG74", -5.0), ("M3 S500\nG84", 5.0)])
def test_the_reversal_is_complete_before_the_feed_goes_up_and_before_the_next_hole(
    code: str, into: float
) -> None:
    """Code 7: both directions by the sign, and a wait until the spindle is at speed."""
    shop = Shop(**(CELLS | {"P800_000": 7.0, "P800_004": AT_SPEED}))
    shop.load(f"G0 Z1\n{code} Z-.5 R.1 F60\nX1\nG80\nM2\n$I CYCLES.TXT\n")
    waits = [((0, 0, 10_000), into)]
    for x in (0, 10_000):
        waits += [((x, 0, DEPTH), -into), ((x, 0, LEVEL), into)]
    for place, volts in waits:
        shop.until(State.WAIT)
        shop.pass_time(1.0)
        assert (shop.pulses(), shop.runner.reason) == (place, "spindle at speed")
        assert shop.card.read(DAC3) == volts
        shop.controller.set_input(AT_SPEED, True)
        shop.pass_time(0.05)
        shop.controller.set_input(AT_SPEED, False)
    shop.until(State.IDLE)
    assert shop.pulses() == (10_000, 0, 10_000)


def down_to(shop: Shop, pulses: int) -> None:
    while shop.pulses()[2] > pulses:
        shop.pass_time(0.005)


@pytest.mark.parametrize("how", ["stop", "input"])
@pytest.mark.parametrize(
    ("code", "into", "out"),
    [("M3 S500\nG84 Z-.5 R.1 P.2 F60", 5.0, -5.0), ("M4 S500\nG74 Z-.5 R.1 F60", -5.0, 5.0)],
)
def test_a_hold_on_the_way_down_waits_for_the_retract(
    how: str, code: str, into: float, out: float
) -> None:
    shop = tapping(code)
    down_to(shop, -2000)
    assert shop.card.read(DAC3) == into
    if how == "stop":
        shop.runner.stop()
        shop.runner.stop()
    else:
        shop.controller.set_input(HOLD_INPUT, True)
        shop.pass_time(0.02)
        shop.controller.set_input(HOLD_INPUT, False)
    assert shop.runner.state is State.RUN
    seen = steps_until_paused(shop)
    depths = [z for z, _ in seen]
    bottom = depths.index(DEPTH)
    assert min(depths) == DEPTH
    assert {volts for _, volts in seen[:bottom]} == {into}
    assert {volts for z, volts in seen[bottom:] if z < LEVEL} == {out}
    assert (shop.pulses(), shop.card.read(DAC3)) == ((0, 0, LEVEL), into)
    shop.pass_time(0.5)
    assert shop.pulses() == (0, 0, LEVEL)
    said = [text for text in shop.said if "feed hold" in text]
    assert said == ["feed hold after the tap is out of its hole"]
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (10_000, 0, 10_000)


@pytest.mark.parametrize("after_s", [0.0, 0.1, 0.3, 0.5])
def test_a_hold_at_the_bottom_and_on_the_way_up_waits_too(after_s: float) -> None:
    shop = tapping()
    down_to(shop, DEPTH)
    shop.pass_time(after_s)
    shop.runner.stop()
    steps_until_paused(shop)
    assert (shop.pulses(), shop.card.read(DAC3)) == ((0, 0, LEVEL), 5.0)


def test_a_hold_before_and_after_the_tapping_acts_at_once() -> None:
    shop = tapping()
    shop.pass_time(0.05)
    shop.runner.stop()
    assert shop.runner.state is State.PAUSED
    shop.pass_time(0.5)
    assert 0 < shop.pulses()[2] < 10_000
    shop.runner.resume()
    while shop.pulses()[0] == 0:
        shop.pass_time(0.005)
    shop.runner.stop()
    assert shop.runner.state is State.PAUSED


def test_a_dry_run_holds_at_once_for_no_spindle_turns() -> None:
    shop = Shop(**CELLS)
    text = "G0 Z1\nM3 S500\nG84 Z-.5 R.1 F60\nM2\n$I CYCLES.TXT\n"
    shop.load(text, Options(is_dry=True))
    down_to(shop, -1000)
    shop.runner.stop()
    assert shop.runner.state is State.PAUSED


def test_an_abort_stops_feed_and_spindle_together_and_the_next_program_holds_at_once() -> None:
    shop = tapping()
    down_to(shop, -2000)
    shop.runner.stop()
    shop.runner.abort()
    shop.until(State.IDLE)
    place = shop.pulses()
    assert (shop.card.read(DAC3), shop.outputs([CW, CCW])) == (0.0, [False, False])
    assert DEPTH < place[2] < -1900
    shop.load("F60\nG1 Z1\nM2\n")
    shop.pass_time(0.1)
    shop.runner.stop()
    assert shop.runner.state is State.PAUSED


def test_single_block_pressed_in_a_hole_stops_after_the_hole() -> None:
    shop = tapping()
    down_to(shop, -2000)
    shop.runner.block(True)
    seen = []
    while shop.runner.state is not State.HOLD:
        before = shop.pulses()[2]
        shop.pass_time(0.005)
        seen.append((before, shop.pulses()[2]))
    rests = {z for before, z in seen if before == z and z < LEVEL}
    assert rests == {DEPTH}


def test_a_line_that_breaks_in_a_hole_stops_feed_and_spindle_together() -> None:
    shop = tapping()
    down_to(shop, -2000)
    shop.runner.machine._has_sent = True
    shop.card._talk.connections += 1
    shop.until(State.ALARM)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [3]
    assert (shop.card.read(DAC3), shop.outputs([CW, CCW])) == (0.0, [False, False])
