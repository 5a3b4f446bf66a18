"""The path of a smooth chain: the programmed one, smoothed inside its tolerance (tube_cy.py).

The path grows with the pieces that become known. What is further than AHEAD samples before the end
of the known path does not change any more; it is given to the next smoothing as its beginning.
"""

import math
from array import array
from typing import cast

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.path import piece_cy, spline_cy, tube_cy
from openacr.trajectory.path.arrays import flat, whole
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals
from openacr.views import F64

_sample = pick(tube_cy.tube_sample)
_smooth = pick(tube_cy.tube_smooth)
_point = pick(spline_cy.spline_point)

STEP = 4.0  # tolerances between two samples
STAGES = (10.0, 6.0, 4.0, 2.4, 2.4, 1.8)  # lengths of smoothing, in samples
ROUNDS, DENSE_ROUNDS = 24, 8  # of every stage; dense pieces leave no long waves
DENSE = 16.0  # samples of a piece on average, where pieces are dense
AHEAD = 150  # samples that still change with what follows
GIVEN = 7  # samples at the beginning that are given: the spline ends where they end
PINNED = 3.01  # samples before the end of the chain that are given
BEFORE = 3  # samples before the start of the chain, and after its end
FULL, FADED = 4, 16  # control points: shifted onto an end, and on which the shift fades
TAPER = 0.02  # of the distance to an end: no more of the tolerance is used there
TUBE_SHARE = 0.96  # of the tolerance, for smoothing and the B-spline in time
WHOLE = 0.985  # of the tolerance, for both together
MOST_TIME = 0.3  # of the tolerance, kept for the B-spline in time
NARROWER = (1.0, 0.9, 0.75, 0.5)  # radii that are tried where the solution is not close enough
OVER = 1.02


def tube_share(acceleration: float, period_s: float, tolerance: float) -> float:
    """The share of the tolerance that is the radius of the tube.

    The B-spline in time passes its control points at D^2/6 of the acceleration. That is kept for
    it; where the path leaves too little, the acceleration across it is limited (knot_rules.py).
    """
    return TUBE_SHARE - min(MOST_TIME, acceleration * period_s**2 / 6.0 / tolerance)


class Samples:
    """Samples of a chain, as compiled functions take them: the arrays are parts of one table."""

    __slots__ = ("_J", "_table", "programmed", "radius", "smoothed")

    def __init__(self, count: int, axes: int, rounds: int) -> None:
        block = (count + 3) * max(axes, tube_cy.BANDS)
        self._J, self._table = whole(tube_cy.J_SIZE), np.zeros((tube_cy.BLOCKS, block))
        self._J[tube_cy.J_AXES], self._J[tube_cy.J_COUNT] = axes, count
        self._J[tube_cy.J_BLOCK], self._J[tube_cy.J_ROUNDS] = block, rounds
        self._J[tube_cy.J_STAGES] = len(STAGES)
        lengths = slice(tube_cy.N_LENGTHS, tube_cy.N_LENGTHS + len(STAGES))
        self._table[tube_cy.NUMBERS, lengths] = STAGES
        self.programmed, self.smoothed = (
            self._table[k, : count * axes].reshape(count, axes)
            for k in (tube_cy.PROGRAMMED, tube_cy.SMOOTHED)
        )
        self.radius = self._table[tube_cy.RADIUS, :count]

    def take(
        self, pieces: F64, count: int, origin_u: float, begin: int, step_u: float,
        share: float,
    ) -> None:  # fmt: skip
        """Sample `count` pieces, the first at `origin_u`, from the step `begin` on.

        `share`: of the tolerance, which is the radius.
        """
        self._J[tube_cy.J_PIECES], self._J[tube_cy.J_BEGIN] = count, begin
        self._table[tube_cy.NUMBERS, : tube_cy.N_LENGTHS] = origin_u, step_u, share
        _sample(self._J, flat(self._table), pieces)

    def smooth(self, head: int, tail: int) -> None:
        """Smooth what comes after the first `head` and before the last `tail` samples."""
        self._J[tube_cy.J_HEAD], self._J[tube_cy.J_TAIL] = head, tail
        _smooth(self._J, flat(self._table))

    def off_u(self) -> Reals:
        """The distances of the smoothed samples from the programmed ones."""
        apart = self.smoothed - self.programmed
        found: Reals = np.sqrt((apart * apart).sum(axis=1))
        return found


class Tube:
    """Samples of the programmed path, and the smoothed ones, from the index `first` on."""

    __slots__ = ("_axes", "_end", "_first", "_left", "_origin", "_pieces", "_q",
                 "_rounds", "_rows", "_start", "_start_off", "final", "known_u", "length_u",
                 "share", "step")  # fmt: skip

    def __init__(self, axes: int, step: float, share: float, piece_u: float) -> None:
        """`piece_u`: the mean length of the first pieces."""
        self._axes, self.step, self.share = axes, step, share
        self._rounds = DENSE_ROUNDS if piece_u < DENSE * step else ROUNDS
        self._rows = array("d")
        self._pieces = 0
        self._start = self._end = self._start_off = np.zeros(axes)
        self._origin = 0.0  # distance at which the first piece of the rows begins
        self._q = np.empty((0, axes))
        self._left = np.empty(0)  # of the tolerance, sample by sample
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
        samples = Samples(count, self._axes, self._rounds)
        samples.take(
            cast("F64", memoryview(self._rows)), self._pieces, self._origin, begin, self.step,
            self.share,
        )  # fmt: skip
        old = begin - self._first
        q, left = self._smoothed(begin, samples)
        self.final = end if is_whole else max(end - AHEAD, begin + GIVEN)
        self._q = np.concatenate([self._q[:old], q[: self.final - begin]])
        self._left = np.concatenate([self._left[:old], left[: self.final - begin]])

    def _smoothed(self, begin: int, samples: Samples) -> tuple[Reals, Reals]:
        """The smoothed samples from the index `begin` on, and what they leave of the radius."""
        count, radius = len(samples.radius), samples.radius.copy()
        is_whole, old = math.isfinite(self.length_u), begin - self._first
        s = (begin + np.arange(count)) * self.step
        to_end = np.minimum(s, self.length_u - s) if is_whole else s
        taper = TAPER * np.maximum(to_end, 1e-9)
        tail = int(np.count_nonzero(s > self.length_u - PINNED * self.step)) if is_whole else 0
        for narrower in NARROWER:
            samples.smoothed[:] = samples.programmed
            if self.final > -BEFORE:
                samples.smoothed[:GIVEN] = self._q[old : old + GIVEN]
            if count <= GIVEN + tail:
                break
            samples.radius[:] = np.minimum(narrower * radius, taper)
            samples.smooth(GIVEN, tail)
            if (samples.off_u() <= OVER * radius).all():
                break
        left: Reals = radius - samples.off_u()
        if self.final > -BEFORE:
            left[:GIVEN] = self._left[old : old + GIVEN]
        return samples.smoothed, left

    def left_u(self, starts: Reals, stops: Reals) -> Reals:
        """The least that the path leaves of its radius between distances."""
        last = len(self._left) - 1
        first = np.clip(np.floor(starts / self.step).astype(int) - self._first, 0, last)
        stop = np.clip(
            np.ceil(stops / self.step).astype(int) - self._first + 1, first + 1, last + 1
        )
        edges = np.stack([first, stop], axis=1).reshape(-1)
        found: Reals = np.minimum.reduceat(np.append(self._left, np.inf), edges)[::2]
        return found

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
        self._left = self._left[keep - self._first :].copy()
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
