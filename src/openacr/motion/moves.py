"""Coordinated moves: check, copy the profile values and hand over to the master."""

from collections.abc import Iterable
from dataclasses import dataclass

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import hold_cy, path_cy
from openacr.map.numbers import (
    AXF_POSITION_CNT,
    AXF_ROTARY_U,
    AXF_TARGET_CNT,
    MA_USER_VELOCITY,
    MF1_IN_MOTION,
    MF1_MOVE_BUFFERED,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_FVEL_UPS,
    MQF_IVEL_UPS,
    MQF_JRK_UPS3,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_BASE,
    MQI_RAPID,
    MQI_RELATIVE,
    MQI_SEEK_AXIS,
    MQI_SEEK_MODE,
    MQI_SLAVES,
    MQI_STRIDE,
    MSF_ACC_UPS2,
    MSF_DEC_UPS2,
    MSF_FVEL_UPS,
    MSF_IVEL_UPS,
    MSF_JRK_UPS3,
    MSF_STP_UPS2,
    MSF_TARGET_CNT,
    MSF_VECDEF,
    MSI_DEPTH,
    MSI_DROP_AT_REST,
    MSI_HEAD,
    MSI_HOLD,
    MSI_QUEUED,
)
from openacr.messages import INVALID_ARGUMENT, NO_MASTER_ATTACHED, UNDEFINED_SYMBOL
from openacr.motion import settings
from openacr.motion.card import Card
from openacr.motion.permits import (
    master_moving,
    needs_free_way,
    needs_moves,
    needs_on,
    scale_of,
)
from openacr.motion.rows import axis_reals, master_ints, master_parameter, master_reals, master_word

RING = path_cy.RING
FARTHEST_U = 1e30  # far beyond any machine; NaN and infinities are refused with it

_COPIED = (
    (MSF_ACC_UPS2, MQF_ACC_UPS2),
    (MSF_DEC_UPS2, MQF_DEC_UPS2),
    (MSF_STP_UPS2, MQF_STP_UPS2),
    (MSF_JRK_UPS3, MQF_JRK_UPS3),
    (MSF_FVEL_UPS, MQF_FVEL_UPS),
    (MSF_IVEL_UPS, MQF_IVEL_UPS),
)
_master_hold = pick(hold_cy.master_hold)
_master_release = pick(hold_cy.master_release)
_master_drop = pick(hold_cy.master_drop)


@dataclass(frozen=True, slots=True)
class Target:
    """Where one axis of a move goes: to `value_u`, or by `value_u` if incremental."""

    axis: int
    value_u: float
    incremental: bool = False


@dataclass(frozen=True, slots=True)
class _Way:
    slave: int
    axis: int
    target_cnt: float
    delta_cnt: float
    relative: bool


def needed_master(card: Card, program: int) -> int:
    """The master of a program; `No master attached` without one."""
    master = card.attachments.master(program)
    if master is None:
        raise CardError(NO_MASTER_ATTACHED)
    return master


def capacity(card: Card, master: int) -> int:
    """How many moves a master holds, the running one included."""
    return card.memory.I[master_ints(master) + MSI_DEPTH] + 1


def has_room(card: Card, master: int, count: int = 1) -> bool:
    """Whether the move buffer of a master takes another `count` moves."""
    queued = card.memory.I[master_ints(master) + MSI_QUEUED]
    return queued + count <= capacity(card, master)


def room_row(card: Card, master: int) -> tuple[int, int]:
    """Row in I and value it must stay below for the buffer to have room."""
    return master_ints(master) + MSI_QUEUED, capacity(card, master)


def issue(card: Card, program: int, targets: Iterable[Target], *, rapid: bool = False) -> None:
    """Start or buffer one linear move; the caller has made sure that there is room."""
    master = needed_master(card, program)
    needs_moves(card, master)
    ways = [_way(card, program, master, target) for target in targets]
    for way in ways:
        needs_on(card, way.axis)
        needs_free_way(card, way.axis, way.delta_cnt / scale_of(card, way.axis))
    if not master_moving(card, master) and all(way.delta_cnt == 0.0 for way in ways):
        return
    record = _append(card, master, ways)
    card.memory.I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID] = int(rapid)


def seek(card: Card, program: int, axis: int, distance_u: float, mode: int) -> None:
    """MSEEK: an incremental move that looks for a capture and returns to it."""
    master = needed_master(card, program)
    needs_moves(card, master)
    needs_on(card, axis)
    needs_free_way(card, axis, distance_u)
    if distance_u == 0.0:
        return
    way = _way(card, program, master, Target(axis, distance_u, incremental=True))
    row = MQI_BASE + _append(card, master, [way]) * MQI_STRIDE
    card.memory.I[row + MQI_SEEK_AXIS] = axis + 1
    card.memory.I[row + MQI_SEEK_MODE] = mode


def _way(card: Card, program: int, master: int, target: Target) -> _Way:
    slave = card.attachments.slave_of(program, target.axis)
    if slave is None:
        raise CardError(UNDEFINED_SYMBOL)
    if not abs(target.value_u) < FARTHEST_U:
        raise CardError(INVALID_ARGUMENT)
    scale = scale_of(card, target.axis)
    here = _planned_end(card, master, slave, target.axis)
    if target.incremental:
        delta = target.value_u * scale
        return _Way(slave, target.axis, here + delta, delta, relative=True)
    length = card.memory.F[axis_reals(target.axis) + AXF_ROTARY_U] * scale
    delta = target.value_u * scale - here
    if length:
        delta = shortest_way(delta, abs(length))
        return _Way(slave, target.axis, here + delta, delta, relative=True)
    return _Way(slave, target.axis, target.value_u * scale, delta, relative=False)


def shortest_way(delta: float, length: float) -> float:
    """A displacement on a circle of `length`, in (-length/2, length/2]."""
    return delta - length * -((0.5 - delta / length) // 1.0)


def _planned_end(card: Card, master: int, slave: int, axis: int) -> float:
    """Where the last queued move of a slave ends, or where it stands."""
    if not master_moving(card, master):
        card.take_written(axis)
        return card.memory.F[axis_reals(axis) + AXF_POSITION_CNT]
    return card.memory.F[master_reals(master) + MSF_TARGET_CNT + slave]


def _append(card: Card, master: int, ways: list[_Way]) -> int:
    """Write the next record of the ring and set the motion flags at once."""
    settings.refresh_max_velocity(card, master)
    memory = card.memory
    rows = master_ints(master)
    queued = memory.I[rows + MSI_QUEUED]
    record = master * RING + (memory.I[rows + MSI_HEAD] + queued) % RING
    _write_profile(card, master, MQF_BASE + record * MQF_STRIDE)
    _write_ways(card, master, record, ways, first=queued == 0)
    memory.I[rows + MSI_QUEUED] = queued + 1
    flags = MF1_IN_MOTION | (MF1_MOVE_BUFFERED if queued else 0)
    memory.I[master_word(master)] |= flags
    return record


def _write_profile(card: Card, master: int, record: int) -> None:
    reals = card.memory.F
    source = master_reals(master)
    for row, copy in _COPIED:
        reals[record + copy] = reals[source + row]
    reals[record + MQF_VEL_UPS] = card.memory.S[master_parameter(master) + MA_USER_VELOCITY]


def _write_ways(card: Card, master: int, record: int, ways: list[_Way], *, first: bool) -> None:
    memory = card.memory
    reals = MQF_BASE + record * MQF_STRIDE
    ints = MQI_BASE + record * MQI_STRIDE
    source = master_reals(master)
    slaves = relative = 0
    for way in ways:
        slaves |= 1 << way.slave
        relative |= int(way.relative) << way.slave
        memory.F[reals + MQF_TARGET_CNT + way.slave] = way.target_cnt
        memory.F[reals + MQF_DELTA_CNT + way.slave] = way.delta_cnt
        memory.F[reals + MQF_WEIGHT + way.slave] = memory.F[source + MSF_VECDEF + way.slave]
        memory.F[source + MSF_TARGET_CNT + way.slave] = way.target_cnt
        if first:
            memory.F[axis_reals(way.axis) + AXF_TARGET_CNT] = way.target_cnt
            card.show(way.axis)
    memory.I[ints + MQI_SLAVES] = slaves
    memory.I[ints + MQI_RELATIVE] = relative
    memory.I[ints + MQI_RAPID] = 0
    memory.I[ints + MQI_SEEK_AXIS] = 0


def hold(card: Card, master: int) -> None:
    """Feedhold: slow the path to rest; the move stays loaded."""
    if card.memory.I[master_ints(master) + MSI_HOLD] == hold_cy.NOT_HELD:
        _master_hold(card.memory.F, card.memory.I, card.memory.S, master)


def release(card: Card, master: int) -> None:
    """Cycle start: the path goes on."""
    if card.memory.I[master_ints(master) + MSI_HOLD] != hold_cy.NOT_HELD:
        _master_release(card.memory.F, card.memory.I, card.memory.S, master)


def halt(card: Card, master: int) -> None:
    """HALT: slow the path to rest, then drop all its moves; no kill flag is left."""
    if not master_moving(card, master):
        return
    rows = master_ints(master)
    if card.memory.I[rows + MSI_HOLD] == hold_cy.IN_FEEDHOLD:
        _master_drop(card.memory.F, card.memory.I, card.memory.S, master)
    else:
        hold(card, master)
        card.memory.I[rows + MSI_DROP_AT_REST] = 1
