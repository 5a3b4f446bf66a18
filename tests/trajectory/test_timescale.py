"""Override and feed hold in front of a plan: limits, ends, stops, and the return to 100 %."""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np
import pytest
from scipy.spatial import cKDTree
from tests.trajectory import plans
from tests.trajectory.plans import ACCEL, JERK, PERIOD_S, Rows, curve, highest

from openacr.compiled import is_compiled
from openacr.trajectory.override import timescale, timescale_cy
from openacr.trajectory.override.timescale import Progress, TimeScale

pytestmark = pytest.mark.evidence("oracle", "distances to the planned path by scipy")

Event = tuple[float, float, float]  # from, to [s], scale
SLOW = [0.0, 0.0, 0.2, 0.5, 0.8]
SCALES = [*SLOW, 0.93, 0.95, 0.98, 0.99]


def scaled(plan: Rows) -> TimeScale:
    """A plan that is known to its end."""
    scale = TimeScale(plan[0], PERIOD_S, [ACCEL] * 3, [JERK] * 3)
    scale.append(plan[3:])
    scale.complete()
    return scale


class Ride:
    """A plan run through to its end with a course of overrides."""

    def __init__(self, plan: Rows, events: Iterable[Event] = ()) -> None:
        self.scale, events = scaled(plan), list(events)
        sent = [plan[0]] * 3
        scales: list[float] = []
        knots: list[float] = []
        progress = Progress.MOVES
        while progress is not Progress.ENDED:
            now_s = len(scales) * PERIOD_S
            wanted = (to for begin, end, to in events if begin <= now_s < end)
            self.scale.want = next(wanted, 1.0)
            progress, point = self.scale.next()
            sent.append(point)
            scales.append(self.scale.scale)
            knots.append(self.scale.knot)
            assert progress is not Progress.WAITS
        self.points, self.scales, self.knots = np.array(sent), np.array(scales), np.array(knots)

    def rest_s(self, begin_s: float) -> float:
        """The time from a hold until the scale is 0; infinite if it was withdrawn before."""
        first = math.ceil(begin_s / PERIOD_S - 1e-9)
        rests = np.flatnonzero(self.scales[first:] == 0.0)
        return (rests[0] + 1) * PERIOD_S if len(rests) else math.inf


def some_events(seed: int, among: Sequence[float] = SCALES) -> list[Event]:
    """Holds and overrides of 50 to 600 ms, one every 0.1 to 0.6 s."""
    chance, events, now_s = np.random.default_rng(seed), [], 0.1
    while now_s < 60.0:
        end_s = now_s + chance.uniform(0.05, 0.6)
        events.append((now_s, end_s, float(chance.choice(among))))
        now_s = end_s + chance.uniform(0.1, 0.6)
    return events


PLANS: list[tuple[Callable[..., Rows], float]] = [
    *((plans.lines, seed) for seed in range(6)),
    *((plans.circle, radius) for radius in (0.5, 3.0, 20.0)),
    *((plans.smooth, seed) for seed in range(12)),
]


@pytest.mark.parametrize(("plan", "number"), PLANS)
def test_no_override_and_no_hold_exceeds_a_limit_or_misses_the_end(
    plan: Callable[..., Rows], number: float
) -> None:
    points = plan(number)
    events = some_events(int(10 * number))
    ride = Ride(points, events)
    speed, accel, jerk = highest(ride.points)
    assert speed <= highest(points)[0] * (1 + 1e-8)
    assert accel <= ACCEL * (1 + 1e-8)
    assert jerk <= JERK * (1 + 1e-8)
    assert (ride.points[-3:] == points[-1]).all()
    assert len(ride.points) > len(points)


def test_two_hundred_events_are_among_these() -> None:
    lengths = [len(Ride(f(n), some_events(int(10 * n))).scales) * PERIOD_S for f, n in PLANS]
    begun = [
        sum(begin < end_s for begin, _, _ in some_events(int(10 * n)))
        for (_, n), end_s in zip(PLANS, lengths, strict=True)
    ]
    assert sum(begun) >= 200


@pytest.mark.parametrize("every_ms", [1.0, 0.5])
def test_samples_of_the_curve_keep_the_limits_in_every_phase(every_ms: float) -> None:
    ride = Ride(plans.smooth(3), some_events(3, SLOW))
    per_knot = round(1000 * PERIOD_S / every_ms)
    period_s = PERIOD_S / per_knot
    for phase in np.arange(0.0, 1.0, 0.25):
        places = curve(ride.points, per_knot, phase)[:-per_knot]
        for order, limit in ((2, ACCEL), (3, JERK)):
            found = np.abs(np.diff(places, order, axis=0)).max() / period_s**order
            assert 0.9 * limit < found <= limit * (1 + 1e-4)  # rounding over 0.5 ms cubed


def test_a_hold_from_full_speed_rests_within_a_quarter_of_a_second() -> None:
    for begin_s in np.arange(0.15, 0.35, 0.01):
        ride = Ride(plans.line(60.0, jerk=0.97 * JERK), [(begin_s, begin_s + 0.4, 0.0)])
        assert ride.rest_s(begin_s) <= 0.25


def test_without_an_override_the_control_points_are_those_of_the_plan() -> None:
    plan = plans.smooth(1)
    assert (Ride(plan).points == plan).all()


def test_back_at_full_speed_the_control_points_are_those_of_the_plan_again() -> None:
    plan = plans.line(160.0, jerk=0.97 * JERK)
    ride = Ride(plan, [(0.2, 0.35, 0.5), (0.6, 0.85, 0.0)])
    again = ride.points[-60:]
    assert ride.scales.min() == 0.0
    assert (again == plan[-60:]).all()


def test_an_override_is_reached_exactly() -> None:
    ride = Ride(plans.line(80.0, jerk=0.97 * JERK), [(0.2, 9.0, 0.3)])
    assert ride.scales[-1] == 0.3


@pytest.mark.parametrize("want", [0.9, 0.92, 0.921, 0.94, 0.96, 0.98, 0.99, 0.999])
@pytest.mark.parametrize("plan", [plans.line(160.0, jerk=0.96 * JERK), plans.circle(3.0)])
def test_every_scale_just_below_full_speed_is_reached_exactly(want: float, plan: Rows) -> None:
    ride = Ride(plan, [(0.0, 99.0, want)])
    assert np.mean(ride.scales == want) > 0.95
    assert (ride.points[-1] == plan[-1]).all()
    speed, accel, jerk = highest(ride.points)
    assert speed == pytest.approx(want * highest(plan)[0], rel=1e-3)
    assert accel <= ACCEL * (1 + 1e-8)
    assert jerk <= JERK * (1 + 1e-8)


@pytest.mark.parametrize("want", [0.95, 0.97, 0.985])
@pytest.mark.parametrize("seed", range(4))
def test_a_scale_that_the_plan_leaves_no_jerk_for_is_given_up_for_a_while(
    want: float, seed: int
) -> None:
    plan = plans.lines(seed)
    assert highest(plan)[2] > 0.999 * JERK
    ride = Ride(plan, [(0.0, 99.0, want)])
    assert ride.scales.min() >= timescale_cy.STEADY - 1e-9
    assert 0.3 < np.mean(ride.scales == want) < 1.0
    assert highest(ride.points)[2] <= JERK * (1 + 1e-8)
    assert (ride.points[-1] == plan[-1]).all()


def test_a_hold_and_full_speed_follow_a_scale_just_below_it() -> None:
    plan = plans.line(160.0, jerk=0.96 * JERK)
    ride = Ride(plan, [(0.0, 0.5, 0.97), (0.5, 1.0, 0.0), (1.3, 9.0, 0.97)])
    assert 0.97 in ride.scales and 1.0 in ride.scales and 0.0 in ride.scales
    assert ride.scales[-1] == 0.97
    assert ride.rest_s(0.5) <= 0.25


@pytest.mark.parametrize("scale", [0.92, 0.9, 0.71, 0.33])
def test_a_jerk_that_alternates_at_every_knot_is_within_the_limit_at_any_constant_scale(
    scale: float,
) -> None:
    plan = plans.bang_bang()
    assert highest(plan)[2] == pytest.approx(JERK, rel=0.01)
    jerk = highest(Ride(plan, [(0.0, 99.0, scale)]).points)[2]
    assert 0.25 * JERK * scale**3 < jerk <= JERK * (1 + 1e-9)


def test_the_curve_stays_on_the_path_of_the_plan() -> None:
    plan = plans.circle(3.0)
    ride = Ride(plan, some_events(5))
    there = cKDTree(curve(plan, 400))
    assert there.query(curve(ride.points, 5))[0].max() < 0.001


def test_a_plan_that_comes_in_parts_is_run_as_if_it_were_known() -> None:
    plan, events = plans.smooth(2), some_events(2)
    scale = TimeScale(plan[0], PERIOD_S, [ACCEL] * 3, [JERK] * 3)
    sent, known, progress = [plan[0]] * 3, 3, Progress.MOVES
    while progress is not Progress.ENDED:
        if scale.ahead < 150 and known < len(plan):
            scale.append(plan[known : known + 60])
            known += 60
            if known >= len(plan):
                scale.complete()
        now_s = (len(sent) - 3) * PERIOD_S
        scale.want = next((to for a, b, to in events if a <= now_s < b), 1.0)
        progress, point = scale.next()
        sent.append(point)
    assert (np.array(sent) == Ride(plan, events).points).all()


def test_a_point_that_is_not_known_is_not_sent() -> None:
    plan = plans.line()
    scale = TimeScale(plan[0], PERIOD_S, [ACCEL] * 3, [JERK] * 3)
    assert scale.next()[0] is Progress.WAITS
    scale.append(plan[3:30])
    sent = []
    while (answer := scale.next())[0] is Progress.MOVES:
        sent.append(answer[1])
    assert answer[0] is Progress.WAITS
    scale.append(plan[30:])
    scale.complete()
    while (answer := scale.next())[0] is Progress.MOVES:
        sent.append(answer[1])
    sent.append(answer[1])
    assert (np.array(sent) == plan[3:]).all()


def test_a_hold_waits_until_the_plan_shows_how_to_rest() -> None:
    plan = plans.line(80.0)
    scale = TimeScale(plan[0], PERIOD_S, [ACCEL] * 3, [JERK] * 3)
    scale.append(plan[3:60])
    for _ in range(50):
        assert scale.next()[0] is Progress.MOVES
    scale.want = 0.0
    before = [scale.next()[0] for _ in range(3)]
    assert before == [Progress.MOVES] * 3
    assert scale.scale == 1.0
    scale.append(plan[60:])
    scale.complete()
    while scale.next()[0] is Progress.MOVES:
        pass
    assert (scale.scale, scale.next()[0]) == (0.0, Progress.HELD)


def test_a_hold_at_rest_gives_no_point_until_it_is_withdrawn() -> None:
    ride = scaled(plans.line())
    ride.want = 0.0
    assert ride.next()[0] is Progress.HELD
    ride.want = 1.0
    assert ride.next()[0] is Progress.MOVES


def test_nothing_follows_the_end() -> None:
    scale = scaled(plans.line())
    with pytest.raises(ValueError, match="ended at rest"):
        scale.append(plans.line())


@pytest.mark.parametrize("want", [-0.01, 1.01, math.nan])
def test_a_scale_beyond_0_to_1_is_refused(want: float) -> None:
    with pytest.raises(ValueError, match="allowed are 0 to 1"):
        scaled(plans.line()).want = want


@pytest.mark.skipif(not is_compiled, reason="the core is not compiled")
def test_both_builds_give_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = Ride(plans.smooth(7), some_events(7)).points
    monkeypatch.setattr(timescale, "_advance", timescale_cy.scale_advance)
    assert Ride(plans.smooth(7), some_events(7)).points.tobytes() == compiled.tobytes()
