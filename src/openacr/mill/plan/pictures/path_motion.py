"""Speed, acceleration and jerk along the path of a program, for pictures.

Each quantity is the magnitude of a vector of the linear axes. On a planned curve it follows from
the control points (trajectory/path/setpoints.py). A move on its own has the position p(s) at the
distance s, and phases with v = ds/dt and a = dv/dt (see `phases`):

    speed  |p'| v        acceleration  |p'' v^2 + p' a|

p'' is 1/r on arcs, and that of the corners that the card rounds (kernel/path/corner_cy.py). The
jerk of such a move is unknown: its acceleration changes in steps, or as the card limits it.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from openacr.cnc.canonical import Arc, Point
from openacr.kernel.path.corner_cy import corner_lift
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import S_PER_MIN, Settings
from openacr.mill.plan.moves.arcs import along
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.geometry import linear_axes
from openacr.mill.plan.moves.phases import Phases
from openacr.mill.plan.pictures.quantities import Quantity
from openacr.mill.plan.pictures.tool_path import DRAWN_CNT, MOST_POINTS
from openacr.trajectory.path.setpoints import evaluate

Rows = NDArray[np.float64]
RAMP_PARTS = 16  # of a phase whose speed changes, or half a rounded corner
TURN_RAD = math.radians(2.0)  # of an arc, at most in one part


@dataclass(frozen=True, slots=True)
class Motion:
    """A path as points, and the quantity in the middle between each two.

    NaN is unknown, and what is not in `moves` is no move.
    """

    quantity: Quantity
    points: Rows
    values: Rows
    moves: NDArray[np.bool_]
    is_cut: bool  # there are more moves than a picture holds

    @property
    def known(self) -> NDArray[np.bool_]:
        """Which values are known."""
        return ~np.isnan(self.values)

    @property
    def unknown(self) -> NDArray[np.bool_]:
        """Which moves have no value."""
        return self.moves & np.isnan(self.values)

    @property
    def highest(self) -> float:
        """The highest known value; 0 if there is none."""
        return float(self.values[self.known].max(initial=0.0))


class PathMotion:
    """Follows the moves of a program as they are planned; give it to a `Predictor` as reader."""

    def __init__(self, settings: Settings, axes: tuple[int, ...], quantity: Quantity) -> None:
        """`axes` are those that are drawn."""
        self._axes, self._quantity = list(axes), quantity
        self._linear = linear_axes(settings)
        indices = [axis.index for axis in settings.axes]
        self._columns = [indices.index(axis) for axis in axes]
        self._linear_columns = [indices.index(axis) for axis in self._linear]
        self._parts: list[tuple[Rows, Rows]] = []
        self._cnt = 0
        self._is_cut = False
        self._before: Job | None = None  # the last move followed, where a corner may join it
        self._next: tuple[Job, Phases] | None = None  # waits for the direction of its successor

    def read(self, job: Job) -> None:
        """Ignore a move that is not planned yet."""

    def passed(self, job: Job, phases: Phases) -> None:
        """Receive a planned move; those of a curve are known from its control points."""
        if job.is_in_curve:
            return
        self._follow(job)
        self._next = job, phases

    def rested(self, seconds: float) -> None:
        """Follow the waiting move: it ends at rest."""
        self._follow(None)
        self._before = None

    def curve(self, points: Rows) -> None:
        """Follow a planned curve: a part for every period."""
        self.rested(0.0)
        if self._is_full():
            return
        knots = np.arange(len(points), dtype=np.float64)
        middles = evaluate(points, knots[:-1] + 0.5)
        order = list(Quantity).index(self._quantity) + 1
        rates = middles[order][:, self._linear_columns] / PERIOD_S**order
        places = evaluate(points, knots)[0][:, self._columns]
        self._add(places, np.linalg.norm(rates, axis=1))

    def finished(self) -> Motion:
        """Return the whole path."""
        self.rested(0.0)
        points = [places for places, _ in self._parts] or [np.zeros((1, DRAWN_CNT))]
        lifted = np.full(1, np.nan)  # from the end of a part to the begin of the next
        values = [part for _, found in self._parts for part in (lifted, found)][1:]
        is_move = [np.full(len(part), part is not lifted) for part in values]
        return Motion(
            self._quantity,
            np.concatenate(points),
            np.concatenate([*values, np.zeros(0)])
            * (S_PER_MIN if self._quantity is Quantity.SPEED else 1.0),
            np.concatenate([*is_move, np.zeros(0, dtype=np.bool_)]),
            self._is_cut,
        )

    def _is_full(self) -> bool:
        """Whether a move is left out, which is noted."""
        self._is_cut = self._cnt >= MOST_POINTS
        return self._is_cut

    def _add(self, places: Rows, values: Rows) -> None:
        drawn = np.zeros((len(places), DRAWN_CNT))
        drawn[:, : places.shape[1]] = places
        self._parts.append((drawn, values))
        self._cnt += len(places)

    # --- moves of their own --------------------------------------------------------------

    def _follow(self, following: Job | None) -> None:
        """Follow the waiting move."""
        if self._next is None:
            return
        job, phases = self._next
        self._next = None
        if not self._is_full():
            shape = _Shape(job, self._before, following, self._linear)
            places, values = [shape.place(0.0)], []
            for middle_u, end_u, v_ups, a_ups2 in _parts(job, phases, shape):
                places.append(shape.place(end_u))
                values.append(self._value(shape, middle_u, v_ups, a_ups2))
            self._add(np.array(places)[:, self._axes], np.array(values))
        self._before = job

    def _value(self, shape: "_Shape", at_u: float, v_ups: float, a_ups2: float) -> float:
        if self._quantity is Quantity.JERK:
            return math.nan
        tangent, bend = shape.derivatives(at_u)
        if self._quantity is Quantity.SPEED:
            return float(np.linalg.norm(tangent)) * v_ups
        return float(np.linalg.norm(bend * v_ups**2 + tangent * a_ups2))


def _parts(
    job: Job, phases: Phases, shape: "_Shape"
) -> Iterator[tuple[float, float, float, float]]:
    """Parts of a move: the distances at their middles in time and their ends, speed, ramp."""
    begin_u, entry = 0.0, job.entry
    sweep_rad = abs(entry.sweep_rad) if isinstance(entry, Arc) else 0.0
    for phase in phases:
        if phase.seconds <= 0.0:
            continue
        turns = math.ceil(sweep_rad * phase.length_u / job.length_u / TURN_RAD)
        is_level = phase.begin_ups == phase.end_ups
        is_even = is_level and not shape.is_round(begin_u + 0.5 * phase.length_u)
        count = max(turns, 1 if is_even else RAMP_PARTS)
        for k in range(count):
            middle_u, v_ups, a_ups2 = phase.at((k + 0.5) / count * phase.seconds)
            end_u, _, _ = phase.at((k + 1.0) / count * phase.seconds)
            yield begin_u + middle_u, begin_u + end_u, v_ups, a_ups2
        begin_u += phase.length_u


class _Shape:
    """The path of one move, with the rounded corners at its ends."""

    def __init__(
        self, job: Job, before: Job | None, following: Job | None, linear: list[int]
    ) -> None:
        self._job, self._linear = job, linear
        self._corners: list[tuple[float, float, Rows]] = []  # place, reach, change of direction
        for at_u, first, second in ((0.0, before, job), (job.length_u, job, following)):
            if first is None or second is None or first.corner is None:
                continue
            if first.end is not None and second.start is not None:
                turn = np.subtract(second.start, first.end)
                self._corners.append((at_u, first.corner.reach_u, turn))

    def is_round(self, at_u: float) -> bool:
        """Whether a place is in a rounded corner."""
        return any(abs(at_u - corner_u) < reach_u for corner_u, reach_u, _ in self._corners)

    def place(self, at_u: float) -> Point:
        """The position of all axes."""
        job, share = self._job, min(at_u / self._job.length_u, 1.0)
        if isinstance(job.entry, Arc):
            point = list(along(job.entry, job.begin, share))
        else:
            point = [a + share * (b - a) for a, b in zip(job.begin, job.finish, strict=True)]
        for corner_u, reach_u, turn in self._corners:
            lift = corner_lift(abs(at_u - corner_u), reach_u, 0)
            for axis, part in zip(self._linear, turn.tolist(), strict=True):
                point[axis] += lift * part
        return tuple(point)

    def derivatives(self, at_u: float) -> tuple[Rows, Rows]:
        """The first and second derivative of the linear axes by the distance."""
        job = self._job
        travel = np.subtract(job.finish, job.begin) / job.length_u
        bend = np.zeros_like(travel)
        if isinstance(job.entry, Arc):
            _turn(job.entry, job, at_u, travel, bend)
        tangent, bend = travel[self._linear], bend[self._linear]
        for corner_u, reach_u, turn in self._corners:
            away_u = at_u - corner_u
            if abs(away_u) < reach_u:  # the lift is (reach - |away|)^2 / (4 reach)
                slope = math.copysign((reach_u - abs(away_u)) / (2.0 * reach_u), -away_u)
                tangent = tangent + slope * turn
                bend = bend + turn / (2.0 * reach_u)
        return tangent, bend


def _turn(arc: Arc, job: Job, at_u: float, tangent: Rows, bend: Rows) -> None:
    """Put the derivatives of an arc or spiral into those of the axes of its plane."""
    x, y = arc.plane.first, arc.plane.second
    share = at_u / job.length_u
    start = math.atan2(job.begin[y] - arc.centre[1], job.begin[x] - arc.centre[0])
    angle, turn = start + share * arc.sweep_rad, arc.sweep_rad / job.length_u
    growth = (arc.end_radius - arc.start_radius) / job.length_u
    radius = arc.start_radius + at_u * growth
    out = np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-out[1], out[0]])
    tangent[[x, y]] = growth * out + radius * turn * across
    bend[[x, y]] = 2.0 * growth * turn * across - radius * turn**2 * out
