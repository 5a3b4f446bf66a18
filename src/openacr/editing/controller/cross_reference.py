"""Where the programs of a card read and write parameters, flags, aliases and labels."""

from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum

from msgspec import Struct

from openacr.editing.controller.marks import marks_of
from openacr.editing.marks import Kind, Mark
from openacr.plc.instructions import Instruction

WRITES = frozenset(("SET", "CLR", "INPUT", "FOR"))  # commands that change what they name
NO_NAMES: frozenset[str] = frozenset()


class Access(StrEnum):
    """What a line does with a name."""

    READS = "reads"
    WRITES = "writes"
    DEFINES = "defines"


class Use(Struct, frozen=True):
    """A place at which a line of a program names something.

    `name` is P10, BIT516, an alias, or a label with its program, `PROG3 more`; `column` from 0.
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
    """
    targets = {alias: name for alias, text in aliases.items() for name in _meant(text)}
    for program, lines in programs.items():
        is_plc = program.startswith("PLC")
        for number, text in lines:
            marks = marks_of(text, frozenset(aliases), NO_NAMES, is_plc=is_plc)
            for name, mark, access in _named(program, text, marks):
                yield Use(name, program, number, mark.start, text.strip(), access)
                if name in targets:
                    yield Use(targets[name], program, number, mark.start, text.strip(), access)


def _named(program: str, text: str, marks: tuple[Mark, ...]) -> Iterator[tuple[str, Mark, Access]]:
    command: Mark | None = None
    for mark in sorted(marks, key=lambda each: each.start):
        if mark.kind is Kind.COMMAND:
            command = mark
        is_user = mark.kind is Kind.VARIABLE and mark.name.startswith("P")
        if mark.kind is Kind.LABEL:
            access = Access.DEFINES if mark.is_definition else Access.READS
            if not mark.name.isdigit():  # lines have numbers of their own
                yield f"{program} {mark.name}", mark, access
        elif is_user or mark.kind in (Kind.PARAMETER, Kind.FLAG, Kind.ALIAS):
            yield mark.name, mark, _access(text, mark, command)


def _access(text: str, mark: Mark, command: Mark | None) -> Access:
    """Writes are assignments, outputs of PLCs and the operands of some commands."""
    if mark.is_definition:
        return Access.DEFINES
    before = text[: mark.start]
    is_alone = before.count("(") == before.count(")")
    if is_alone and text[mark.end :].lstrip().startswith("="):
        return Access.WRITES
    if command is None or ":" in text[command.end : mark.start]:
        return Access.READS
    row = command.row
    is_output = row.is_output if isinstance(row, Instruction) else command.name in WRITES
    is_first = is_alone and "=" not in text[command.end : mark.start]
    return Access.WRITES if is_output and is_first else Access.READS


def _meant(text: str) -> Iterator[str]:
    for mark in marks_of(text, NO_NAMES, NO_NAMES, is_plc=False):
        if mark.kind in (Kind.PARAMETER, Kind.FLAG, Kind.VARIABLE):
            yield mark.name
            return
