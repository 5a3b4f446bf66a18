"""Tables of cams and ballscrews, and switching them on and off."""

from __future__ import annotations

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.followers import cam_cy
from openacr.kernel.followers.cam_cy import BALLSCREW_TABLES, LONGS
from openacr.kernel.sources.source_cy import CAM_ON, TRIGGERS
from openacr.map.memory import Memory
from openacr.map.rows import axes, cams, tables
from openacr.map.words import af1, af2
from openacr.messages import (
    INVALID_ARGUMENT,
    NO_CAM_SEGMENTS,
    OUT_OF_MEMORY,
    REDIMENSIONED_BLOCK,
    SUBSCRIPT_OUT_OF_RANGE,
    UNDEFINED_VARIABLE,
)
from openacr.motion.card import Card
from openacr.motion.follower_defaults import set_table_defaults
from openacr.motion.followers import gear
from openacr.motion.interlocks import scale_of
from openacr.motion.sources import sources

MOST_SEGMENTS = tables.ARRAY_SIZE
_header = pick(cam_cy.array_header)
_ready = pick(cam_cy.table_ready)


def ballscrew(axis: int) -> int:
    """The table number of the ballscrew of an axis; that of its cam is the axis number."""
    return BALLSCREW_TABLES + axis


# tables


def segments(memory: Memory, table: int) -> int:
    """How many segments a table has."""
    return memory.I[tables.segments[table]]


def dimension(memory: Memory, table: int, count: int) -> None:
    """DIM: give a table its segments."""
    if segments(memory, table):
        raise CardError(REDIMENSIONED_BLOCK)
    if count < 1:
        raise CardError(INVALID_ARGUMENT)
    if count > MOST_SEGMENTS:
        raise CardError(OUT_OF_MEMORY)
    memory.I[tables.segments[table]] = count


def array_length(card: Card, program: int, table: int, array: int, words: int) -> int:
    """Elements of an array of a program; `Undefined variable` if it does not exist."""
    header = _header(card.memory.I, program, table, array, words)
    if not header:
        raise CardError(UNDEFINED_VARIABLE)
    return card.memory.I[header]


def set_segment(
    card: Card, table: int, segment: int, length_cnt: float, program: int, array: int
) -> None:
    """SEG: a segment has a length in source pulses and has the points of an array."""
    if not 0 <= segment < segments(card.memory, table):
        raise CardError(SUBSCRIPT_OUT_OF_RANGE)
    if array_length(card, program, LONGS, array, 1) < 2 or not length_cnt > 0.0:
        raise CardError(INVALID_ARGUMENT)
    memory = card.memory
    memory.F[tables.length_cnt[table] + segment] = length_cnt
    memory.I[tables.program[table] + segment] = program
    memory.I[tables.array[table] + segment] = array + 1


def needs_segments(card: Card, table: int) -> None:
    """`No cam segments` for a table that is not complete."""
    if not _ready(card.memory.F, card.memory.I, table):
        raise CardError(NO_CAM_SEGMENTS)


def shift(card: Card, axis: int, table: int) -> float:
    """SHIFT of a table in units."""
    return card.memory.F[tables.shift_cnt[table]] / scale_of(card, axis)


def set_shift(card: Card, axis: int, table: int, shift_u: float) -> None:
    """Preload SHIFT."""
    row = tables.shift_cnt[table]
    card.memory.F[row] = shift_u * scale_of(card, axis)


# cams


def trigger(axis: int) -> int:
    """The trigger CAM ON may wait for."""
    return axis * TRIGGERS + CAM_ON


def is_on(card: Card, axis: int) -> bool:
    """Whether the cam is switched on."""
    return bool(card.memory.I[af1.word[axis]] & af1.CAM_ACTIVATE)


def on(card: Card, axis: int) -> None:
    """CAM ON: start at index 0."""
    sources.go_live(card, axis)
    disarm(card, axis)
    card.memory.I[tables.running[axis]] = 0
    card.memory.I[af1.word[axis]] |= af1.CAM_ACTIVATE


def off(card: Card, axis: int) -> None:
    """CAM OFF: stop at once; the offset stays."""
    disarm(card, axis)
    card.memory.I[af1.word[axis]] &= ~af1.CAM_ACTIVATE
    card.memory.I[cams.poff[axis]] = 0
    card.memory.I[tables.running[axis]] = 0
    card.memory.F[axes.cam_smoothing_cps[axis]] = 0.0


def disarm(card: Card, axis: int) -> None:
    """Forget what CAM ON or PON waits for."""
    sources.disarm(card, trigger(axis))
    card.memory.I[af2.word[axis]] &= ~(af2.CAM_TRIGGER_MODE | af2.CAM_TRIGGER_STARTED)
    card.memory.I[cams.pon[axis]] = 0


def engage_at(card: Card, axis: int, position_cnt: float) -> None:
    """PON: engage when the source passes a position within the cycle."""
    sources.go_live(card, axis)
    card.memory.F[cams.pon_cnt[axis]] = position_cnt
    card.memory.I[cams.pon[axis]] = 1


def disengage_at(card: Card, axis: int, position_cnt: float) -> None:
    """POFF: disengage when the index passes a position within the cycle."""
    card.memory.F[cams.poff_cnt[axis]] = position_cnt
    card.memory.I[cams.poff[axis]] = 1


def reset(card: Card, axis: int, offset_u: float) -> None:
    """CAM RES: set the cam offset, clear the shift; the primary setpoint stays."""
    gear.reset_cam(card, axis, offset_u)
    memory = card.memory
    base = cams.base_cnt[axis]
    memory.F[base] += memory.F[tables.shift_cnt[axis]]
    memory.F[base] += memory.F[axes.cam_cnt[axis]] - memory.F[tables.shown_cnt[axis]]
    memory.F[tables.shown_cnt[axis]] = memory.F[axes.cam_cnt[axis]]
    memory.F[tables.shift_cnt[axis]] = 0.0


def clear(memory: Memory, table: int) -> None:
    """CLEAR: drop segments and settings of a table that is off."""
    set_table_defaults(memory, table)


# ballscrews


def ballscrew_is_on(card: Card, axis: int) -> bool:
    """Whether the ballscrew table is switched on."""
    return bool(card.memory.I[af1.word[axis]] & af1.BALLSCREW_ACTIVATE)


def ballscrew_on(card: Card, axis: int) -> None:
    """BSC ON: the offset of the table is added at once."""
    sources.go_live(card, axis)
    card.memory.I[af1.word[axis]] |= af1.BALLSCREW_ACTIVATE


def ballscrew_off(card: Card, axis: int) -> None:
    """BSC OFF: the offset is taken away at once."""
    card.memory.I[af1.word[axis]] &= ~af1.BALLSCREW_ACTIVATE
    card.memory.I[tables.running[ballscrew(axis)]] = 0
    card.memory.F[axes.ballscrew_cnt[axis]] = 0.0
    card.show(axis)


def reset_ballscrew(card: Card, axis: int, offset_u: float) -> None:
    """BSC RES: the offset becomes `offset_u`; the difference goes to SHIFT."""
    card.take_written(axis)
    memory, row = card.memory, axes.ballscrew_cnt[axis]
    wanted = offset_u * scale_of(card, axis)
    table = ballscrew(axis)
    if ballscrew_is_on(card, axis):
        memory.F[tables.shift_cnt[table]] += wanted - memory.F[row]
    memory.F[row] = wanted
    memory.F[tables.shown_cnt[table]] = wanted
    card.show(axis)
