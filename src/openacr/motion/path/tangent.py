"""TANG: keep an axis in degrees tangential to the path of the first two slaves.

Where a move is to begin in another direction the axis first turns there by the smaller angle,
in a move of its own; less than TANG Turn Limit it makes up during the move. Along curves it
turns with the tangent (kernel/path/tangent_cy.py). It does not count for the length of the path.
"""

from collections.abc import Sequence
from itertools import pairwise

from openacr.compiled import pick
from openacr.kernel.path import tangent_cy
from openacr.kernel.path.path_cy import MARK_TURN
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters, moves
from openacr.map.words import af3, mf2
from openacr.motion.card import Card
from openacr.motion.interlocks import needs_on, scale_of
from openacr.motion.path.curves import slave_of
from openacr.motion.path.move_request import Shape, Target
from openacr.motion.path.records import SlaveMove, append, write

SAMPLES = 32
LEAST_CNT = 0.5
_tangent_deg = pick(tangent_cy.tangent_deg)


def switch_on(card: Card, program: int, master: int, axis: int) -> None:
    """Keep an axis of the program tangential from the next move on."""
    slave_of(card, program, axis)
    switch_off(card, master)
    card.memory.I[masters.tang_axis[master]] = axis + 1
    card.memory.I[af3.word[axis]] |= af3.TANGENTIAL
    card.memory.I[mf2.word[master]] |= mf2.TANG_MODE


def switch_off(card: Card, master: int) -> None:
    """Leave the axis alone again."""
    axis = _axis(card, master)
    if axis is not None:
        card.memory.I[af3.word[axis]] &= ~af3.TANGENTIAL
    card.memory.I[masters.tang_axis[master]] = 0
    card.memory.I[mf2.word[master]] &= ~mf2.TANG_MODE


def _axis(card: Card, master: int) -> int | None:
    axis = card.memory.I[masters.tang_axis[master]] - 1
    return axis if axis >= 0 else None


def axis_of(card: Card, master: int) -> int | None:
    """The axis that is kept tangential, None while TANG is off."""
    return _axis(card, master) if card.memory.I[mf2.word[master]] & mf2.TANG_MODE else None


def moves_of(card: Card, master: int) -> int:
    """How many records a move may take."""
    return 1 if axis_of(card, master) is None else 2


def add(
    card: Card, program: int, master: int, slave_moves: list[SlaveMove], shapes: Sequence[Shape]
) -> int:
    """Append a move with the turns it needs; the record of the move itself."""
    axis = axis_of(card, master)
    if axis is None or any(one.axis == axis for one in slave_moves):
        return append(card, program, master, slave_moves, shapes)
    course = _course(card, program, master, slave_moves, shapes)
    if course is None:
        return append(card, program, master, slave_moves, shapes)
    needs_on(card, axis)
    return _turned(card, program, master, slave_moves, shapes, axis, course)


def _turned(
    card: Card,
    program: int,
    master: int,
    slave_moves: list[SlaveMove],
    shapes: Sequence[Shape],
    axis: int,
    course: tuple[float, float],
) -> int:
    slave, scale = slave_of(card, program, axis), scale_of(card, axis)
    offset = card.memory.F[masters.tang_deg[master]]
    start = _start(card, master, slave, axis)
    lag = (course[0] + offset - start / scale + 180.0) % 360.0 - 180.0
    limit = card.memory.S[masters.tang_turn_limit[master]]
    if abs(lag) > limit and abs(lag * scale) > LEAST_CNT:
        turn = SlaveMove(slave, axis, start, start + lag * scale, lag * scale, relative=True)
        record = append(card, program, master, [turn], [Target(axis, lag, incremental=True)])
        card.memory.I[moves.marks[record]] = MARK_TURN
        start, lag = start + lag * scale, 0.0
    delta = (lag + course[1]) * scale
    turn = SlaveMove(slave, axis, start, start + delta, delta, relative=True, weightless=True)
    record = append(card, program, master, [*slave_moves, turn], shapes)
    _note(card, master, record, slave, scale, offset, lag)
    return record


def _start(card: Card, master: int, slave: int, axis: int) -> float:
    if card.memory.I[masters.queued[master]]:
        return card.memory.F[masters.target_cnt[master] + slave]
    return card.memory.F[axis_rows.position_cnt[axis]]


def _units(card: Card, master: int) -> tuple[float, float]:
    """Units per pulse of the first two slaves."""
    axes = card.memory.I[masters.slave_axis[master] :][:2]
    x, y = (1.0 / scale_of(card, axis) if axis >= 0 else 0.0 for axis in axes)
    return x, y


def _course(
    card: Card, program: int, master: int, slave_moves: list[SlaveMove], shapes: Sequence[Shape]
) -> tuple[float, float] | None:
    """Direction at the beginning, and turn to the end, of a move; None if it has none.

    The move is written to be measured, then taken back.
    """
    memory = card.memory
    ints = masters.ints[master]
    reals = masters.reals[master]
    kept_ints = bytes(memory.I[ints : ints + masters.INTS_SIZE])
    kept_reals = bytes(memory.F[reals : reals + masters.REALS_SIZE])
    record = write(card, program, master, slave_moves, shapes)
    x, y = _units(card, master)
    angles = [
        _tangent_deg(memory.F, memory.I, record, x, y, n / SAMPLES) for n in range(SAMPLES + 1)
    ]
    memory.I[ints : ints + masters.INTS_SIZE] = memoryview(kept_ints).cast("i")
    memory.F[reals : reals + masters.REALS_SIZE] = memoryview(kept_reals).cast("d")
    angles = [angle for angle in angles if angle > -999.0]
    if not angles:
        return None
    turns = ((b - a + 180.0) % 360.0 - 180.0 for a, b in pairwise(angles))
    return angles[0], sum(turns)


def _note(
    card: Card, master: int, record: int, slave: int, scale: float, offset: float, lag: float
) -> None:
    """Let the kernel follow the tangent of a curve; a line has but one."""
    memory = card.memory
    if not memory.I[moves.curved[record]]:
        return
    memory.I[moves.tang_slave[record]] = slave + 1
    for n, value in enumerate((*_units(card, master), scale, offset, lag)):
        memory.F[moves.tang[record] + n] = value
