"""Vectorized planning data of a polyline: many straight moves computed at once.

The formulas are those of `geometry` and `encoding`, for n moves at once: programs of
free-form surfaces are millions of short lines.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from openacr.cnc.canonical import Line, Polyline, Source
from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings
from openacr.mill.plan.geometry import Point, limits_jerk, weights

Column = NDArray[np.float64]
MOST_PULSES = float(1 << 62)  # beyond any card; keeps the conversion to integers defined


@dataclass(frozen=True, slots=True)
class Columns:
    """Planning data of n straight moves, one row each."""

    length_u: Column
    feed_ups: Column
    ramp_ups2: Column
    jerk_ups3: Column
    direction: NDArray[np.float64]  # n x linear axes; unit vectors, 0 without linear motion
    turns: NDArray[np.float64]  # n x rotary axes, see `MoveShape`
    tolerance_u: Column  # of the corners at their ends
    pulses: NDArray[np.int64]  # (n + 1) x axes of the machine, start first


def columns(
    polyline: Polyline,
    begin: Point,
    settings: Settings,
    wanted_ups: float,
    tolerance_u: float = 0.0,
) -> Columns:
    """Lengths, tangents, limits and pulses of the lines of a polyline."""
    axes, speeds = settings.axes, settings.speeds
    points = np.vstack((np.asarray(begin, float), polyline.ends))
    delta = np.diff(points, axis=0)
    linear = [axis.index for axis in axes if axis.is_linear]
    rotary = [axis.index for axis in axes if not axis.is_linear]
    along = np.sqrt(np.sum(delta[:, linear] ** 2, axis=1))
    turned = np.max(np.abs(delta[:, rotary]), axis=1, initial=0.0)
    is_linear = along > 0.0
    length = np.where(is_linear, along, turned)
    per = np.where(length > 0.0, length, 1.0)[:, None]
    share = np.abs(delta) / per
    feed = np.where(is_linear, min(wanted_ups, speeds.max_ups), wanted_ups)
    fastest_turn = np.maximum(share[:, rotary].max(axis=1, initial=0.0), 1.0)
    ramp = speeds.feed_acc_ups2 / (fastest_turn if can_plan(settings) else np.ones(len(length)))
    only_linear = is_linear & (turned == 0.0)
    tolerance = np.where(only_linear, tolerance_u, 0.0)
    rounds = tolerance > 0.0
    jerk = np.where(is_linear | (turned == 0.0), speeds.jerk_ups3, np.inf)
    for axis in axes:
        goes = share[:, axis.index]
        rotary_ups = speeds.rotary_max if axis.index in rotary else 0.0
        feed = _limited(_limited(feed, axis.max_speed_ups, goes), rotary_ups, goes)
        part = np.where(rounds & (goes > 0.0), 1.0, goes)  # see Geometry.ramp_limit
        ramp = _limited(ramp, axis.max_acceleration_ups2, part)
        if limits_jerk(axis, speeds.jerk_ups3):
            jerk = _limited(jerk, axis.jerk_ups3, goes)
    jerk = np.where(np.isinf(jerk), speeds.jerk_ups3, jerk)  # a move that none of these limits
    scale = np.array([axis.pulses_per_unit for axis in axes])
    exact = np.clip(points[:, [axis.index for axis in axes]] * scale, -MOST_PULSES, MOST_PULSES)
    pulses = np.copysign(np.floor(np.abs(exact) + 0.5), exact).astype(np.int64)
    direction = delta[:, linear] / per
    if tolerance_u > 0.0:
        sent, goes_far = _as_sent(np.diff(pulses, axis=0) / scale, axes)
        direction[rounds & goes_far] = sent[rounds & goes_far]
    turns = np.array(weights(settings))[rotary] * delta[:, rotary] / per
    return Columns(length, feed, ramp, jerk, direction, turns, tolerance, pulses)


def _as_sent(
    delta: NDArray[np.float64], axes: Sequence[AxisSettings]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Directions of moves between whole pulses, as the card makes them; and which have one.

    In short moves rounding creates corners that the program does not have.
    """
    linear = delta[:, [axis.is_linear for axis in axes]]
    length = np.linalg.norm(linear, axis=1)
    goes_far = length > 0.0
    return linear / np.where(goes_far, length, 1.0)[:, None], goes_far


def _limited(vector: Column, limit: float, share: Column) -> Column:
    """Limit a speed or ramp along the path by the limit of an axis; 0 is no limit."""
    if limit <= 0.0:
        return vector
    with np.errstate(divide="ignore"):
        return np.minimum(vector, np.where(share > 0.0, limit / share, np.inf))


def lines(polyline: Polyline) -> Iterator[Line]:
    """Yield the moves one by one; their text can be read from the file."""
    file, pace = polyline.source.file, polyline.pace
    for end, line in zip(polyline.ends.tolist(), polyline.lines.tolist(), strict=True):
        yield Line(Source(file, line, ""), tuple(end), pace)
