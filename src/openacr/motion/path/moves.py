"""Coordinated moves: check, copy the profile values and hand over to the master."""

from collections.abc import Sequence

from openacr.errors import CardError
from openacr.kernel import calls_cy
from openacr.map.rows import axes, masters, moves
from openacr.map.words import mf1
from openacr.messages import INVALID_ARGUMENT, NO_MASTER_ATTACHED
from openacr.motion.card import Card
from openacr.motion.interlocks import (
    master_moving,
    needs_free_direction,
    needs_moves,
    needs_on,
    scale_of,
)
from openacr.motion.path import corners, curve_modes, curve_points, replacing, tangent
from openacr.motion.path.curves import slave_of
from openacr.motion.path.move_request import FlagState, Part, Target, end_points
from openacr.motion.path.records import SlaveMove, append

FARTHEST_U = 1e30  # far beyond any machine; NaN and infinities are refused with it


def needed_master(card: Card, program: int) -> int:
    """The master of a program; `No master attached` without one."""
    master = card.attachments.master(program)
    if master is None:
        raise CardError(NO_MASTER_ATTACHED)
    return master


def capacity(card: Card, master: int) -> int:
    """How many moves a master holds, the running one included."""
    return card.memory.I[masters.depth[master]] + 1


def has_room(card: Card, master: int, count: int = 1) -> bool:
    """Whether the move buffer of a master takes another `count` moves."""
    queued = card.memory.I[masters.queued[master]]
    return queued + count <= capacity(card, master)


def room_row(card: Card, master: int) -> tuple[int, int]:
    """Row in I and value it must stay below for the buffer to have room."""
    return masters.queued[master], capacity(card, master)


def issue(
    card: Card,
    program: int,
    parts: Sequence[Part],
    *,
    rapid: bool = False,
    interrupt: FlagState | None = None,
    replace: bool = False,
    tolerance_u: float | None = None,
) -> None:
    """Start or buffer one move; the caller has made sure that there is room.

    `interrupt` ends it early (INT); `replace` drops all other moves first (TRJ);
    `tolerance_u` is its own path tolerance for the corner at its end.
    """
    master = needed_master(card, program)
    needs_moves(card, master)
    here = replace or not master_moving(card, master)
    slave_moves = [
        _slave_move(card, program, master, target, here=here) for target in end_points(parts)
    ]
    permit_slave_moves(card, slave_moves, here=here)
    if here and not replace and _is_nothing(slave_moves, parts):
        return
    if replace:
        replacing.replace_waiting_moves(card, master, slave_moves)
    record = tangent.add(card, program, master, slave_moves, parts)
    if tolerance_u is not None:
        corners.set_of_move(card, master, record, tolerance_u)
    card.memory.I[moves.rapid[record]] = int(rapid)
    card.memory.I[moves.interrupt[record]] = interrupt.signed if interrupt else 0


def point(
    card: Card, program: int, targets: Sequence[Target], knot: float | None, weight: float | None
) -> None:
    """Take a point of the curve that SPLINE MODE or NURB MODE has begun."""
    master = needed_master(card, program)
    needs_moves(card, master)
    here = not master_moving(card, master)
    slave_moves = [_slave_move(card, program, master, target, here=here) for target in targets]
    permit_slave_moves(card, slave_moves, here=here)
    values = {one.slave: one.target_cnt for one in slave_moves}
    curve_modes.take(card, program, master, values, knot, weight)


def permit_slave_moves(card: Card, slave_moves: Sequence[SlaveMove], *, here: bool) -> None:
    """Refuse a move of axes that are off or, if it starts `here` and now, barred by a limit.

    Where a buffered move will start is not known yet: the limits watch it when it runs.
    """
    for one in slave_moves:
        needs_on(card, one.axis)
        if here:
            needs_free_direction(card, one.axis, one.delta_cnt / scale_of(card, one.axis))


def _is_nothing(slave_moves: list[SlaveMove], parts: Sequence[Part]) -> bool:
    """Whether a move that starts from rest leads nowhere; curves may return to their start."""
    straight = all(isinstance(part, Target) for part in parts)
    return straight and all(one.delta_cnt == 0.0 for one in slave_moves)


def seek(card: Card, program: int, axis: int, distance_u: float, mode: int) -> None:
    """MSEEK: an incremental move that looks for a capture and returns to it."""
    record = _single(card, program, Target(axis, distance_u, incremental=True))
    if record is not None:
        card.memory.I[moves.seek_axis[record]] = axis + 1
        card.memory.I[moves.seek_mode[record]] = mode


def high_speed_interrupt(
    card: Card,
    program: int,
    target: Target,
    mode: int,
    distance_u: float,
    window_u: tuple[float, float],
    abort: FlagState | None,
) -> None:
    """HSINT: a move that a capture within the window (width, start) leads `distance_u` after it."""
    record = _single(card, program, target)
    if record is None:
        return
    scale = scale_of(card, target.axis)
    card.memory.I[moves.hsint_axis[record]] = target.axis + 1
    card.memory.I[moves.hsint_mode[record]] = mode
    card.memory.I[moves.hsint_abort[record]] = abort.signed if abort else 0
    card.memory.F[moves.hsint_distance_cnt[record]] = distance_u * scale
    card.memory.F[moves.hsint_window_cnt[record]] = window_u[0] * abs(scale)
    card.memory.F[moves.hsint_start_cnt[record]] = window_u[1] * abs(scale)


def _single(card: Card, program: int, target: Target) -> int | None:
    """Append a move of one axis; its record, None if there is nothing to do."""
    master = needed_master(card, program)
    needs_moves(card, master)
    here = not master_moving(card, master)
    one = _slave_move(card, program, master, target, here=here)
    permit_slave_moves(card, [one], here=here)
    return append(card, program, master, [one], [target]) if one.delta_cnt else None


def _slave_move(card: Card, program: int, master: int, target: Target, *, here: bool) -> SlaveMove:
    """The displacement of an axis from where it is or, else, from its last planned end."""
    slave = slave_of(card, program, target.axis)
    if not abs(target.value_u) < FARTHEST_U:
        raise CardError(INVALID_ARGUMENT)
    scale = scale_of(card, target.axis)
    start = start_cnt(card, master, slave, target.axis, here=here)
    if target.incremental:
        delta = target.value_u * scale
        return SlaveMove(slave, target.axis, start, start + delta, delta, relative=True)
    length = card.memory.F[axes.rotary_u[target.axis]] * scale
    delta = target.value_u * scale - start
    if length:
        delta = shortest_turn(delta, abs(length))
        return SlaveMove(slave, target.axis, start, start + delta, delta, relative=True)
    return SlaveMove(slave, target.axis, start, target.value_u * scale, delta, relative=False)


def shortest_turn(delta: float, length: float) -> float:
    """A displacement on a circle of `length`, in (-length/2, length/2]."""
    return delta - length * -((0.5 - delta / length) // 1.0)


def start_cnt(card: Card, master: int, slave: int, axis: int, *, here: bool) -> float:
    """Where a slave is, or where its last queued move (or point of a curve) ends."""
    point = curve_points.last_cnt(card, master, slave)
    if point is not None:
        return point
    if not here:
        return card.memory.F[masters.target_cnt[master] + slave]
    if not master_moving(card, master):
        card.take_written(axis)
    return card.memory.F[axes.position_cnt[axis]]


def hold(card: Card, master: int) -> None:
    """Feedhold: slow the path to rest; the move stays loaded."""
    card.call(calls_cy.PATH_HOLD, master)


def release(card: Card, master: int) -> None:
    """Cycle start: the path goes on."""
    card.call(calls_cy.PATH_RELEASE, master)


def step(card: Card, master: int) -> None:
    """STEP of block mode: the move that is held goes on, or the next one may begin; no more."""
    card.memory.I[mf1.word[master]] |= mf1.START_MOVE_INHIBIT
    card.memory.I[masters.step_go[master]] = int(not card.memory.I[masters.moving[master]])
    release(card, master)


def end_steps(card: Card, master: int) -> None:
    """Block mode has ended: moves begin as ever."""
    card.memory.I[mf1.word[master]] &= ~mf1.START_MOVE_INHIBIT
    card.memory.I[masters.step_go[master]] = 0


def halt(card: Card, master: int) -> None:
    """HALT: slow the path to rest, then drop all its moves; no kill flag is left."""
    card.call(calls_cy.PATH_HALT, master)
