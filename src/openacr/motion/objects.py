"""Filters, hand wheels, locked pairs, ratchets, limiters, switches, outputs and the sampler."""

from __future__ import annotations

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import offset_cy
from openacr.map import numbers as at
from openacr.messages import AXIS_IS_LOCKED, INVALID_ARGUMENT
from openacr.motion import sources
from openacr.motion.card import Card
from openacr.motion.permits import needs_on, needs_rest
from openacr.motion.rows import axis_reals

_filter_clear = pick(offset_cy.filter_clear)
_filter_halt = pick(offset_cy.filter_halt)


# filtered following


def filter_on(card: Card, axis: int) -> None:
    """FLT ON: follow the source through an empty window."""
    sources.go_live(card, axis)
    _filter_clear(card.memory.F, card.memory.I, axis)
    card.memory.I[at.FLI_BASE + axis * at.FLI_STRIDE + at.FLI_ON] = 1
    card.memory.I[at.AF3_WORD + axis] |= at.AF3_FILTER_MOVED


def filter_off(card: Card, axis: int) -> None:
    """FLT OFF: stop at once."""
    _filter_halt(card.memory.F, card.memory.I, axis)


def set_filter_size(card: Card, axis: int, ticks: int) -> None:
    """FLT COEF: ticks to average over; the window starts empty."""
    _filter_clear(card.memory.F, card.memory.I, axis)
    card.memory.I[at.FLI_BASE + axis * at.FLI_STRIDE + at.FLI_SIZE] = ticks


def set_filter_out(card: Card, axis: int, parameter: int | None) -> None:
    """FLT OUT: the parameter that moves, None for the gear offset."""
    out = -1 if parameter is None else parameter
    card.memory.I[at.FLI_BASE + axis * at.FLI_STRIDE + at.FLI_OUT] = out


# hand wheels


def wheel_on(card: Card, axis: int, on: bool) -> None:
    """HDW ON and OFF; a target already given is still reached."""
    if on:
        sources.go_live(card, axis)
    card.memory.I[at.HWI_BASE + axis * at.HWI_STRIDE + at.HWI_ON] = int(on)


# locked pairs


def leader(card: Card, axis: int) -> int | None:
    """The axis that leads a locked one."""
    found = card.memory.I[at.FOI_BASE + axis * at.FOI_STRIDE + at.FOI_LEADER]
    return found - 1 if found else None


def lock(card: Card, first: int, second: int) -> None:
    """LOCK: the second axis follows the setpoint of the first."""
    if first == second:
        raise CardError(INVALID_ARGUMENT)
    for axis in (first, second):
        needs_on(card, axis)
        needs_rest(card, axis)
    if any(leader(card, axis) == second for axis in range(card.model.axes)):
        raise CardError(AXIS_IS_LOCKED)
    memory = card.memory
    old = at.FOF_BASE + second * at.FOF_STRIDE + at.FOF_LOCK_OLD_CNT
    memory.F[old] = memory.F[axis_reals(first) + at.AXF_PSP_CNT]
    memory.I[at.FOI_BASE + second * at.FOI_STRIDE + at.FOI_LEADER] = first + 1
    memory.I[at.OBI_BASE + at.OBI_LOCKED] += 1


def unlock(card: Card, axis: int) -> None:
    """UNLOCK: free a locked axis, or all axes locked to this one."""
    for other in range(card.model.axes):
        found = leader(card, other)
        if found is not None and axis in (other, found):
            card.memory.I[at.FOI_BASE + other * at.FOI_STRIDE + at.FOI_LEADER] = 0
            card.memory.I[at.OBI_BASE + at.OBI_LOCKED] -= 1
            for freed in (other, found):
                card.memory.F[at.FOF_BASE + freed * at.FOF_STRIDE + at.FOF_LOCK_V] = 0.0


def locked_pairs(card: Card) -> list[tuple[int, int]]:
    """Leader and follower of every locked pair."""
    pairs = ((leader(card, axis), axis) for axis in range(card.model.axes))
    return [(first, second) for first, second in pairs if first is not None]


# ratchets and limiters


def reset_ratchet(card: Card, number: int, value: float) -> None:
    """RATCH RES: the output is `value`, nothing is buffered."""
    sources.objects_go_live(card)
    row = at.RTF_BASE + number * at.RTF_STRIDE
    card.memory.F[row + at.RTF_OUTPUT_CNT] = value
    card.memory.F[row + at.RTF_BACKLOG_CNT] = 0.0


def reset_limiter(card: Card, number: int, value: float) -> None:
    """LIMIT RES: the output is `value`, nothing is held back."""
    sources.objects_go_live(card)
    row = at.LTF_BASE + number * at.LTF_STRIDE
    card.memory.F[row + at.LTF_OUTPUT_CNT] = value
    card.memory.F[row + at.LTF_BACKLOG_CNT] = 0.0


# output objects


def output_on(card: Card, number: int, on: bool) -> None:
    """OOP ON and OFF; switched off, its flag is clear."""
    sources.objects_go_live(card)
    row = at.OOI_BASE + number * at.OOI_STRIDE
    card.memory.I[row + at.OOI_ON] = int(on)
    if not on:
        card.memory.set_bit(card.memory.I[row + at.OOI_BIT], False)


def set_window(card: Card, number: int, first: float, second: float) -> None:
    """OOP POS: one window, from the smaller to below the larger position."""
    row = at.OOF_BASE + number * at.OOF_STRIDE
    card.memory.F[row + at.OOF_FROM_CNT] = min(first, second)
    card.memory.F[row + at.OOF_TO_CNT] = max(first, second)


def set_windows(
    card: Card, number: int, start: float, pitch: float, width: float, count: int
) -> None:
    """OOP INC: windows of a width, `count` of them (0: endless)."""
    if not (pitch > 0.0 and width > 0.0 and 0 <= count < 1 << 31):
        raise CardError(INVALID_ARGUMENT)
    row = at.OOF_BASE + number * at.OOF_STRIDE
    card.memory.F[row + at.OOF_START_CNT] = start
    card.memory.F[row + at.OOF_PITCH_CNT] = pitch
    card.memory.F[row + at.OOF_WIDTH_CNT] = width
    card.memory.I[at.OOI_BASE + number * at.OOI_STRIDE + at.OOI_WINDOWS] = count
