"""Override and feed hold of a planned trajectory: the control points that are sent.

The mathematics is in `timescale_cy`; here are the window of the plan it reads and the units.
"""

from collections.abc import Sequence
from enum import Enum
from typing import cast

import numpy as np
from numpy.typing import NDArray

from openacr.compiled import pick
from openacr.trajectory.override import timescale_cy as core
from openacr.trajectory.override import timescale_points_cy as layout
from openacr.views import F64

Rows = NDArray[np.float64]
KEPT = 512  # control points that have been passed are dropped this many at a time

_advance = pick(core.scale_advance)


class Progress(Enum):
    """Why `TimeScale.next` has given a control point, or none."""

    MOVES = core.SENT
    ENDED = core.AT_END
    WAITS = core.UNKNOWN  # for more of the plan
    HELD = 3


class TimeScale:
    """Runs through a plan at a scale of 0 to 1 of its speed.

    The plan is a uniform cubic B-spline in time that begins at rest at `start`. Accelerations and
    jerks of what comes out stay within the limits given [units/s2, units/s3, by axis].
    """

    def __init__(
        self,
        start: Sequence[float],
        period_s: float,
        acceleration_ups2: Sequence[float],
        jerk_ups3: Sequence[float],
    ) -> None:
        axes = len(start)
        if not 0 < axes <= layout.AXES:
            raise ValueError(f"{axes} axes: 1 to {layout.AXES} are possible")
        self._axes = axes
        self._rows: Rows = np.tile(np.asarray(start, dtype=np.float64), (3, 1))
        self._view: F64 = cast("F64", self._rows.ravel().data)
        self._ints = np.zeros(layout.K_SIZE, dtype=np.int32)
        self._numbers = np.zeros(layout.W_SIZE)
        self._dropped = -1  # knot of the plan that is knot 0 of this window
        self._ints[layout.K_AXES] = axes
        self._ints[layout.K_COUNT] = 3
        numbers = self._numbers
        numbers[layout.W_S] = numbers[layout.W_SIGMA] = numbers[layout.W_WANT] = 1.0
        for axis in range(axes):
            numbers[layout.W_ACCEL + axis] = acceleration_ups2[axis] * period_s**2
            numbers[layout.W_JERK + axis] = jerk_ups3[axis] * period_s**3
            for k in range(3):
                numbers[layout.W_SENT + layout.AXES * k + axis] = start[axis]

    # --- the plan -----------------------------------------------------------------------

    def append(self, points: Rows) -> None:
        """Add the control points that follow; they are not changed any more."""
        if self.is_complete:
            raise ValueError("the plan has ended at rest")
        self._rows = np.concatenate([self._rows, np.asarray(points, dtype=np.float64)])
        self._show()

    def complete(self) -> None:
        """Note that the plan ends at rest with the last control points."""
        self._ints[layout.K_COMPLETE] = 1

    @property
    def is_complete(self) -> bool:
        """Whether the end of the plan is known."""
        return bool(self._ints[layout.K_COMPLETE])

    def _show(self) -> None:
        self._view = cast("F64", np.ascontiguousarray(self._rows).ravel().data)
        self._ints[layout.K_COUNT] = len(self._rows)

    def _drop(self) -> None:
        """Forget what has been passed."""
        passed = int(self._numbers[layout.W_S]) - 1
        if passed >= KEPT:
            self._rows = self._rows[passed:]
            self._numbers[layout.W_S] -= passed
            self._dropped += passed
            self._show()

    @property
    def ahead(self) -> float:
        """Knots of the plan that are known and still to come."""
        return max(len(self._rows) - 3 - float(self._numbers[layout.W_S]), 0.0)

    # --- the scale ----------------------------------------------------------------------

    @property
    def want(self) -> float:
        """The wanted scale, 0 to 1."""
        return float(self._numbers[layout.W_WANT])

    @want.setter
    def want(self, scale: float) -> None:
        if not 0.0 <= scale <= 1.0:
            raise ValueError(f"scale {scale}: allowed are 0 to 1")
        self._numbers[layout.W_WANT] = scale
        if self._is_at_start:
            self._numbers[layout.W_SIGMA] = core.scale_start(scale)

    @property
    def _is_at_start(self) -> bool:
        return self.knot == 0.0

    @property
    def scale(self) -> float:
        """The present scale."""
        return float(self._numbers[layout.W_SIGMA])

    @property
    def is_at_rest(self) -> bool:
        """Whether the last three control points are one."""
        sent = self._numbers[layout.W_SENT : layout.W_SENT + 3 * layout.AXES].reshape(
            3, layout.AXES
        )
        return bool((sent == sent[0]).all())

    @property
    def knot(self) -> float:
        """Where the plan has been passed to, in knots from its beginning."""
        return float(self._numbers[layout.W_S]) + self._dropped

    def next(self) -> tuple[Progress, Rows]:
        """The next control point; the last one again where there is none."""
        numbers = self._numbers
        if self.want == 0.0 and self.scale == 0.0 and self.is_at_rest:
            return Progress.HELD, self._last
        progress = Progress(_advance(self._view, self._ints.data, cast("F64", numbers.data)))
        if progress is Progress.WAITS:
            return progress, self._last
        if progress is Progress.ENDED:
            at = layout.W_SENT
            numbers[at : at + self._axes] = self._rows[-1]
            progress = Progress.ENDED if self.is_at_rest else Progress.MOVES
        self._drop()
        return progress, self._last

    @property
    def _last(self) -> Rows:
        return self._numbers[layout.W_SENT : layout.W_SENT + self._axes].copy()
