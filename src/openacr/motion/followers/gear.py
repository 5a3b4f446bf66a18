"""Gears of axes: engage, disengage, registers."""

from __future__ import annotations

from openacr.kernel.sources.source_cy import GEAR_OFF, GEAR_ON, TRIGGERS
from openacr.map.rows import axes, gears
from openacr.map.words import af1, af2
from openacr.motion.axis import registers
from openacr.motion.card import Card
from openacr.motion.follower_defaults import set_gear_defaults
from openacr.motion.interlocks import needs_no_kill, needs_on, scale_of
from openacr.motion.jog.jog import needs_no_moves
from openacr.motion.sources import sources


def permit(card: Card, axis: int) -> None:
    """Refuse a follower that a kill or the axis bars."""
    needs_no_kill(card, axis)
    needs_on(card, axis)


def on_trigger(axis: int) -> int:
    """The trigger GEAR ON may wait for."""
    return axis * TRIGGERS + GEAR_ON


def off_trigger(axis: int) -> int:
    """The trigger GEAR OFF may wait for."""
    return axis * TRIGGERS + GEAR_OFF


def is_on(card: Card, axis: int) -> bool:
    """Whether the gear is switched on."""
    return bool(card.memory.I[af1.word[axis]] & af1.GEAR_ACTIVATE)


def on(card: Card, axis: int) -> None:
    """GEAR ON: follow the source from now."""
    sources.go_live(card, axis)
    disarm_on(card, axis)
    card.memory.I[af1.word[axis]] |= af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE


def off(card: Card, axis: int) -> None:
    """GEAR OFF: ramp the ratio down; anything armed is disarmed."""
    disarm_on(card, axis)
    disarm_off(card, axis)
    card.memory.I[af1.word[axis]] &= ~af1.GEAR_ACTIVATE


def disarm_on(card: Card, axis: int) -> None:
    """Forget what GEAR ON waits for."""
    sources.disarm(card, on_trigger(axis))
    card.memory.I[af2.word[axis]] &= ~(af2.GEAR_ON_TRIG_ARMED | af2.GEAR_ON_POSITION)


def disarm_off(card: Card, axis: int) -> None:
    """Forget what GEAR OFF waits for."""
    sources.disarm(card, off_trigger(axis))
    card.memory.I[af2.word[axis]] &= ~(af2.GEAR_OFF_ARMED | af2.GEAR_OFF_POSITION)


def clear(card: Card, axis: int) -> None:
    """GEAR CLEAR: off at once, settings as at power-up; the offset stays."""
    off(card, axis)
    card.memory.F[gears.ratio_now[axis]] = 0.0
    set_gear_defaults(card.memory, axis)


def set_offset(card: Card, axis: int, offset_u: float) -> None:
    """GEAR OFFSET: the axis moves by the difference."""
    permit(card, axis)
    card.take_written(axis)
    card.memory.F[axes.gear_cnt[axis]] = offset_u * scale_of(card, axis)
    card.show(axis)


def reset(card: Card, axis: int, offset_u: float) -> None:
    """GEAR RES: the gear offset becomes `offset_u`, the coordinated position the rest."""
    transfer(card, axis, axes.gear_cnt[axis], offset_u)


def reset_cam(card: Card, axis: int, offset_u: float) -> None:
    """CAM RES: the cam offset becomes `offset_u`, the coordinated position the rest."""
    transfer(card, axis, axes.cam_cnt[axis], offset_u)


def transfer(card: Card, axis: int, part: int, offset_u: float) -> None:
    """Set one offset and give the difference to the coordinated position; PSP stays."""
    needs_no_moves(card, axis)
    card.take_written(axis)
    memory = card.memory
    offset_cnt = offset_u * scale_of(card, axis)
    position = memory.F[axes.position_cnt[axis]] + memory.F[part] - offset_cnt
    memory.F[part] = offset_cnt
    registers.set_position(card, axis, position)
