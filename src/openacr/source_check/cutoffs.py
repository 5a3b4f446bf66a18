"""Low-pass filters whose cut-off is too near to the servo rate."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.basic.language.grammar.axes import AxisItem
from openacr.basic.language.loader import FileLine
from openacr.basic.language.nodes import Block, Number, Statement
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.motion.card import DEFAULT_PERIOD_S
from openacr.source_check.texts import Finding

HIGHEST_PART = 0.1
WARNING = "LOPASS above a tenth of the servo rate"


class _Cutoff(Struct, frozen=True):
    """A cut-off as written, and where."""

    line: FileLine
    span: Span
    frequency_hz: float


@dataclass(slots=True)
class Cutoffs:
    """The cut-offs of a file, judged by the servo period that is in effect in the end."""

    period_s: float = DEFAULT_PERIOD_S
    _found: list[_Cutoff] = field(default_factory=list)

    def note(self, line: FileLine, found: Iterable[Token], blocks: Iterable[Block]) -> None:
        """Take note of the LOPASS and PERIOD commands of a line, those after THEN included."""
        numbers = [token for token in found if token.kind is TokenKind.NUMBER]
        for statement in statements(blocks):
            words, arguments = statement.command.words, statement.arguments
            if words == ("LOPASS",) and arguments:
                after = [token for token in numbers if token.column > statement.column]
                self._found += _cutoffs(line, after, arguments[0])
            elif words == ("PERIOD",) and arguments and (period_s := _number(arguments[0])):
                self.period_s = period_s

    def findings(self) -> Iterator[Finding]:
        """Warn of those that are too high, and forget them all."""
        highest_hz = HIGHEST_PART / self.period_s
        hint = f"at most {highest_hz:g} Hz at PERIOD {self.period_s:g}"
        for each in self._found:
            if each.frequency_hz > highest_hz * (1.0 + 1e-9):
                yield Finding(each.line, None, each.span, WARNING, hint)
        self._found = []


def statements(blocks: Iterable[Block]) -> Iterator[Statement]:
    """The statements of a line, those after THEN included."""
    for block in blocks:
        for statement in block:
            if isinstance(statement, Statement):
                yield statement
                for argument in statement.arguments:
                    yield from statements(getattr(argument, "blocks", ()))


def _cutoffs(line: FileLine, numbers: list[Token], items: object) -> Iterator[_Cutoff]:
    """The cut-offs of one LOPASS that are written as literals."""
    for item in items if isinstance(items, tuple) else ():
        frequency_hz = _number(item.argument) if isinstance(item, AxisItem) else None
        # An axis number in front of the value may be equal to it only below the limit.
        token = next((token for token in numbers if token.value == frequency_hz), None)
        if frequency_hz is not None and token is not None:
            yield _Cutoff(line, token.span, frequency_hz)
            numbers = [each for each in numbers if each.column > token.column]


def _number(value: object) -> float | None:
    match value:
        case Number(number):
            return float(number)
    return None
