"""What a card does as written, and hardly as meant: the traps that users ask about most."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from openacr.basic.commands.evaluation import Assigned
from openacr.basic.language.grammar.axes import AxisItem
from openacr.basic.language.grammar.flags import BitItem
from openacr.basic.language.loader import FileLine
from openacr.basic.language.nodes import Block, Flag, Move, Number, Statement
from openacr.basic.language.registry import Level
from openacr.lang.source import Span
from openacr.source_check.cutoffs import statements
from openacr.source_check.numbers import literal
from openacr.source_check.texts import Finding, TextLine

OUTPUTS = range(32, 64)
SHARED = range(8, 16)  # the programs that share one time slice
LONGEST_STOP_S = 60.0
WHOLE = frozenset(("DZL", "DZU", "FFVC"))  # commands whose values are whole pulses
WAITS = frozenset(("DWL", "INH"))
JOGS = frozenset(("VEL", "DEC"))  # of JOG
SWITCHES = frozenset(("SET", "CLR", "BIT"))
_REMARK = re.compile(r"\s*(?:\d+\s*)?(?:REM\b|')", re.IGNORECASE)

AT_ONCE = "an output right after a move is set when the move begins"
WAIT = "moves are buffered; INH -516 before it waits for their end (master m: 516 + 32m)"
ALL_WAIT = "programs 8 to 15 share a time slice: while it waits, so do the others"
OWN_SLICE = "programs 0 to 7 have a slice each"


def is_noted(words: frozenset[str], number: int) -> bool:
    """Whether a line with these words, of this program, may be one of which `Advice` takes note."""
    is_wait = number in SHARED and words & WAITS
    return bool(is_wait or words & WHOLE or ("JOG" in words and words & JOGS))


def after_moves(
    lines: Iterable[TextLine], read: Callable[[TextLine], tuple[Block, ...]]
) -> Iterator[Finding]:
    """Warn of outputs that are switched directly after a move, as if that had ended."""
    is_after_move = False
    for line in lines:
        known = line.outline
        if known.is_empty or (not known.words and _REMARK.match(line.place.text)):
            continue
        if known.words & SWITCHES and (is_after_move or known.moves):
            is_move = is_after_move
            for statement in _in_order(read(line)):
                if is_move and isinstance(statement, Statement) and _switches_output(statement):
                    span = Span(1, statement.column, len(statement.command.name))
                    yield Finding(line.place, None, span, AT_ONCE, WAIT)
                is_move = isinstance(statement, Move)
        is_after_move = known.ends_with_move


def _in_order(blocks: tuple[Block, ...]) -> list[object]:
    return [statement for block in blocks for statement in block]


def _switches_output(statement: Statement) -> bool:
    first = statement.arguments[0] if statement.arguments else None
    if statement.command.words in (("SET",), ("CLR",)) and isinstance(first, tuple):
        return any(isinstance(item, BitItem) and literal(item.number) in OUTPUTS for item in first)
    target = first.target if isinstance(first, Assigned) else None
    return isinstance(target, Flag) and literal(target.index) in OUTPUTS


@dataclass(slots=True)
class Advice:
    """What single statements add up to, over all files."""

    _waits: dict[int, tuple[FileLine, Span]] = field(default_factory=dict)  # first of programs
    _jogs: dict[tuple[str, object], tuple[float, FileLine, Span]] = field(default_factory=dict)

    def note(
        self,
        line: FileLine,
        level: Level,
        number: int,
        blocks: Iterable[Block],
        axes: Mapping[str, int | None],
    ) -> Iterator[Finding]:
        """Take note of a line of a program, or of one that is executed at once."""
        for statement in statements(blocks):
            words = statement.command.words
            span = Span(1, statement.column, len(statement.command.name))
            if words in (("DWL",), ("INH",)) and level is Level.PROG and number in SHARED:
                self._waits.setdefault(number, (line, span))
            elif words in (("JOG", "VEL"), ("JOG", "DEC")):
                for axis, value in _values(statement, axes):
                    self._jogs[words[1], axis] = value, line, span
            elif words[0] in WHOLE:
                for _, value in _values(statement, axes):
                    if value != int(value):
                        text = f"{words[0]} is in whole pulses: {value:g} is {int(value)}"
                        yield Finding(line, None, span, text)

    def findings(self, programs: Iterable[int]) -> Iterator[Finding]:
        """Warn of what has been noted; `programs` are those that have a text."""
        if len(set(programs) & set(SHARED)) > 1:
            for line, span in self._waits.values():
                yield Finding(line, None, span, ALL_WAIT, OWN_SLICE)
            self._waits.clear()
        for (word, axis), (velocity, _, _) in list(self._jogs.items()):
            slow = self._jogs.get(("DEC", axis))
            if word == "VEL" and slow and 0.0 < slow[0] < velocity / LONGEST_STOP_S:
                del self._jogs["DEC", axis]
                text = f"a stop from JOG VEL {velocity:g} takes {velocity / slow[0]:.0f} s"
                yield Finding(slow[1], None, slow[2], text, f"JOG DEC {velocity:g} takes 1 s")


def _values(statement: Statement, axes: Mapping[str, int | None]) -> Iterator[tuple[object, float]]:
    """The values of a command that are literals, by axis number or name."""
    items = statement.arguments[0] if statement.arguments else None
    for item in items if isinstance(items, tuple) else ():
        if isinstance(item, AxisItem) and isinstance(item.argument, Number):
            ref = item.axis
            axis = axes.get(ref.name, ref.name) if ref.number is None else literal(ref.number)
            yield axis, float(item.argument.value)
