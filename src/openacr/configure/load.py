"""Read the answers; what is wrong is said with its line."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path

import msgspec

from openacr.configure.answers import Answers
from openacr.errors import SourceError
from openacr.motion.attach import RESERVED_NAMES
from openacr.plant.locate import nearest, places
from openacr.project import read_bytes

_WHERE = re.compile(r"(.*?)(?: - at `\$(.*)`)?", re.DOTALL)
_UNKNOWN = re.compile(r"Object contains unknown field `(.*)`")
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+)\]")
_TOML_PLACE = re.compile(r"(.*?)(?: \(at line (\d+), column (\d+)\)| \(at end of document\))?")
_Where = tuple[str | int, ...]


def load_answers(path: Path) -> Answers:
    """Read the answers in the file at `path`."""
    data = read_bytes(path)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SourceError("the file is not UTF-8 text", path=str(path), line=line) from None
    return parse_answers(text, str(path))


def parse_answers(text: str, path: str = "configure.toml") -> Answers:
    """Read the answers in a text; SourceError for the first thing that is wrong."""
    try:
        answers = msgspec.convert(tomllib.loads(text), Answers)
    except tomllib.TOMLDecodeError as error:
        raise _syntax(str(error), text, path) from None
    except msgspec.ValidationError as error:
        found = _WHERE.fullmatch(str(error))
        what, where = (found[1], found[2] or "") if found else (str(error), "")
        steps = [key or int(index) for key, index in _STEP.findall(where)]
        if unknown := _UNKNOWN.fullmatch(what):
            raise _at(text, path, [*steps, unknown[1]], f"unknown key {unknown[1]!r}") from None
        what = what[:1].lower() + what[1:].replace(" | null", "")
        name = next((str(step) for step in reversed(steps) if isinstance(step, str)), "")
        raise _at(text, path, steps, f"{name}: {what}" if name else what) from None
    for place, what in _contradictions(answers):
        raise _at(text, path, place, what)
    return answers


def _at(text: str, path: str, steps: Sequence[str | int], what: str) -> SourceError:
    line, column = nearest(places(text), tuple(steps))
    return SourceError(what, path=path, line=line, column=column)


def _syntax(message: str, text: str, path: str) -> SourceError:
    found = _TOML_PLACE.fullmatch(message)
    if found and found[2]:
        return SourceError(found[1], path=path, line=int(found[2]), column=int(found[3]))
    return SourceError(found[1] if found else message, path=path, line=text.count("\n") + 1)


def _contradictions(answers: Answers) -> Iterator[tuple[_Where, str]]:
    """What does not fit together, or not on the card."""
    card = answers.card.hardware
    numbers: set[int] = set()
    names: set[str] = set()
    for index, axis in enumerate(answers.axis):
        if axis.number in numbers or axis.number >= card.axes:
            what = "is there twice" if axis.number in numbers else f"is not on an {card.name}"
            yield ("axis", index, "number"), f"axis {axis.number} {what}"
        if axis.name.upper() in names or axis.name.upper() in RESERVED_NAMES:
            what = "is no axis" if axis.name.upper() in RESERVED_NAMES else "is there twice"
            yield ("axis", index, "name"), f"the name {axis.name} {what}"
        if axis.limits.soft is not None and axis.limits.soft[0] <= axis.limits.soft[1]:
            yield ("axis", index, "limits", "soft"), "the positive limit is not above the negative"
        numbers.add(axis.number)
        names.add(axis.name.upper())
    yield from _wrong_masters(answers, names)


def _wrong_masters(answers: Answers, names: set[str]) -> Iterator[tuple[_Where, str]]:
    taken: set[str] = set()
    programs: set[int] = set()
    for index, master in enumerate(answers.master):
        program = answers.program_of(master.number)
        if program in programs or master.number >= answers.card.hardware.masters:
            yield ("master", index, "number"), f"master {master.number} cannot be had (again)"
        programs.add(program)
        for name in map(str.upper, master.axes):
            if name not in names or name in taken:
                what = "has two masters" if name in taken else "is no axis of this file"
                yield ("master", index, "axes"), f"{name} {what}"
            taken.add(name)
