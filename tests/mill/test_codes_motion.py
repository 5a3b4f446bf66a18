"""G0 to G4, G9 and G61 to G64 on the virtual machine: speeds, ramps, corners, waits."""

import math
from itertools import pairwise

import pytest
from tests.mill.shop import STEP_S, Shop

from openacr.map import numbers as n
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import State

HALF, FULL = 5, 10  # clicks of the feed override: 50 and 100 percent
MAX_SPEED, RAPID_RAMP, FEED_RAMP, CORNER = "P650_000", "P650_007", "P650_008", "P650_003"
SOFT_LOOP, BAND = "P150_000", "P200_003"  # P gain and in-position band of X
ROV_HALF = 8  # 45 percent


def travelled(shop: Shop, text: str, *, every: int = 1) -> list[tuple[float, float, float]]:
    """Position, speed along X and path speed, tick by tick, of a program run to its end."""
    shop.load(text)
    found = []
    tick = 0
    while shop.runner.is_busy:
        shop.controller.advance(seconds=shop.controller.period_s)
        tick += 1
        if tick % 10 == 0:
            shop.runner.step()
        if tick % every == 0:
            speeds = [shop.controller.axis(axis).velocity_ups for axis in range(3)]
            found.append((shop.place()[0], speeds[0], math.hypot(*speeds)))
    return found


def ramps(speeds: list[float], period_s: float) -> tuple[float, float]:
    """The steepest rise and fall of a speed."""
    changes = [(after - before) / period_s for before, after in pairwise(speeds)]
    return max(changes), -min(changes)


@pytest.mark.req("MILL-G0", "MILL-G0-STOPBEFORE")
def test_g0_goes_straight_at_rapid_speed_from_rest_to_rest() -> None:
    shop = Shop(**{MAX_SPEED: 300.0, RAPID_RAMP: 50.0, FEED_RAMP: 200.0})
    shop.load("F60\nG1 X1\nG0 X4 Y4\nG1 X5\nM2\n")
    seen = []
    while shop.runner.is_busy:
        shop.pass_time(STEP_S)
        x, y, _ = shop.place()
        speed = math.hypot(*(shop.controller.axis(axis).velocity_ups for axis in (0, 1)))
        seen.append((x, y, speed))
    rapid = [row for row in seen if 1.0 < row[0] < 4.0]
    assert all(y == pytest.approx((x - 1) * 4 / 3, abs=2e-4) for x, y, _ in rapid)
    assert max(speed for *_, speed in rapid) == pytest.approx(5.0, rel=1e-6)
    # v2 = 2 a s: the ramps of rapids, at both ends down to nothing
    for x, _, speed in rapid:
        path = (x - 1.0) * 5 / 3
        bound = math.sqrt(2 * 50.0 * min(path, 5.0 - path))
        assert speed <= bound * 1.02 + 0.3
    for corner_x in (1.0, 4.0):
        at_corner = min(speed for x, _, speed in seen if abs(x - corner_x) < 1e-4)
        assert at_corner <= 200.0 * shop.controller.period_s  # one tick of the ramp


@pytest.mark.req("MILL-G0-ROV")
@pytest.mark.parametrize(("feed", "rapid", "speed"), [(HALF, 15, 5.0), (FULL, ROV_HALF, 2.25)])
def test_only_the_rapid_override_slows_g0(feed: int, rapid: int, speed: float) -> None:
    shop = Shop(**{MAX_SPEED: 300.0})
    shop.runner.overrides.choose(Override.FEED, feed)
    shop.runner.overrides.choose(Override.RAPID, rapid)
    seen = travelled(shop, "G0 X6\nM2\n")
    assert max(v for _, v, _ in seen) == pytest.approx(speed, rel=1e-6)


@pytest.mark.req("MILL-G1-FEEDCHANGE")
def test_a_new_f_ramps_the_speed_at_the_block_without_a_stop() -> None:
    shop = Shop()
    seen = travelled(shop, "F60\nG1 X2\nX4 F180\nX6 F30\nX6.5\nM2\n")
    speeds = [v for _, v, _ in seen]
    for low, high, speed in ((0.5, 1.9, 1.0), (2.1, 3.9, 3.0), (4.1, 6.4, 0.5)):
        part = [v for x, v, _ in seen if low < x < high]
        assert sorted(part)[len(part) // 2] == pytest.approx(speed)
    assert min(v for x, v, _ in seen if 0.1 < x < 6.45) > 0.49
    rise, fall = ramps(speeds, shop.controller.period_s)
    assert rise == pytest.approx(100.0, rel=0.05)
    assert fall == pytest.approx(100.0, rel=0.05)


@pytest.mark.req("MILL-G1-CONT", "MILL-G64")
def test_lines_and_arcs_run_as_one_path() -> None:
    shop = Shop()
    text = "G64 F120\nG1 X2\nG3 X2 Y2 I2 J1\nG1 X1\nG2 X0 Y3 I1 J3\nG1 Y4\nM2\n"
    seen = travelled(shop, text)
    speeds = [speed for *_, speed in seen]
    first = next(k for k, speed in enumerate(speeds) if speed > 1.99)
    last = len(speeds) - next(k for k, speed in enumerate(reversed(speeds)) if speed > 1.99)
    assert min(speeds[first:last]) > 1.98
    assert max(speeds) < 2.02


@pytest.mark.req("MILL-G1-FOV")
@pytest.mark.parametrize("move", ["G1 X4", "G2 X4 Y0 I2 J0", "G3 X4 Y0 I2 J0"])
def test_the_feed_override_acts_on_lines_and_arcs(move: str) -> None:
    shop = Shop()
    shop.runner.overrides.choose(Override.FEED, HALF)
    seen = travelled(shop, f"F240\n{move}\nM2\n")
    assert max(speed for *_, speed in seen) == pytest.approx(2.0, rel=2e-3)


@pytest.mark.req("MILL-G63")
@pytest.mark.parametrize(
    ("codes", "speeds"),
    [("G63", (2.0, 2.0)), ("G64", (1.0, 1.0)), ("G63|G61", (2.0, 1.0)), ("G63|G62", (2.0, 1.0)),
     ("G63|G64", (2.0, 1.0)), ("G64|G63", (1.0, 2.0))],
)  # fmt: skip
def test_g63_runs_at_100_percent_until_another_mode(
    codes: str, speeds: tuple[float, float]
) -> None:
    shop = Shop()
    shop.runner.overrides.choose(Override.FEED, HALF)
    first, _, second = codes.partition("|")
    seen = travelled(shop, f"{first} F120\nG1 X1\n{second}\nX2\nM2\n")
    for part, speed in zip(((0.2, 0.8), (1.2, 1.8)), speeds, strict=True):
        found = [v for x, v, _ in seen if part[0] < x < part[1]]
        assert found == pytest.approx([speed] * len(found), rel=1e-6)


def corner(shop: Shop, text: str) -> float:
    """The lowest speed along X, then along Y, around the corner at X2."""
    shop.load(f"{text}\nM2\n")
    seen: list[tuple[float, float]] = []
    while shop.runner.is_busy:
        shop.controller.advance(seconds=shop.controller.period_s)
        if shop.controller.tick % 10 == 0:
            shop.runner.step()
        speeds = [abs(shop.controller.axis(axis).velocity_ups) for axis in (0, 1)]
        seen.append((shop.place()[0], sum(speeds)))
    near = [k for k, (x, _) in enumerate(seen) if abs(x - 2.0) < 0.02]
    return min(seen[k][1] for k in range(near[0], near[0] + 60))


RIGHT_ANGLE = "F120\nG1 X2\nY1"


# Acute angle 45, corner speed 60: F - (F - m) (q - a1)/(180 - a1) at a right angle, F 120
SLOW = (120.0 - 60.0 * 45 / 135) / 60


@pytest.mark.req("MILL-G62")
@pytest.mark.parametrize(
    ("modes", "speed"),
    [("G62", SLOW), ("G64", 2.0), ("G63", 2.0), ("G61", 0.0), ("G62|G63", 2.0),
     ("G62|G64", 2.0), ("G62|G61", 0.0), ("G64|G62", SLOW)],
)  # fmt: skip
def test_g62_slows_corners_down_by_their_angle(modes: str, speed: float) -> None:
    shop = Shop(**{"P250_010": 45.0, CORNER: 60.0})
    text = f"{modes.replace('|', chr(10))}\n{RIGHT_ANGLE}"
    assert corner(shop, text) == pytest.approx(speed, abs=0.06)


@pytest.mark.req("MILL-G9", "MILL-G61")
@pytest.mark.parametrize(
    ("first", "second", "waits"),
    [("", "", (False, False)), ("G9 ", "", (True, False)), ("G61 ", "", (True, True)),
     ("G61 ", "G64 ", (True, False)), ("G61 ", "G62 ", (True, False))],
)  # fmt: skip
def test_exact_stops_let_nothing_start_before_the_axes_are_in_position(
    first: str, second: str, waits: tuple[bool, bool]
) -> None:
    shop = Shop(**{BAND: 0.0002, SOFT_LOOP: 0.0005})  # 2 pulses, a slow servo loop
    shop.load(f"F1200\n{first}G1 X1\n{second}X2\nX3\nM2\n")
    errors = {10_000: 1e9, 20_000: 1e9}
    before = 0
    while shop.runner.is_busy:
        shop.controller.advance(seconds=shop.controller.period_s)
        if shop.controller.tick % 4 == 0:
            shop.runner.step()
        now = shop.pulses()[0]
        if before in errors and now > before:  # the next move starts here
            errors[before] = abs(float(shop.controller.p[n.AX_BASE + n.AX_FOLLOWING_ERROR]))
        before = now
    for place, does_wait in zip((10_000, 20_000), waits, strict=True):
        # without the wait the axis passes between two pulses, or lags far
        assert (errors[place] <= 3) == does_wait, (place, errors)


@pytest.mark.req("MILL-G4-FEEDHOLD")
def test_feed_hold_freezes_a_dwell_and_cycle_start_counts_on() -> None:
    shop = Shop(P400_002=9, P400_003=10)
    shop.load("F600\nG4 F2\nG1 X1\nM2\n")
    shop.pass_time(1.0)
    shop.controller.set_input(9, True)
    shop.pass_time(0.1)
    shop.controller.set_input(9, False)
    shop.pass_time(5.0)
    assert shop.runner.state is State.PAUSED
    assert shop.pulses()[0] == 0
    shop.controller.set_input(10, True)
    shop.pass_time(0.9)
    assert shop.pulses()[0] == 0
    shop.pass_time(0.3)
    assert shop.pulses()[0] > 0
    shop.until(State.IDLE)


@pytest.mark.req("MILL-G4-ABORT")
@pytest.mark.parametrize("is_emergency", [False, True])
def test_abort_and_emergency_stop_end_a_dwell_at_once(is_emergency: bool) -> None:
    shop = Shop(P400_004=12)
    shop.load("F600\nG4 F900\nG1 X1\nM2\n")
    shop.pass_time(0.5)
    assert shop.runner.state is State.WAIT
    if is_emergency:
        shop.controller.set_input(12, True)
    else:
        shop.runner.abort()
    ended = shop.until(State.IDLE, State.ALARM, limit_s=0.2)
    assert (ended is State.ALARM) == is_emergency
    shop.pass_time(1.0)
    assert shop.pulses()[0] == 0
