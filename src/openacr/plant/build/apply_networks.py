"""Write the CANopen nodes and communicating drives of a machine into the memory of a card."""

from openacr.map.memory import Memory
from openacr.map.rows import bus as bus_rows
from openacr.map.rows import bus_drives, bus_faults, bus_nodes, bus_signals, every
from openacr.plant.bus import aries
from openacr.plant.bus import bus
from openacr.plant.bus import terminals
from openacr.plant.describe.counts import position_of
from openacr.plant.describe.network_schema import (
    PORTS,
    Coupler,
    Fault,
    Health,
    Node,
    Signal,
    TalkingDrive,
)
from openacr.plant.describe.schema import Axis, ExactDrive, StepperDrive, TorqueDrive, VelocityDrive, World

COUPLERS = {Coupler.PIO_337: 0, Coupler.PIO_347: 1}
HEALTH = {Health.HEARTBEAT: 1, Health.GUARDING: 2}
# Spelled out: the generator of the map writes the names that it finds in the sources.
REALS = (
    every(bus_drives.reals, bus_drives.REALS_SIZE),
    every(bus_nodes.reals, bus_nodes.REALS_SIZE),
    every(bus_signals.reals, bus_signals.REALS_SIZE),
    every(bus_faults.reals, bus_faults.REALS_SIZE),
    every(bus_rows.reals, bus_rows.REALS_SIZE),
)
INTS = (
    every(bus_drives.ints, bus_drives.INTS_SIZE),
    every(bus_nodes.ints, bus_nodes.INTS_SIZE),
    every(bus_signals.ints, bus_signals.INTS_SIZE),
    every(bus_faults.ints, bus_faults.INTS_SIZE),
    every(bus_rows.ints, bus_rows.INTS_SIZE),
)


def write_nodes(memory: Memory, world: World) -> None:
    """Put the nodes of a machine on the bus, with outputs off."""
    if world.canopen is None:
        return
    memory.I[bus_rows.fitted] = 1
    places = {node.id: place for place, node in enumerate(world.canopen.node)}
    for place, node in enumerate(world.canopen.node):
        _write_node(memory, place, node)
    for place, fault in enumerate(world.canopen.fault):
        _write_fault(memory, place, fault, places)
    axes = {axis.number: axis for axis in world.axis}
    for place, signal in enumerate(world.canopen.signal):
        _write_signal(memory, place, signal, axes)
    for place in places.values():
        bus.begin(memory, place, bus.NodeState.PRE_OPERATIONAL)
    bus.follow_power(memory)


def _write_node(memory: Memory, place: int, node: Node) -> None:
    ints = {
        bus_nodes.id: node.id,
        bus_nodes.bit_rate: int(node.bit_rate),
        bus_nodes.coupler: COUPLERS[node.coupler],
        bus_nodes.health: HEALTH[node.health],
        bus_nodes.digital_inputs: node.digital_inputs,
        bus_nodes.digital_outputs: node.digital_outputs,
        bus_nodes.analog_inputs: node.analog_inputs,
        bus_nodes.analog_outputs: node.analog_outputs,
        bus_nodes.analog_bits: node.analog_bits,
    }
    for row, number in ints.items():
        memory.I[row[place]] = number
    reals = {
        bus_nodes.input_low: node.input_range[0],
        bus_nodes.input_high: node.input_range[1],
        bus_nodes.output_low: node.output_range[0],
        bus_nodes.output_high: node.output_range[1],
    }
    for row, value in reals.items():
        memory.F[row[place]] = value
    for index, value in enumerate(node.analog_values, bus_nodes.measured[place]):
        memory.F[index] = value


def _write_fault(memory: Memory, place: int, fault: Fault, places: dict[int, int]) -> None:
    memory.I[bus_faults.kind[place]] = bus.Trouble[fault.kind.name]
    memory.I[bus_faults.node[place]] = places.get(fault.node or 0, 0)
    memory.F[bus_faults.from_s[place]] = fault.at_s
    memory.F[bus_faults.until_s[place]] = bus.NEVER_S if fault.until_s is None else fault.until_s
    memory.F[bus_faults.rate[place]] = fault.rate


def _write_signal(memory: Memory, place: int, signal: Signal, axes: dict[int, Axis]) -> None:
    """A position counts from the machine's own zero, in units of its axis."""
    scale, offset = signal.scale, signal.offset
    memory.I[bus_signals.input[place]] = terminals.analog_input(memory, signal.input) or 0
    memory.I[bus_signals.axis[place]] = -1 if signal.axis is None else signal.axis
    if signal.axis is not None:
        axis = axes[signal.axis]
        origin, unit = (position_of(axis, count) for count in (0.0, 1.0))
        scale, offset = scale * (unit - origin), offset + scale * origin
    elif output := terminals.analog_output(memory, signal.output or 0):
        memory.I[bus_signals.node[place]], memory.I[bus_signals.channel[place]] = output
    memory.F[bus_signals.scale[place]], memory.F[bus_signals.offset[place]] = scale, offset


# -- drives --------------------------------------------------------------------------------


def write_drives(memory: Memory, world: World) -> None:
    """Connect the communicating drives of a machine to their lines."""
    axes = {axis.number: axis for axis in world.axis}
    for talking in world.drive:
        _write_drive(aries.Drive(memory, talking.axis), talking, axes[talking.axis])


def _write_drive(drive: aries.Drive, talking: TalkingDrive, axis: Axis) -> None:
    wholes = {
        bus_drives.kind: aries.ARIES,
        bus_drives.port: PORTS[talking.port],
        bus_drives.baud: int(talking.baud),
        bus_drives.address: talking.address,
        bus_drives.revision: int(talking.revision.replace(".", "")),
    }
    for row, number in wholes.items():
        drive.put_whole(row, number)
    reals = {
        bus_drives.connected_s: talking.connected_s,
        bus_drives.powered_s: talking.powered_s,
        bus_drives.lost_s: bus.NEVER_S if talking.lost_s is None else talking.lost_s,
        bus_drives.back_s: bus.NEVER_S if talking.back_s is None else talking.back_s,
        bus_drives.drive_temp_c: talking.drive_temp_c,
        bus_drives.motor_temp_c: talking.motor_temp_c,
        bus_drives.bus_v: talking.bus_v,
    }
    for row, value in reals.items():
        drive.put_real(row, value)
    for index, value in enumerate(_settings(axis)):
        drive.put_real(bus_drives.settings, value, index)


def _settings(axis: Axis) -> tuple[float, ...]:
    """DMODE, ERES, SMPER, DMTIP, DMTSCL, DMVSCL, as the machine file describes the drive."""
    drive, counts = axis.drive, float(axis.counts)
    if isinstance(drive, StepperDrive | ExactDrive):
        raise ValueError(f"axis {axis.label}: its drive does not talk")
    if isinstance(drive, TorqueDrive):
        return (aries.TORQUE, counts, counts, drive.peak_amps, drive.amps_per_volt, 0.0)
    peak = drive.peak_amps if isinstance(drive, VelocityDrive) else 0.0
    return (aries.VELOCITY, counts, counts, peak, 0.0, drive.revs_per_s_per_volt)
