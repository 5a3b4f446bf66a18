"""Check the bus of a `machine.toml`: places, modes, numbers on the card."""

from collections.abc import Iterator
from difflib import get_close_matches

from openacr.plant.describe.bus_schema import INPUT_BITS, BusDriveTable, CyclicMode, Terminal
from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.schema import Axis, StepperDrive, World
from openacr.plant.inputs import OUTPUT_RANGES, WIRED_RANGES, within

ADC_RANGE, DAC_RANGE = ((0, 7),), ((0, 15),)
_ONE = {"outputs": "an output", "adcs": "an analog input", "dacs": "an analog output"}
MOST_V = 10.0  # of an analog output
_PLACES = ("position", "alias", "serial")


def bus_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions in `[bus]` and `[axis.bus]`."""
    taken: dict[str, str] = {}
    for path, device, what in _devices(world):
        given = [key for key in _PLACES if getattr(device, key) is not None]
        if len(given) != 1:
            count = "more than one" if given else "none"
            text = f"{what} has {count} of position, alias and serial"
            yield Complaint(path, text, "give one of them: openacr bus scan shows all three")
        elif device.place in taken:
            text = f"{what} is at {device.place}, as {taken[device.place]}"
            yield Complaint((*path, given[0]), text)
        taken.setdefault(device.place, what)
    for index, axis in enumerate(world.axis):
        if axis.bus is not None:
            yield from _drive(("axis", index, "bus"), axis, axis.bus, world)
    for index, terminal in enumerate(world.bus.terminal if world.bus else ()):
        yield from _terminal(("bus", "terminal", index), terminal)
    yield from _inputs(world)


def _devices(world: World) -> Iterator[tuple[Path, BusDriveTable | Terminal, str]]:
    for index, axis in enumerate(world.axis):
        if axis.bus is not None:
            yield ("axis", index, "bus"), axis.bus, f"the drive of axis {axis.label}"
    for index, terminal in enumerate(world.bus.terminal if world.bus else ()):
        yield ("bus", "terminal", index), terminal, f"the terminal {terminal.name or index}"


def _drive(path: Path, axis: Axis, drive: BusDriveTable, world: World) -> Iterator[Complaint]:
    what = f"axis {axis.label}"
    if world.bus is None:
        hint = 'add [bus] with interface = "..."'
        yield Complaint(path, f"{what} has a drive on a bus, but there is no [bus]", hint)
    if isinstance(axis.drive, StepperDrive):
        text = f"{what}: a stepper output commands pulses, which no drive on the bus takes"
        yield Complaint(path, text, 'set mode = "exact" in [axis.drive] and attach DAC and encoder')
    if (drive.mode is CyclicMode.CSP) != (drive.per_volt is None):
        unit = "counts/s of the drive" if drive.mode is CyclicMode.CSV else "0.1 % of rated torque"
        if drive.per_volt is None:
            text = f'{what}: mode = "{drive.mode}" needs per_volt'
            yield Complaint(path, text, f"{unit} for a volt of the analog output")
        else:
            text = f'{what}: mode = "csp" has no use for per_volt'
            yield Complaint((*path, "per_volt"), text, "it takes the setpoint, not the voltage")
    elif drive.per_volt == 0.0:
        yield Complaint((*path, "per_volt"), f"{what}: per_volt 0 commands nothing")
    elif drive.per_volt is not None and abs(drive.per_volt) * MOST_V > drive.most:
        text = f"{what}: {MOST_V:g} V ask for {abs(drive.per_volt) * MOST_V:g}"
        most = drive.most / MOST_V
        hint = f"the target of {drive.mode} ends at {drive.most}: per_volt at most {most:g}"
        yield Complaint((*path, "per_volt"), text, hint)
    for name in drive.inputs:
        if name not in INPUT_BITS:
            close = get_close_matches(name, INPUT_BITS, 1)
            hint = f"did you mean {close[0]}?" if close else f"known: {', '.join(INPUT_BITS)}"
            yield Complaint((*path, "inputs", name), f"{what}: no drive input {name!r}", hint)


def _terminal(path: Path, terminal: Terminal) -> Iterator[Complaint]:
    for kind, ranges in (
        ("inputs", WIRED_RANGES),
        ("outputs", OUTPUT_RANGES),
        ("adcs", ADC_RANGE),
        ("dacs", DAC_RANGE),
    ):
        first, count = getattr(terminal, f"{kind}_from"), getattr(terminal, kind)
        what = f"the terminal {terminal.label}"
        if (first is None) != (count == 0):
            text = f"{what} has only one of {kind} and {kind}_from"
            yield Complaint(path, text, f"{kind} is how many, {kind}_from the first of the card")
        elif kind != "inputs" and first is not None:
            for number in (first, first + count - 1):
                if not within(number, ranges):
                    text = f"{what} leads to {number}, which is not {_ONE[kind]}"
                    yield Complaint((*path, f"{kind}_from"), text, _ranges(kind, ranges))
                    break


def bus_inputs(world: World) -> Iterator[tuple[Path, int, str]]:
    """What of the bus drives inputs of the card: its place in the file, the input, its name."""
    for index, axis in enumerate(world.axis):
        if axis.bus is not None:
            for name, number in axis.bus.inputs.items():
                place: Path = ("axis", index, "bus", "inputs", name)
                yield place, number, f"{name} of the drive of axis {axis.label}"
    for index, terminal in enumerate(world.bus.terminal if world.bus else ()):
        for channel in range(terminal.inputs if terminal.inputs_from is not None else 0):
            number = (terminal.inputs_from or 0) + channel
            what = f"channel {channel + 1} of the terminal {terminal.label}"
            yield ("bus", "terminal", index, "inputs_from"), number, what


def bus_adcs(world: World) -> Iterator[tuple[Path, int, str]]:
    """What of the bus brings voltages to analog inputs: its place in the file, the input, name."""
    for index, terminal in enumerate(world.bus.terminal if world.bus else ()):
        for channel in range(terminal.adcs if terminal.adcs_from is not None else 0):
            what = f"analog channel {channel + 1} of the terminal {terminal.label}"
            place: Path = ("bus", "terminal", index, "adcs_from")
            yield place, (terminal.adcs_from or 0) + channel, what


def _inputs(world: World) -> Iterator[Complaint]:
    analog: dict[int, str] = {}
    for path, number, what in bus_adcs(world):
        if number in analog:
            yield Complaint(path, f"two signals on ADC{number}: {analog[number]} and {what}")
        analog.setdefault(number, what)
    taken: dict[int, str] = {}
    for path, number, what in bus_inputs(world):
        if not within(number, WIRED_RANGES):
            text = f"{what} leads to {number}, which is not an input"
            yield Complaint(path, text, _ranges("inputs", WIRED_RANGES))
        elif number in taken:
            yield Complaint(path, f"two signals on input {number}: {taken[number]} and {what}")
        taken.setdefault(number, what)


def _ranges(what: str, ranges: tuple[tuple[int, int], ...]) -> str:
    return f"{what} are " + ", ".join(f"{first} to {last}" for first, last in ranges)
