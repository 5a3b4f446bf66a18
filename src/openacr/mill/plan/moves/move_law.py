"""Length, tangents and limits of the moves of one machine (`move_rows_cy`), one move at a time."""

import math
import struct
from array import array
from typing import NamedTuple

from openacr.cnc.canonical import Arc
from openacr.cnc.rows.room import doubles, integers
from openacr.compiled import pick
from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves import move_rows_cy as row
from openacr.mill.plan.moves.geometry import Direction, Point, linear_axes, weights
from openacr.views import F64, I32

_fill = pick(row.move_row)
X_GIVEN = 8 * row.X_BEGIN_U  # bytes before what is given of a move: both ends, F, tolerance
GIVEN = struct.Struct(f"{row.X_CENTRE_U - row.X_BEGIN_U}d")
FOUND = struct.Struct(f"{row.Q_WANTED_UPS}d")


def put_machine(J: I32, X: F64, settings: Settings, *, is_dry: bool) -> None:
    """Write the axes and speeds of a machine where the core reads them."""
    speeds, each = settings.speeds, weights(settings)
    X[row.X_RAPID_UPS] = min(speeds.rapid_ups, speeds.trial_ups) if is_dry else speeds.rapid_ups
    X[row.X_RAPID_UPS2], X[row.X_FEED_UPS2] = speeds.rapid_acc_ups2, speeds.feed_acc_ups2
    X[row.X_ARC_UPS2], X[row.X_MAX_UPS] = speeds.arc_acc_ups2, speeds.max_ups
    X[row.X_ROTARY_UPS], X[row.X_JERK_UPS3] = speeds.rotary_max, speeds.jerk_ups3
    J[row.J_AXES] = len(settings.axes)
    for k, axis in enumerate(settings.axes):
        high, low = axis.soft_limits or (0.0, 0.0)
        numbers = (
            axis.index, axis.is_linear, axis.pulses_per_unit, axis.max_speed_ups,
            axis.max_acceleration_ups2, axis.jerk_ups3, axis.soft_limits is not None, high, low,
            each[axis.index],
        )  # fmt: skip
        first = row.X_AXES + k * row.Y_SIZE
        X[first : first + row.Y_SIZE] = array("d", numbers)


class Shape(NamedTuple):
    """Of a move: what the planner has to know, in the order of `move_rows_cy`."""

    length_u: float  # along the linear axes, or in degrees of the fastest rotary one
    feed_ups: float  # the highest speed within all limits
    ramp_ups2: float  # the highest acceleration at up to this speed
    jerk_ups3: float  # the highest jerk; 0 = any
    tolerance_u: float  # of its corners; 0 where the card does not round them
    start: Direction | None  # None where no linear axis moves
    end: Direction | None
    turns: Direction  # what the rotary axes turn by the length, as lengths (`per_degree`)


class MoveLaw:
    """What moves are to the planner, on one machine."""

    def __init__(self, settings: Settings, *, is_dry: bool = False) -> None:
        self._J, self._X = integers(row.J_MOVES), doubles(row.X_MOVES)
        self._Q = doubles(row.Q_SIZE)
        self._linear = len(linear_axes(settings))
        self._rotary = len(settings.axes) - self._linear
        put_machine(self._J, self._X, settings, is_dry=is_dry)
        self._J[row.J_SHARES_RAMP] = can_plan(settings)

    def straight(
        self,
        begin: Point,
        end: Point,
        wanted_ups: float | None = None,
        tolerance_u: float = 0.0,
        *,
        is_in_polyline: bool = False,
    ) -> Shape:
        """A straight move; one without a speed is a rapid.

        `tolerance_u`: of its corners, where only linear axes move. The card then makes the move
        between whole pulses; of a line of many only the tangents are those of the move as it is
        sent.
        """
        self._J[row.J_KIND] = row.RAPID if wanted_ups is None else row.LINE
        self._J[row.J_IN_POLYLINE] = is_in_polyline
        return self._shape(begin, end, wanted_ups or 0.0, tolerance_u)

    def arc(
        self, arc: Arc, begin: Point, wanted_ups: float = 0.0, *, is_planned: bool = False
    ) -> Shape:
        """An arc.

        A radius that changes along the path (a spiral) counts as its mean; other linear axes are
        added as on a helix. Of a planned path the planner finds what its turns leave; Arc
        Acceleration it does not know.
        """
        J, X, plane = self._J, self._X, arc.plane
        J[row.J_KIND], J[row.J_IS_PLANNED] = row.ARC, is_planned
        J[row.J_FIRST], J[row.J_SECOND] = plane.first, plane.second
        X[row.X_CENTRE_U], X[row.X_CENTRE_U + 1] = arc.centre
        X[row.X_SWEEP_RAD] = arc.sweep_rad
        for k, place in enumerate((begin, arc.end), row.X_RADII_U):
            X[k] = math.dist((place[plane.first], place[plane.second]), arc.centre)
        return self._shape(begin, arc.end, wanted_ups, 0.0)

    def _shape(self, begin: Point, end: Point, wanted_ups: float, tolerance_u: float) -> Shape:
        GIVEN.pack_into(self._X, X_GIVEN, *begin, *end, wanted_ups, tolerance_u)
        _fill(self._J, self._X, self._Q, 0)
        found = FOUND.unpack_from(self._Q)
        start = last = None
        if found[row.Q_HAS_TANGENT]:
            start = found[row.Q_START : row.Q_START + self._linear]
            last = found[row.Q_END : row.Q_END + self._linear]
        turns = found[row.Q_TURNS : row.Q_TURNS + self._rotary]
        return Shape._make((*found[: row.Q_MODE], start, last, turns))
