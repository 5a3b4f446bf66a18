"""RES, REN and position capture: commands on the position registers of an axis."""

from openacr.compiled import pick
from openacr.kernel import calls_cy
from openacr.kernel.axis import axis_cy
from openacr.kernel.words_cy import round32
from openacr.map.rows import axes
from openacr.motion.card import Card
from openacr.motion.interlocks import needs_rest, scale_of

_axis_target_changed = pick(axis_cy.axis_target_changed)


def res(card: Card, axis: int, position_u: float = 0.0) -> None:
    """RES: commanded and actual position become `position_u`, all offsets 0."""
    needs_rest(card, axis)
    card.take_written(axis)
    position_cnt = position_u * scale_of(card, axis)
    card.call(calls_cy.FEEDBACK_SET, axis, round32(position_cnt))
    card.call(calls_cy.AXIS_PRELOAD, axis, value=position_cnt)
    card.show(axis)


def ren(card: Card, axis: int) -> None:
    """REN: the actual position becomes the setpoint; jog, gear and cam offsets stay."""
    needs_rest(card, axis)
    card.take_written(axis)
    card.call(calls_cy.AXIS_RENEW, axis)
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
    card.call(calls_cy.FEEDBACK_SET, axis, actual - round(turns * length_cnt))
    memory.F[axes.position_cnt[axis]] -= turns * length_cnt
    card.call(calls_cy.AXIS_SETTLED, axis)
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
    card.call(calls_cy.CAPTURE_ARM, axis, mode)
    card.memory.I[axes.capture_copy[axis]] = copy_to


def disarm_capture(card: Card, axis: int) -> None:
    """INTCAP OFF."""
    card.call(calls_cy.CAPTURE_ARM, axis, -1)


def capture_mode(card: Card, axis: int) -> int | None:
    """The mode an axis is armed in, None if it is not."""
    mode = card.memory.I[axes.capture_mode[axis]]
    return mode if mode >= 0 else None
