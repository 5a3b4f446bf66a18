"""Where the programs of a card read and write parameters, flags, aliases and labels."""

import re
from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum

from msgspec import Struct

from openacr.editing.controller.marks import marks_of
from openacr.editing.marks import Kind, Mark
from openacr.plc.instructions import Instruction

WRITES = frozenset(("SET", "CLR", "INPUT", "FOR"))  # commands that change what they name
NO_NAMES: frozenset[str] = frozenset()
VALUES = (Kind.PARAMETER, Kind.FLAG, Kind.ALIAS, Kind.VARIABLE)
_DIM = re.compile(r"\bDIM\s*$", re.IGNORECASE)
_ASSIGNED = re.compile(r"\s*(\((?:[^()]|\([^()]*\))*\)\s*)?=")  # an element: one index, (LV0+1)


class Access(StrEnum):
    """What a line does with a name."""

    READS = "reads"
    WRITES = "writes"
    DEFINES = "defines"


class Use(Struct, frozen=True):
    """A place at which a line of a program names something.

    `name` is P10, BIT516, an alias, or what belongs to a program: a label, `PROG3 more`, a variable
    or array, `PROG3 LV0`; `column` from 0.
    """

    name: str
    program: str
    line: int
    column: int
    text: str
    access: Access


def uses(
    programs: Mapping[str, Iterable[tuple[int, str]]], aliases: Mapping[str, str]
) -> Iterator[Use]:
    """Every use in programs and PLCs (PROG3, PLC0: numbers and texts of lines).

    What has an alias is used where the alias is, too: `aliases` has what each is defined to be.
    A count of DIM defines those of its variables that the program names.
    """
    targets = {alias: mark for alias, text in aliases.items() for mark in _meant(text)}
    for program, lines in programs.items():
        counts: list[tuple[Mark, int, str]] = []
        named: set[str] = set()
        is_plc = program.startswith("PLC")
        for number, text in lines:
            marks = marks_of(text, frozenset(aliases), NO_NAMES, is_plc=is_plc)
            counts += [(mark, number, text.strip()) for mark in marks if _is_count(text, mark)]
            for name, mark, access in _named(program, text, marks):
                named.add(name)
                yield Use(name, program, number, mark.start, text.strip(), access)
                if target := targets.get(name):
                    meant = _name(program, target)
                    named.add(meant)
                    yield Use(meant, program, number, mark.start, text.strip(), access)
        for count, number, text in counts:
            kind = count.name.rstrip("0123456789")
            for name in sorted({f"{program} {kind}{n}" for n in range(count.number)} & named):
                yield Use(name, program, number, count.start, text, Access.DEFINES)


def _named(program: str, text: str, marks: tuple[Mark, ...]) -> Iterator[tuple[str, Mark, Access]]:
    command: Mark | None = None
    for mark in sorted(marks, key=lambda each: each.start):
        if mark.kind is Kind.COMMAND:
            command = mark
        if mark.kind is Kind.LABEL:
            access = Access.DEFINES if mark.is_definition else Access.READS
            if not mark.name.isdigit():  # lines have numbers of their own
                yield f"{program} {mark.name}", mark, access
        elif mark.kind in VALUES and not _is_count(text, mark):
            is_array = command is not None and command.name.startswith("DIM")
            access = Access.DEFINES if is_array else _access(text, mark, command)
            if mark.kind is not Kind.VARIABLE or mark.number >= 0:
                yield _name(program, mark), mark, access


def _name(program: str, mark: Mark) -> str:
    """Variables belong to a program, those of the user (P10) to all of them."""
    is_own = mark.kind is Kind.VARIABLE and not mark.name.startswith("P")
    return f"{program} {mark.name}" if is_own else mark.name


def _is_count(text: str, mark: Mark) -> bool:
    """Whether it is how many variables DIM makes: `DIM LV(2)`."""
    is_call = mark.kind is Kind.VARIABLE and text[: mark.end].endswith(")")
    return is_call and _DIM.search(text, 0, mark.start) is not None


def _access(text: str, mark: Mark, command: Mark | None) -> Access:
    """Writes are assignments, outputs of PLCs and the operands of some commands."""
    if mark.is_definition:
        return Access.DEFINES
    before = text[: mark.start]
    is_alone = before.count("(") == before.count(")")
    if is_alone and _ASSIGNED.match(text, mark.end):
        return Access.WRITES
    if command is None or ":" in text[command.end : mark.start]:
        return Access.READS
    row = command.row
    is_output = row.is_output if isinstance(row, Instruction) else command.name in WRITES
    is_first = is_alone and "=" not in text[command.end : mark.start]
    return Access.WRITES if is_output and is_first else Access.READS


def _meant(text: str) -> Iterator[Mark]:
    for mark in marks_of(text, NO_NAMES, NO_NAMES, is_plc=False):
        if mark.kind in (Kind.PARAMETER, Kind.FLAG, Kind.VARIABLE):
            yield mark
            return
