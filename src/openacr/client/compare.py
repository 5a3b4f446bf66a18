"""Compare the contents of two cards: settings, variables and programs, by what they mean.

Contents are read from the files of a backup, whose lines are what a card reports. Every setting has
a key, the line without its value: `AXIS0 PGAIN`, `BIT8453`, `PROG0 ATTACH SLAVE1`.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from typing import TypeAlias

from msgspec import Struct

from openacr.basic.language.registry import Command
from openacr.client.backup import NOT_READABLE, NOT_UNDERSTOOD, SETUP_FILE
from openacr.client.listing import meaning
from openacr.client.requests import SYS, Level
from openacr.client.restore import command_of
from openacr.map import flags, parameters

MANY = 4
USERS = 4096  # parameters below are variables of the user
# What no terminal reads; it is in no backup, so it cannot be compared.
NEVER = "network address, passwords, local variables, strings, positions"

_HEAD = "REM Backup of "
_ACTIONS = frozenset(("HALT ALL", "NEW ALL", "CLEAR", "DETACH ALL"))
_FORMS = tuple(
    re.compile(form)
    for form in (
        r"(?P<key>DIM \$?\w+)\((?P<value>.*)\)",
        r"(?P<key>#DEFINE \S+) (?P<value>.*)",
        r"(?P<key>ATTACH (?:AXIS|SLAVE)\d+) (?P<value>.*)",
        r"(?P<key>ATTACH MASTER)(?P<value>\d+)",
        r"(?P<key>CONFIG) (?P<value>.*)",
        r"(?P<key>CMT\d+ (?:ENC|DAC|ADC))(?P<value>\d+ \w+)",
        r"PM (?P<value>ON|OFF) (?P<axis>\w+)",
        r"(?P<value>SET|CLR) (?P<key>BIT\d+)",
        r"(?P<key>P\d+)=(?P<value>.*)",
        r"(?P<key>AXIS\d+) (?P<value>ON|OFF)",
        r"(?P<key>.+) (?P<value>\S+)",
    )
)
_SLAVE = re.compile(r'AXIS(\d+) "(\w+)"')
_AXIS = re.compile(r"AXIS(\d+)\b")
_NUMBERED = re.compile(r"(P|BIT)(\d+)")
_OF_CARD = re.compile(r"AXIS\d|(?:P|BIT)\d+$")
_ALIASED = re.compile(r"#DEFINE (\S+)")
_IS_STORED = re.compile(r"\s*(?:(?:SYS|NEW)\s*|(?:PROG|PLC)\s*\d+\s*|)", re.IGNORECASE)

Texts: TypeAlias = Mapping[str, str]


@dataclass(slots=True)
class Contents:
    """What a card holds, and what of it is not known."""

    name: str
    version: str = ""
    settings: dict[str, str] | None = field(default_factory=dict)  # None: there is no set-up
    programs: dict[str, list[str]] = field(default_factory=dict)  # by level, only those compared
    unknown: dict[str, str] = field(default_factory=dict)  # why, by key

    @property
    def axes(self) -> dict[str, str]:
        """The names of axes by their numbers, as programs call them."""
        values = (self.settings or {}).values()
        return {found[1]: found[2] for found in map(_SLAVE.fullmatch, values) if found}


class Difference(Struct, frozen=True):
    """A setting with two values; None: one of them is not there."""

    key: str
    name: str
    first: str | None
    second: str | None


class Change(Struct, frozen=True):
    """Lines of a program that differ, in the place of each other."""

    program: str
    line: int  # of the first, counted from 1
    first: list[str]
    second: list[str]


def is_backup(setup: str) -> bool:
    """Whether a set-up file is one that a backup has written."""
    return setup.startswith(_HEAD)


def contents(name: str, files: Texts, *, levels: Iterable[str] = ()) -> Contents:
    """Read the files of a backup; `levels` are those of programs, by default all there can be."""
    found = Contents(name, programs={level: [] for level in levels})
    for file, text in files.items():
        if file == SETUP_FILE:
            _read_setup(found, text)
        else:
            level = file.removesuffix(".8k").upper()
            found.programs[level] = [
                line.strip() for line in text.splitlines() if not _IS_STORED.fullmatch(line)
            ]
    if SETUP_FILE not in files:
        found.settings = None
    return found


def _read_setup(found: Contents, text: str) -> None:
    level, settings = SYS, found.settings if found.settings is not None else {}
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith(_HEAD):
            found.version = line.removeprefix(_HEAD)
        elif line.startswith((NOT_READABLE, NOT_UNDERSTOOD)):
            query, _, why = line.partition(": ")[2].partition(": ")
            found.unknown[_at(level, query)] = why
        elif (other := Level.of_line(line)) is not None:
            level = other
        elif line.strip() and line not in _ACTIONS and not line.startswith("REM"):
            match = next(filter(None, (form.fullmatch(line) for form in _FORMS)), None)
            if match is None:
                found.unknown[line] = f"line {number} of {SETUP_FILE} is no setting"
                continue
            key = f"PM {match['axis']}" if "axis" in match.groupdict() else match["key"]
            settings[_at(level, key)] = match["value"]


def _at(level: Level, key: str) -> str:
    """The key of a setting: those of a program or its master are named with it."""
    return key if level == SYS or _OF_CARD.match(key) else f"{level} {key}"


def not_compared(first: Contents, second: Contents) -> Iterator[str]:
    """What cannot be compared, as sentences."""
    for each, other in ((first, second), (second, first)):
        if each.settings is None:
            yield f"settings and variables: {each.name} holds programs only"
        missing = [level for level in other.programs if level not in each.programs]
        if missing:
            named = ", ".join(missing) if len(missing) < MANY else "the other programs and PLCs"
            yield f"{named}: not in {each.name}"
        if other.settings is not None:
            for key, why in each.unknown.items():
                if other.unknown.get(key) != why:
                    yield f"{key}: {each.name}: {why}"
    yield f"{NEVER}: no terminal reads them"


def differences(first: Contents, second: Contents) -> Iterator[Difference]:
    """Every setting and variable whose values differ."""
    if first.settings is None or second.settings is None:
        return
    axes = first.axes | second.axes
    unknown = first.unknown.keys() | second.unknown.keys()
    for key in {**first.settings, **second.settings}:
        if key in unknown:
            continue
        values = [each.settings.get(key, _default(key)) for each in (first, second)]  # type: ignore[union-attr]
        if not _is_same(*values):
            yield Difference(key, _name(key, axes, (first.settings, second.settings)), *values)


def changes(first: Contents, second: Contents) -> Iterator[Change]:
    """The lines in which programs and PLCs differ that both have or lack."""
    for level in first.programs:
        if level in second.programs:
            yield from _changes(level, first.programs[level], second.programs[level])


def _changes(level: str, first: list[str], second: list[str]) -> Iterator[Change]:
    matcher = SequenceMatcher(
        a=[meaning(line) for line in first],
        b=[meaning(line) for line in second],
        autojunk=False,
    )
    for what, begin, end, other_begin, other_end in matcher.get_opcodes():
        if what != "equal":
            yield Change(level, begin + 1, first[begin:end], second[other_begin:other_end])


# --- values and names ---------------------------------------------------------------------


def _default(key: str) -> str | None:
    """What a key has that a backup leaves out: a variable is 0, an extension as by default."""
    if (number := _NUMBERED.fullmatch(key)) and number[1] == "P" and int(number[2]) < USERS:
        return "0"
    row = _command(key)
    return (row.default or "0") if row is not None and row.is_extension else None


def _is_same(first: str | None, second: str | None) -> bool:
    if first is None or second is None:
        return first == second
    return first == second or _numbers(first) == _numbers(second)


def _numbers(value: str) -> list[float | str]:
    """The numbers of a value, whatever their spelling; other values as they are."""
    try:
        return [float(part) for part in value.strip("()").split(",")]
    except ValueError:
        return [value]


def _command(key: str) -> Command | None:
    """The command that sets a key, without the level it is set at."""
    return command_of(re.sub(r"^(?:PROG|PLC)\d+ ", "", key))


def _name(key: str, axes: Mapping[str, str], settings: Iterable[Mapping[str, str]]) -> str:
    """What a key is, by the tables: name of the axis, purpose, unit."""
    if number := _NUMBERED.fullmatch(key):
        return _number_name(number[1], int(number[2]), settings)
    row = _command(key)
    axis = _AXIS.match(key)
    parts = [f"axis {axes[axis[1]]}"] if axis and axis[1] in axes else []
    if row is not None:
        parts.append(row.summary.rstrip(".") + (f" [{row.units}]" if row.units else ""))
    return ": ".join(parts)


def _number_name(kind: str, number: int, settings: Iterable[Mapping[str, str]]) -> str:
    """The name of a parameter or flag in the tables; of a variable, its aliases."""
    record = (parameters() if kind == "P" else flags()).get(number)
    if record is not None and not (kind == "P" and number < USERS):
        return f"{record.object}{'' if record.index is None else record.index} {record.name}"
    aliases = [
        found[1]
        for each in settings
        for key, value in each.items()
        if value == f"{kind}{number}" and (found := _ALIASED.fullmatch(key))
    ]
    return ", ".join(dict.fromkeys(aliases))
