"""The commands and functions of the language: one decorated function each.

A row holds everything about a command: its words, how its arguments are read, at which
levels it may be used, its place in the manual and the function that executes it. Parser,
level checks, LIST, HELP and the reference pages are derived from these rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Flag, auto
from functools import lru_cache
from typing import Any, TypeVar

from msgspec import Struct

from openacr.basic.language.form import Form
from openacr.models import Feature

EXTENSION = "extension"  # in place of the manual: no card of the family has it
SWITCHES = frozenset(("ON", "OFF"))
INDEX = "#"  # stands in the words of a command for the number of an object: `ENC # RES`


class Level(Flag):
    """Where a command may be used."""

    SYS = auto()
    PROG = auto()
    PLC = auto()
    SYS_BY_OBJECT = auto()  # at SYS if the statement names AXISn, MASTERm, PROGn, PLCn or ALL


SYS = Level.SYS
PROG = Level.PROG
PLC = Level.PLC
ANY = SYS | PROG | PLC
BY_OBJECT = PROG | Level.SYS_BY_OBJECT  # axis and master commands
BY_TARGET = PROG | PLC | Level.SYS_BY_OBJECT  # RUN, HALT, NEW, ...


class Use(Flag):
    """Whether a command may be typed, stored, or both."""

    IMMEDIATE = auto()
    PROGRAM = auto()
    BOTH = IMMEDIATE | PROGRAM


IMMEDIATE = Use.IMMEDIATE
PROGRAM = Use.PROGRAM
BOTH = Use.BOTH


class Command(Struct, frozen=True, eq=False):
    """One command of the language."""

    words: tuple[str, ...]
    group: str
    levels: Level
    use: Use
    grammar: tuple[Form, ...]
    handler: Callable[..., Any]
    ref: str = ""
    units: str = ""
    default: str = ""
    move: bool = False  # its handler returns targets that belong to the move of the block
    emit: Callable[..., None] | None = None  # writes byte code instead of calling the handler
    saved: bool = False  # kept by ESAVE
    synonyms: tuple[tuple[str, ...], ...] = ()
    lacks: str = ""  # what no modelled card has, so that the command cannot do its work
    needs: Feature = Feature.NONE  # what some models lack: they refuse the command

    @property
    def name(self) -> str:
        """The words as they are written, e.g. `JOG VEL` or `ENC # RES`."""
        return " ".join(self.words)

    @property
    def summary(self) -> str:
        """What the command does, in one sentence."""
        return (self.handler.__doc__ or "").strip().split("\n")[0]

    @property
    def is_extension(self) -> bool:
        """Whether only openacr has it: a real card refuses it."""
        return self.ref == EXTENSION

    @property
    def is_switch(self) -> bool:
        """Whether it turns something on or off and is complete without arguments."""
        return self.words[-1] in SWITCHES

    @property
    def forms(self) -> tuple[Form, ...]:
        """The forms whose values the handler gets."""
        return tuple(form for form in self.grammar if not form.silent)

    def __repr__(self) -> str:
        return f"<{self.name}>"

    def __reduce__(self) -> tuple[Callable[[str], Command], tuple[str]]:
        """Pickle by name: a row is code, not data."""
        return find, (self.name,)


class Function(Struct, frozen=True, eq=False):
    """One function of expressions; `code` is its number in the VM, else `apply` computes it.

    `takes` has one letter per argument: n number, s string, e either; `p` alone is a number
    that is handed over as the text PRINT shows. With `wants_run`
    the first argument of `apply` is the Run, and it may return a Wait.
    """

    name: str
    takes: str
    fewest: int
    code: int | None
    apply: Callable[..., Any] | None
    summary: str
    wants_run: bool = False
    optional_first: bool = False  # the argument that may be left out is the first one

    @property
    def gives_text(self) -> bool:
        """Whether the result is a string: the name says so."""
        return self.name.endswith("$")

    def accepts(self, texts: list[bool]) -> bool:
        """Whether arguments of these types (True: a string) fit; the last letters count."""
        letters = self.takes[-len(texts) :] if self.optional_first else self.takes
        return all(
            letter == "e" or (letter == "s") == text
            for letter, text in zip(letters, texts, strict=False)
        )

    def __reduce__(self) -> tuple[Callable[[str], Function], tuple[str]]:
        """Pickle by name."""
        return find_function, (self.name,)


@dataclass(slots=True)
class Node:
    """A step of the word tree: what may follow, and the command that may end here."""

    children: dict[str, Node] = field(default_factory=dict)
    command: Command | None = None


root = Node()
functions: dict[str, Function] = {}
_commands: dict[str, Command] = {}

_Handler = TypeVar("_Handler", bound=Callable[..., Any])


def command(
    words: str,
    *also: str,
    group: str,
    levels: Level,
    use: Use = BOTH,
    grammar: tuple[Form, ...] = (),
    ref: str = "",
    units: str = "",
    default: str = "",
    move: bool = False,
    emit: Callable[..., None] | None = None,
    saved: bool = False,
    typed: bool = True,
    lacks: str = "",
    needs: Feature = Feature.NONE,
) -> Callable[[_Handler], _Handler]:
    """Enter the decorated function as the command `words` (and under the names in `also`).

    A row with `typed=False` has a name only here: the parser knows it by its form.
    """

    def enter(handler: _Handler) -> _Handler:
        row = Command(
            tuple(words.split()), group, levels, use, grammar, handler, ref, units, default,
            move, emit, saved, tuple(tuple(name.split()) for name in also), lacks, needs,
        )  # fmt: skip
        if row.name in _commands:
            raise ValueError(f"{row.name} is registered twice")
        _commands[row.name] = row
        for path in (row.words, *row.synonyms) if typed else ():
            _place(path, row)
        return handler

    return enter


def _place(path: tuple[str, ...], row: Command) -> None:
    node = root
    for word in path:
        node = node.children.setdefault(word, Node())
    if node.command is not None:
        raise ValueError(f"{' '.join(path)} is registered twice")
    node.command = row


def function(
    name: str,
    takes: str = "n",
    *,
    fewest: int | None = None,
    code: int | None = None,
    apply: Callable[..., Any] | None = None,
    summary: str,
    wants_run: bool = False,
    optional_first: bool = False,
) -> None:
    """Enter a function of expressions."""
    if name in functions:
        raise ValueError(f"{name} is registered twice")
    least = len(takes) if fewest is None else fewest
    functions[name] = Function(name, takes, least, code, apply, summary, wants_run, optional_first)


_issuers: list[Callable[..., Any]] = []


def issues_moves(handler: _Handler) -> _Handler:
    """Enter the function `(run, targets) -> Wait | None` that starts the move of a block."""
    if _issuers:
        raise ValueError("moves are issued by one function only")
    _issuers.append(handler)
    return handler


def move_issuer() -> Callable[..., Any]:
    """The function that starts the move of a block."""
    return _issuers[0]


def find(name: str) -> Command:
    """The command with exactly these words, e.g. `find("JOG VEL")`."""
    return _commands[name]


def known(name: str) -> Command | None:
    """The command with exactly these words, if there is one."""
    return _commands.get(name)


def find_function(name: str) -> Function:
    """The function of this name."""
    return functions[name]


def commands() -> Iterator[Command]:
    """All commands in the order of their names."""
    for name in sorted(_commands):
        yield _commands[name]


def count() -> int:
    """How many commands there are."""
    return len(_commands)


def keywords() -> frozenset[str]:
    """Words that no alias and no axis may be named."""
    return _keywords(len(root.children), len(functions))


@lru_cache(maxsize=1)
def _keywords(command_words: int, function_words: int) -> frozenset[str]:
    """The keywords, cached until the number of commands or functions changes."""
    first = {word for word in root.children if word.isalpha()}
    return frozenset(first | set(functions) | VARIABLES | OPERATORS | CLAUSES)


VARIABLES = frozenset(("P", "BIT", "LV", "SV", "DV", "LA", "SA", "DA", "$V", "$A"))
OPERATORS = frozenset(("MOD", "NOT", "AND", "NAND", "OR", "NOR", "XOR", "XNOR"))
CLAUSES = frozenset(("THEN", "TO", "STEP", "USING", "AS", "REM"))
