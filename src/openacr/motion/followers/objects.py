"""Filters, hand wheels, locked pairs, ratchets, limiters, switches, outputs and the sampler."""

from __future__ import annotations

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.followers import offset_cy
from openacr.map.rows import (
    axes,
    filters,
    followers,
    hand_wheels,
    limiters,
    objects,
    output_objects,
    ratchets,
)
from openacr.map.words import af3
from openacr.messages import AXIS_IS_LOCKED, INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.interlocks import needs_on, needs_rest
from openacr.motion.sources import sources

_filter_clear = pick(offset_cy.filter_clear)
_filter_halt = pick(offset_cy.filter_halt)


# filtered following


def filter_on(card: Card, axis: int) -> None:
    """FLT ON: follow the source through an empty window."""
    sources.go_live(card, axis)
    _filter_clear(card.memory.F, card.memory.I, axis)
    card.memory.I[filters.on[axis]] = 1
    card.memory.I[af3.word[axis]] |= af3.FILTER_MOVED


def filter_off(card: Card, axis: int) -> None:
    """FLT OFF: stop at once."""
    _filter_halt(card.memory.F, card.memory.I, axis)


def set_filter_size(card: Card, axis: int, ticks: int) -> None:
    """FLT COEF: ticks to average over; the window starts empty."""
    _filter_clear(card.memory.F, card.memory.I, axis)
    card.memory.I[filters.size[axis]] = ticks


def set_filter_out(card: Card, axis: int, parameter: int | None) -> None:
    """FLT OUT: the parameter that moves, None for the gear offset."""
    out = -1 if parameter is None else parameter
    card.memory.I[filters.out[axis]] = out


# hand wheels


def wheel_on(card: Card, axis: int, on: bool) -> None:
    """HDW ON and OFF; a target already given is still reached."""
    if on:
        sources.go_live(card, axis)
    card.memory.I[hand_wheels.on[axis]] = int(on)


# locked pairs


def leader(card: Card, axis: int) -> int | None:
    """The axis that leads a locked one."""
    found = card.memory.I[followers.leader[axis]]
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
    old = followers.lock_old_cnt[second]
    memory.F[old] = memory.F[axes.psp_cnt[first]]
    memory.I[followers.leader[second]] = first + 1
    memory.I[objects.locked] += 1


def unlock(card: Card, axis: int) -> None:
    """UNLOCK: free a locked axis, or all axes locked to this one."""
    for other in range(card.model.axes):
        found = leader(card, other)
        if found is not None and axis in (other, found):
            card.memory.I[followers.leader[other]] = 0
            card.memory.I[objects.locked] -= 1
            for freed in (other, found):
                card.memory.F[followers.lock_v[freed]] = 0.0


def locked_pairs(card: Card) -> list[tuple[int, int]]:
    """Leader and follower of every locked pair."""
    pairs = ((leader(card, axis), axis) for axis in range(card.model.axes))
    return [(first, second) for first, second in pairs if first is not None]


# ratchets and limiters


def reset_ratchet(card: Card, number: int, value: float) -> None:
    """RATCH RES: the output is `value`, nothing is buffered."""
    sources.objects_go_live(card)
    card.memory.F[ratchets.output_cnt[number]] = value
    card.memory.F[ratchets.backlog_cnt[number]] = 0.0


def reset_limiter(card: Card, number: int, value: float) -> None:
    """LIMIT RES: the output is `value`, nothing is held back."""
    sources.objects_go_live(card)
    card.memory.F[limiters.output_cnt[number]] = value
    card.memory.F[limiters.backlog_cnt[number]] = 0.0


# output objects


def output_on(card: Card, number: int, on: bool) -> None:
    """OOP ON and OFF; switched off, its flag is clear."""
    sources.objects_go_live(card)
    card.memory.I[output_objects.on[number]] = int(on)
    if not on:
        card.memory.set_bit(card.memory.I[output_objects.bit[number]], False)


def set_window(card: Card, number: int, first: float, second: float) -> None:
    """OOP POS: one window, from the smaller to below the larger position."""
    card.memory.F[output_objects.from_cnt[number]] = min(first, second)
    card.memory.F[output_objects.to_cnt[number]] = max(first, second)


def set_windows(
    card: Card, number: int, start: float, pitch: float, width: float, count: int
) -> None:
    """OOP INC: windows of a width, `count` of them (0: endless)."""
    if not (pitch > 0.0 and width > 0.0 and 0 <= count < 1 << 31):
        raise CardError(INVALID_ARGUMENT)
    card.memory.F[output_objects.start_cnt[number]] = start
    card.memory.F[output_objects.pitch_cnt[number]] = pitch
    card.memory.F[output_objects.width_cnt[number]] = width
    card.memory.I[output_objects.windows[number]] = count
