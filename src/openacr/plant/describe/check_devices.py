"""Check the devices of a machine that are Python classes: kinds, names, what they are wired to."""

from collections.abc import Iterator
from difflib import get_close_matches

from openacr.errors import UserError
from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.schema import DeviceTable, World
from openacr.plant.devices.device import Device
from openacr.plant.devices.kinds import LIBRARY, is_own, made

WIRINGS = {  # table: whether it wires commands, and the type of what it wires
    "outputs": (True, bool),
    "dacs": (True, float),
    "axes": (True, float),
    "inputs": (False, bool),
    "analogs": (False, float),
}


def device_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions among devices; own classes are not looked into."""
    axes = {axis.number for axis in world.axis}
    taken: dict[str, int] = {}
    for index, table in enumerate(world.device):
        path: Path = ("device", index)
        other = taken.setdefault(table.label, index)
        if other != index:
            text = f"two devices are called {table.label!r}"
            yield Complaint((*path, "name"), text, f"the other is device[{other}]")
        yield from _kind_faults(path, table)
        for name, axis in table.axes.items():
            if axis not in axes:
                known = ", ".join(map(str, sorted(axes)))
                text = f"there is no axis {axis}"
                yield Complaint((*path, "axes", name), text, f"axes: {known}")


def _kind_faults(path: Path, table: DeviceTable) -> Iterator[Complaint]:
    if is_own(table.kind):
        return
    if table.kind not in LIBRARY:
        close = get_close_matches(table.kind, LIBRARY, 1)
        hint = f"did you mean {close[0]!r}?" if close else f"known are {', '.join(LIBRARY)};"
        text = f"the device kind {table.kind!r} is not known"
        yield Complaint((*path, "kind"), text, f"{hint} a class of a file is press.py:Press")
        return
    yield from class_faults(path, table, LIBRARY[table.kind])


def class_faults(path: Path, table: DeviceTable, found: type[Device]) -> Iterator[Complaint]:
    """Yield what a table asks of a class that it does not have."""
    for key, (is_command, wanted) in WIRINGS.items():
        what, names = ("command", found.COMMANDS) if is_command else ("signal", found.SIGNALS)
        for name in getattr(table, key):
            known = [each for each, kind in names.items() if kind is wanted]
            if name not in known:
                hint = ", ".join(known) or "there are none"
                text = f"{table.label} has no {what} {name!r} for {key}"
                yield Complaint((*path, key, name), text, f"known: {hint}")
    try:
        made(found, table.settings)
    except UserError as error:
        yield Complaint((*path, "settings"), f"{table.label}: {error}")
