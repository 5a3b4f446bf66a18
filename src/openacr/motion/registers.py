"""RES, REN and position capture: commands on the position registers of an axis."""

from openacr.compiled import pick
from openacr.kernel import axis_cy, capture_cy, feedback_cy
from openacr.kernel.words_cy import round32
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AXF_POSITION_CNT,
    AXF_ROTARY_U,
    AXF_TARGET_CNT,
    AXI_CAPTURE_COPY,
    AXI_CAPTURE_MODE,
)
from openacr.motion.card import Card
from openacr.motion.permits import needs_rest, scale_of
from openacr.motion.rows import axis_ints, axis_parameter, axis_reals

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
    memory, reals = card.memory, axis_reals(axis)
    length_cnt = memory.F[reals + AXF_ROTARY_U] * abs(scale_of(card, axis))
    if length_cnt <= 0.0:
        return
    card.take_written(axis)
    turns = memory.F[reals + AXF_POSITION_CNT] // length_cnt
    actual = memory.I[axis_parameter(axis) + AX_ACTUAL_POSITION]
    _feedback_set(memory.F, memory.I, memory.S, axis, actual - round(turns * length_cnt))
    memory.F[reals + AXF_POSITION_CNT] -= turns * length_cnt
    _axis_settled(memory.F, memory.I, axis)
    card.show(axis)


def set_position(card: Card, axis: int, position_cnt: float) -> None:
    """Let an axis whose master rests have this coordinated position; offsets stay."""
    memory = card.memory
    memory.F[axis_reals(axis) + AXF_POSITION_CNT] = position_cnt
    memory.F[axis_reals(axis) + AXF_TARGET_CNT] = position_cnt
    _axis_target_changed(memory.F, memory.I, axis)
    card.show(axis)


def arm_capture(card: Card, axis: int, mode: int, copy_to: int = 0) -> None:
    """INTCAP: capture the position at the edge `mode` names (0-15), once."""
    _capture_arm(card.memory.F, card.memory.I, axis, mode)
    card.memory.I[axis_ints(axis) + AXI_CAPTURE_COPY] = copy_to


def disarm_capture(card: Card, axis: int) -> None:
    """INTCAP OFF."""
    _capture_arm(card.memory.F, card.memory.I, axis, -1)


def capture_mode(card: Card, axis: int) -> int | None:
    """The mode an axis is armed in, None if it is not."""
    mode = card.memory.I[axis_ints(axis) + AXI_CAPTURE_MODE]
    return mode if mode >= 0 else None
