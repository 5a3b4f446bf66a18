"""Write the CANopen nodes and communicating drives of a machine into the memory of a card."""

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_faults, bus_signals
from openacr.plant import aries, bus, terminals
from openacr.plant.counts import position_of
from openacr.plant.network_schema import (
    Coupler,
    DrivePort,
    Fault,
    FaultKind,
    Health,
    Node,
    Signal,
    TalkingDrive,
)
from openacr.plant.schema import Axis, ExactDrive, StepperDrive, TorqueDrive, VelocityDrive, World

COUPLERS = {Coupler.PIO_337: 0, Coupler.PIO_347: 1}
HEALTH = {Health.HEARTBEAT: 1, Health.GUARDING: 2}
TROUBLES = {
    FaultKind.SILENT: bus.Trouble.SILENT,
    FaultKind.LOST: bus.Trouble.LOST,
    FaultKind.NOISE: bus.Trouble.NOISE,
    FaultKind.CONTROLLER: bus.Trouble.CONTROLLER,
    FaultKind.SOFTWARE_OVERFLOW: bus.Trouble.SOFTWARE_OVERFLOW,
    FaultKind.HARDWARE_OVERFLOW: bus.Trouble.HARDWARE_OVERFLOW,
}
PORTS = {DrivePort.COM1: 1, DrivePort.COM2: 2}
REALS = (
    (at.BUSDF_BASE, at.BUSD_COUNT * at.BUSDF_STRIDE),
    (at.BUSNF_BASE, at.BUSN_COUNT * at.BUSNF_STRIDE),
    (at.BUSSF_BASE, at.BUSS_COUNT * at.BUSSF_STRIDE),
    (at.BUSXF_BASE, at.BUSX_COUNT * at.BUSXF_STRIDE),
    (at.BUSF_BASE, at.BUSF_STRIDE),
)
INTS = (
    (at.BUSDI_BASE, at.BUSD_COUNT * at.BUSDI_STRIDE),
    (at.BUSNI_BASE, at.BUSN_COUNT * at.BUSNI_STRIDE),
    (at.BUSSI_BASE, at.BUSS_COUNT * at.BUSSI_STRIDE),
    (at.BUSXI_BASE, at.BUSX_COUNT * at.BUSXI_STRIDE),
    (at.BUSI_BASE, at.BUSI_STRIDE),
)


def write_nodes(memory: Memory, world: World) -> None:
    """Put the nodes of a machine on the bus, with outputs off."""
    if world.canopen is None:
        return
    memory.I[at.BUSI_BASE + at.BUSI_FITTED] = 1
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
        at.BUSNI_ID: node.id,
        at.BUSNI_BIT_RATE: int(node.bit_rate),
        at.BUSNI_COUPLER: COUPLERS[node.coupler],
        at.BUSNI_HEALTH: HEALTH[node.health],
        at.BUSNI_DIGITAL_INPUTS: node.digital_inputs,
        at.BUSNI_DIGITAL_OUTPUTS: node.digital_outputs,
        at.BUSNI_ANALOG_INPUTS: node.analog_inputs,
        at.BUSNI_ANALOG_OUTPUTS: node.analog_outputs,
        at.BUSNI_ANALOG_BITS: node.analog_bits,
    }
    for row, number in ints.items():
        memory.I[terminals.ints(place) + row] = number
    reals = {
        at.BUSNF_INPUT_LOW: node.input_range[0],
        at.BUSNF_INPUT_HIGH: node.input_range[1],
        at.BUSNF_OUTPUT_LOW: node.output_range[0],
        at.BUSNF_OUTPUT_HIGH: node.output_range[1],
        **{at.BUSNF_MEASURED + n: value for n, value in enumerate(node.analog_values)},
    }
    for row, value in reals.items():
        memory.F[terminals.reals(place) + row] = value


def _write_fault(memory: Memory, place: int, fault: Fault, places: dict[int, int]) -> None:
    memory.I[bus_faults.kind[place]] = TROUBLES[fault.kind]
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
        at.BUSDI_KIND: aries.ARIES,
        at.BUSDI_PORT: PORTS[talking.port],
        at.BUSDI_BAUD: int(talking.baud),
        at.BUSDI_ADDRESS: talking.address,
        at.BUSDI_REVISION: int(talking.revision.replace(".", "")),
    }
    for row, number in wholes.items():
        drive.put_whole(row, number)
    reals = {
        at.BUSDF_CONNECTED_S: talking.connected_s,
        at.BUSDF_POWERED_S: talking.powered_s,
        at.BUSDF_LOST_S: bus.NEVER_S if talking.lost_s is None else talking.lost_s,
        at.BUSDF_BACK_S: bus.NEVER_S if talking.back_s is None else talking.back_s,
        at.BUSDF_DRIVE_TEMP_C: talking.drive_temp_c,
        at.BUSDF_MOTOR_TEMP_C: talking.motor_temp_c,
        at.BUSDF_BUS_V: talking.bus_v,
        **{at.BUSDF_SETTINGS + n: value for n, value in enumerate(_settings(axis))},
    }
    for row, value in reals.items():
        drive.put_real(row, value)


def _settings(axis: Axis) -> tuple[float, ...]:
    """DMODE, ERES, SMPER, DMTIP, DMTSCL, DMVSCL, as the machine file describes the drive."""
    drive, counts = axis.drive, float(axis.counts)
    if isinstance(drive, StepperDrive | ExactDrive):
        raise ValueError(f"axis {axis.label}: its drive does not talk")
    if isinstance(drive, TorqueDrive):
        return (aries.TORQUE, counts, counts, drive.peak_amps, drive.amps_per_volt, 0.0)
    peak = drive.peak_amps if isinstance(drive, VelocityDrive) else 0.0
    return (aries.VELOCITY, counts, counts, peak, 0.0, drive.revs_per_s_per_volt)
