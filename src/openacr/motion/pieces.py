"""Hand the pieces of SPLINE and NURB over to a master as moves.

In time modes the path is the parameter of the curve: a piece is as long as its time, and
the speed is 1 (or 1 / NURB Time Factor). Ramps in such a path are those of the master over
the highest speed of the piece, so that no axis brakes harder in a feedhold than in a move.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from openacr.compiled import pick
from openacr.kernel import bezier_cy
from openacr.kernel.path_cy import MARK_CURVE_BEGIN, MARK_NURB
from openacr.map.hidden.motion import SLAVES
from openacr.map.numbers import (
    AXF_POSITION_CNT,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_FVEL_UPS,
    MQF_IVEL_UPS,
    MQF_JRK_UPS3,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TMOV_S,
    MQF_VEL_UPS,
    MQI_BASE,
    MQI_MARKS,
    MQI_STRIDE,
    MSF_TARGET_CNT,
    MSI_QUEUED,
    MSI_SIZE,
    MSI_SLAVE_AXIS,
)
from openacr.motion import tangent
from openacr.motion.bezier import Bezier
from openacr.motion.card import Card
from openacr.motion.orders import Piece, Target
from openacr.motion.permits import scale_of
from openacr.motion.records import Way
from openacr.motion.rows import axis_reals, master_ints, master_reals

MOST = 12  # records that one statement can make, the way to the first one included
NEAR_CNT = 0.01
SAMPLES = 16

_bezier_speed = pick(bezier_cy.bezier_speed)


@dataclass(frozen=True, slots=True)
class Pace:
    """How a piece is run through: with the profile of the master or, timed, at a rate."""

    rate: float = 0.0  # of the path per second; 0: not timed
    start_s: float = 0.0  # ramp to that rate
    most_ups: float = 0.0  # bound of the speed, 0 none
    is_nurb: bool = False
    begins: bool = False
    ends: bool = False


def has_room(card: Card, master: int, count: int) -> bool:
    """Whether the ring of a master takes another `count` pieces, whatever MBUF says."""
    row, limit = room_row(card, master, count)
    return card.memory.I[row] < limit


def room_row(card: Card, master: int, count: int) -> tuple[int, int]:
    """Row in I and value it must stay below for `count` pieces to have room."""
    rows = master_ints(master)
    return rows + MSI_QUEUED, card.memory.I[rows + MSI_SIZE] - count + 1


def hand_over(
    card: Card,
    program: int,
    master: int,
    slaves: list[int],
    curve: Bezier,
    span: float,
    pace: Pace,
) -> None:
    """Append a piece; one that begins elsewhere is led up to in a straight line."""
    axes = {s: card.memory.I[master_ints(master) + MSI_SLAVE_AXIS + s] for s in slaves}
    if _lead_up(card, program, master, axes, curve.poles[0]):
        pace = replace(pace, begins=True)
    time_s = span if pace.rate else 0.0
    piece = Piece(tuple(axes), tuple(axes.values()), curve.poles, curve.weights, time_s)
    ways = _ways(axes, curve.poles[0], curve.poles[-1])
    record = tangent.add(card, program, master, ways, [piece])
    marks = (MARK_CURVE_BEGIN if pace.begins else 0) | (MARK_NURB if pace.is_nurb else 0)
    card.memory.I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS] = marks
    if pace.rate:
        _write_timed(card, record, span, pace)
    else:
        _write_path(card, record, pace)


def _ways(axes: dict[int, int], starts: Sequence[float], ends: Sequence[float]) -> list[Way]:
    return [
        Way(s, axis, first, last, last - first, relative=False)
        for (s, axis), first, last in zip(axes.items(), starts, ends, strict=True)
    ]


def _lead_up(
    card: Card, program: int, master: int, axes: dict[int, int], start: tuple[float, ...]
) -> bool:
    """Go straight to the beginning of a piece; False if the path is there already."""
    here = [_end(card, master, s, axis) for s, axis in axes.items()]
    if all(abs(a - b) <= NEAR_CNT for a, b in zip(here, start, strict=True)):
        return False
    ways = _ways(axes, here, start)
    targets = [Target(way.axis, way.target_cnt / scale_of(card, way.axis)) for way in ways]
    tangent.add(card, program, master, ways, targets)
    return True


def _end(card: Card, master: int, slave: int, axis: int) -> float:
    """Where the last move of the buffer ends, or the axis is."""
    if card.memory.I[master_ints(master) + MSI_QUEUED]:
        return card.memory.F[master_reals(master) + MSF_TARGET_CNT + slave]
    return card.memory.F[axis_reals(axis) + AXF_POSITION_CNT]


def _write_timed(card: Card, record: int, span: float, pace: Pace) -> None:
    memory, row = card.memory, MQF_BASE + record * MQF_STRIDE
    steepest = max(
        _bezier_speed(memory.F, memory.I, record, n / SAMPLES) for n in range(SAMPLES + 1)
    )
    per_unit = span / steepest if steepest > 0.0 else 0.0
    acc = memory.F[row + MQF_ACC_UPS2] * per_unit
    for place, value in (
        (MQF_VEL_UPS, pace.rate),
        (MQF_ACC_UPS2, pace.rate / pace.start_s if pace.start_s else acc),
        (MQF_DEC_UPS2, memory.F[row + MQF_DEC_UPS2] * per_unit),
        (MQF_IVEL_UPS, pace.rate if pace.begins and not pace.start_s else 0.0),
    ):
        memory.F[row + place] = value
    for place in (MQF_STP_UPS2, MQF_FVEL_UPS, MQF_JRK_UPS3, MQF_TMOV_S):
        memory.F[row + place] = 0.0


def _write_path(card: Card, record: int, pace: Pace) -> None:
    """A piece that may be the last known one ends at rest: what follows may come late."""
    reals, row = card.memory.F, MQF_BASE + record * MQF_STRIDE
    reals[row + MQF_TMOV_S] = 0.0
    if pace.most_ups:
        reals[row + MQF_VEL_UPS] = min(reals[row + MQF_VEL_UPS], pace.most_ups)
    if not pace.begins:
        reals[row + MQF_IVEL_UPS] = 0.0
    if not pace.ends:
        reals[row + MQF_FVEL_UPS] = 0.0
        if reals[row + MQF_STP_UPS2] <= 0.0:
            reals[row + MQF_STP_UPS2] = reals[row + MQF_DEC_UPS2]


def base_point(card: Card, master: int) -> list[float]:
    """Where all slaves of a master are when the moves that wait are done."""
    axes = card.memory.I[master_ints(master) + MSI_SLAVE_AXIS :][:SLAVES]
    return [_end(card, master, s, axis) if axis >= 0 else 0.0 for s, axis in enumerate(axes)]
