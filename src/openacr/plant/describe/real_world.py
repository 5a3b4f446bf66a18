"""The machine as it is where its bus is open: real drives and signals replace modelled ones."""

from msgspec.structs import replace

from openacr.plant.describe.check_bus import bus_inputs
from openacr.plant.describe.schema import Axis, BusDrive, Inputs, Load, World, switches


def real_world(world: World) -> World:
    """The world with what is on the bus taken out of the model.

    Axes with a drive on the bus have no motor, no marker, no hard stops and no modelled switches;
    an input that the bus drives is driven by nothing else.
    """
    real = {number for _, number, _ in bus_inputs(world)}
    axes = tuple(_on_the_bus(axis) if axis.bus else _without(axis, real) for axis in world.axis)
    return replace(
        world,
        axis=axes,
        wire=tuple(wire for wire in world.wire if wire.input not in real),
        device=tuple(
            replace(device, inputs={k: v for k, v in device.inputs.items() if v not in real})
            for device in world.device
        ),
        inputs=Inputs(
            on=tuple(number for number in world.inputs.on if number not in real),
            off=(*(number for number in world.inputs.off if number not in real), *sorted(real)),
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
