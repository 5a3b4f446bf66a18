"""Write the curves of a move into its record: what the kernel lays out when it begins."""

from collections.abc import Sequence
from math import radians

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import bezier_cy, curve_cy
from openacr.map.hidden.motion import SLAVES
from openacr.map.numbers import (
    AF1_SINUSOIDAL_MODE,
    MQF_BASE,
    MQF_STRIDE,
    MQF_WEIGHT,
    MQI_BASE,
    MQI_CURVE,
    MQI_CURVED,
    MQI_DEGREE,
    MQI_HALF_WAVE,
    MQI_PLANE,
    MQI_STRIDE,
    MWF_AMPLITUDE_CNT,
    MWF_BASE,
    MWF_PHASE_RAD,
    MWF_POINT_CNT,
    MWF_POLE_WEIGHT,
    MWF_RADIUS_SCALE,
    MWF_SPAN,
    MWF_STRIDE,
    MWF_SWEEP_RAD,
)
from openacr.messages import INVALID_ARC, UNDEFINED_SYMBOL
from openacr.motion.card import Card
from openacr.motion.orders import Circle, Piece, Shape, Sine, SpaceArc, Target
from openacr.motion.permits import scale_of
from openacr.motion.rows import axis_word


def write(card: Card, program: int, record: int, parts: Sequence[Shape]) -> None:
    """Write the curves of all parts; parts on straight lines have none."""
    rows = MQI_BASE + record * MQI_STRIDE
    ints = card.memory.I
    ints[rows + MQI_CURVED] = ints[rows + MQI_HALF_WAVE] = 0
    ints[rows + MQI_CURVE] = curve_cy.CURVE_NONE
    ints[rows + MQI_PLANE] = 0
    for part in parts:
        match part:
            case Target(axis):
                if ints[axis_word(axis)] & AF1_SINUSOIDAL_MODE:
                    _mark(card, program, record, axis, MQI_CURVED, MQI_HALF_WAVE)
            case Sine(axis):
                _mark(card, program, record, axis, MQI_CURVED)
                _write_sine(card, program, record, part)
            case Circle(axes, _, center, direction, stretch):
                _write_plane(card, program, record, axes, center, direction, stretch)
            case SpaceArc(axes, _, mid):
                _write_plane(card, program, record, axes, mid, curve_cy.CURVE_SPACE)
            case Piece():
                _write_piece(card, record, part)


_bezier_measure = pick(bezier_cy.bezier_measure)


def slave_of(card: Card, program: int, axis: int) -> int:
    """The slave number of an axis; `Undefined symbol` if the program does not have it."""
    slave = card.attachments.slave_of(program, axis)
    if slave is None:
        raise CardError(UNDEFINED_SYMBOL)
    return slave


def _mark(card: Card, program: int, record: int, axis: int, *masks: int) -> None:
    bit = 1 << slave_of(card, program, axis)
    for mask in masks:
        card.memory.I[MQI_BASE + record * MQI_STRIDE + mask] |= bit


def _write_sine(card: Card, program: int, record: int, sine: Sine) -> None:
    slave = slave_of(card, program, sine.axis)
    reals, row = card.memory.F, MWF_BASE + record * MWF_STRIDE + slave
    reals[row + MWF_AMPLITUDE_CNT] = sine.amplitude_u * scale_of(card, sine.axis)
    reals[row + MWF_PHASE_RAD] = radians(sine.phase_deg)
    reals[row + MWF_SWEEP_RAD] = radians(sine.sweep_deg)


def _write_plane(
    card: Card,
    program: int,
    record: int,
    axes: Sequence[int],
    point_u: Sequence[float],
    curve: int,
    stretch: Sequence[float] = (1.0, 1.0, 1.0),
) -> None:
    rows = MQI_BASE + record * MQI_STRIDE
    if card.memory.I[rows + MQI_CURVE] or len(set(axes)) < len(axes):
        raise CardError(INVALID_ARC)
    card.memory.I[rows + MQI_CURVE] = curve
    for place, (axis, value) in enumerate(zip(axes, point_u, strict=True)):
        scaling = MWF_BASE + record * MWF_STRIDE + MWF_RADIUS_SCALE + place
        card.memory.F[scaling] = stretch[place]
        _mark(card, program, record, axis, MQI_CURVED)
        card.memory.I[rows + MQI_PLANE + place] = slave_of(card, program, axis)
        point = MWF_BASE + record * MWF_STRIDE + MWF_POINT_CNT + place
        card.memory.F[point] = value * scale_of(card, axis)


def _write_piece(card: Card, record: int, piece: Piece) -> None:
    """Poles relative to the target, and what the way is measured by."""
    memory = card.memory
    rows, waves = MQI_BASE + record * MQI_STRIDE, MWF_BASE + record * MWF_STRIDE
    memory.I[rows + MQI_CURVE] = bezier_cy.CURVE_TIMED if piece.span else bezier_cy.CURVE_PATH
    memory.I[rows + MQI_DEGREE] = len(piece.poles_cnt) - 1
    memory.I[rows + MQI_CURVED] = sum(1 << slave for slave in piece.slaves)
    target = piece.poles_cnt[-1]
    for k, (pole, weight) in enumerate(zip(piece.poles_cnt, piece.weights, strict=True)):
        memory.F[waves + MWF_POLE_WEIGHT + k] = weight
        row = waves + MWF_AMPLITUDE_CNT + k * SLAVES
        for slave, value, end in zip(piece.slaves, pole, target, strict=True):
            memory.F[row + slave] = value - end
    _weigh(card, record, piece)
    length = _bezier_measure(memory.F, memory.I, record)
    memory.F[waves + MWF_SPAN] = piece.span or length


def _weigh(card: Card, record: int, piece: Piece) -> None:
    """Turn the weights of VECDEF into units per pulse; without any all slaves count alike."""
    first = MQF_BASE + record * MQF_STRIDE + MQF_WEIGHT
    given = [card.memory.F[first + slave] for slave in piece.slaves]
    weights = given if any(given) else [1.0] * len(given)
    for slave, axis, weight in zip(piece.slaves, piece.axes, weights, strict=True):
        card.memory.F[first + slave] = weight / abs(scale_of(card, axis))
