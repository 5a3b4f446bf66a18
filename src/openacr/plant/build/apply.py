"""Write a machine description into the memory of a card, in the units of the simulation step.

A motor is described in encoder counts (four per line) and seconds. Count 0 begins at the
initial position, because an incremental encoder starts counting where the axis is at power-up:

    position_cnt = direction * (position_u - initial_u) * counts_per_rev / units_per_rev + 0.5

(the half places the motor in the middle of a count). Torques become accelerations: one
radian is counts_per_rev / 2 pi counts, so T newton metres on an inertia J give
T / J * counts_per_rev / 2 pi counts/s^2. Borders of switches and regions are moved to the
middle of the count they lie in, so that the count at an edge has no rounding in it.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from openacr.map import numbers as at
from openacr.map.memory import Memory, flag_place
from openacr.map.rows import analogs as analog_rows
from openacr.map.rows import bus as bus_rows
from openacr.map.rows import (
    bus_motors,
    compliant_loads,
    encoders,
    every,
    input_words,
    motors,
    phases,
    plant,
    stepper_motors,
    system,
    wires,
)
from openacr.plant.build import analogs
from openacr.plant.build import apply_networks
from openacr.plant.build import apply_phases
from openacr.plant.build import apply_stepper
from openacr.plant.bus import bus
from openacr.plant.describe.counts import count_of
from openacr.plant.inputs import WORD_BITS, input_place, output_place
from openacr.plant.describe.schema import (
    LOADLESS,
    Axis,
    BusDrive,
    Contact,
    ExactDrive,
    IdealDrive,
    Motor,
    PhaseDrive,
    Space,
    StepperDrive,
    TorqueDrive,
    VelocityDrive,
    Wire,
    World,
    switches,
)
from openacr.plant.physics.step_cy import (
    BUS_DRIVE,
    EXACT_DRIVE,
    IDEAL_DRIVE,
    NO_ENCODER,
    PHASE_DRIVE,
    STEPPER_DRIVE,
    TORQUE_DRIVE,
    VELOCITY_DRIVE,
    plant_refresh,
)
from openacr.plant.physics.wiring_cy import NO_BORDER_CNT

_KINDS = {
    TorqueDrive: TORQUE_DRIVE,
    VelocityDrive: VELOCITY_DRIVE,
    IdealDrive: IDEAL_DRIVE,
    PhaseDrive: PHASE_DRIVE,
    StepperDrive: STEPPER_DRIVE,
    ExactDrive: EXACT_DRIVE,
    BusDrive: BUS_DRIVE,
}
FULL_DAC_BITS = 16
_Row = tuple[int, ...]  # the place of a row for each motor


def apply_world(world: World, memory: Memory) -> None:
    """Connect a machine to the card of `memory`, at rest at its initial positions."""
    _clear(memory)
    memory.F[system.period_s] = world.card.period_s
    for axis in world.axis:
        _write_motor(memory, axis, world)
    analogs.write_analogs(memory, world)
    apply_networks.write_nodes(memory, world)
    apply_networks.write_drives(memory, world)
    slots = _write_input_words(memory, world)
    _write_wires(memory, world, slots)
    plant_refresh(memory.F, memory.I, motors.COUNT)


# Spelled out: the generator of the map writes the names that it finds in the sources.
_REALS = (
    every(motors.reals, motors.REALS_SIZE),
    every(phases.reals, phases.REALS_SIZE),
    every(stepper_motors.reals, stepper_motors.REALS_SIZE),
    every(compliant_loads.reals, compliant_loads.REALS_SIZE),
    every(bus_motors.reals, bus_motors.REALS_SIZE),
    every(analog_rows.reals, analog_rows.REALS_SIZE),
    every(wires.reals, wires.REALS_SIZE),
    every(plant.reals, plant.REALS_SIZE),
    *apply_networks.REALS,
)
_INTS = (
    every(motors.ints, motors.INTS_SIZE),
    every(phases.ints, phases.INTS_SIZE),
    every(stepper_motors.ints, stepper_motors.INTS_SIZE),
    every(bus_motors.ints, bus_motors.INTS_SIZE),
    every(analog_rows.ints, analog_rows.INTS_SIZE),
    every(wires.ints, wires.INTS_SIZE),
    every(input_words.ints, input_words.INTS_SIZE),
    every(plant.ints, plant.INTS_SIZE),
    *apply_networks.INTS,
    slice(at.W_INPUTS, at.W_INPUTS + 1),  # the onboard inputs
)


def take_state(memory: Memory) -> tuple[list[list[float]], list[list[int]]]:
    """The state of the machine, which survives a restart of the card."""
    memory.F[bus_rows.before_s] = bus.now_s(memory)
    return (
        [list(memory.F[places]) for places in _REALS],
        [memory.I[places].tolist() for places in _INTS],
    )


def put_state(memory: Memory, state: tuple[list[list[float]], list[list[int]]]) -> None:
    """Restore the state of the machine; encoders continue from the motor positions."""
    for places, reals in zip(_REALS, state[0], strict=True):
        for index, real in enumerate(reals, places.start):
            memory.F[index] = real
    for places, ints in zip(_INTS, state[1], strict=True):
        for index, number in enumerate(ints, places.start):
            memory.I[index] = number
    for motor in range(motors.COUNT):
        raw = memory.F[motors.raw_count[motor]]
        memory.F[encoders.raw_old_cnt[motor]] = raw
        memory.F[stepper_motors.pulses_seen[motor]] = 0.0
        memory.F[encoders.filter_old_cnt[motor]] = raw
        memory.F[encoders.filter_level_cnt[motor]] = raw


def push(memory: Memory, motor: int, by_cnt: float) -> bool:
    """Move the load of a motor by raw encoder counts; False if there is no such motor."""
    if not memory.I[motors.kind[motor]]:
        return False
    memory.F[motors.position_cnt[motor]] += by_cnt
    return True


def _clear(memory: Memory) -> None:
    for places in _REALS:
        memory.F[places] = memoryview(bytes(memory.F[places].nbytes)).cast("d")
    for places in _INTS[:-1]:
        memory.I[places] = memoryview(bytes(memory.I[places].nbytes)).cast("i")


# -- motors --------------------------------------------------------------------------------


def _write_motor(memory: Memory, axis: Axis, world: World) -> None:
    doubles = {
        motors.dac_step: 2.0 ** (FULL_DAC_BITS - world.card.dac_bits),
        motors.position_cnt: count_of(axis, axis.initial),
        bus_motors.reported_cnt: count_of(axis, axis.initial),
        **_drive_rows(axis),
        **load_rows(axis),
        **stop_rows(axis),
        **_marker_rows(axis),
        **_compliance(axis),
    }
    for row, value in doubles.items():
        memory.F[row[axis.number]] = value
    for row, number in _int_rows(axis).items():
        memory.I[row[axis.number]] = number
    if isinstance(axis.drive, PhaseDrive):
        apply_phases.write_phases(memory, axis, axis.drive)
    elif isinstance(axis.drive, StepperDrive):
        apply_stepper.write_stepper(memory, axis, axis.drive, accel_per_nm(axis))


def _int_rows(axis: Axis) -> dict[_Row, int]:
    drive = axis.drive
    rows = {motors.dac: axis.number if axis.dac is None else axis.dac}
    rows[motors.kind] = _KINDS[type(drive)]
    if isinstance(drive, PhaseDrive):
        rows[motors.dac] = drive.dacs[0]
    elif isinstance(drive, StepperDrive):
        rows[motors.dac] = drive.output
    if not axis.has_encoder:
        rows[motors.encoder_fault] = NO_ENCODER
    if drive.fault_input is not None:
        rows[motors.fault_word], rows[motors.fault_mask] = flag_place(drive.fault_input)
        rows[motors.fault_closed] = int(drive.fault_contact is Contact.CLOSED)
    return rows


def _drive_rows(axis: Axis) -> dict[_Row, float]:
    """The effect of a volt: an acceleration, or a speed with a lag and a peak acceleration.

    A stepper drive has no voltage input (`apply_stepper` writes its rows); an exact drive
    ignores the value.
    """
    drive = axis.drive
    sign = axis.encoder_direction.sign
    if isinstance(drive, StepperDrive | ExactDrive | BusDrive):
        return {}
    rows = {motors.offset_v: drive.offset_v}
    if isinstance(drive, IdealDrive):
        speed = sign * drive.revs_per_s_per_volt * axis.counts
        return rows | {motors.speed_per_volt_cps: speed, motors.lag_s: drive.lag_s}
    motor = _motor(axis)
    torque_nm_per_a = motor.torque_nm_per_a or 0.0
    per_amp = torque_nm_per_a * accel_per_nm(axis)
    rows[motors.peak_accel] = drive.peak_amps * per_amp
    if isinstance(drive, VelocityDrive):
        speed = sign * drive.revs_per_s_per_volt * axis.counts
        return rows | {motors.speed_per_volt_cps: speed, motors.lag_s: drive.lag_s}
    rows[motors.accel_per_volt] = sign * drive.amps_per_volt * per_amp
    if drive.supply_v is not None and motor.resistance_ohm is not None:
        # In SI units the back-EMF constant (V per rad/s) is the torque constant (Nm per A).
        rows |= supply_rows(axis, drive.supply_v)
        rows[motors.back_emf_per_s] = torque_nm_per_a**2 / (
            motor.resistance_ohm * _inertia_kgm2(axis)
        )
    return rows


def supply_rows(axis: Axis, supply_v: float) -> dict[_Row, float]:
    """What the supply of a drive can press into its motor, by row; the motor has a resistance."""
    motor = _motor(axis)
    per_amp = (motor.torque_nm_per_a or 0.0) * accel_per_nm(axis)
    return {motors.supply_accel: supply_v / (motor.resistance_ohm or 1.0) * per_amp}


def load_rows(axis: Axis) -> dict[_Row, float]:
    """Friction per inertia, by row; some drives have no load model."""
    if isinstance(axis.drive, LOADLESS):
        return {}
    load = axis.load
    static_nm = load.coulomb_nm if load.static_nm is None else load.static_nm
    return {
        motors.viscous_per_s: load.viscous_nms / _inertia_kgm2(axis),
        motors.coulomb_accel: load.coulomb_nm * accel_per_nm(axis),
        motors.static_accel: static_nm * accel_per_nm(axis),
    }


def _compliance(axis: Axis) -> dict[_Row, float]:
    """What a load on an elastic shaft has on top, by row."""
    if axis.load.resonance_hz is None:
        return {}
    resonance_rad_s = 2.0 * math.pi * axis.load.resonance_hz
    return {
        compliant_loads.resonance_rad_s: resonance_rad_s,
        compliant_loads.damping_per_s: axis.load.damping_ratio * resonance_rad_s,
        compliant_loads.inertia_ratio: axis.load.inertia_kgm2 / _motor(axis).inertia_kgm2,
    }


def _motor(axis: Axis) -> Motor:
    if axis.motor is None:
        raise ValueError(f"axis {axis.label} has no motor")
    return axis.motor


def _inertia_kgm2(axis: Axis) -> float:
    return _motor(axis).inertia_kgm2 + axis.load.inertia_kgm2


def accel_per_nm(axis: Axis) -> float:
    """Acceleration in counts/s^2 per newton metre at the motor shaft."""
    return axis.counts / (2 * math.pi * _inertia_kgm2(axis))


def stop_rows(axis: Axis) -> dict[_Row, float]:
    """The counts between which an axis can move, by row."""
    if axis.travel is None:
        return {motors.low_stop_cnt: -NO_BORDER_CNT, motors.high_stop_cnt: NO_BORDER_CNT}
    low, high = sorted(count_of(axis, end) for end in axis.travel)
    return {motors.low_stop_cnt: low, motors.high_stop_cnt: high}


def _marker_rows(axis: Axis) -> dict[_Row, float]:
    """Place the marker: it is present in one count of each revolution."""
    if axis.marker is None:
        return {}
    phase = math.floor(count_of(axis, axis.marker)) % axis.counts
    return {motors.marker_pitch_cnt: float(axis.counts), motors.marker_phase_cnt: float(phase)}


# -- inputs --------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Side:
    """One side of the box in which a wire is active."""

    axis: int
    low_cnt: float
    high_cnt: float


@dataclass(frozen=True, slots=True)
class _Box:
    """An input and the box in space that makes it active."""

    input: int
    contact: Contact
    sides: tuple[_Side, ...]


def _boxes(world: World) -> Iterator[_Box]:
    for axis in world.axis:
        for switch in switches(axis):
            side = _side(axis, switch.low_u, switch.high_u)
            yield _Box(switch.input, switch.contact, (side,))
    by_label = {axis.label.upper(): axis for axis in world.axis}
    for wire in world.wire:
        if wire.region is not None:
            yield _Box(wire.input, wire.contact, tuple(_region_sides(wire, by_label)))


def _region_sides(wire: Wire, by_label: dict[str, Axis]) -> Iterator[_Side]:
    for name, (low, high) in (wire.region or {}).items():
        axis = by_label[name.upper()]
        scale = {Space.USER: 1.0, Space.REVS: axis.units_per_rev}.get(
            wire.units, 1 / axis.counts_per_unit
        )
        yield _side(axis, low * scale, high * scale)


def _side(axis: Axis, low_u: float, high_u: float) -> _Side:
    """Convert a range of positions; an encoder that counts down exchanges its ends."""
    low, high = sorted(_border(axis, end) for end in (low_u, high_u))
    return _Side(axis.number, low, high)


def _border(axis: Axis, position_u: float) -> float:
    count = count_of(axis, position_u)
    if abs(count) >= NO_BORDER_CNT:
        return math.copysign(NO_BORDER_CNT, count)
    return math.floor(count) + 0.5


def _write_input_words(memory: Memory, world: World) -> dict[int, int]:
    """List the words that hold wired inputs; the onboard inputs always come first."""
    on, off = world.inputs.on, world.inputs.off
    wired = [*(box.input for box in _boxes(world)), *(wire.input for wire in world.wire), *on, *off]
    wired += [number for device in world.device for number in device.inputs.values()]
    words = sorted({input_place(number)[0] for number in wired} | {at.W_INPUTS})
    slots = {word: slot for slot, word in enumerate(words)}
    for word, slot in slots.items():
        memory.I[input_words.word[slot]] = word
    for number in wired:
        word, mask = input_place(number)
        memory.I[input_words.wired[slots[word]]] |= mask
    for number in on:
        word, mask = input_place(number)
        memory.I[input_words.level[slots[word]]] |= mask
    memory.I[plant.words] = len(slots)
    return slots


def _write_wires(memory: Memory, world: World, slots: dict[int, int]) -> None:
    """Write outputs that drive inputs first, then boxes, one entry for each side."""
    follows = [wire for wire in world.wire if wire.output is not None]
    for entry, wire in enumerate(follows):
        _write_target(memory, entry, wire.input, wire.contact, slots)
        _write_output(memory, entry, wire)
    entry = len(follows)
    for box in _boxes(world):
        entry = _write_box(memory, entry, box, slots)
    memory.I[plant.follows] = len(follows)
    memory.I[plant.wires] = entry


def _write_target(
    memory: Memory, entry: int, number: int, contact: Contact, slots: dict[int, int]
) -> None:
    word, mask = input_place(number)
    memory.I[wires.slot[entry]] = slots[word]
    memory.I[wires.mask[entry]] = mask
    memory.I[wires.bit[entry]] = number % WORD_BITS
    if contact is Contact.CLOSED:
        memory.I[wires.closed[entry]] = 1
        memory.I[input_words.level[slots[word]]] |= mask


def _write_output(memory: Memory, entry: int, wire: Wire) -> None:
    word, mask = output_place(wire.output or 0)
    memory.I[wires.output_word[entry]], memory.I[wires.output_mask[entry]] = word, mask
    memory.F[wires.delay_s[entry]] = wire.delay_s


def _write_box(memory: Memory, entry: int, box: _Box, slots: dict[int, int]) -> int:
    """Write one box and return the next free entry."""
    _write_target(memory, entry, box.input, box.contact, slots)
    for side, more in zip(box.sides, _all_but_last(box.sides), strict=True):
        memory.I[wires.axis[entry]], memory.I[wires.more[entry]] = side.axis, int(more)
        memory.F[wires.low_cnt[entry]] = side.low_cnt
        memory.F[wires.high_cnt[entry]] = side.high_cnt
        entry += 1
    return entry


def _all_but_last(sides: Iterable[_Side]) -> list[bool]:
    count = len(list(sides))
    return [position < count - 1 for position in range(count)]
