"""Write the record of a move into the ring of its master."""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import path_cy, round_law_cy
from openacr.map.numbers import (
    AXF_TARGET_CNT,
    MA_DISTANCE_SQUARED,
    MA_MOVE_TIME,
    MA_USER_VELOCITY,
    MF1_IN_MOTION,
    MF1_MOVE_BUFFERED,
    MF2_MASTER_IN_TMOV,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_CORNER_TURN,
    MQF_CORNER_U,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_FVEL_UPS,
    MQF_IVEL_UPS,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQF_TMOV_S,
    MQF_TOLERANCE_U,
    MQF_TURN_DEG,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_AHEAD,
    MQI_BASE,
    MQI_CURVE,
    MQI_HSINT_AXIS,
    MQI_INTERRUPT,
    MQI_MARKS,
    MQI_RAPID,
    MQI_RELATIVE,
    MQI_SEEK_AXIS,
    MQI_SLAVES,
    MQI_STRIDE,
    MQI_TANG_SLAVE,
    MQI_TRIGGER,
    MQI_TRIGGER_AXIS,
    MSF_ACC_UPS2,
    MSF_DEC_UPS2,
    MSF_FVEL_UPS,
    MSF_IVEL_UPS,
    MSF_JRK_UPS3,
    MSF_STP_UPS2,
    MSF_TARGET_CNT,
    MSF_TOLERANCE_U,
    MSF_VECDEF,
    MSI_FIRST,
    MSI_HEAD,
    MSI_LOOK_DIRTY,
    MSI_QUEUED,
    MSI_ROUNDING,
    MSI_SIZE,
    MSI_TRIGGER,
    MSI_TRIGGER_AXIS,
)
from openacr.messages import INVALID_ARC
from openacr.motion import curves, settings
from openacr.motion.card import Card
from openacr.motion.orders import Shape
from openacr.motion.rows import (
    axis_reals,
    master_ints,
    master_parameter,
    master_reals,
    master_word,
    master_word2,
)

_COPIED = (
    (MSF_ACC_UPS2, MQF_ACC_UPS2),
    (MSF_DEC_UPS2, MQF_DEC_UPS2),
    (MSF_STP_UPS2, MQF_STP_UPS2),
    (MSF_JRK_UPS3, MQF_JRK_UPS3),
    (MSF_FVEL_UPS, MQF_FVEL_UPS),
    (MSF_IVEL_UPS, MQF_IVEL_UPS),
    (MSF_TOLERANCE_U, MQF_TOLERANCE_U),
)
_CLEARED = (
    MQI_RAPID,
    MQI_SEEK_AXIS,
    MQI_INTERRUPT,
    MQI_HSINT_AXIS,
    MQI_MARKS,
    MQI_TANG_SLAVE,
    MQI_AHEAD,
)
_move_shape = pick(path_cy.move_shape)
_move_directions = pick(path_cy.move_directions)
_path_turn_deg = pick(path_cy.path_turn_deg)
_round_between = pick(round_law_cy.round_between)


@dataclass(frozen=True, slots=True)
class Way:
    """The displacement of one slave; a relative one keeps it wherever the move begins.

    A weightless one does not count for the length of the path.
    """

    slave: int
    axis: int
    start_cnt: float
    target_cnt: float
    delta_cnt: float
    relative: bool
    weightless: bool = False


def append(card: Card, program: int, master: int, ways: list[Way], parts: Sequence[Shape]) -> int:
    """Write the next record of the ring and set the motion flags at once; its index."""
    settings.refresh_max_velocity(card, master)
    memory = card.memory
    rows = master_ints(master)
    queued = memory.I[rows + MSI_QUEUED]
    ring = (memory.I[rows + MSI_HEAD] + queued) % memory.I[rows + MSI_SIZE]
    record = memory.I[rows + MSI_FIRST] + ring
    _write_profile(card, master, MQF_BASE + record * MQF_STRIDE)
    _write_ways(card, master, record, ways)
    curves.write(card, program, record, parts)
    _lay_out(card, master, record, ways)
    _take_trigger(card, master, record)
    _look_back(card, master, record, queued)
    for way in ways:
        memory.F[master_reals(master) + MSF_TARGET_CNT + way.slave] = way.target_cnt
        if not queued:
            memory.F[axis_reals(way.axis) + AXF_TARGET_CNT] = way.target_cnt
        card.show(way.axis)
    length_u = memory.F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
    memory.S[master_parameter(master) + MA_DISTANCE_SQUARED] = length_u * length_u
    memory.I[rows + MSI_QUEUED] = queued + 1
    flags = MF1_IN_MOTION | (MF1_MOVE_BUFFERED if queued else 0)
    memory.I[master_word(master)] |= flags
    return record


def _write_profile(card: Card, master: int, record: int) -> None:
    reals = card.memory.F
    source = master_reals(master)
    for row, copy in _COPIED:
        reals[record + copy] = reals[source + row]
    timed = card.memory.I[master_word2(master)] & MF2_MASTER_IN_TMOV
    time_s = card.memory.S[master_parameter(master) + MA_MOVE_TIME]
    reals[record + MQF_TMOV_S] = time_s if timed else 0.0
    reals[record + MQF_VEL_UPS] = card.memory.S[master_parameter(master) + MA_USER_VELOCITY]


def _write_ways(card: Card, master: int, record: int, ways: list[Way]) -> None:
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
        weight = 0.0 if way.weightless else memory.F[source + MSF_VECDEF + way.slave]
        memory.F[reals + MQF_WEIGHT + way.slave] = weight
    memory.I[ints + MQI_SLAVES] = slaves
    memory.I[ints + MQI_RELATIVE] = relative
    for row in _CLEARED:
        memory.I[ints + row] = 0


def _lay_out(card: Card, master: int, record: int, ways: list[Way]) -> None:
    """Lay the move out from its planned start; `Invalid arc` for a curve that is none."""
    memory = card.memory
    for way in ways:
        memory.F[master_reals(master) + MSF_TARGET_CNT + way.slave] = way.start_cnt
    _move_shape(memory.F, memory.I, memory.S, master, record, True)
    if memory.I[MQI_BASE + record * MQI_STRIDE + MQI_CURVE]:
        if not 0.0 < memory.F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]:
            raise CardError(INVALID_ARC)


def _look_back(card: Card, master: int, record: int, queued: int) -> None:
    """Note where the path heads, and by how much it turns behind the move before."""
    memory, rows = card.memory, master_ints(master)
    _move_directions(memory.F, memory.I, memory.S, master, record)
    memory.F[MQF_BASE + record * MQF_STRIDE + MQF_TURN_DEG] = 0.0
    memory.I[rows + MSI_LOOK_DIRTY] = 1
    if queued:
        ring = (memory.I[rows + MSI_HEAD] + queued - 1) % memory.I[rows + MSI_SIZE]
        before = memory.I[rows + MSI_FIRST] + ring
        turn = _path_turn_deg(memory.F, before, record)
        memory.F[MQF_BASE + before * MQF_STRIDE + MQF_TURN_DEG] = turn
        _round_between(memory.F, memory.I, memory.S, master, before, record)
    memory.F[MQF_BASE + record * MQF_STRIDE + MQF_CORNER_U] = 0.0
    memory.F[MQF_BASE + record * MQF_STRIDE + MQF_CORNER_TURN] = 0.0
    if memory.F[MQF_BASE + record * MQF_STRIDE + MQF_TOLERANCE_U] > 0.0:
        memory.I[rows + MSI_ROUNDING] = 1


def _take_trigger(card: Card, master: int, record: int) -> None:
    """TRG is for the next move: this one."""
    rows = master_ints(master)
    ints = card.memory.I
    for row, copy in ((MSI_TRIGGER, MQI_TRIGGER), (MSI_TRIGGER_AXIS, MQI_TRIGGER_AXIS)):
        ints[MQI_BASE + record * MQI_STRIDE + copy] = ints[rows + row]
        ints[rows + row] = 0
