"""The points of an unfinished SPLINE or NURB, kept in hidden rows so that snapshots hold them."""

from dataclasses import dataclass, field

from openacr.map.hidden.path import KNOTS, POINTS, SLAVES
from openacr.map.memory import Memory
from openacr.map.rows import curve_points
from openacr.map.words import mf3
from openacr.motion.card import Card

USUAL_RANK = 4


@dataclass(slots=True)
class CurvePoints:
    """Points in pulses, one value per slave; those of other slaves than `slaves` rest."""

    slaves: int = 0
    points: list[list[float]] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    knots: list[float] = field(default_factory=list)
    points_before: int = 0
    tangent: list[float] = field(default_factory=lambda: [0.0] * SLAVES)
    is_open: bool = False

    @property
    def numbers(self) -> list[int]:
        """The slaves of the curve."""
        return [s for s in range(SLAVES) if self.slaves >> s & 1]


def load(card: Card, master: int) -> CurvePoints:
    """What has been given so far."""
    memory = card.memory
    count, knots = memory.I[curve_points.points[master]], memory.I[curve_points.knots[master]]
    first = curve_points.point_cnt[master]
    return CurvePoints(
        memory.I[curve_points.slaves[master]],
        [_listed(memory, first + n * SLAVES, SLAVES) for n in range(count)],
        _listed(memory, curve_points.weight[master], count),
        _listed(memory, curve_points.knot[master], knots),
        memory.I[curve_points.points_before[master]],
        _listed(memory, curve_points.tangent_cps[master], SLAVES),
        bool(memory.I[curve_points.open[master]]),
    )


def _listed(memory: Memory, first: int, count: int) -> list[float]:
    return list(memory.F[first : first + count])


def store(card: Card, master: int, curve: CurvePoints) -> None:
    """Keep what is left for the next point."""
    memory = card.memory
    if len(curve.points) > POINTS or len(curve.knots) > KNOTS:
        raise OverflowError(f"{len(curve.points)} points, {len(curve.knots)} knots")
    for n, point in enumerate(curve.points):
        for s, value in enumerate(point):
            memory.F[curve_points.point_cnt[master] + n * SLAVES + s] = value
    for first, values in (
        (curve_points.weight, curve.weights),
        (curve_points.knot, curve.knots),
        (curve_points.tangent_cps, curve.tangent),
    ):
        for n, value in enumerate(values):
            memory.F[first[master] + n] = value
    memory.I[curve_points.slaves[master]] = curve.slaves
    memory.I[curve_points.points[master]] = len(curve.points)
    memory.I[curve_points.knots[master]] = len(curve.knots)
    memory.I[curve_points.points_before[master]] = curve.points_before
    memory.I[curve_points.open[master]] = int(curve.is_open)
    memory.I[curve_points.live[master]] = 1


def last_cnt(card: Card, master: int, slave: int) -> float | None:
    """Where the last point given lies, None without an unfinished curve."""
    count = card.memory.I[curve_points.points[master]]
    if not count:
        return None
    return card.memory.F[curve_points.point_cnt[master] + (count - 1) * SLAVES + slave]


def rank(card: Card, master: int) -> int:
    """Order of the NURBs of a master: points that act on a place of the curve."""
    return card.memory.I[curve_points.rank[master]] or USUAL_RANK


def set_rank(card: Card, master: int, value: int) -> None:
    """Choose the order of NURBs."""
    card.memory.I[curve_points.rank[master]] = value


def is_given(card: Card, master: int) -> bool:
    """Whether moves of a master are points of a curve at present."""
    return bool(
        card.memory.I[mf3.word[master]] & (mf3.NURB_INTERPOLATION | mf3.SPLINE_INTERPOLATION)
    )
