"""Files, texts and projects checked: which card they are for, and what is read before them."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from openacr.basic.memory.storage import Storage
from openacr.errors import SourceError, UserError
from openacr.map.memory import Memory
from openacr.plant.describe.load import load_world
from openacr.plant.describe.schema import Card
from openacr.project import (
    PROGRAM_COUNT,
    Place,
    Project,
    SourceFile,
    find_project,
    is_folder,
    place_of,
    read_source,
)
from openacr.scenario import load_scenario
from openacr.source_check.cutoffs import Cutoffs
from openacr.source_check.devices import device_faults
from openacr.source_check.faults import Fault
from openacr.source_check.room import Room
from openacr.source_check.source import Reader

Level = tuple[Place, int]  # set-up, program or PLC, and its number
_NOTHING: Mapping[Path, bytes] = {}


def check(
    path: Path,
    at: Level | None = None,
    unsaved: Mapping[Path, bytes] = _NOTHING,
    axes: Sequence[str] = (),
) -> list[Fault]:
    """Every fault of a controller file, or of all files of a project folder.

    `at` is the level of a file whose name does not say it, `unsaved` are controller files as an
    editor holds them, `axes` the names of axes 0, 1 ... that all programs have without ATTACH.
    SourceError or UserError where the input cannot be read at all.
    """
    project = find_project(path, unsaved)
    tables = [*table_faults(project), *device_faults(project)]
    return [*tables, *read(path, project, at, unsaved, axes).faults]


def check_text(text: str, path: Path, at: Level | None = None) -> list[Fault]:
    """Every fault of a text that is to be the file `path`, which need not exist.

    The set-up and the machine file beside `path` are read before it.
    """
    place, number = place_of(path) if at is None else at
    source = SourceFile(path, text.encode(errors="replace"), place, number)
    home = Project(path.parent) if place is Place.SETUP else _home(path.parent, is_needed=False)
    reader = _reader(home)
    _read_after_setup(reader, home, source)
    return reader.faults


def read(
    file: Path,
    project: Project,
    at: Level | None = None,
    unsaved: Mapping[Path, bytes] = _NOTHING,
    axes: Sequence[str] = (),
) -> Reader:
    """Read all files of a project; one alone is read after the set-up beside it.

    `at` is the level of a file whose name does not say it, `axes` the names of axes 0, 1 ...
    """
    place, number = place_of(file) if at is None else at
    is_all = is_folder(file, unsaved)
    is_whole = is_all or place is Place.SETUP
    home = project if is_whole else _home(file.parent, unsaved, is_needed=at is None)
    reader = _reader(home)
    if axes:
        named = {name.upper(): number for number, name in enumerate(axes)}
        reader.axes = {program: dict(named) for program in range(PROGRAM_COUNT)}
    if is_whole:
        reader.sizes.is_complete = reader.room.is_complete = is_all
        for source in project.sources:
            reader.read(source)
        return reader
    _read_after_setup(reader, home, read_source(file, place, number, unsaved))
    return reader


def table_faults(project: Project) -> Iterator[Fault]:
    """The faults of the machine and scenario files of a project."""
    for path, load in ((project.machine, load_world), (project.scenario, load_scenario)):
        try:
            if path:
                load(path)
        except SourceError as wrong:
            text = (path.read_text(errors="replace") if path else "").split("\n")
            for error in wrong.errors:
                line = text[error.line - 1].rstrip() if 0 < error.line <= len(text) else ""
                place = (error.line, error.column, 1)
                yield Fault(error.path, *place, error.text, error.hint, line)


def _reader(home: Project) -> Reader:
    """A reader for the card of a project."""
    card = _card(home)
    model = card.board
    return Reader(
        room=Room(Storage(Memory(), streams=model.streams)),
        model=model,
        cutoffs=Cutoffs(card.period_s),
    )


def _read_after_setup(reader: Reader, home: Project, source: SourceFile) -> None:
    """Read a file after the set-up of its project, whose own faults are not wanted."""
    if home.setup:
        reader.room.is_complete = True
        reader.read(home.setup)
        reader.faults.clear()
        reader.parts.clear()
    reader.read(source)
    path = str(source.path)
    reader.faults[:] = [fault for fault in reader.faults if fault.path == path]


def _home(folder: Path, unsaved: Mapping[Path, bytes] = _NOTHING, *, is_needed: bool) -> Project:
    """The project a file lies in; one without files where a project is absent and not needed."""
    try:
        return find_project(folder, unsaved)
    except SourceError:
        raise
    except UserError:
        if is_needed:
            raise
        return Project(folder)


def _card(project: Project) -> Card:
    """The card the files are for; the usual one unless a readable machine file says which."""
    if project.machine is None:
        return Card()
    try:
        return load_world(project.machine).card
    except SourceError:
        return Card()
