"""The set-up of a card beside that of its project: memory, attachments, aliases, settings.

What the project makes of a card is found by asking a virtual card that is loaded with it what the
card is asked: the lines of a backup, compared by what they mean.
"""

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from hashlib import blake2b
from pathlib import Path
from typing import Literal, NamedTuple

from openacr.client import Card
from openacr.client.backup import SETUP_FILE
from openacr.client.compare import NEVER, Contents, contents, differences
from openacr.client.errors import ChangedError
from openacr.client.requests import SYS, Level
from openacr.controller import Controller
from openacr.controller.loading import LoadError
from openacr.panel.work.project_texts import write
from openacr.project import find_project

_VARIABLE = re.compile(r"P(\d+)")
USERS = 4096  # parameters below are variables of the user, no set-up
# What AcroMill changes beside its lines: of its program, then (after a colon) of the card.
_OF_MACHINE = re.compile(r"(ATTACH|PM|DIM MBUF)\b.*|: AXIS\d+ VECDEF")
By = Literal["", "machine"]


class SetupRow(NamedTuple):
    """A setting that differs; `line` of the set-up file sets it, 0: none does.

    `by` is `machine` where the card has what AcroMill sets for the machine of the store.
    """

    key: str
    name: str
    line: int
    project: str | None
    card: str | None
    by: By


def compared(root: Path, reading: "Reading") -> list[SetupRow]:
    """The settings in which a card differs from a virtual card with the project."""
    card, project = contents("the card", reading.files), _of_project(root)
    at = places(_setup_file(root)[1])
    return [
        SetupRow(
            each.key,
            each.name,
            at.get(each.key, 0),
            each.second,
            each.first,
            reading.by(each.key, each.first),
        )
        for each in differences(card, project)
        if reading.is_setup(each.key)
    ]


def not_compared(reading: "Reading") -> list[str]:
    """What the card does not tell, as sentences."""
    unknown = contents("the card", reading.files).unknown
    return [*(f"{key}: {why}" for key, why in unknown.items()), NEVER]


def version(root: Path) -> str:
    """Changes with the set-up file."""
    return blake2b(_setup_file(root)[1].encode(), digest_size=8).hexdigest()


def store(root: Path, reading: "Reading", known: str) -> list[SetupRow]:
    """Store what differs into the set-up file of the project: the lines that the card reports.

    A line that sets the value takes the new one, one that the card does not have becomes a remark,
    what no line sets is added at the end. ChangedError where the file has another version.
    """
    path, text = _setup_file(root)
    if version(root) != known:
        raise ChangedError(f"{path.name} of the project was changed since it was read")
    rows = [each for each in compared(root, reading) if not each.by]
    said = {
        key: reading.lines[number - 1] for key, number in places("\n".join(reading.lines)).items()
    }
    lines = text.splitlines()
    added: list[str] = []
    for each in rows:
        if each.line:
            old = lines[each.line - 1]
            lines[each.line - 1] = f"REM {old}" if each.card is None else said[each.key]
        elif each.card is not None:
            level = Level.of_line(each.key.partition(" ")[0]) or SYS
            added += [str(level), said[each.key]]
    if rows:
        end = "\r\n" if "\r\n" in text else "\n"
        write(path, end.join([*lines, *added, ""]))
    return rows


class Reading(NamedTuple):
    """What a card reports of itself, and what AcroMill has to do with it.

    `own` is the program that AcroMill uses, `machine` the lines with which it sets up the program
    `master`; empty where it has not.
    """

    files: Mapping[str, str]
    own: str = ""
    master: str = ""
    machine: Sequence[str] = ()

    @property
    def lines(self) -> list[str]:
        """The lines of the set-up that the card reports."""
        return self.files[SETUP_FILE].splitlines()

    def is_setup(self, key: str) -> bool:
        """Whether a key is one of the set-up: no variable, none of the program of AcroMill."""
        variable = _VARIABLE.fullmatch(key)
        is_variable = variable is not None and int(variable[1]) < USERS
        return not is_variable and not (self.own and key.startswith(f"{self.own} "))

    def by(self, key: str, value: str | None) -> By:
        """Who has set what differs."""
        if key == "DIM P":  # also where the set-up was refused afterwards
            return "machine"
        if not self.machine:
            return ""
        of_master = key.removeprefix(f"{self.master} ")
        if _OF_MACHINE.fullmatch(of_master if of_master != key else f": {key}"):
            return "machine"
        text = "\n".join(self.machine)
        wanted = contents("", {SETUP_FILE: text}).settings or {}
        return "machine" if value is not None and _same(wanted.get(of_master), value) else ""


def _same(one: str | None, other: str) -> bool:
    """Whether two values are the same number, or the same text; a band may be one number."""
    if one is None:
        return False
    try:
        first, second = ([float(n) for n in text.strip("()").split(",")] for text in (one, other))
    except ValueError:
        return one == other
    if len(first) == 1 and len(second) == 2:  # of both directions
        first = [first[0], -first[0]]
    return len(first) == len(second) and all(
        abs(a - b) <= 1e-6 * max(abs(a), abs(b)) for a, b in zip(first, second, strict=True)
    )


def places(text: str) -> dict[str, int]:
    """The line of a set-up file, from 1, that is the last to set each key."""
    found: dict[str, int] = {}
    level = SYS
    for number, line in enumerate(text.splitlines(), start=1):
        level = Level.of_line(line) or level
        read = contents("", {SETUP_FILE: f"{level}\n{line.strip()}"}).settings or {}
        found |= dict.fromkeys(read, number)
    return found


def _setup_file(root: Path) -> tuple[Path, str]:
    """The set-up file of a project and its text, empty where there is none."""
    setup = find_project(root).setup
    return (root / SETUP_FILE, "") if setup is None else (setup.path, setup.text)


def _of_project(root: Path) -> Contents:
    return _loaded(root, find_project(root).fingerprint)


@lru_cache(1)
def _loaded(root: Path, _fingerprint: str) -> Contents:
    """What a virtual card reports once the project is loaded, before any program has run."""
    controller, refused = Controller.load(find_project(root))
    if refused:
        raise LoadError(refused)
    controller.send("HALT ALL\r")
    with Card.open(controller) as card:
        return contents("the project", card.read_all())
