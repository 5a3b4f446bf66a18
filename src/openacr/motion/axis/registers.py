"""RES, REN and position capture: commands on the position registers of an axis."""

from openacr.compiled import pick
from openacr.kernel.axis import axis_cy, capture_cy, feedback_cy
from openacr.kernel.words_cy import round32
from openacr.map.rows import axes
from openacr.motion.card import Card
from openacr.motion.interlocks import needs_rest, scale_of

_axis_preload = pick(axis_cy.axis_preload)
_axis_renew = pick(axis_cy.axis_renew)
_axis_settled = pick(axis_cy.axis_settled)
_axis_target_changed = pick(axis_cy.axis_target_changed)
_feedback_set = pick(feedback_cy.feedback_set)
_capture_arm = pick(capture_cy.capture_arm)


def res(card: Card, axis: int, position_u: float = 0.0) -> None:
    """RES: commanded and actual position become `position_u`, all offsets 0."""
    needs_rest(card, axis)
    memory = card.memory
    card.take_written(axis)
    position_cnt = position_u * scale_of(card, axis)
    _feedback_set(memory.F, memory.I, memory.S, axis, round32(position_cnt))
    _axis_preload(memory.F, memory.I, axis, position_cnt)
    card.show(axis)


def ren(card: Card, axis: int) -> None:
    """REN: the actual position becomes the setpoint; jog, gear and cam offsets stay."""
    needs_rest(card, axis)
    card.take_written(axis)
    _axis_renew(card.memory.F, card.memory.I, axis)
    card.show(axis)


def norm(card: Card, axis: int) -> None:
    """NORM: take whole turns off a rotary axis, so that 0 <= current position < ROTARY."""
    needs_rest(card, axis)
    memory = card.memory
    length_cnt = memory.F[axes.rotary_u[axis]] * abs(scale_of(card, axis))
    if length_cnt <= 0.0:
        return
    card.take_written(axis)
    turns = memory.F[axes.position_cnt[axis]] // length_cnt
    actual = memory.I[axes.actual_position[axis]]
    _feedback_set(memory.F, memory.I, memory.S, axis, actual - round(turns * length_cnt))
    memory.F[axes.position_cnt[axis]] -= turns * length_cnt
    _axis_settled(memory.F, memory.I, axis)
    card.show(axis)


def set_position(card: Card, axis: int, position_cnt: float) -> None:
    """Let an axis whose master rests have this coordinated position; offsets stay."""
    memory = card.memory
    memory.F[axes.position_cnt[axis]] = position_cnt
    memory.F[axes.target_cnt[axis]] = position_cnt
    _axis_target_changed(memory.F, memory.I, axis)
    card.show(axis)


def arm_capture(card: Card, axis: int, mode: int, copy_to: int = 0) -> None:
    """INTCAP: capture the position at the edge `mode` names (0-15), once."""
    _capture_arm(card.memory.F, card.memory.I, axis, mode)
    card.memory.I[axes.capture_copy[axis]] = copy_to


def disarm_capture(card: Card, axis: int) -> None:
    """INTCAP OFF."""
    _capture_arm(card.memory.F, card.memory.I, axis, -1)


def capture_mode(card: Card, axis: int) -> int | None:
    """The mode an axis is armed in, None if it is not."""
    mode = card.memory.I[axes.capture_mode[axis]]
    return mode if mode >= 0 else None
