"""Write the curves of a move into its record: what the kernel lays out when it begins."""

from collections.abc import Sequence
from math import radians

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.path import bezier_cy, curve_cy
from openacr.map.hidden.path import SLAVES
from openacr.map.rows import curves, moves
from openacr.map.words import af1
from openacr.messages import INVALID_ARC, UNDEFINED_SYMBOL
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.motion.path.move_request import Circle, Piece, Shape, Sine, SpaceArc, Target


def write(card: Card, program: int, record: int, parts: Sequence[Shape]) -> None:
    """Write the curves of all parts; parts on straight lines have none."""
    ints = card.memory.I
    ints[moves.curved[record]] = ints[moves.half_wave[record]] = 0
    ints[moves.curve[record]] = curve_cy.CURVE_NONE
    ints[moves.plane[record]] = 0
    for part in parts:
        match part:
            case Target(axis):
                if ints[af1.word[axis]] & af1.SINUSOIDAL_MODE:
                    _mark(card, program, record, axis, moves.curved, moves.half_wave)
            case Sine(axis):
                _mark(card, program, record, axis, moves.curved)
                _write_sine(card, program, record, part)
            case Circle(axes, _, center, direction, radius_scales):
                _write_plane(card, program, record, axes, center, direction, radius_scales)
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


def _mark(card: Card, program: int, record: int, axis: int, *rows: tuple[int, ...]) -> None:
    bit = 1 << slave_of(card, program, axis)
    for row in rows:
        card.memory.I[row[record]] |= bit


def _write_sine(card: Card, program: int, record: int, sine: Sine) -> None:
    slave = slave_of(card, program, sine.axis)
    reals = card.memory.F
    reals[curves.amplitude_cnt[record] + slave] = sine.amplitude_u * scale_of(card, sine.axis)
    reals[curves.phase_rad[record] + slave] = radians(sine.phase_deg)
    reals[curves.sweep_rad[record] + slave] = radians(sine.sweep_deg)


def _write_plane(
    card: Card,
    program: int,
    record: int,
    axes: Sequence[int],
    point_u: Sequence[float],
    curve: int,
    radius_scales: Sequence[float] = (1.0, 1.0, 1.0),
) -> None:
    if card.memory.I[moves.curve[record]] or len(set(axes)) < len(axes):
        raise CardError(INVALID_ARC)
    card.memory.I[moves.curve[record]] = curve
    for place, (axis, value) in enumerate(zip(axes, point_u, strict=True)):
        scaling = curves.radius_scale[record] + place
        card.memory.F[scaling] = radius_scales[place]
        _mark(card, program, record, axis, moves.curved)
        card.memory.I[moves.plane[record] + place] = slave_of(card, program, axis)
        point = curves.point_cnt[record] + place
        card.memory.F[point] = value * scale_of(card, axis)


def _write_piece(card: Card, record: int, piece: Piece) -> None:
    """Poles relative to the target, and the measure of its length."""
    memory = card.memory
    memory.I[moves.curve[record]] = bezier_cy.CURVE_TIMED if piece.span else bezier_cy.CURVE_PATH
    memory.I[moves.degree[record]] = len(piece.poles_cnt) - 1
    memory.I[moves.curved[record]] = sum(1 << slave for slave in piece.slaves)
    target = piece.poles_cnt[-1]
    for k, (pole, weight) in enumerate(zip(piece.poles_cnt, piece.weights, strict=True)):
        memory.F[curves.pole_weight[record] + k] = weight
        row = curves.amplitude_cnt[record] + k * SLAVES
        for slave, value, end in zip(piece.slaves, pole, target, strict=True):
            memory.F[row + slave] = value - end
    _weigh(card, record, piece)
    length = _bezier_measure(memory.F, memory.I, record)
    memory.F[curves.span[record]] = piece.span or length


def _weigh(card: Card, record: int, piece: Piece) -> None:
    """Turn the weights of VECDEF into units per pulse; without any all slaves count alike."""
    first = moves.weight[record]
    given = [card.memory.F[first + slave] for slave in piece.slaves]
    weights = given if any(given) else [1.0] * len(given)
    for slave, axis, weight in zip(piece.slaves, piece.axes, weights, strict=True):
        card.memory.F[first + slave] = weight / abs(scale_of(card, axis))
