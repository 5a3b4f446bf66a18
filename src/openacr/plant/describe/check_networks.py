"""Check the CANopen nodes and communicating drives of a `machine.toml` for contradictions."""

from collections.abc import Callable, Iterator

from openacr.models import MODELS
from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.network_schema import (
    DIGITAL,
    FAULTS,
    NODES,
    SIGNALS,
    Canopen,
    DrivePort,
    Fault,
    FaultKind,
    Node,
    Signal,
)
from openacr.plant.describe.schema import ExactDrive, StepperDrive, World

FIRST_INPUT, FIRST_OUTPUT, FLAGS_PER_NODE = 11520, 12032, 1024
FIRST_ANALOG_OUTPUT, FIRST_ANALOG_INPUT = 33280, 33288
PARAMETERS_PER_NODE = 512
_OF_A_NODE = {FaultKind.SILENT, FaultKind.LOST}


def input_ranges(world: World) -> tuple[tuple[int, int], ...]:
    """Return the flags of the digital inputs of all nodes."""
    return tuple(_ranges(world, FIRST_INPUT, lambda node: node.digital_inputs))


def output_ranges(world: World) -> tuple[tuple[int, int], ...]:
    """Return the flags of the digital outputs of all nodes."""
    return tuple(_ranges(world, FIRST_OUTPUT, lambda node: node.digital_outputs))


def _ranges(world: World, first: int, count_of: Callable[[Node], int]) -> Iterator[tuple[int, int]]:
    for place, node in enumerate(world.canopen.node if world.canopen else ()):
        if count := count_of(node):
            start = first + place * FLAGS_PER_NODE
            yield start, start + count - 1


def nodes_inputs(world: World) -> set[int]:
    """Return the flags of all inputs of nodes that are real where the bus is open."""
    canopen = world.canopen
    if canopen is None:
        return set()
    places = [place for place, node in enumerate(canopen.node) if node in canopen.real]
    firsts = [FIRST_INPUT + place * FLAGS_PER_NODE for place in places]
    return {first + number for first in firsts for number in range(DIGITAL)}


def parameters_of(place: int) -> range:
    """Return the parameters of the analog inputs and outputs of a node."""
    first = FIRST_ANALOG_OUTPUT + PARAMETERS_PER_NODE * place
    return range(first, first + PARAMETERS_PER_NODE)


def canopen_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions in `[canopen]`."""
    if world.canopen is None:
        return
    if not MODELS[world.card.model].has_canopen:
        text = f"the {world.card.model} has no CANopen controller"
        with_canopen = [model.name for model in MODELS.values() if model.has_canopen]
        yield Complaint(("canopen",), text, "these have: " + ", ".join(with_canopen))
    yield from _bus(world.canopen)
    yield from _sizes(world.canopen)
    yield from _nodes(world.canopen)
    for place, fault in enumerate(world.canopen.fault):
        yield from _fault(("canopen", "fault", place), fault, world.canopen)
    for place, signal in enumerate(world.canopen.signal):
        yield from _signal(("canopen", "signal", place), signal, world)


def _bus(canopen: Canopen) -> Iterator[Complaint]:
    """The CAN bus of the computer, and what is said of real nodes."""
    if canopen.interface is None and canopen.channel is not None:
        text = f"[canopen] has the channel {canopen.channel} of no interface"
        yield Complaint(("canopen", "channel"), text, 'add interface = "socketcan"')
    for place, node in enumerate(canopen.node):
        is_real = canopen.interface is not None and not node.modelled
        if node.modelled and canopen.interface is None:
            text = f"node {node.id} is modelled, as all nodes are without an interface"
            yield Complaint(("canopen", "node", place, "modelled"), text, "leave the key out")
        for key in ("vendor", "product", "revision", "serial"):
            if getattr(node, key) is not None and not is_real:
                text = f"{key} of node {node.id} is not checked: it is modelled"
                hint = "only real nodes have an identity: [canopen] with interface"
                yield Complaint(("canopen", "node", place, key), text, hint)
        if is_real and node.bit_rate != canopen.bit_rate:
            text = f"node {node.id} has {node.bit_rate} kbit/s, the bus {canopen.bit_rate}"
            yield Complaint(("canopen", "node", place, "bit_rate"), text, "all have one bit rate")


def _sizes(canopen: Canopen) -> Iterator[Complaint]:
    for key, limit in (("node", NODES), ("fault", FAULTS), ("signal", SIGNALS)):
        count = len(getattr(canopen, key))
        if count > limit:
            text = f"{count} {key}s are more than {limit}"
            yield Complaint(("canopen", key, limit), text)


def _nodes(canopen: Canopen) -> Iterator[Complaint]:
    taken: dict[int, int] = {}
    for place, node in enumerate(canopen.node):
        path: Path = ("canopen", "node", place)
        other = taken.setdefault(node.id, place)
        if other != place:
            hint = f"the other is canopen.node[{other}]"
            yield Complaint((*path, "id"), f"two nodes have the id {node.id}", hint)
        for key in ("input_range", "output_range"):
            low, high = getattr(node, key)
            if high <= 0.0 or low not in (0.0, -high):
                text = f"{key} of node {node.id} goes from {low:g} to {high:g}"
                yield Complaint((*path, key), text, "it is [0, x] or [-x, x]")
        if len(node.analog_values) > node.analog_inputs:
            text = f"node {node.id} has {node.analog_inputs} analog inputs"
            yield Complaint((*path, "analog_values"), text, "give no more values than inputs")


def _fault(path: Path, fault: Fault, canopen: Canopen) -> Iterator[Complaint]:
    if (fault.node is None) == (fault.kind in _OF_A_NODE):
        text = f'the fault "{fault.kind}" ' + (
            "lacks its node" if fault.node is None else "has a node"
        )
        yield Complaint((*path, "kind"), text, "silent and lost are faults of one node")
    elif fault.node is not None and fault.node not in {node.id for node in canopen.node}:
        known = ", ".join(str(node.id) for node in canopen.node)
        yield Complaint((*path, "node"), f"there is no node {fault.node}", f"nodes: {known}")
    if fault.until_s is not None and fault.until_s <= fault.at_s:
        text = f"the fault ends at {fault.until_s:g} s, but begins at {fault.at_s:g} s"
        yield Complaint((*path, "until_s"), text)


def _signal(path: Path, signal: Signal, world: World) -> Iterator[Complaint]:
    nodes = world.canopen.node if world.canopen else ()
    inputs = [
        FIRST_ANALOG_INPUT + PARAMETERS_PER_NODE * place + 16 * channel
        for place, node in enumerate(nodes)
        for channel in range(node.analog_inputs)
    ]
    outputs = [
        FIRST_ANALOG_OUTPUT + PARAMETERS_PER_NODE * place + 16 * channel
        for place, node in enumerate(nodes)
        for channel in range(node.analog_outputs)
    ]
    if signal.input not in inputs:
        text = f"P{signal.input} shows no analog input of a node"
        yield Complaint((*path, "input"), text, "they are P33288 + 512 n + 16 k of node n")
    if (signal.axis is None) == (signal.output is None):
        yield Complaint(path, "a signal comes from one of axis and output")
    elif signal.output is not None and signal.output not in outputs:
        text = f"P{signal.output} commands no analog output of a node"
        yield Complaint((*path, "output"), text, "they are P33280 + 512 n + 16 k of node n")
    elif signal.axis is not None and signal.axis not in {axis.number for axis in world.axis}:
        yield Complaint((*path, "axis"), f"there is no axis {signal.axis}")


def drive_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions in `[[drive]]`."""
    axes, taken = {axis.number: axis.drive for axis in world.axis}, set[int]()
    leads_to: dict[str, DrivePort] = {}
    for place, drive in enumerate(world.drive):
        path: Path = ("drive", place)
        if drive.axis not in axes:
            text = f"there is no axis {drive.axis} for the drive"
            yield Complaint((*path, "axis"), text, "it needs a motor: [[axis]]")
        elif isinstance(axes[drive.axis], StepperDrive | ExactDrive):
            text = f"the drive of axis {drive.axis} does not talk"
            yield Complaint((*path, "axis"), text, "stepper and exact drives have no serial port")
        if drive.axis in taken:
            yield Complaint((*path, "axis"), f"two drives talk for axis {drive.axis}")
        taken.add(drive.axis)
        if drive.serial is not None:
            port = leads_to.setdefault(drive.serial, drive.port)
            if port != drive.port:
                text = f"{drive.serial} is {drive.port} for axis {drive.axis}, {port} for another"
                yield Complaint((*path, "port"), text, "a line belongs to one port of the card")
        lost_s = float("inf") if drive.lost_s is None else drive.lost_s
        if drive.back_s is not None and drive.back_s <= lost_s:
            text = f"the drive is back at {drive.back_s:g} s, but not lost before"
            yield Complaint((*path, "back_s"), text, "give lost_s, the earlier time")
