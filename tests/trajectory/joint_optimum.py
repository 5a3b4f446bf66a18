"""The joint optimum: path and time together, by linear programmes over control points in time.

Unknown are the control points c of a uniform cubic B-spline in time, n of them, in the plane X Y.
Given for every knot is the piece of the path that it belongs to. Near a line it lies within a
strip. Near an arc with the radius r and the tolerance e it lies beyond the chord that touches the
circle r - e next to where the knot was before, and within a polygon around the circle r + e. At
corners one knot belongs to both pieces and lies within the tolerance of the vertex. So with
velocity and acceleration of every axis, the feed (a polygon of 16 sides around the circle) and

    |third difference| <= gamma J D^3        minimise gamma

everything is linear; without a jerk limit gamma is a share of the acceleration. gamma <= 1: the
motion is possible in n periods. It is solved again with the pieces that knots were found next to,
corners are shifted knot by knot while gamma falls, and n is reduced while gamma <= 1. Something
faster, with corners passed at quite other times, is not excluded. The tolerance is kept at the
knots; between them, on chains of corners, it is left by a third at most.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from openacr.trajectory import Segment
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals

SIDES = [(math.cos(a), math.sin(a)) for a in np.arange(16) * math.pi / 8]
AXES = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
ROUND = np.linspace(-1.0, 1.0, 9)  # sides of the polygon around an arc, by its half angle
FEED, ACCELERATION, JERK = 100.0, 1000.0, 20_000.0
CORNER = math.radians(5.0)  # turns of which the vertex counts
LESS = 1e-3  # of gamma: what counts as a fall


@dataclass(frozen=True, slots=True)
class Path:
    """A path in the plane with its tolerance, and the limits of its motion."""

    pieces: Sequence[Piece]
    tolerance: float
    period_s: float
    has_jerk: bool = True

    @classmethod
    def of(
        cls, segments: Sequence[Segment], start: Sequence[float], period_s: float, *,
        has_jerk: bool = True,
    ) -> "Path":  # fmt: skip
        """The path of segments from a start, with the tolerance of the first."""
        starts = [tuple(start), *(segment.end for segment in segments)]
        pieces = [Piece(at, segment) for at, segment in zip(starts, segments, strict=False)]
        return cls(pieces, segments[0].tolerance_u, period_s, has_jerk)

    def is_corner(self, joint: int) -> bool:
        """Whether the path turns between a piece and the next one."""
        before, after = self.pieces[joint], self.pieces[joint + 1]
        turn = math.dist(before.tangent(before.length_u), after.tangent(0.0))
        return turn > 2.0 * math.sin(0.5 * CORNER)


class Rows:
    """The rows of a linear programme over the control points of both axes and gamma."""

    def __init__(self, count: int) -> None:
        self._rows: list[sp.spmatrix] = []
        self._sides: list[Reals] = []
        self.knots = sp.diags([1 / 6, 4 / 6, 1 / 6], [0, 1, 2], shape=(count - 2, count)).tocsr()
        self._count = count

    def add(self, x: sp.spmatrix, y: sp.spmatrix, most: Reals | float, share: float = 0.0) -> None:
        """Add the rows x c_x + y c_y <= most + share gamma."""
        size = x.shape[0]
        self._rows.append(sp.hstack([x, y, sp.csr_matrix(np.full((size, 1), -share))]))
        self._sides.append(np.zeros(size) + most)

    def limit(self, order: int, most: float, *, is_shared: bool) -> None:
        """Limit differences of both axes; `is_shared`: gamma is a share of this limit."""
        for a, b in SIDES if order == 1 else AXES:
            of = _differences(self._count, order)
            self.add(a * of, b * of, 0.0 if is_shared else most, most if is_shared else 0.0)

    def within(
        self, first: int, last: int, a: Reals | float, b: Reals | float, most: Reals | float
    ) -> None:
        """Add a x + b y <= most at the knots first .. last, one a and b for each."""
        part = self.knots[first : last + 1]
        self.add(sp.diags(np.zeros(part.shape[0]) + a) @ part,
                 sp.diags(np.zeros(part.shape[0]) + b) @ part, most)  # fmt: skip

    def solve(self, start: Reals, end: Reals) -> tuple[float, Reals]:
        """The least gamma and its control points, at rest in both ends; infinite: none."""
        count = self._count
        low, high = np.full(2 * count + 1, -np.inf), np.full(2 * count + 1, np.inf)
        low[-1] = 0.0
        for axis in (0, 1):
            for n, point in ((0, start), (count - 3, end)):
                fixed = slice(axis * count + n, axis * count + n + 3)
                low[fixed] = high[fixed] = point[axis]
        cost = np.append(np.zeros(2 * count), 1.0)
        found = linprog(cost, A_ub=sp.vstack(self._rows).tocsr(), b_ub=np.concatenate(self._sides),
                        bounds=np.stack([low, high], axis=1), method="highs")  # fmt: skip
        if found.x is None:
            return math.inf, np.empty((0, 2))
        return float(found.x[-1]), np.stack([found.x[:count], found.x[count:-1]], axis=1)


def stretched(path: Path, near: Reals, joints: Sequence[int]) -> tuple[float, Reals]:
    """The least gamma and its control points, with knots next to `near`; infinite: none."""
    count, period = len(near) + 2, path.period_s
    rows = Rows(count)
    rows.limit(1, FEED * period, is_shared=False)
    rows.limit(2, ACCELERATION * period**2, is_shared=not path.has_jerk)
    if path.has_jerk:
        rows.limit(3, JERK * period**3, is_shared=True)
    passed = [0, *joints, count - 3]
    for n, piece in enumerate(path.pieces):
        first, last = passed[n], passed[n + 1]
        if n and not path.is_corner(n - 1):
            first += 1
        if piece.is_line:
            _near_line(rows, piece, path.tolerance, first, last)
        else:
            _near_arc(rows, piece, path.tolerance, first, near[first : last + 1])
        if n + 1 < len(path.pieces) and path.is_corner(n):
            x, y = piece.segment.end[:2]
            for a, b in SIDES:
                rows.within(last, last, a, b, path.tolerance + a * x + b * y)
    ends = path.pieces[0].start, path.pieces[-1].segment.end
    return rows.solve(*(np.array(end) for end in ends))


def _near_line(rows: Rows, piece: Piece, tolerance: float, first: int, last: int) -> None:
    """The strip around a line, and its ends."""
    start, end = np.array(piece.start[:2]), np.array(piece.segment.end[:2])
    along = (end - start) / piece.length_u
    across = np.array([-along[1], along[0]])
    for (a, b), point in ((across, start), (-across, start), (along, end), (-along, start)):
        rows.within(first, last, a, b, tolerance + a * point[0] + b * point[1])


def _near_arc(rows: Rows, piece: Piece, tolerance: float, first: int, near: Reals) -> None:
    """The part of a ring around an arc next to where the knots were, and its ends."""
    arc, radius, last = piece.segment.arc, piece.radius_u, first + len(near) - 1
    assert arc is not None
    centre = np.array(arc.centre)
    angles = np.arctan2(near[:, 1] - centre[1], near[:, 0] - centre[0])
    half = math.acos((radius - tolerance) / (radius + tolerance))
    ring = [(angles + share * half, radius + tolerance) for share in ROUND]
    for turned, most in [(angles + math.pi, tolerance - radius), *ring]:
        a, b = np.cos(turned), np.sin(turned)
        rows.within(first, last, a, b, most + a * centre[0] + b * centre[1])
    for knot, s, side in ((first, 0.0, -1.0), (last, piece.length_u, 1.0)):
        u, v = (side * part for part in piece.tangent(s)[:2])
        x, y = piece.point(s)[:2]
        rows.within(knot, knot, u, v, tolerance + u * x + v * y)


def at_knots(control: Reals) -> Reals:
    """Where a B-spline is at its knots, on X and Y."""
    found: Reals = (control[:-2, :2] + 4.0 * control[1:-1, :2] + control[2:, :2]) / 6.0
    return found


def fewest(path: Path, plan: Reals) -> Reals:
    """The fewest control points that are found, from those of a plan that is possible.

    The plan itself where its own count is not found to be possible.
    """
    near, best = at_knots(plan), plan
    joints = _joints(path, near)
    while True:
        gamma, control, joints = _shifted(path, near, joints)
        if gamma > 1.0 + 1e-7:
            return best
        best, count = control, len(control)
        fewer = max(1, int(0.3 * count * (1.0 - gamma ** (1 / 3))))
        joints = [round(k * (count - fewer) / count) for k in joints]
        times = np.linspace(0.0, count - 3.0, count - 2 - fewer)
        near = np.stack(
            [np.interp(times, np.arange(count - 2), x) for x in at_knots(control).T], axis=1
        )


def _shifted(path: Path, near: Reals, joints: list[int]) -> tuple[float, Reals, list[int]]:
    """Shift joints until the motion is possible, or gamma falls no more."""
    gamma, control = stretched(path, near, joints)
    corners = [n for n in range(len(joints)) if path.is_corner(n)]
    is_better = math.isfinite(gamma)
    while gamma > 1.0 and is_better:
        near, is_better = at_knots(control), False
        shifted = [
            [k + shift * (i == n) for i, k in enumerate(joints)]
            for n in corners for shift in (-1, 1)
        ]  # fmt: skip
        for other in (_joints(path, near, joints), *shifted):
            least, found = stretched(path, near, other)
            if least < gamma - LESS:
                gamma, control, joints, is_better = least, found, other, True
                break
    return gamma, control, joints


def _joints(path: Path, near: Reals, known: Sequence[int] = ()) -> list[int]:
    """The last knots of pieces; at corners those known, or else the nearest to the vertex."""
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(near, axis=0), axis=1))])
    found, end_u = list(known), 0.0
    for n, (before, after) in enumerate(pairwise(path.pieces)):
        end_u += before.length_u
        if known and path.is_corner(n):
            continue
        to_end = before.segment.end[:2] - near
        if path.is_corner(n):
            own = np.abs(gone - end_u) < 0.5 * np.where(
                gone < end_u, before.length_u, after.length_u
            )
            joint = int(np.argmin(np.where(own, np.linalg.norm(to_end, axis=1), math.inf)))
        else:
            joint, ahead = int(np.searchsorted(gone, end_u)), to_end @ after.tangent(0.0)[:2]
            while ahead[joint + 1] >= 0.0:
                joint += 1
            while ahead[joint] < 0.0:
                joint -= 1
        found[n : n + 1] = [joint]
    return found


def _differences(count: int, order: int) -> sp.csr_matrix:
    """The matrix of differences of an order."""
    signs = [(-1.0) ** (order - k) * math.comb(order, k) for k in range(order + 1)]
    return sp.diags(signs, list(range(order + 1)), shape=(count - order, count)).tocsr()
