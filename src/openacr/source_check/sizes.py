"""What files dimension, and the variables they use beyond it."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from openacr.basic.commands.memory_control import Dimension
from openacr.basic.language.cursor import StatementError
from openacr.basic.language.nodes import (
    Block,
    Element,
    Expr,
    Local,
    LocalKind,
    Number,
    Parameter,
    Statement,
    StringElement,
    StringLocal,
    resolved,
)
from openacr.basic.vm.outline import STORED_KINDS
from openacr.lang.lexer import Token, TokenKind
from openacr.map.numbers import USER_COUNT
from openacr.messages import UNDEFINED_VARIABLE
from openacr.source_check.texts import Finding, Text, TextLine

GLOBAL = "P"
UNKNOWN_COUNT = 1 << 31  # a size that is computed
_VARIABLE = re.compile(r"(?<![A-Za-z$])([LSD][VA]|\$[VA]|P)[ \t]*(\d{1,9})", re.IGNORECASE)
_SCALARS = {LocalKind.LONG: "LV", LocalKind.SINGLE: "SV", LocalKind.DOUBLE: "DV"}
_ARRAYS = {LocalKind.LONG: "LA", LocalKind.SINGLE: "SA", LocalKind.DOUBLE: "DA"}


@dataclass(slots=True)
class Sizes:
    """How many variables of each kind there are: P for all programs, others for each."""

    counts: dict[tuple[int, str], int] = field(default_factory=dict)
    is_complete: bool = False  # the files read are all there is

    @property
    def are_known(self) -> bool:
        """Whether a variable that was not seen to be dimensioned does not exist."""
        return self.is_complete or bool(self.counts)

    def count(self, program: int, kind: str) -> int:
        """How many there are."""
        return self.counts.get((0 if kind == GLOBAL else program, kind), 0)

    def note(self, program: int, blocks: Iterable[Block]) -> None:
        """Take note of the DIM commands of a line, those after THEN included."""
        for block in blocks:
            for statement in block:
                if isinstance(statement, Statement):
                    for argument in statement.arguments:
                        self.note(program, getattr(argument, "blocks", ()))
                        if isinstance(argument, Dimension):
                            self._dimension(program, argument)

    def _dimension(self, program: int, what: Dimension) -> None:
        if what.word not in STORED_KINDS or what.index is not None:
            return
        size = resolved(what.sizes[0])
        known = isinstance(size, Number)
        count = int(size.value) if isinstance(size, Number) and known else UNKNOWN_COUNT
        key = (0 if what.word == GLOBAL else program, what.word)
        self.counts[key] = max(count, self.counts.get(key, 0))


def undimensioned(
    text: Text, program: int, sizes: Sizes, aliases: Mapping[str, Expr]
) -> Iterator[Finding]:
    """The first use of each variable of a program that does not exist."""
    if not sizes.are_known:
        return
    users = [line for line in text.in_order() if line.outline.stored_kinds]
    used = frozenset[str]().union(*(line.outline.stored_kinds for line in users))
    names = {name: named for name, node in aliases.items() if (named := variable(node))}
    highest = _highest(users, names)
    missing = {kind for kind in used if _is_missing(kind, highest, sizes.count(program, kind))}
    seen: set[tuple[str, int]] = set()
    for line in users if missing else ():
        if line.outline.stored_kinds & missing and not line.outline.dimensions:
            for token, kind, number in _variables(line.tokens, names):
                count = sizes.count(program, kind)
                if number >= count and (kind, number) not in seen:
                    seen.add((kind, number))
                    yield _finding(line, token, kind, number, count)


def variable(node: Expr) -> tuple[str, int] | None:
    """The kind and number of a variable that needs a DIM; None for anything else."""
    match resolved(node):
        case Parameter(Number(number)) if number < USER_COUNT:
            return GLOBAL, int(number)
        case Local(kind, Number(number)):
            return _SCALARS[kind], int(number)
        case Element(kind, Number(number), _):
            return _ARRAYS[kind], int(number)
        case StringLocal(Number(number)):
            return "$V", int(number)
        case StringElement(Number(number), _):
            return "$A", int(number)
    return None


def _highest(users: list[TextLine], names: Mapping[str, tuple[str, int]]) -> dict[str, int]:
    """No variable of a kind has a higher number; strings and remarks may make it too high."""
    highest: dict[str, int] = {}
    found = set(_VARIABLE.findall("\n".join(line.place.text for line in users)))
    for kind, digits in (*found, *names.values()):
        word, number = kind.upper(), int(digits)
        if word != GLOBAL or number < USER_COUNT:
            highest[word] = max(number, highest.get(word, 0))
    return highest


def _is_missing(kind: str, highest: Mapping[str, int], count: int) -> bool:
    return highest.get(kind, -1) >= count or (kind != GLOBAL and not count)


def _variables(
    found: tuple[Token, ...], names: Mapping[str, tuple[str, int]]
) -> Iterator[tuple[Token, str, int]]:
    """Variables written with a literal number, or by an alias."""
    for token, following in pairwise(found):
        if token.kind is not TokenKind.WORD:
            continue
        if token.text in names:
            yield token, *names[token.text]
        elif token.value in STORED_KINDS:
            number = following.value if following.kind is TokenKind.NUMBER else 0
            is_system = token.value == GLOBAL and following.kind is not TokenKind.NUMBER
            if isinstance(number, int) and not is_system and not _is_parameter(token, number):
                yield token, str(token.value), number


def _is_parameter(token: Token, number: int) -> bool:
    return token.value == GLOBAL and number >= USER_COUNT


def _finding(line: TextLine, token: Token, kind: str, number: int, count: int) -> Finding:
    hint = f"DIM {kind} makes {kind}0 to {kind}{count - 1}" if count else f"no DIM {kind} was read"
    error = StatementError(UNDEFINED_VARIABLE, token.span)
    return Finding(line.place, error, hint=hint)
