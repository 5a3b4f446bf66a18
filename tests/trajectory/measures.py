"""What a planned trajectory does: finite differences in every phase, distances from the path."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from openacr.trajectory import Limits, Segment, Setpoints, TrajectoryPlanner, evaluate
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals

PERIOD_S = 0.003
CHORD_U, TURN = 0.02, 0.05  # of arcs, and by their radii: at most 0.0003 of the radius off


def limits(jerk: float | None = 20_000.0, axes: int = 3) -> Limits:
    """100 mm/s, 1000 mm/s2 and a jerk on every axis."""
    return Limits((100.0,) * axes, (1000.0,) * axes, None if jerk is None else (jerk,) * axes)


def planned(
    segments: Sequence[Segment], start: Sequence[float], machine: Limits, period_s: float = PERIOD_S
) -> list[Setpoints]:
    """All setpoints of a program; they are taken as soon as they are there."""
    planner = TrajectoryPlanner(tuple(start), machine, period_s)
    found: list[Setpoints] = []

    def take() -> None:
        while (setpoints := planner.take()) is not None:
            found.append(setpoints)

    for segment in segments:
        planner.add(segment)
        take()
    planner.stop()
    take()
    return found


def points(setpoints: Sequence[Setpoints]) -> Reals:
    """All control points in one array, with the rest before the first."""
    rows = np.concatenate([each.points for each in setpoints])
    return np.concatenate([rows[:1], rows[:1], rows])


@dataclass(frozen=True, slots=True)
class Largest:
    """Largest speed along the path, acceleration and jerk of any axis."""

    speed: float
    acceleration: float
    jerk: float


def sampled(control: Reals, period_s: float, sample_s: float, phases: int = 4) -> Largest:
    """The largest finite differences of samples of the spline, over all phases."""
    found = [Largest(0.0, 0.0, 0.0)]
    end = (len(control) - 1) * period_s
    for phase in range(phases):
        times = np.arange(phase * sample_s / phases, end, sample_s)
        at = evaluate(control, times / period_s)[0]
        v, a, j = (np.diff(at, n, axis=0) / sample_s**n for n in (1, 2, 3))
        speed = float(np.linalg.norm(v, axis=1).max())
        found.append(Largest(speed, float(np.abs(a).max()), float(np.abs(j).max())))
    return Largest(*(max(getattr(each, name) for each in found)
                     for name in ("speed", "acceleration", "jerk")))  # fmt: skip


def off(at: Reals, starts: Reals, ends: Reals) -> float:
    """The largest distance of points from the nearest of some lines.

    The nearest is found by the middles of lines, among those of a like length at a time: of the
    short chords of a small arc there can be any number nearer than the middle of a long line.
    """
    counts = np.maximum(1, np.ceil(np.linalg.norm(ends - starts, axis=1) / 0.2)).astype(int)
    cut = [a + (b - a) * np.arange(n + 1)[:, None] / n
           for a, b, n in zip(starts, ends, counts, strict=True)]  # fmt: skip
    first = np.concatenate([each[:-1] for each in cut])
    last = np.concatenate([each[1:] for each in cut])
    sizes = np.ceil(np.log2(np.maximum(np.linalg.norm(last - first, axis=1), 1e-9)))
    best = np.full(len(at), np.inf)
    for size in np.unique(sizes):
        alike = sizes == size
        np.minimum(best, _apart(at, first[alike], last[alike]), out=best)
    return float(best.max())


def _apart(at: Reals, starts: Reals, ends: Reals) -> Reals:
    """The distances of points from the nearest of some lines of a like length."""
    _, near = cKDTree(0.5 * (starts + ends)).query(at, k=min(32, len(starts)))
    best = np.full(len(at), np.inf)
    for column in np.reshape(near, (len(at), -1)).T:
        a, d = starts[column], ends[column] - starts[column]
        share = ((at - a) * d).sum(1) / np.maximum((d * d).sum(1), 1e-30)
        apart = np.linalg.norm(at - a - d * np.clip(share, 0, 1)[:, None], axis=1)
        best = np.minimum(best, apart)
    return best


def deviations(
    control: Reals, segments: Sequence[Segment], start: Sequence[float]
) -> tuple[float, float]:
    """How far the spline is from the programmed path, and the vertices from the spline."""
    at = evaluate(control, np.arange(0, len(control) - 1, 0.25))[0]
    path, vertices = [tuple(start)], []
    for segment in segments:
        piece = Piece(path[-1], segment)
        if piece.length_u > 0.0:
            path += piece.chords(CHORD_U if piece.is_line else min(CHORD_U, TURN * piece.radius_u))
            vertices.append(segment.end)
    lines = np.array(path)
    close = evaluate(control, np.arange(0, len(control) - 1, 0.0625))[0]
    return off(at, lines[:-1], lines[1:]), off(np.array(vertices), close[:-1], close[1:])
