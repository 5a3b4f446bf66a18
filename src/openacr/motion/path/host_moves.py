"""Moves that a host sends as packets: into the same buffer, but past the language.

Targets are pulses of slaves; ROTARY, Sinusoidal Mode and the transformations of programmed
paths do not act on them. A velocity or ramp that comes with a move stays for the later
ones, ramps at the end and marks are the move's own.
"""

from collections.abc import Mapping

from msgspec import Struct, field

from openacr.errors import CardError
from openacr.kernel.path.lookahead_cy import look_record
from openacr.kernel.path.path_cy import (
    MARK_BLOCK_SKIP,
    MARK_COUNT_DOWN,
    MARK_COUNT_UP,
    MARK_FINAL_ZERO,
    MARK_INTERRUPT,
    MARK_OVERRIDE_LOCKED,
    MARK_ROUNDS,
)
from openacr.map.rows import masters, moves
from openacr.map.words import mf2
from openacr.messages import (
    INVALID_ARGUMENT,
    NO_MASTER_ATTACHED,
    NOT_SUPPORTED,
    UNDEFINED_SYMBOL,
)
from openacr.models import Feature
from openacr.motion.card import Card
from openacr.motion.interlocks import (
    master_moving,
    needs_moves,
    scale_of,
)
from openacr.motion.path import corners, curve_modes
from openacr.motion.path.move_request import Circle, Direction, Part
from openacr.motion.path.moves import permit_slave_moves, start_cnt
from openacr.motion.path.records import SlaveMove, append

LONGEST_COUNT = 2**31 - 1


class Arc(Struct, frozen=True):
    """A circle of two slaves round a centre in pulses, stretched along its axes."""

    slaves: tuple[int, int]
    center_cnt: tuple[float, float]
    direction: Direction
    relative_center: bool = False
    radius_scale: tuple[float, float] = (1.0, 1.0)


class HostMove(Struct, frozen=True, kw_only=True):
    """One move of a master as a packet describes it."""

    master: int
    targets_cnt: Mapping[int, float] = field(default_factory=dict)  # by slave
    relative: bool = False
    arc: Arc | None = None
    vel_ups: float | None = None
    acc_ups2: float | None = None
    fvel_ups: float | None = None
    stop_ramp: bool = False
    final_velocity_zero: bool = False
    rapid: bool = False
    override_locked: bool = False
    count: int = 0
    interrupt: bool = False
    block_skip: bool = False
    tolerance_u: float | None = None  # of the corner at its end

    @property
    def marks(self) -> int:
        """What the kernel keeps with the move."""
        return (
            _count_marks(self.count)
            | _lock_mark(self.override_locked)
            | (MARK_FINAL_ZERO if self.final_velocity_zero else 0)
            | (MARK_INTERRUPT if self.interrupt else 0)
            | (MARK_BLOCK_SKIP if self.block_skip else 0)
            | (MARK_ROUNDS if self.tolerance_u else 0)
        )


class HostPoint(Struct, frozen=True, kw_only=True):
    """A point of SPLINE or NURB of a master as a packet describes it."""

    master: int
    family: curve_modes.Family
    targets_cnt: Mapping[int, float] = field(default_factory=dict)  # by slave
    relative: bool = False
    knot: float | None = None
    weight: float | None = None
    vel_ups: float | None = None
    acc_ups2: float | None = None
    fvel_ups: float | None = None
    override_locked: bool = False
    count: int = 0


def has_rapid_modes(card: Card, master: int) -> bool:
    """Whether move packets of a master carry rapid modes (Enable Rapid Move Modes)."""
    return bool(card.memory.I[mf2.word[master]] & mf2.ENABLE_RAPID_MOVE_MODES)


def slave_axis(card: Card, master: int, slave: int) -> int:
    """The axis of a slave; `Undefined symbol` if nothing is attached there."""
    _program(card, master)
    axis = card.memory.I[masters.slave_axis[master] + slave]
    if axis < 0:
        raise CardError(UNDEFINED_SYMBOL)
    return axis


def _program(card: Card, master: int) -> int:
    program = card.attachments.program(master) if master < card.model.masters else None
    if program is None:
        raise CardError(NO_MASTER_ATTACHED)
    return program


def issue(card: Card, move: HostMove) -> None:
    """Start or buffer the move; the caller has made sure that there is room."""
    program = _program(card, move.master)
    needs_moves(card, move.master)
    if move.tolerance_u is not None and not corners.is_tolerance(move.tolerance_u):
        raise CardError(INVALID_ARGUMENT)
    slave_moves = _slave_moves(card, move)
    permit_slave_moves(card, slave_moves, here=not master_moving(card, move.master))
    _take_profile(card, move)
    if move.arc is None and not any(one.delta_cnt for one in slave_moves):
        if not master_moving(card, move.master):
            _count_at_once(card, move)
            return
    parts: list[Part] = [_circle(card, move, slave_moves)] if move.arc else []
    record = append(card, program, move.master, slave_moves, parts)
    ramp = card.memory.F[moves.dec_ups2[record]]
    card.memory.F[moves.stp_ups2[record]] = ramp if move.stop_ramp else 0.0
    card.memory.I[moves.rapid[record]] = int(move.rapid)
    card.memory.I[moves.marks[record]] = move.marks
    if move.tolerance_u is not None:
        corners.set_of_move(card, move.master, record, move.tolerance_u)


def take_point(card: Card, point: HostPoint) -> None:
    """Take a point of a curve, which it begins in mode 0 if no command has; as with `issue`."""
    if point.family is curve_modes.Family.NURB and Feature.NURBS in card.model.lacks:
        raise CardError(NOT_SUPPORTED)
    program = _program(card, point.master)
    needs_moves(card, point.master)
    here = not master_moving(card, point.master)
    slave_moves = _straight(
        card, point.master, point.targets_cnt, here=here, relative=point.relative
    )
    permit_slave_moves(card, slave_moves, here=here)
    if not slave_moves and point.family is curve_modes.Family.SPLINE:
        raise CardError(INVALID_ARGUMENT)
    if curve_modes.family(card, point.master) is not point.family:
        curve_modes.begin(card, point.master, point.family, 0)
    _take_profile(card, point)
    values = {one.slave: one.target_cnt for one in slave_moves}
    before = card.memory.I[masters.queued[point.master]]
    curve_modes.take(card, program, point.master, values, point.knot, point.weight)
    _mark_pieces(card, point, before)


def _mark_pieces(card: Card, point: HostPoint, before: int) -> None:
    """Mark the pieces that a point completes: the first of them counts it."""
    marks = _count_marks(point.count)
    for place in range(before, card.memory.I[masters.queued[point.master]]):
        record = look_record(card.memory.I, point.master, place)
        card.memory.I[moves.marks[record]] |= marks | _lock_mark(point.override_locked)
        marks = 0


def _count_marks(count: int) -> int:
    """What a packet does to the move counter when it begins."""
    return MARK_COUNT_UP if count > 0 else MARK_COUNT_DOWN if count < 0 else 0


def _lock_mark(is_locked: bool) -> int:
    return MARK_OVERRIDE_LOCKED if is_locked else 0


def _count_at_once(card: Card, move: HostMove) -> None:
    """A move that leads nowhere is over when it comes."""
    row = masters.move_counter[move.master]
    counted = card.memory.I[row] + move.count
    if abs(counted) <= LONGEST_COUNT:
        card.memory.I[row] = counted


def _take_profile(card: Card, move: HostMove | HostPoint) -> None:
    """Velocity, ramps and final velocity are those of the master from now on."""
    given = (move.vel_ups, move.acc_ups2, move.fvel_ups)
    if any(value is not None and value < 0.0 for value in given):
        raise CardError(INVALID_ARGUMENT)
    if move.vel_ups is not None:
        card.memory.S[masters.user_velocity[move.master]] = move.vel_ups
    if move.acc_ups2 is not None:
        card.memory.F[masters.acc_ups2[move.master]] = move.acc_ups2
        card.memory.F[masters.dec_ups2[move.master]] = move.acc_ups2
    if move.fvel_ups is not None:
        card.memory.F[masters.fvel_ups[move.master]] = move.fvel_ups


def _slave_moves(card: Card, move: HostMove) -> list[SlaveMove]:
    here = not master_moving(card, move.master)
    targets = dict(move.targets_cnt)
    for slave in move.arc.slaves if move.arc else ():
        if slave not in targets:  # stays where it is: half of a circle's target is enough
            axis = slave_axis(card, move.master, slave)
            start = start_cnt(card, move.master, slave, axis, here=here)
            targets[slave] = 0.0 if move.relative else start
    return _straight(card, move.master, targets, here=here, relative=move.relative)


def _straight(
    card: Card, master: int, targets: Mapping[int, float], *, here: bool, relative: bool
) -> list[SlaveMove]:
    found = []
    for slave, value in sorted(targets.items()):
        axis = slave_axis(card, master, slave)
        start = start_cnt(card, master, slave, axis, here=here)
        delta = value if relative else value - start
        found.append(SlaveMove(slave, axis, start, start + delta, delta, relative=relative))
    return found


def _circle(card: Card, move: HostMove, slave_moves: list[SlaveMove]) -> Circle:
    arc = move.arc
    if arc is None:
        raise TypeError(move)
    by_slave = {one.slave: one for one in slave_moves}
    pair = [by_slave[slave] for slave in arc.slaves]
    scales = [scale_of(card, one.axis) for one in pair]
    center = [
        (value + (one.start_cnt if arc.relative_center else 0.0)) / scale
        for one, value, scale in zip(pair, arc.center_cnt, scales, strict=True)
    ]
    return Circle(
        (pair[0].axis, pair[1].axis),
        (pair[0].target_cnt / scales[0], pair[1].target_cnt / scales[1]),
        (center[0], center[1]),
        arc.direction,
        arc.radius_scale,
    )
