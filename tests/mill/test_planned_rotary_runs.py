"""Turns of a table within planned paths, while they run: holds, traces, overrides."""

import itertools
import math

import numpy as np
import pytest
from tests.mill.planned import FEED, SPEED, TOLERANCE, Reals, feed, go_on, stop
from tests.mill.planned_rotary import (
    BEGIN,
    PROGRAMS,
    SCALES,
    TURN_SPEED,
    A,
    assert_limits,
    counts,
    follow,
    line,
    off_path,
    rotary_shop,
    scales_of,
    to,
)
from tests.mill.shop import Shop, end
from tests.search import sparse
from tests.trajectory.measures import off

from openacr.cnc import canonical as c
from openacr.mill.plan.moves.encoding import Encoder
from openacr.mill.plan.moves.geometry import weights
from openacr.mill.run.rejoin import apart_u
from openacr.sysvar.tabs import AXIS, FOV, SPEEDS

TURN_PULSES = AXIS.pulses_per_unit[A]
TRACE_UPM = 600.0
HALF = 0.5


def rests_at_s(places: Reals, period_s: float, from_s: float) -> float:
    """The first time from one on at which no axis moves."""
    still = np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) == 0.0) * period_s
    return float(still[still > from_s][0])


HELD = [("wave", 0.4), ("mixed", 0.3), ("mixed", 0.75), ("turns", 0.5), ("circle", 1.2)]


@pytest.mark.parametrize(
    ("name", "at_s", "pulses"),
    sparse([(*held, pulses) for held, pulses in itertools.product(HELD, [10_000.0, 50.0])], 3),
)
def test_a_hold_among_turns_keeps_the_limits_and_the_path_goes_on(
    name: str, at_s: float, pulses: float
) -> None:
    shop, program = rotary_shop(**{f"P{TURN_PULSES}": pulses}), PROGRAMS[name]
    shop.start(*program)
    places = follow(shop, (at_s, stop), (at_s + 0.7, go_on))
    period_s = shop.controller.period_s
    assert rests_at_s(places, period_s, at_s) - at_s < 0.4
    assert_limits(places, period_s)  # the beginning from between two pulses is one of them
    assert (places[-1] * scales_of(shop)).tolist() == counts(program, scales_of(shop))
    assert off_path(shop.store, places, program) <= 2 * TOLERANCE + HALF / pulses


@pytest.mark.parametrize(
    ("name", "at_s", "speed_ups"),
    [("wave", 0.8, TRACE_UPM / 60), ("circle", 1.2, 2 * math.pi * 5 * TURN_SPEED / 360)],
)
def test_turns_are_traced_back_and_forward_as_far_as_they_were_held(
    name: str, at_s: float, speed_ups: float
) -> None:
    shop, program = rotary_shop(**{f"P{SPEEDS.forward_backward_speed}": TRACE_UPM}), PROGRAMS[name]
    seen: list[tuple[float, ...]] = []

    def note(shop: Shop) -> None:
        seen.append(shop.runner.stream.host.position()[: A + 1])

    shop.start(*program)
    places = follow(
        shop, (at_s, stop), (at_s + 0.4, note), (at_s + 0.5, lambda shop: shop.runner.trace(-1)),
        (at_s + 0.9, lambda shop: shop.runner.trace(0)), (at_s + 1.2, note),
        (at_s + 1.3, lambda shop: shop.runner.trace(1)), (at_s + 2.4, note), (at_s + 2.5, go_on),
    )  # fmt: skip
    held, back, forward = (np.array(place) for place in seen)
    assert np.linalg.norm((held - back)[:A]) > 1.0
    assert abs(held[A] - back[A]) > 2.0
    assert forward * SCALES == pytest.approx(held * SCALES, abs=1.0)
    assert (places[-1] * SCALES).tolist() == counts(program)
    assert off_path(shop.store, places, program) <= 2 * TOLERANCE
    period_s = shop.controller.period_s
    begin, over = (round((at_s + after) / period_s) for after in (0.5, 2.45))
    assert_limits(places[:begin], period_s)
    assert_limits(places[over:], period_s)
    rates = np.diff(places[begin:over], axis=0) / period_s
    assert np.linalg.norm(rates[:, :A], axis=1).max() == pytest.approx(speed_ups, rel=1e-3)
    assert np.abs(rates[:, A]).max() <= TURN_SPEED * (1 + 1e-4)  # its start is on pulses


@pytest.mark.parametrize(
    ("name", "percent"),
    sparse(list(itertools.product(["wave", "mixed", "turns"], [93.0, 97.0, 99.0])), 4),
)
def test_an_override_below_100_percent_is_the_speed_of_the_turn(name: str, percent: float) -> None:
    shop = rotary_shop(**{f"P{FOV.percents[9]}": percent})  # 90 by default
    feed(percent)(shop)
    shop.start(*PROGRAMS[name])
    places, period_s = follow(shop), shop.controller.period_s
    assert_limits(places, period_s)
    turned = np.abs(np.diff(places[:, A])).max() / period_s
    assert turned == pytest.approx(percent / 100 * TURN_SPEED, rel=1.1e-3)
    assert (places[-1] * SCALES).tolist() == counts(PROGRAMS[name])


@pytest.mark.parametrize("turn_deg", [30.0, 54.0])
def test_an_override_above_100_percent_ends_at_the_limit_of_the_table(turn_deg: float) -> None:
    shop = rotary_shop()
    percent = max(shop.store.read(cell) for cell in FOV.percents)
    assert percent > 100.0
    legs = [(30.0 * (k % 2), 0.0, 0.0, turn_deg * (k % 2)) for k in range(1, 5)]
    program: list[c.Entry] = [
        *(line(k, *place, feed=HALF * FEED) for k, place in enumerate(legs)), end()
    ]  # fmt: skip
    shop.start(*program)
    places, period_s = follow(shop, (0.1, feed(percent))), shop.controller.period_s
    assert_limits(places, period_s)
    rates = np.abs(np.diff(places, axis=0)) / period_s
    before, after = rates[: round(0.5 / period_s)].max(axis=0), rates.max(axis=0)
    share = turn_deg / 30.0  # degrees per unit
    assert before[A] == pytest.approx(HALF * SPEED * share, rel=1e-3)
    assert after[A] == pytest.approx(
        min(percent / 100 * HALF * SPEED * share, TURN_SPEED), rel=1e-3
    )
    assert after[0] == pytest.approx(after[A] / share, rel=1e-3)
    assert (places[-1] * SCALES).tolist() == counts(program)


@pytest.mark.parametrize(
    ("here", "lines"), [((0.005, 0, 0, 89.9), [1, 2]), ((0.002, 0, 0, 89.9), [1])]
)
def test_between_two_moves_a_degree_counts_as_a_length(
    here: tuple[float, ...], lines: list[int]
) -> None:
    """A degree is 1/32 inch: at 89.9 degrees the turn is 0.0031 inch from its end."""
    stream = rotary_shop().runner.stream
    encoder, tracker = Encoder(stream.settings), stream.tracker
    turn = encoder.job(line(1, 0, 0, 0, 90), BEGIN)
    travel = encoder.job(line(2, 10, 0, 0, 90), turn.finish)
    tracker.add(turn, has_packet=True)
    tracker.add_packet()  # part of a planned curve: the piece that follows has the corner
    tracker.add(travel, has_packet=True)
    tracker.update(turn.last)
    next(stream.withdraw(to(*here)))
    assert [job.entry.source.line for job in tracker.trail.path()] == lines


@pytest.mark.parametrize(
    "here", [(1.0, 0, 0, 30), (9.0, 1, 0, 89), (-1.0, 0, 0, -5), (0, 0, 0, 90)]
)
def test_the_distance_from_a_turned_line_is_measured_where_paths_are_planned(
    here: tuple[float, ...],
) -> None:
    each = weights(rotary_shop().runner.stream.settings)
    move, point = line(1, 10, 2, 0, 90), to(*here)
    begin, end, place = (np.array([p]) * each for p in (BEGIN, move.end, point))
    assert apart_u(move, BEGIN, point, each) == pytest.approx(off(place, begin, end))
