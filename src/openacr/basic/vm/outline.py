"""What the check of a whole program needs to know about one line.

Lines of one shape have the same outline, so a file of many lines needs few of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from msgspec import Struct

from openacr.basic.language.flow_forms import Conditional
from openacr.basic.language.nodes import Block, LineTree, Move, Statement
from openacr.basic.vm import flow_cy as flow
from openacr.basic.vm.compiler import Emitter
from openacr.basic.vm.levels import STRUCTURE, CompileError, Level, Levels
from openacr.lang.lexer import Token, TokenKind

KINDS = {
    "IF": flow.FLOW_IF, "ENDIF": flow.FLOW_IF,
    "FOR": flow.FLOW_FOR, "NEXT": flow.FLOW_FOR,
    "WHILE": flow.FLOW_WHILE, "WEND": flow.FLOW_WHILE,
}  # fmt: skip
_OPENING = frozenset(("IF", "FOR", "WHILE"))
_CLOSING = frozenset(("ENDIF", "NEXT", "WEND"))
_BRANCHES = frozenset(("ELSEIF", "ELSE"))
_FLOW = _OPENING | _CLOSING | _BRANCHES | {"BREAK"}
_JUMPS = frozenset(("GOTO", "GOSUB"))
_JUDGED = frozenset(("LOPASS", "PERIOD", "TOL", "EPLC"))
STORED_KINDS = frozenset(("P", "LV", "SV", "DV", "LA", "SA", "DA", "$V", "$A"))


class FlowEvent(Struct, frozen=True):
    """A word that opens, divides, leaves or closes a level, and which token it is."""

    word: str
    token: int


@dataclass(slots=True, eq=False)
class OpenLevel(Level):
    """A level that knows which token of its line has opened it."""

    token: int = 0


class Outline(Struct, frozen=True):
    """The outline of a line; `fault` is what the compiler says about its expressions."""

    events: tuple[FlowEvent, ...] = ()
    is_empty: bool = False
    has_label: bool = False
    jumps: bool = False
    dimensions: bool = False  # holds a DIM
    is_judged: bool = False  # holds a LOPASS, a PERIOD, LOOK TOL or EPLC
    stored_kinds: frozenset[str] = frozenset()  # of the variables used
    fault: CompileError | None = None
    words: frozenset[str] = frozenset()  # all words of the line
    moves: bool = False  # holds a move
    ends_with_move: bool = False

    @property
    def has_structure(self) -> bool:
        """Whether the line matters beyond itself."""
        return bool(self.events) or self.has_label or self.jumps


def outline(found: list[Token], line: LineTree, aliases: Mapping[str, str]) -> Outline:
    """The outline of a line that was read; `aliases` says of which kind named variables are."""
    words = frozenset(str(each.value) for each in found if each.kind is TokenKind.WORD)
    statements = [statement for block in line.blocks for statement in block]
    named = {aliases[token.text] for token in found if token.text in aliases}
    return Outline(
        tuple(_events(line.blocks, {token.column: place for place, token in enumerate(found)})),
        line.is_empty,
        line.label is not None,
        bool(words & _JUMPS),
        "DIM" in words,
        bool(words & _JUDGED),
        (words & STORED_KINDS) | named,
        _fault(line),
        words,
        any(isinstance(each, Move) for each in statements),
        bool(statements) and isinstance(statements[-1], Move),
    )


def follow(levels: Levels[OpenLevel], event: FlowEvent, line: int) -> None:
    """What a word does to the levels; CompileError if it fits nowhere."""
    if event.word in _OPENING:
        levels.enter(OpenLevel(KINDS[event.word], line, token=event.token))
    elif event.word in _CLOSING:
        levels.leave(KINDS[event.word], line)
    elif event.word in _BRANCHES:
        levels.branch(line, is_last=event.word == "ELSE")
    else:
        levels.loop(line)


def _events(blocks: tuple[Block, ...], places: dict[int, int]) -> Iterator[FlowEvent]:
    for block in blocks:
        for statement in block:
            if isinstance(statement, Statement) and statement.command.name in _FLOW:
                then = statement.arguments[-1] if statement.arguments else None
                if isinstance(then, Conditional):
                    yield from _events(then.blocks, places)
                else:
                    yield FlowEvent(statement.command.name, places[statement.column])


def _fault(line: LineTree) -> CompileError | None:
    """What is wrong with the line whatever stands around it."""
    for block in line.blocks:
        for statement in block:
            emitter = Emitter()
            emitter.open(flow.FLOW_IF)  # ELSEIF has an expression
            try:
                emitter.statement(statement)
            except CompileError as error:
                if error.message not in STRUCTURE:
                    return error
    return None
