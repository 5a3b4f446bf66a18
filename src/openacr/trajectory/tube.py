"""The path of a smooth chain: the programmed one, smoothed inside its tolerance (tube_cy.py).

The path grows with the pieces that become known. What is further than AHEAD samples before the end
of the known path does not change any more; it is given to the next smoothing as its beginning.
"""

import math
from array import array
from typing import cast

import numpy as np

from openacr.compiled import pick
from openacr.trajectory import piece_cy, spline_cy, tube_cy
from openacr.trajectory.arrays import flat, numbers
from openacr.trajectory.segments import Piece
from openacr.trajectory.setpoints import Reals
from openacr.views import F64

_sample = pick(piece_cy.pieces_sample)
_smooth = pick(tube_cy.tube_smooth)
_point = pick(spline_cy.spline_point)

STEP = 4.0  # tolerances between two samples
STAGES = (10.0, 6.0, 4.0, 2.4, 2.4, 2.4)  # lengths of smoothing, in samples
ROUNDS = 8
AHEAD = 150  # samples that still change with what follows
GIVEN = 7  # samples at the beginning that are given: the spline ends where they end
PINNED = 3.01  # samples before the end of the chain that are given
BEFORE = 3  # samples before the start of the chain, and after its end
FULL, FADED = 4, 16  # control points: shifted onto an end, and on which the shift fades
TAPER = 0.02  # of the distance to an end: no more of the tolerance is used there


class Tube:
    """Samples of the programmed path, and the smoothed ones, from the index `first` on."""

    __slots__ = ("_axes", "_end", "_first", "_origin", "_pieces", "_q", "_rows", "_share",
                 "_start", "_start_off", "final", "known_u", "length_u", "step")  # fmt: skip

    def __init__(self, axes: int, step: float, share: float) -> None:
        self._axes, self.step, self._share = axes, step, share
        self._rows = array("d")
        self._pieces = 0
        self._start = self._end = self._start_off = np.zeros(axes)
        self._origin = 0.0  # distance at which the first piece of the rows begins
        self._q = np.empty((0, axes))
        self._first = -BEFORE
        self.final = -BEFORE  # index of the first sample that may still change
        self.known_u = 0.0
        self.length_u = math.inf  # of the whole chain, once it is known

    def add(self, piece: Piece) -> None:
        """Append a piece."""
        if not self._pieces:
            self._start = np.array(piece.start)
        self._end = np.array(piece.segment.end)
        self._rows.extend(piece.row())
        self._pieces += 1
        self.known_u += piece.length_u

    @property
    def valid_u(self) -> float:
        """The distance up to which the path is final."""
        if self.final * self.step >= self.length_u:
            return self.length_u
        return max(0.0, (self.final - 6) * self.step)

    def grow(self) -> None:
        """Smooth what is new."""
        begin = max(self.final - GIVEN, -BEFORE)
        is_whole = math.isfinite(self.length_u)
        if is_whole:
            end = math.ceil(self.length_u / self.step) + BEFORE + 1
        else:
            end = math.floor(self.known_u / self.step) + 1
        count = end - begin
        if count <= GIVEN:
            return
        programmed = np.empty((count, self._axes))
        radius, arcs = np.empty(count), np.empty(count)
        _sample(cast("F64", memoryview(self._rows)), self._pieces, self._axes, self._origin,
        begin, count,
                self.step, self._share, flat(programmed), flat(radius), flat(arcs))  # fmt: skip
        s = (begin + np.arange(count)) * self.step
        to_end = np.minimum(s, self.length_u - s) if is_whole else s
        np.minimum(radius, TAPER * np.maximum(to_end, 1e-9), out=radius)
        q = np.zeros((count + 3, self._axes))
        q[:count] = programmed
        if self.final > -BEFORE:
            q[:GIVEN] = self._q[begin - self._first : begin - self._first + GIVEN]
        tail = int(np.count_nonzero(s > self.length_u - PINNED * self.step)) if is_whole else 0
        room = [np.empty_like(q) for _ in range(3)] + [np.empty((count, 4)) for _ in range(2)]
        if count > GIVEN + tail:
            _smooth(count, self._axes, GIVEN, tail, flat(programmed), flat(radius), flat(arcs),
                    len(STAGES), numbers(STAGES), ROUNDS,
                    flat(q), *(flat(each) for each in room))  # fmt: skip
        self.final = end if is_whole else max(end - AHEAD, begin + GIVEN)
        self._q = np.concatenate([self._q[: begin - self._first], q[: self.final - begin]])

    def control_points(self) -> tuple[Reals, float]:
        """Control points of the spline through the final samples, and where it begins.

        The prefilter 1 - D2/6 + D4/36 makes the spline pass through samples of a smooth path to
        sixth order.
        """
        q = self._q
        points = (54.0 * q[2:-2] - 10.0 * (q[1:-3] + q[3:-1]) + q[:-4] + q[4:]) / 36.0
        first = self._first + BEFORE  # the knot at which the first four points begin
        if self._first == -BEFORE:
            self._start_off = self._start - (points[0] + 4.0 * points[1] + points[2]) / 6.0
        rows = np.arange(first, first + len(points), dtype=np.float64)
        points += _fading(rows - FULL)[:, None] * self._start_off
        if math.isfinite(self.length_u):
            at = np.empty(self._axes)
            _point(flat(points), len(points), self._axes, self.step,
                   self.length_u - first * self.step, flat(at), 0)  # fmt: skip
            last = math.floor(self.length_u / self.step)
            points += _fading(last - 1 - rows)[:, None] * (self._end - at)
        return points, first * self.step

    def close(self) -> None:
        """The path ends where the last piece ends."""
        self.length_u = self.known_u

    def drop(self, before_u: float) -> None:
        """Forget what lies before a distance."""
        keep = max(self._first, min(math.floor(before_u / self.step), self.final) - 2 * GIVEN)
        self._q = self._q[keep - self._first :].copy()
        self._first = keep
        size = piece_cy.E_POINTS + 2 * self._axes
        start = (keep - GIVEN) * self.step
        gone = 0
        while gone + 1 < self._pieces and self._origin + self._rows[gone * size] < start:
            self._origin += self._rows[gone * size]
            gone += 1
        if gone:
            del self._rows[: gone * size]
            self._pieces -= gone


def _fading(distance: Reals) -> Reals:
    """1 up to a distance of 0 control points, then falling smoothly to 0."""
    share = np.clip(distance / FADED, 0.0, 1.0)
    found: Reals = 1.0 - share * share * (3.0 - 2.0 * share)
    return found
