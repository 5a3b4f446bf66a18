"""Check how a machine is drawn: colours, directions, what carries what, files."""

import re
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path as FilePath

from openacr.plant.describe.complaint import Complaint, Path
from openacr.plant.describe.links import carriers_of, names_of, subject_of
from openacr.plant.describe.schema import Axis, World

COLOUR = re.compile(r"#[0-9A-Fa-f]{6}")
KINDS = (".stl", ".glb")  # of files with bodies


def body_faults(world: World) -> Iterator[Complaint]:
    """Yield the contradictions in the tables of bodies and signs."""
    known = sorted(names_of(world.axis))
    for index, axis in enumerate(world.axis):
        path: Path = ("axis", index, "body")
        yield from _looks(path, axis)
        yield from _parent(path, axis.body.parent, known)
    for index, device in enumerate(world.device):
        if device.sign is not None:
            yield from _parent(("device", index, "sign"), device.sign.parent, known)
    yield from _circles(world)


def file_faults(world: World, folder: FilePath) -> Iterator[Complaint]:
    """Yield the files of bodies that are not in the folder of the machine file."""
    for index, axis in enumerate(world.axis):
        if axis.body.file and not (folder / axis.body.file).is_file():
            text = f"axis {axis.label}: there is no file {axis.body.file!r}"
            yield Complaint(("axis", index, "body", "file"), text, f"it is sought in {folder}")


def _looks(path: Path, axis: Axis) -> Iterator[Complaint]:
    body = axis.body
    if body.colour and not COLOUR.fullmatch(body.colour):
        text = f"axis {axis.label}: the colour is {body.colour!r}"
        yield Complaint((*path, "colour"), text, 'red, green and blue from 00 to ff: "#3b82f6"')
    if body.direction is not None and not any(body.direction):
        text = f"axis {axis.label}: the direction is 0, 0, 0"
        yield Complaint((*path, "direction"), text, "X is [1, 0, 0]; other lengths mean the same")
    if not body.file:
        return
    file = FilePath(body.file)
    if file.suffix.lower() not in KINDS:
        text = f"axis {axis.label}: {body.file!r} is no file with a body"
        yield Complaint((*path, "file"), text, f"its name ends in {' or '.join(KINDS)}")
    elif file.is_absolute() or ".." in file.parts:
        text = f"axis {axis.label}: {body.file!r} is outside the folder of the machine"
        yield Complaint((*path, "file"), text, "give a name in the folder of machine.toml")
    if body.size is not None:
        text = f"axis {axis.label}: the body has both a file and the size of a box"
        yield Complaint((*path, "size"), text, "give one of them")


def _parent(path: Path, parent: str | None, known: list[str]) -> Iterator[Complaint]:
    if parent and parent.upper() not in known:
        close = get_close_matches(parent.upper(), known, 1)
        hint = f"did you mean {close[0]}?" if close else f'axes: {", ".join(known)}; "": the ground'
        yield Complaint((*path, "parent"), f"there is no axis {parent!r}", hint)


def _circles(world: World) -> Iterator[Complaint]:
    carriers = carriers_of(map(subject_of, world.axis))
    for index, axis in enumerate(world.axis):
        chain, name = list[str](), axis.label.upper()
        while name and name not in chain:
            chain.append(name)
            name = carriers.get(name, "")
        if name == axis.label.upper():
            text = f"axis {axis.label} carries itself: {' on '.join([*chain, name])}"
            hint = 'the ground is parent = ""'
            yield Complaint(("axis", index, "body", "parent"), text, hint)
