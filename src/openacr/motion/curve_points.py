"""The points of an unfinished SPLINE or NURB, kept in hidden rows so that snapshots hold them."""

from dataclasses import dataclass, field

from openacr.map.hidden.motion import KNOTS, POINTS, SLAVES
from openacr.map.numbers import (
    CPF_BASE,
    CPF_KNOT,
    CPF_POINT_CNT,
    CPF_STRIDE,
    CPF_TANGENT_CPS,
    CPF_WEIGHT,
    CPI_BASE,
    CPI_BEHIND,
    CPI_KNOTS,
    CPI_LIVE,
    CPI_OPEN,
    CPI_POINTS,
    CPI_RANK,
    CPI_SLAVES,
    CPI_STRIDE,
    MF3_NURB_INTERPOLATION,
    MF3_SPLINE_INTERPOLATION,
    MF3_WORD,
)
from openacr.motion.card import Card

USUAL_RANK = 4


@dataclass(slots=True)
class CurvePoints:
    """Points in pulses, one value per slave; those of other slaves than `slaves` rest."""

    slaves: int = 0
    points: list[list[float]] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    knots: list[float] = field(default_factory=list)
    behind: int = 0
    tangent: list[float] = field(default_factory=lambda: [0.0] * SLAVES)
    is_open: bool = False

    @property
    def numbers(self) -> list[int]:
        """The slaves of the curve."""
        return [s for s in range(SLAVES) if self.slaves >> s & 1]


def reals(master: int) -> int:
    """Index in F of the rows of a master."""
    return CPF_BASE + master * CPF_STRIDE


def ints(master: int) -> int:
    """Index in I of the rows of a master."""
    return CPI_BASE + master * CPI_STRIDE


def load(card: Card, master: int) -> CurvePoints:
    """What has been given so far."""
    row, base, memory = ints(master), reals(master), card.memory
    count, knots = memory.I[row + CPI_POINTS], memory.I[row + CPI_KNOTS]
    first = base + CPF_POINT_CNT
    return CurvePoints(
        memory.I[row + CPI_SLAVES],
        [list(memory.F[first + n * SLAVES : first + (n + 1) * SLAVES]) for n in range(count)],
        list(memory.F[base + CPF_WEIGHT : base + CPF_WEIGHT + count]),
        list(memory.F[base + CPF_KNOT : base + CPF_KNOT + knots]),
        memory.I[row + CPI_BEHIND],
        list(memory.F[base + CPF_TANGENT_CPS : base + CPF_TANGENT_CPS + SLAVES]),
        bool(memory.I[row + CPI_OPEN]),
    )


def store(card: Card, master: int, curve: CurvePoints) -> None:
    """Keep what is left for the next point."""
    row, base, memory = ints(master), reals(master), card.memory
    if len(curve.points) > POINTS or len(curve.knots) > KNOTS:
        raise OverflowError(f"{len(curve.points)} points, {len(curve.knots)} knots")
    for n, point in enumerate(curve.points):
        for s, value in enumerate(point):
            memory.F[base + CPF_POINT_CNT + n * SLAVES + s] = value
    for first, values in (
        (CPF_WEIGHT, curve.weights),
        (CPF_KNOT, curve.knots),
        (CPF_TANGENT_CPS, curve.tangent),
    ):
        for n, value in enumerate(values):
            memory.F[base + first + n] = value
    memory.I[row + CPI_SLAVES] = curve.slaves
    memory.I[row + CPI_POINTS] = len(curve.points)
    memory.I[row + CPI_KNOTS] = len(curve.knots)
    memory.I[row + CPI_BEHIND] = curve.behind
    memory.I[row + CPI_OPEN] = int(curve.is_open)
    memory.I[row + CPI_LIVE] = 1


def last_cnt(card: Card, master: int, slave: int) -> float | None:
    """Where the last point given lies, None without an unfinished curve."""
    count = card.memory.I[ints(master) + CPI_POINTS]
    if not count:
        return None
    return card.memory.F[reals(master) + CPF_POINT_CNT + (count - 1) * SLAVES + slave]


def rank(card: Card, master: int) -> int:
    """Order of the NURBs of a master: points that act on a place of the curve."""
    return card.memory.I[ints(master) + CPI_RANK] or USUAL_RANK


def set_rank(card: Card, master: int, value: int) -> None:
    """Choose the order of NURBs."""
    card.memory.I[ints(master) + CPI_RANK] = value


def is_given(card: Card, master: int) -> bool:
    """Whether moves of a master are points of a curve at present."""
    return bool(
        card.memory.I[MF3_WORD + master] & (MF3_NURB_INTERPOLATION | MF3_SPLINE_INTERPOLATION)
    )
