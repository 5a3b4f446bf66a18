"""Read the answers; errors are reported with their line."""

from collections.abc import Iterator
from typing import Any, TypeAlias

from openacr.configure.answers import Answers
from openacr.motion.axis.attach import RESERVED_NAMES
from openacr.plant.describe import toml_file
from openacr.plant.describe.locate import Path as Steps

Complaint: TypeAlias = tuple[Steps, str]


def parse_answers(text: str, path: str = "configure.toml") -> Answers:
    """Read the answers in a text; SourceError with all errors found."""
    raw = toml_file.parse(text, path)
    answers, found = checked(raw)
    toml_file.refuse(toml_file.wrong(text, path, *each) for each in found)
    if answers is None:
        raise toml_file.wrong(text, path, (), "it holds no answers")
    return answers


def checked(raw: dict[str, Any]) -> tuple[Answers | None, list[Complaint]]:
    """Answers made of plain tables, and all that is wrong with them: where, and what."""
    answers, messages = toml_file.convert_all(raw, Answers)
    found = [(steps, "numbers have to be finite") for steps in toml_file.not_finite(raw)]
    found += map(_complaint, messages)
    if answers is not None and not found:
        found += _contradictions(answers)
    return answers, found


def _complaint(message: str) -> Complaint:
    what, steps = toml_file.complaint_of(message)
    if unknown := toml_file.UNKNOWN.fullmatch(what):
        return (*steps, unknown[1]), f"unknown key {unknown[1]!r}"
    if missing := toml_file.MISSING.fullmatch(what):
        return steps, f"{missing[1]!r} is missing"
    what = what[:1].lower() + what[1:].replace(" | null", "")
    name = next((step for step in reversed(steps) if isinstance(step, str)), "")
    return steps, f"{name}: {what}" if name else what


def _contradictions(answers: Answers) -> Iterator[Complaint]:
    """Report answers that contradict each other or exceed the card."""
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


def _wrong_masters(answers: Answers, names: set[str]) -> Iterator[Complaint]:
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
