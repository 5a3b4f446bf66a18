"""The machine as it is where its bus is open: real drives and signals replace modelled ones."""

from msgspec.structs import replace

from openacr.plant.describe.check_bus import bus_adcs, bus_inputs
from openacr.plant.describe.check_networks import nodes_inputs, parameters_of
from openacr.plant.describe.network_schema import Canopen, Node
from openacr.plant.describe.schema import Axis, BusDrive, Inputs, Load, World, switches

ABSENT = 0  # the id of a place without a node


def real_world(world: World) -> World:
    """The world with what is on the bus taken out of the model.

    Axes with a drive on the bus have no motor, no marker, no hard stops and no modelled switches;
    an input that the bus drives, digital or analog, is driven by nothing else. Real nodes leave
    their places empty.
    """
    nodes = nodes_inputs(world)
    on_bus = {axis.number for axis in world.axis if axis.bus}
    real = {number for _, number, _ in bus_inputs(world)} | nodes
    analogs = {number for _, number, _ in bus_adcs(world)}
    axes = tuple(_on_the_bus(axis) if axis.bus else _without(axis, real) for axis in world.axis)
    return replace(
        world,
        axis=axes,
        analog=tuple(one for one in world.analog if one.input not in analogs),
        wire=tuple(wire for wire in world.wire if wire.input not in real),
        device=tuple(
            replace(
                device,
                inputs={k: v for k, v in device.inputs.items() if v not in real},
                analogs={k: v for k, v in device.analogs.items() if v not in analogs},
            )
            for device in world.device
        ),
        inputs=Inputs(
            on=tuple(number for number in world.inputs.on if number not in real),
            off=(
                *(number for number in world.inputs.off if number not in real),
                *sorted(real - nodes),
            ),
        ),
        canopen=world.canopen and _modelled(world.canopen),
        drive=tuple(
            drive for drive in world.drive if drive.serial is None and drive.axis not in on_bus
        ),
    )


def is_real(world: World) -> bool:
    """Whether anything of the machine is on a bus of the computer."""
    has_node = world.canopen is not None and world.canopen.interface is not None
    return world.bus is not None or has_node or any(drive.serial for drive in world.drive)


def _modelled(canopen: Canopen) -> Canopen:
    """The modelled nodes at their places, with their faults and signals."""
    if not canopen.interface:
        return canopen
    places = [place for place, node in enumerate(canopen.node) if node.modelled]
    kept = {canopen.node[place].id for place in places}
    shown = {number for place in places for number in parameters_of(place)}
    return replace(
        canopen,
        node=tuple(node if node.modelled else Node(id=ABSENT) for node in canopen.node),
        fault=tuple(fault for fault in canopen.fault if fault.node in kept),
        signal=tuple(
            signal
            for signal in canopen.signal
            if signal.input in shown and (signal.output is None or signal.output in shown)
        ),
    )


def _on_the_bus(axis: Axis) -> Axis:
    return replace(
        axis, drive=BusDrive(), motor=None, load=Load(), marker=None, travel=None,
        positive_limit=None, negative_limit=None, home=None,
    )  # fmt: skip


def _without(axis: Axis, real: set[int]) -> Axis:
    """A modelled axis without the switches whose inputs the bus drives."""
    gone = {switch.key: None for switch in switches(axis) if switch.input in real}
    return replace(axis, **gone) if gone else axis
