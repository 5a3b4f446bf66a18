"""Hand the parts of SPLINE and NURB over to a master as moves.

In time modes the path is the parameter of the curve: a piece is as long as its time, and
the speed is 1 (or 1 / NURB Time Factor). Ramps in such a path are those of the master over
the highest speed of the piece, so that no axis brakes harder in a feedhold than in a move.
"""

from collections.abc import Sequence
from math import cbrt, sqrt

from msgspec import Struct
from msgspec.structs import replace

from openacr.compiled import pick
from openacr.kernel.path import bezier_cy
from openacr.kernel.path.path_cy import MARK_CURVE_BEGIN, MARK_NURB
from openacr.map.hidden.path import SLAVES
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters, moves
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.motion.path import bezier, tangent
from openacr.motion.path.bezier import Bezier
from openacr.motion.path.move_request import Piece, Target
from openacr.motion.path.records import SlaveMove

MOST = 12  # records that one statement can make, the move to the first one included
NEAR_CNT = 0.01
BESIDE_CNT = 1.0  # from a position to the whole pulse that a host reads
SAMPLES = 16

_bezier_speed = pick(bezier_cy.bezier_speed)


class Pace(Struct, frozen=True):
    """How a piece is run through: with the profile of the master or, timed, at a rate."""

    rate: float = 0.0  # of the path per second; 0: not timed
    start_s: float = 0.0  # ramp to that rate
    most_ups: float = 0.0  # bound of the speed, 0 none
    is_nurb: bool = False
    begins: bool = False
    ends: bool = False


def has_room(card: Card, master: int, count: int) -> bool:
    """Whether the ring of a master takes another `count` moves, whatever MBUF says."""
    row, limit = room_row(card, master, count)
    return card.memory.I[row] < limit


def room_row(card: Card, master: int, count: int) -> tuple[int, int]:
    """Row in I and value it must stay below for `count` moves to have room."""
    return masters.queued[master], card.memory.I[masters.size[master]] - count + 1


def hand_over(
    card: Card,
    program: int,
    master: int,
    slaves: list[int],
    curve: Bezier,
    span: float,
    pace: Pace,
) -> None:
    """Append a piece; one that begins elsewhere is led up to.

    A curve in time that begins within a pulse of its axes, as after a feed hold between pulses,
    is led up to by pieces of its own. Any other is led up to in a straight line.
    """
    axes = {s: card.memory.I[masters.slave_axis[master] + s] for s in slaves}
    here, start = tuple(_end(card, master, s, axis) for s, axis in axes.items()), curve.poles[0]
    apart_cnt = max(abs(a - b) for a, b in zip(here, start, strict=True))
    step_s = _step_s(card, master, axes, here, start)
    if pace.rate and step_s and NEAR_CNT < apart_cnt <= BESIDE_CNT:
        for part in bezier.step(here, start):
            hand_over(card, program, master, slaves, part, step_s * pace.rate, pace)
            pace = replace(pace, begins=False)
    elif apart_cnt > NEAR_CNT:
        _lead_up(card, program, master, _slave_moves(axes, here, start))
        pace = replace(pace, begins=True)
    time_s = span if pace.rate else 0.0
    piece = Piece(tuple(axes), tuple(axes.values()), curve.poles, curve.weights, time_s)
    slave_moves = _slave_moves(axes, curve.poles[0], curve.poles[-1])
    record = tangent.add(card, program, master, slave_moves, [piece])
    marks = (MARK_CURVE_BEGIN if pace.begins else 0) | (MARK_NURB if pace.is_nurb else 0)
    card.memory.I[moves.marks[record]] = marks
    if pace.rate:
        _write_timed(card, record, span, pace)
    else:
        _write_path(card, record, pace)


def _slave_moves(
    axes: dict[int, int], starts: Sequence[float], ends: Sequence[float]
) -> list[SlaveMove]:
    return [
        SlaveMove(s, axis, first, last, last - first, relative=False)
        for (s, axis), first, last in zip(axes.items(), starts, ends, strict=True)
    ]


def _lead_up(card: Card, program: int, master: int, slave_moves: list[SlaveMove]) -> None:
    """Go straight to the beginning of a piece."""
    targets = [Target(one.axis, one.target_cnt / scale_of(card, one.axis)) for one in slave_moves]
    tangent.add(card, program, master, slave_moves, targets)


def _step_s(
    card: Card, master: int, axes: dict[int, int], here: Sequence[float], start: Sequence[float]
) -> float:
    """Period of a step of control points that keeps DEC and JRK on every axis; 0 without JRK.

    Of a step d its second differences are d, the third ones 2 d: d/T^2 <= DEC, 2 d/T^3 <= JRK.
    """
    dec_ups2 = card.memory.F[masters.dec_ups2[master]]
    jrk_ups3 = card.memory.F[masters.jrk_ups3[master]]
    if jrk_ups3 <= 0.0:
        return 0.0
    apart_u = max(
        abs((a - b) / scale_of(card, axis))
        for axis, a, b in zip(axes.values(), here, start, strict=True)
    )
    by_dec_s = sqrt(apart_u / dec_ups2) if dec_ups2 > 0.0 else 0.0
    return max(cbrt(2.0 * apart_u / jrk_ups3), by_dec_s)


def _end(card: Card, master: int, slave: int, axis: int) -> float:
    """Where the last move of the buffer ends, or the axis is."""
    if card.memory.I[masters.queued[master]]:
        return card.memory.F[masters.target_cnt[master] + slave]
    return card.memory.F[axis_rows.position_cnt[axis]]


def _write_timed(card: Card, record: int, span: float, pace: Pace) -> None:
    memory = card.memory
    steepest = max(
        _bezier_speed(memory.F, memory.I, record, n / SAMPLES) for n in range(SAMPLES + 1)
    )
    per_unit = span / steepest if steepest > 0.0 else 0.0
    acc = memory.F[moves.acc_ups2[record]] * per_unit
    for row, value in (
        (moves.vel_ups, pace.rate),
        (moves.acc_ups2, pace.rate / pace.start_s if pace.start_s else acc),
        (moves.dec_ups2, memory.F[moves.dec_ups2[record]] * per_unit),
        (moves.ivel_ups, pace.rate if pace.begins and not pace.start_s else 0.0),
    ):
        memory.F[row[record]] = value
    for row in (moves.stp_ups2, moves.fvel_ups, moves.jrk_ups3, moves.tmov_s):
        memory.F[row[record]] = 0.0


def _write_path(card: Card, record: int, pace: Pace) -> None:
    """A piece that may be the last known one ends at rest: what follows may come late."""
    reals = card.memory.F
    reals[moves.tmov_s[record]] = 0.0
    if pace.most_ups:
        reals[moves.vel_ups[record]] = min(reals[moves.vel_ups[record]], pace.most_ups)
    if not pace.begins:
        reals[moves.ivel_ups[record]] = 0.0
    if not pace.ends:
        reals[moves.fvel_ups[record]] = 0.0
        if reals[moves.stp_ups2[record]] <= 0.0:
            reals[moves.stp_ups2[record]] = reals[moves.dec_ups2[record]]


def base_point(card: Card, master: int) -> list[float]:
    """Where all slaves of a master are when the moves that wait are done."""
    axes = card.memory.I[masters.slave_axis[master] :][:SLAVES]
    return [_end(card, master, s, axis) if axis >= 0 else 0.0 for s, axis in enumerate(axes)]
