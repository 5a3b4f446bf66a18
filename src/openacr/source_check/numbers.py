"""Parameters, flags, axes and other objects of a file that no card, or not this one, has."""

import re
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from itertools import pairwise

from msgspec import Struct

from openacr.basic.language.cursor import StatementError
from openacr.basic.language.grammar.flags import BitItem
from openacr.basic.language.loader import FileLine
from openacr.basic.language.nodes import (
    Alias,
    AxisRef,
    Block,
    Expr,
    Flag,
    Number,
    Parameter,
    Prefix,
    Statement,
    parts,
    resolved,
)
from openacr.basic.language.registry import Command, Function
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.map.memory import kind_table
from openacr.map.numbers import FLAG_LAST, KIND_NONE, USER_COUNT
from openacr.messages import (
    INVALID_ARGUMENT,
    INVALID_BIT,
    INVALID_PARAMETER,
    INVALID_SOURCE,
    Message,
)
from openacr.models import Model
from openacr.source_check.cutoffs import statements
from openacr.source_check.texts import Finding

_OBJECTS = {  # word: count of a model, and what they are called
    "AXIS": ("axes", "axes"),
    "MASTER": ("masters", "masters"),
    "ENC": ("encoders", "encoders"),
    "DAC": ("dacs", "analog outputs"),
    "ADC": ("adcs", "analog inputs"),
    "STEPPER": ("axes", "steppers"),
    "CMT": ("commutators", "commutators"),
}
_WORDS = "|".join(_OBJECTS)
_NAMES = re.compile(
    rf"(?<![A-Za-z$])(?:P|BIT|SET|CLR|INH|TRG|INT|{_WORDS})[ \t(+-]*\d", re.IGNORECASE
)
_OBJECT = re.compile(rf"(?<![A-Za-z$])({_WORDS})[ \t(]*(\d+)", re.IGNORECASE)
_INTEGER = re.compile(r"\d{4,}")  # all numbers below USER_COUNT are of parameters and flags
_LONGEST = 18  # digits; more make no number of anything


def is_doubtful(text: str, shape: str, model: Model) -> bool:
    """Whether a line may name what there is not; cheap, for all lines of a long program."""
    has_numbers, has_objects = _names(shape or text)
    if not has_numbers:
        return False
    if any(len(digits) > _LONGEST or _is_unused(int(digits)) for digits in _INTEGER.findall(text)):
        return True
    return has_objects and any(
        int(number) >= _count(model, word) for word, number in _OBJECT.findall(text)
    )


@lru_cache(maxsize=4096)
def _names(shape: str) -> tuple[bool, bool]:
    """Whether lines of a shape have numbers of parameters, flags or objects, and of objects."""
    return _NAMES.search(shape) is not None, _OBJECT.search(shape) is not None


def literal(number: Expr) -> int | None:
    """The whole number that is written, or that an alias stands for; None if it is computed."""
    value = resolved(number)
    return int(value.value) if isinstance(value, Number) else None


def missing(
    line: FileLine, found: Iterable[Token], blocks: tuple[Block, ...], model: Model
) -> Iterator[Finding]:
    """An error for each literal number of a parameter, flag or object that does not exist."""
    tokens = list(found)
    for statement in statements(blocks):
        for number, message, hint in dict.fromkeys(_wrong(statement, model)):
            span = _place(tokens, statement, number)
            yield Finding(line, StatementError(message, span), hint=hint)


def _wrong(statement: Statement, model: Model) -> Iterator[tuple[int, Message, str]]:
    named = tuple(_objects(statement))
    for node in _nodes((*named, statement.arguments, statement.prefix)):
        match node:
            case Parameter(Number(value)) if not _is_parameter(int(value)):
                yield int(value), INVALID_PARAMETER, f"there is no parameter P{int(value)}"
            case Flag(Number(value)) | BitItem(Number(value)) if not abs(value) <= FLAG_LAST:
                yield abs(int(value)), INVALID_BIT, f"flags are 0 to {FLAG_LAST}"
            case (
                AxisRef(word, Number(value)) | Prefix(word, Number(value)) | (word, Number(value))
            ) if word in _OBJECTS and value >= _count(model, word):
                is_source = statement.command.name.endswith("SRC") and isinstance(node, tuple)
                message = INVALID_SOURCE if is_source and node not in named else INVALID_ARGUMENT
                yield int(value), message, _what_there_is(model, word)


def _objects(statement: Statement) -> Iterator[tuple[str, Expr]]:
    """The objects that a command names itself: CMT 0 of CMT # MODE."""
    words = statement.command.name.split()
    named = (word for word, number in pairwise(words) if number == "#")
    return zip(named, statement.indices, strict=False)


def _count(model: Model, word: str) -> int:
    count: int = getattr(model, _OBJECTS[word.upper()][0])
    return count


def _what_there_is(model: Model, word: str) -> str:
    called, last = _OBJECTS[word][1], _count(model, word) - 1
    return f"the card has {called} 0 to {last}" if last >= 0 else f"the card has no {called}"


def _nodes(item: object) -> Iterator[object]:
    """A tree and all that is written in it; an alias was judged where it is defined."""
    if isinstance(item, tuple | Struct) and not isinstance(
        item, Command | Function | Alias | Statement
    ):
        yield item
        for part in parts(item):
            yield from _nodes(part)


def _place(found: list[Token], statement: Statement, number: int) -> Span:
    """Where the number is written in its statement or, as a prefix, before it."""
    places = [token for token in found if token.kind is TokenKind.NUMBER and token.value == number]
    after = [token for token in places if token.column > statement.column]
    token = next(iter(after or places[-1:]), None)
    if token is None:
        return Span(1, statement.column, len(statement.command.name))
    return Span(1, token.column, len(token.text))


def _is_unused(number: int) -> bool:
    """Whether this is the number of no parameter or of no flag."""
    return number > FLAG_LAST or not _is_parameter(number)


def _is_parameter(number: int) -> bool:
    kinds = _kinds()
    return number < USER_COUNT or (number < len(kinds) and kinds[number] != KIND_NONE)


@cache
def _kinds() -> bytes:
    return kind_table()
