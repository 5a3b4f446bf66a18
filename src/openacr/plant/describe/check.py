"""Check a `machine.toml` for contradictions between values that are valid separately."""

from collections.abc import Callable, Iterator
from difflib import get_close_matches

from openacr.plant.describe.check_analog import analog_faults
from openacr.plant.describe.check_bodies import body_faults
from openacr.plant.describe.check_bus import bus_faults
from openacr.plant.describe.check_devices import device_faults
from openacr.plant.describe.check_networks import (
    canopen_faults,
    drive_faults,
    input_ranges,
    output_ranges,
)
from openacr.plant.describe.check_stepper import stepper_faults
from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.schema import (
    LOADLESS,
    Axis,
    IdealDrive,
    PhaseDrive,
    StepperDrive,
    Switch,
    TorqueDrive,
    World,
    switches,
)
from openacr.plant.inputs import OUTPUT_RANGES, WIRED_RANGES, within

BOX_SIDES = 64
INPUT_WORDS = 16


def contradictions(world: World) -> Iterator[Complaint]:
    """Yield the contradictions, in the order of the file."""
    for check in CHECKS:
        yield from check(world)


def _numbers_and_names(world: World) -> Iterator[Complaint]:
    taken: dict[object, int] = {}
    for index, axis in enumerate(world.axis):
        for key, value in (("number", axis.number), ("name", axis.name.upper())):
            other = taken.setdefault(value, index) if value != "" else index
            if other != index:
                yield Complaint(
                    ("axis", index, key),
                    f"two axes have the {key} {getattr(axis, key)}",
                    f"the other is axis[{other}]",
                )


def _encoders(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        is_free = isinstance(axis.drive, StepperDrive) and not axis.has_encoder
        if (axis.encoder_lines is None) == (axis.counts_per_rev is None) and not is_free:
            both = "both" if axis.encoder_lines else "neither"
            yield Complaint(
                ("axis", index),
                f"axis {axis.label} has {both} of encoder_lines and counts_per_rev",
                "give one of them; an encoder has four counts per line",
            )


def _motors(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        for key, text, hint in _motor_faults(axis):
            yield Complaint(("axis", index, *key), f"axis {axis.label}: {text}", hint)


def _motor_faults(axis: Axis) -> Iterator[tuple[tuple[str, ...], str, str]]:
    drive, motor, load = axis.drive, axis.motor, axis.load
    if isinstance(drive, LOADLESS):
        if motor is not None:
            word = "an ideal" if isinstance(drive, IdealDrive) else "an exact"
            yield ("motor",), f"{word} drive has no use for a motor", 'or set mode = "torque"'
    elif motor is None:
        yield (
            (),
            "the motor is missing",
            "add [axis.motor]; only an ideal or exact drive needs none",
        )
    elif isinstance(drive, StepperDrive):
        yield from stepper_faults(axis, drive)
    elif motor.torque_nm_per_a is None:
        yield ("motor",), "the motor lacks torque_nm_per_a", "the current of the drive needs it"
    elif isinstance(drive, TorqueDrive) and drive.supply_v and motor.resistance_ohm is None:
        yield (
            ("drive", "supply_v"),
            "supply_v limits nothing without resistance_ohm of the motor",
            "add resistance_ohm to [axis.motor]",
        )
    if load.resonance_hz is not None:
        if not isinstance(drive, TorqueDrive):
            text = "only torque makes a load swing"
            yield ("load", "resonance_hz"), text, 'leave it away, or set mode = "torque"'
        elif not load.inertia_kgm2:
            text = "resonance_hz swings nothing without inertia_kgm2 of the load"
            yield ("load", "resonance_hz"), text, "add inertia_kgm2 to [axis.load]"
    if load.static_nm is not None and load.static_nm < load.coulomb_nm:
        yield (
            ("load", "static_nm"),
            f"static_nm {load.static_nm:g} is below coulomb_nm {load.coulomb_nm:g}",
            "static friction is never less than the friction of motion",
        )


def _commutation(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        for key, text, hint in _commutation_faults(axis):
            yield Complaint(("axis", index, *key), f"axis {axis.label}: {text}", hint)


def _commutation_faults(axis: Axis) -> Iterator[tuple[tuple[str, ...], str, str]]:
    drive, pole_pairs = axis.drive, axis.motor and axis.motor.pole_pairs
    if not isinstance(drive, PhaseDrive):
        if pole_pairs:
            hint = 'leave them away, or set mode = "phases"'
            yield ("motor", "pole_pairs"), "a drive that commutates has no use for pole_pairs", hint
        return
    if axis.motor is not None and not pole_pairs:
        yield (
            ("motor",),
            "the motor has no pole_pairs",
            "give the electrical turns in one turn of the motor",
        )
    if axis.dac is not None:
        yield ("dac",), "the phases have analog outputs of their own", "leave dac away"
    if drive.dacs[0] == drive.dacs[1]:
        yield (
            ("drive", "dacs"),
            f"both phases are on analog output {drive.dacs[0]}",
            "give two different ones",
        )


def _travel(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        if axis.travel is None:
            continue
        low, high = axis.travel
        if low >= high:
            text = f"axis {axis.label}: travel goes from {low:g} to {high:g}"
            yield Complaint(("axis", index, "travel"), text, "give the lower end first")
        elif not low <= axis.initial <= high:
            yield Complaint(
                ("axis", index, "initial"),
                f"axis {axis.label}: initial {axis.initial:g} is outside the travel "
                f"{low:g} to {high:g}",
            )


def _switch_positions(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        for switch in switches(axis):
            for text, hint in _switch_faults(axis, switch):
                yield Complaint(("axis", index, switch.key), f"axis {axis.label}: {text}", hint)
        positive, negative = axis.positive_limit, axis.negative_limit
        if positive and negative and negative.at >= positive.at:
            yield Complaint(
                ("axis", index, "negative_limit", "at"),
                f"axis {axis.label}: negative_limit at {negative.at:g} is not below "
                f"positive_limit at {positive.at:g}",
            )


def _switch_faults(axis: Axis, switch: Switch) -> Iterator[tuple[str, str]]:
    if switch.low_u >= switch.high_u:
        yield (
            f"{switch.key} is active between {switch.low_u:g} and {switch.high_u:g}",
            "give the lower end first",
        )
    elif axis.travel is not None:
        low, high = axis.travel
        if switch.low_u > high or switch.high_u < low:
            at = switch.low_u if switch.low_u > high else switch.high_u
            yield (
                f"{switch.key} at {at:g} is outside the travel {low:g} to {high:g}",
                "the axis would never reach it",
            )


def _wires(world: World) -> Iterator[Complaint]:
    labels = {axis.label.upper(): axis for axis in world.axis}
    for index, wire in enumerate(world.wire):
        path: Path = ("wire", index)
        if (wire.region is None) == (wire.output is None):
            both = (
                "both a region and an output" if wire.region else "neither a region nor an output"
            )
            yield Complaint(path, f"the wire to input {wire.input} has {both}", "give one of them")
        elif wire.region is not None:
            yield from _region_faults(wire.region, labels, (*path, "region"))
            if wire.delay_s:
                yield Complaint((*path, "delay_s"), "delay_s has a meaning only with output")
        elif wire.output is not None and not within(wire.output, _outputs(world)):
            text = f"output {wire.output} is not an output"
            yield Complaint((*path, "output"), text, _ranges("outputs", _outputs(world)))


def _device_outputs(world: World) -> Iterator[Complaint]:
    for index, device in enumerate(world.device):
        for name, number in device.outputs.items():
            if not within(number, _outputs(world)):
                text = f"output {number} is not an output"
                path: Path = ("device", index, "outputs", name)
                yield Complaint(path, text, _ranges("outputs", _outputs(world)))


def _region_faults(
    region: dict[str, tuple[float, float]], labels: dict[str, Axis], path: Path
) -> Iterator[Complaint]:
    if not region:
        yield Complaint(path, "the region names no axis")
    for name, (low, high) in region.items():
        if name.upper() not in labels:
            known = sorted(labels)
            close = get_close_matches(name.upper(), known, 1)
            hint = f"did you mean {close[0]}?" if close else "axes: " + ", ".join(known)
            yield Complaint((*path, name), f"the region names the unknown axis {name!r}", hint)
        if low >= high:
            text = f"the range of {name} goes from {low:g} to {high:g}"
            yield Complaint((*path, name), text, "give the lower end first")


def _inputs(world: World) -> Iterator[Complaint]:
    """Every input has at most one source."""
    taken: dict[int, str] = {}
    ranges = WIRED_RANGES + input_ranges(world)
    for path, number, what in sources(world):
        if not within(number, ranges):
            text = f"{what} is wired to {number}, which is not an input"
            yield Complaint(path, text, _ranges("inputs", ranges))
        elif number in taken:
            yield Complaint(path, f"two wires on input {number}: {taken[number]} and {what}")
        taken[number] = what


def sources(world: World) -> Iterator[tuple[Path, int, str]]:
    """What drives inputs: its place in the file, the input, its name."""
    for index, axis in enumerate(world.axis):
        for switch in switches(axis):
            what = f"{switch.key} of axis {axis.label}"
            yield ("axis", index, switch.key, "input"), switch.input, what
    for index, wire in enumerate(world.wire):
        yield ("wire", index, "input"), wire.input, wire.name or f"wire[{index}]"
    for index, device in enumerate(world.device):
        for name, number in device.inputs.items():
            yield ("device", index, "inputs", name), number, f"{name} of {device.label}"
    for level in ("on", "off"):
        for index, number in enumerate(getattr(world.inputs, level)):
            yield ("inputs", level, index), number, f"the constant level {level}"


def _fault_inputs(world: World) -> Iterator[Complaint]:
    for index, axis in enumerate(world.axis):
        number = axis.drive.fault_input
        if number is not None and not within(number, WIRED_RANGES):
            yield Complaint(
                ("axis", index, "drive", "fault_input"),
                f"axis {axis.label}: fault_input {number} is not an input",
                _ranges("inputs", WIRED_RANGES),
            )


def _size(world: World) -> Iterator[Complaint]:
    sides = sum(len(list(switches(axis))) for axis in world.axis)
    sides += sum(len(wire.region or "o") for wire in world.wire)
    if sides > BOX_SIDES:
        yield Complaint((), f"{sides} switches, ranges and wires are more than {BOX_SIDES}")
    words = len({0, *(number // 32 for _, number, _ in sources(world))})
    if words > INPUT_WORDS:
        yield Complaint((), f"wires lead to inputs of {words} words, more than {INPUT_WORDS}")


def _outputs(world: World) -> tuple[tuple[int, int], ...]:
    return OUTPUT_RANGES + output_ranges(world)


def _ranges(what: str, ranges: tuple[tuple[int, int], ...]) -> str:
    return f"{what} are " + ", ".join(f"{first} to {last}" for first, last in ranges)


CHECKS: tuple[Callable[[World], Iterator[Complaint]], ...] = (
    _numbers_and_names,
    _encoders,
    _motors,
    _commutation,
    _travel,
    _switch_positions,
    _wires,
    _inputs,
    _fault_inputs,
    canopen_faults,
    drive_faults,
    bus_faults,
    analog_faults,
    device_faults,
    _device_outputs,
    body_faults,
    _size,
)
