"""Check the wiring of the card's analog inputs for contradictions."""

from collections.abc import Iterator

from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.schema import Analog, World


def analog_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions among the analog inputs."""
    axes = {axis.number for axis in world.axis}
    taken: dict[int, Path] = {}
    for path, channel in _sources(world):
        other = taken.setdefault(channel, path)
        if other != path:
            text = f"two voltages at analog input {channel}"
            yield Complaint(path, text, f"the other is {other[0]}[{other[1]}]")
    for index, analog in enumerate(world.analog):
        for key, text, hint in _faults(analog, axes):
            yield Complaint(("analog", index, key), text, hint)


def _sources(world: World) -> Iterator[tuple[Path, int]]:
    for index, analog in enumerate(world.analog):
        yield ("analog", index, "input"), analog.input
    for index, device in enumerate(world.device):
        for name, channel in device.analogs.items():
            yield ("device", index, "analogs", name), channel


def _faults(analog: Analog, axes: set[int]) -> Iterator[tuple[str, str, str]]:
    if analog.axis is None and analog.volts_per_unit:
        yield "volts_per_unit", "volts_per_unit has a meaning only with axis", ""
    elif analog.axis is not None and analog.axis not in axes:
        known = ", ".join(map(str, sorted(axes)))
        yield "axis", f"there is no axis {analog.axis}", f"axes: {known}"
    elif analog.axis is not None and not analog.volts_per_unit:
        yield "axis", f"axis {analog.axis} brings no voltage", "add volts_per_unit"
