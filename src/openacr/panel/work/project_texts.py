"""Programs of a project beside those of its card: which differ, their text, another text stored."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import Literal

from openacr.client.errors import ChangedError
from openacr.client.requests import Level
from openacr.client.stored import ListedLine
from openacr.errors import UserError, unwritable
from openacr.panel.work.comparing import Row, side_by_side
from openacr.panel.work.text_questions import Entered
from openacr.project import decode, find_project
from openacr.source_check import read

Listings = Mapping[str, Sequence[ListedLine]]  # by PROG3, PLC0
State = Literal["equal", "differs", "card", "project"]  # the last two: only there


@dataclass(frozen=True, slots=True)
class ProjectText:
    """A program as a project has it: its file, the text of the program in it, whether the card's.

    `file` is the name of the file that holds it, or that would; `text` is empty where there is
    none. `version` changes with the file. `why_not`: why no other text is stored, if so.
    """

    name: str
    file: str
    text: str
    version: str
    is_same: bool
    why_not: str = ""


@dataclass(frozen=True, slots=True)
class _Place:
    """Where the text of a program is: lines of a file, from 0; `last` is beyond it."""

    path: Path
    first: int = 0
    last: int = 0


def states(root: Path, listings: Listings) -> dict[str, State]:
    """Of each program and PLC whether card and project have the same, or which of them has one."""
    entered = {name: lines for name, (lines, _place) in _entered(root).items()}
    return {
        name: _state(entered.get(name, ()), listings.get(name, ()))
        for name in sorted({*entered, *listings}, key=_order)
        if entered.get(name) or listings.get(name)
    }


def _state(entered: Sequence[Entered], listed: Sequence[ListedLine]) -> State:
    if _is_same(entered, listed):
        return "equal"
    return "card" if not entered else "project" if not listed else "differs"


def beside(root: Path, name: str, listed: Sequence[ListedLine]) -> list[Row]:
    """The lines of a program of a project beside those of its listing."""
    return side_by_side(_entered(root).get(name, ((), None))[0], listed)


def text_of(root: Path, name: str, listed: Sequence[ListedLine]) -> ProjectText:
    """A program of a project beside its listing of the card."""
    own = _own_file(root, name)
    lines, place = _entered(root).get(name, ([], _Place(own)))
    data = own.read_bytes() if own.is_file() else b""
    is_own = place.path == own
    text = "\n".join(_lines(data)[place.first : place.last]) if is_own else ""
    why_not = "" if is_own else f"{name} is in {place.path.name} of the project: change it there"
    return ProjectText(name, own.name, text, _version(data), _is_same(lines, listed), why_not)


def store(root: Path, name: str, text: str, version: str) -> ProjectText:
    """Store another text of a program in its file of the project; what is around it stays.

    ChangedError where the file has another version; UserError where the program is in another
    file, or the file cannot be written.
    """
    own = _own_file(root, name)
    place = _entered(root).get(name, ([], _Place(own)))[1]
    if place.path != own:
        raise UserError(f"{name} is in {place.path.name} of the project: change it there")
    data = own.read_bytes() if own.is_file() else b""
    if _version(data) != version:
        raise ChangedError(f"{own.name} of the project was changed since it was read")
    lines = _lines(data)
    whole = [*lines[: place.first], *text.rstrip("\n").split("\n"), *(lines[place.last :] or [""])]
    write(own, ("\r\n" if b"\r\n" in data else "\n").join(whole))
    return text_of(root, name, ())


def _entered(root: Path) -> dict[str, tuple[list[Entered], _Place]]:
    """The programs of a project: the lines that a card stores, and where their text is."""
    found = {}
    for (level, number), text in read(root, find_project(root)).texts.items():
        rows = list(text.in_order())
        if not rows:
            continue
        path = Path(rows[-1].place.file.path if rows[-1].place.file else "")
        here = [row.place for row in rows if row.place.file and Path(row.place.file.path) == path]
        numbers = [n for each in here for n in (each.number, *(rest for rest, _ in each.rests))]
        lines = [Entered(row.number, row.place.number, row.stored.text) for row in rows]
        place = _Place(path, min(numbers) - 1, max(numbers))
        found[f"{level.name}{number}"] = (lines, place)
    return found


def _is_same(entered: Sequence[Entered], listed: Sequence[ListedLine]) -> bool:
    return all(row.is_same for row in side_by_side(entered, listed))


def _own_file(root: Path, name: str) -> Path:
    """The file of a program, in the spelling of its project."""
    own = f"{name.lower()}.8k"
    return next((each for each in root.iterdir() if each.name.lower() == own), root / own)


def _lines(data: bytes) -> list[str]:
    return decode(data).replace("\r\n", "\n").replace("\r", "\n").split("\n") if data else []


def _version(data: bytes) -> str:
    return blake2b(data, digest_size=8).hexdigest()


def _order(name: str) -> tuple[str, int]:
    level = Level.of_line(name) or Level()
    return level.word, level.number


def write(path: Path, text: str) -> None:
    """Write a text, whole or not at all."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        partial.write_bytes(text.encode())
        os.replace(partial, path)
    except OSError as error:
        raise unwritable(path, error) from None
    finally:
        partial.unlink(missing_ok=True)
