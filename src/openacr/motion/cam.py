"""Tables of cams and ballscrews, and switching them on and off."""

from __future__ import annotations

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import cam_cy
from openacr.kernel.cam_cy import BALLSCREW_TABLES, LONGS
from openacr.kernel.source_cy import CAM_ON, TRIGGERS
from openacr.map.numbers import (
    AF1_BALLSCREW_ACTIVATE,
    AF1_CAM_ACTIVATE,
    AF2_CAM_TRIGGER_MODE,
    AF2_CAM_TRIGGER_STARTED,
    AXF_BALLSCREW_CNT,
    AXF_CAM_CNT,
    AXF_CAM_SMOOTHING_CPS,
    CAF_BASE,
    CAF_BASE_CNT,
    CAF_POFF_CNT,
    CAF_PON_CNT,
    CAF_STRIDE,
    CAI_BASE,
    CAI_POFF,
    CAI_PON,
    CAI_STRIDE,
    TBF_BASE,
    TBF_LENGTH_CNT,
    TBF_SHIFT_CNT,
    TBF_SHOWN_CNT,
    TBF_STRIDE,
    TBI_ARRAY,
    TBI_ARRAY_SIZE,
    TBI_BASE,
    TBI_PROGRAM,
    TBI_RUNNING,
    TBI_SEGMENTS,
    TBI_STRIDE,
)
from openacr.messages import (
    INVALID_ARGUMENT,
    NO_CAM_SEGMENTS,
    OUT_OF_MEMORY,
    REDIMENSIONED_BLOCK,
    SUBSCRIPT_OUT_OF_RANGE,
    UNDEFINED_VARIABLE,
)
from openacr.motion import gear, sources
from openacr.motion.card import Card
from openacr.motion.follower_defaults import set_table_defaults
from openacr.motion.permits import scale_of
from openacr.motion.rows import axis_reals, axis_word, axis_word2

MOST_SEGMENTS = TBI_ARRAY_SIZE
_header = pick(cam_cy.array_header)
_ready = pick(cam_cy.table_ready)


def ballscrew(axis: int) -> int:
    """The table number of the ballscrew of an axis; that of its cam is the axis number."""
    return BALLSCREW_TABLES + axis


# tables


def segments(card: Card, table: int) -> int:
    """How many segments a table has."""
    return card.memory.I[TBI_BASE + table * TBI_STRIDE + TBI_SEGMENTS]


def dimension(card: Card, table: int, count: int) -> None:
    """DIM: give a table its segments."""
    if segments(card, table):
        raise CardError(REDIMENSIONED_BLOCK)
    if count < 1:
        raise CardError(INVALID_ARGUMENT)
    if count > MOST_SEGMENTS:
        raise CardError(OUT_OF_MEMORY)
    card.memory.I[TBI_BASE + table * TBI_STRIDE + TBI_SEGMENTS] = count


def array_length(card: Card, program: int, table: int, array: int, words: int) -> int:
    """Elements of an array of a program; `Undefined variable` if it does not exist."""
    header = _header(card.memory.I, program, table, array, words)
    if not header:
        raise CardError(UNDEFINED_VARIABLE)
    return card.memory.I[header]


def set_segment(
    card: Card, table: int, segment: int, length_cnt: float, program: int, array: int
) -> None:
    """SEG: a segment is so many source pulses long and has the points of an array."""
    if not 0 <= segment < segments(card, table):
        raise CardError(SUBSCRIPT_OUT_OF_RANGE)
    if array_length(card, program, LONGS, array, 1) < 2 or not length_cnt > 0.0:
        raise CardError(INVALID_ARGUMENT)
    memory = card.memory
    memory.F[TBF_BASE + table * TBF_STRIDE + TBF_LENGTH_CNT + segment] = length_cnt
    memory.I[TBI_BASE + table * TBI_STRIDE + TBI_PROGRAM + segment] = program
    memory.I[TBI_BASE + table * TBI_STRIDE + TBI_ARRAY + segment] = array + 1


def needs_segments(card: Card, table: int) -> None:
    """`No cam segments` for a table that is not complete."""
    if not _ready(card.memory.F, card.memory.I, table):
        raise CardError(NO_CAM_SEGMENTS)


def shift(card: Card, axis: int, table: int) -> float:
    """SHIFT of a table in units."""
    return card.memory.F[TBF_BASE + table * TBF_STRIDE + TBF_SHIFT_CNT] / scale_of(card, axis)


def set_shift(card: Card, axis: int, table: int, shift_u: float) -> None:
    """Preload SHIFT."""
    row = TBF_BASE + table * TBF_STRIDE + TBF_SHIFT_CNT
    card.memory.F[row] = shift_u * scale_of(card, axis)


# cams


def trigger(axis: int) -> int:
    """The trigger CAM ON may wait for."""
    return axis * TRIGGERS + CAM_ON


def is_on(card: Card, axis: int) -> bool:
    """Whether the cam is switched on."""
    return bool(card.memory.I[axis_word(axis)] & AF1_CAM_ACTIVATE)


def on(card: Card, axis: int) -> None:
    """CAM ON: start at index 0."""
    sources.go_live(card, axis)
    disarm(card, axis)
    card.memory.I[TBI_BASE + axis * TBI_STRIDE + TBI_RUNNING] = 0
    card.memory.I[axis_word(axis)] |= AF1_CAM_ACTIVATE


def off(card: Card, axis: int) -> None:
    """CAM OFF: stop at once; the offset stays."""
    disarm(card, axis)
    card.memory.I[axis_word(axis)] &= ~AF1_CAM_ACTIVATE
    card.memory.I[CAI_BASE + axis * CAI_STRIDE + CAI_POFF] = 0
    card.memory.I[TBI_BASE + axis * TBI_STRIDE + TBI_RUNNING] = 0
    card.memory.F[axis_reals(axis) + AXF_CAM_SMOOTHING_CPS] = 0.0


def disarm(card: Card, axis: int) -> None:
    """Forget what CAM ON or PON waits for."""
    sources.disarm(card, trigger(axis))
    card.memory.I[axis_word2(axis)] &= ~(AF2_CAM_TRIGGER_MODE | AF2_CAM_TRIGGER_STARTED)
    card.memory.I[CAI_BASE + axis * CAI_STRIDE + CAI_PON] = 0


def engage_at(card: Card, axis: int, position_cnt: float) -> None:
    """PON: engage when the source passes a position within the cycle."""
    sources.go_live(card, axis)
    card.memory.F[CAF_BASE + axis * CAF_STRIDE + CAF_PON_CNT] = position_cnt
    card.memory.I[CAI_BASE + axis * CAI_STRIDE + CAI_PON] = 1


def disengage_at(card: Card, axis: int, position_cnt: float) -> None:
    """POFF: disengage when the index passes a position within the cycle."""
    card.memory.F[CAF_BASE + axis * CAF_STRIDE + CAF_POFF_CNT] = position_cnt
    card.memory.I[CAI_BASE + axis * CAI_STRIDE + CAI_POFF] = 1


def reset(card: Card, axis: int, offset_u: float) -> None:
    """CAM RES: set the cam offset, clear the shift; the primary setpoint stays."""
    gear.reset_cam(card, axis, offset_u)
    memory = card.memory
    row = TBF_BASE + axis * TBF_STRIDE
    base = CAF_BASE + axis * CAF_STRIDE + CAF_BASE_CNT
    memory.F[base] += memory.F[row + TBF_SHIFT_CNT]
    memory.F[base] += memory.F[axis_reals(axis) + AXF_CAM_CNT] - memory.F[row + TBF_SHOWN_CNT]
    memory.F[row + TBF_SHOWN_CNT] = memory.F[axis_reals(axis) + AXF_CAM_CNT]
    memory.F[row + TBF_SHIFT_CNT] = 0.0


def clear(card: Card, table: int) -> None:
    """CLEAR: drop segments and settings of a table that is off."""
    set_table_defaults(card.memory, table)


# ballscrews


def ballscrew_is_on(card: Card, axis: int) -> bool:
    """Whether the ballscrew table is switched on."""
    return bool(card.memory.I[axis_word(axis)] & AF1_BALLSCREW_ACTIVATE)


def ballscrew_on(card: Card, axis: int) -> None:
    """BSC ON: the offset of the table is added at once."""
    sources.go_live(card, axis)
    card.memory.I[axis_word(axis)] |= AF1_BALLSCREW_ACTIVATE


def ballscrew_off(card: Card, axis: int) -> None:
    """BSC OFF: the offset is taken away at once."""
    card.memory.I[axis_word(axis)] &= ~AF1_BALLSCREW_ACTIVATE
    card.memory.I[TBI_BASE + ballscrew(axis) * TBI_STRIDE + TBI_RUNNING] = 0
    card.memory.F[axis_reals(axis) + AXF_BALLSCREW_CNT] = 0.0
    card.show(axis)


def reset_ballscrew(card: Card, axis: int, offset_u: float) -> None:
    """BSC RES: the offset becomes `offset_u`; the difference goes to SHIFT."""
    card.take_written(axis)
    memory, row = card.memory, axis_reals(axis) + AXF_BALLSCREW_CNT
    wanted = offset_u * scale_of(card, axis)
    table = TBF_BASE + ballscrew(axis) * TBF_STRIDE
    if ballscrew_is_on(card, axis):
        memory.F[table + TBF_SHIFT_CNT] += wanted - memory.F[row]
    memory.F[row] = wanted
    memory.F[table + TBF_SHOWN_CNT] = wanted
    card.show(axis)
