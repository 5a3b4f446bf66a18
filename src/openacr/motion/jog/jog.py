"""Jog commands of an axis. Commands do not wait; the jog profiler does the rest."""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import calls_cy
from openacr.kernel.axis import axis_cy
from openacr.kernel.jog import homing_cy
from openacr.kernel.jog.jog_cy import (
    JOG_HOMING,
    JOG_KILLED,
    JOG_TO_TARGET,
)
from openacr.kernel.jog.jogplan_cy import FAR_CNT
from openacr.kernel.sources.source_cy import FROM_CLOCK, USE_JOG, USES
from openacr.map.rows import axes, masters, sources
from openacr.map.words import af1, mf1
from openacr.messages import INVALID_ARGUMENT, INVALID_SOURCE, NOT_VALID_WHILE_IN_MOTION
from openacr.motion.axis import registers
from openacr.motion.card import Card
from openacr.motion.interlocks import (
    master_moving,
    master_of,
    needs_free_direction,
    needs_no_kill,
    needs_on,
    needs_rest,
    scale_of,
)

_axis_jog_set = pick(axis_cy.axis_jog_set)
_home_begin = pick(homing_cy.home_begin)


def permit(card: Card, axis: int, direction: float) -> None:
    """Refuse a jog in `direction` (its sign) that a kill, the axis or a limit bars."""
    needs_no_kill(card, axis)
    needs_on(card, axis)
    needs_free_direction(card, axis, direction)


def continuous(card: Card, axis: int, direction: int) -> None:
    """JOG FWD (+1) or JOG REV (-1): run until JOG OFF."""
    permit(card, axis, direction)
    word = af1.word[axis]
    wanted, other = af1.JOG_FORWARD, af1.JOG_REVERSE
    if direction < 0:
        wanted, other = other, wanted
    flags = card.memory.I[word] & ~other | wanted
    if not flags & af1.JOG_LOCKOUT:
        flags |= af1.JOG_ACTIVE
    card.memory.I[word] = flags


def offset(card: Card, axis: int) -> float:
    """The jog offset in units."""
    card.take_written(axis)
    return card.memory.F[axes.jog_cnt[axis]] / scale_of(card, axis)


def absolute(card: Card, axis: int, position_u: float) -> None:
    """JOG ABS: jog until the jog offset is `position_u`."""
    card.take_written(axis)
    _to_target(card, axis, position_u * scale_of(card, axis))


def incremental(card: Card, axis: int, distance_u: float) -> None:
    """JOG INC: from the jog offset, or from the target of a running JOG ABS or INC."""
    card.take_written(axis)
    running = card.memory.I[axes.jog_mode[axis]] == JOG_TO_TARGET or waits(card, axis)
    start = card.memory.F[(axes.jog_target_cnt if running else axes.jog_cnt)[axis]]
    _to_target(card, axis, start + distance_u * scale_of(card, axis))


def waits(card: Card, axis: int) -> bool:
    """Whether JOG ABS or INC waits for the end of the stop of a limit or kill."""
    return card.memory.I[axes.jog_mode[axis]] == JOG_KILLED and bool(
        card.memory.I[axes.jog_replan[axis]]
    )


def _to_target(card: Card, axis: int, target_cnt: float) -> None:
    memory = card.memory
    if not abs(target_cnt) < FAR_CNT:
        raise CardError(INVALID_ARGUMENT)
    distance = target_cnt - memory.F[axes.jog_cnt[axis]]
    permit(card, axis, distance / scale_of(card, axis))
    card.call(calls_cy.JOG_AIM, axis, value=target_cnt)


def off(card: Card, axis: int) -> None:
    """JOG OFF: ramp to rest with JOG DEC."""
    card.call(calls_cy.JOG_OFF, axis)


def permit_home(card: Card, axis: int) -> None:
    """Refuse homing of an axis that moves or may not; a limit only turns the search round."""
    needs_rest(card, axis)
    needs_no_kill(card, axis)
    needs_on(card, axis)
    if card.memory.I[sources.kind[axis * USES + USE_JOG]] != FROM_CLOCK:
        raise CardError(INVALID_SOURCE)


def home(card: Card, axis: int, direction: int) -> None:
    """JOG HOME: start the homing sequence in `direction` (+1 or -1), unless locked out."""
    permit_home(card, axis)
    rows = card.memory.I
    word = af1.word[axis]
    if rows[word] & af1.JOG_LOCKOUT:
        return
    _home_begin(rows, axis, direction)
    rows[axes.jog_mode[axis]] = JOG_HOMING
    rows[word] |= af1.JOG_ACTIVE


def needs_no_moves(card: Card, axis: int) -> None:
    """Refuse while the master of the axis moves."""
    master = master_of(card, axis)
    if master is not None and master_moving(card, master):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def path_held(card: Card, axis: int) -> bool:
    """Whether the axis belongs to a path with moves that rests in a feedhold."""
    master = master_of(card, axis)
    if master is None or not card.memory.I[masters.queued[master]]:
        return False
    return card.memory.I[mf1.word[master]] & mf1.IN_FEEDHOLD != 0


def needs_no_jog(card: Card, axis: int) -> None:
    """Refuse while the axis jogs."""
    if card.memory.I[af1.word[axis]] & af1.JOG_ACTIVE:
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def renew(card: Card, axis: int, position_u: float) -> None:
    """JOG REN: the coordinated position becomes `position_u`, the jog offset the rest."""
    needs_no_moves(card, axis)
    card.take_written(axis)
    memory = card.memory
    total = memory.F[axes.position_cnt[axis]] + memory.F[axes.jog_cnt[axis]]
    position = position_u * scale_of(card, axis)
    _share(card, axis, position, total - position)


def reset(card: Card, axis: int, offset_u: float) -> None:
    """JOG RES: the jog offset becomes `offset_u`, the coordinated position the rest.

    In a feedhold the path keeps its place to continue.
    """
    needs_no_jog(card, axis)
    is_held = path_held(card, axis)
    if not is_held:
        needs_no_moves(card, axis)
    card.take_written(axis)
    memory = card.memory
    jog = memory.F[axes.jog_cnt[axis]]
    kept = offset_u * scale_of(card, axis)
    position = memory.F[axes.position_cnt[axis]] + jog - kept
    if not is_held:
        _share(card, axis, position, kept)
        return
    memory.F[axes.folded_cnt[axis]] += jog - kept
    memory.F[axes.position_cnt[axis]] = position
    _axis_jog_set(memory.F, memory.I, axis, kept)
    card.show(axis)


def _share(card: Card, axis: int, position_cnt: float, jog_cnt: float) -> None:
    """Divide the sum of coordinated position and jog offset anew; no setpoint changes."""
    _axis_jog_set(card.memory.F, card.memory.I, axis, jog_cnt)
    registers.set_position(card, axis, position_cnt)
