"""Forms of branches, loops and jumps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.language import registry
from openacr.basic.language.grammar import Form
from openacr.basic.language.nodes import Block, Expr, Statement
from openacr.basic.language.registry import Level
from openacr.lang.lexer import TokenKind
from openacr.messages import (
    NOT_VALID_AT_THIS_LEVEL,
    SYNTAX_ERROR,
    UNKNOWN_COMMAND,
)

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser


class Conditional(Struct, frozen=True):
    """The rest of the line after THEN."""

    blocks: tuple[Block, ...]


class Then(Form):
    """`THEN statements`: everything up to the end of the line; `THEN 100` means GOTO 100."""

    def __init__(self) -> None:
        super().__init__("THEN", optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether THEN stands here; the block form belongs to programs only."""
        if p.cursor.is_word("THEN"):
            return True
        if not p.cursor.at_block_end:
            raise p.cursor.error(SYNTAX_ERROR)
        if not p.scope.stored:
            at_sys = p.scope.level is Level.SYS
            raise p.cursor.error(UNKNOWN_COMMAND if at_sys else NOT_VALID_AT_THIS_LEVEL)
        return False

    def parse(self, p: Parser) -> Conditional:
        """Read the statements."""
        p.cursor.advance()
        if p.cursor.token.kind is TokenKind.NUMBER and p.scope.stored:
            column = p.cursor.token.column
            goto_line = Statement(registry.find("GOTO"), (Destination().parse(p),), column=column)
            first, *others = p.rest_of_line()
            return Conditional(((goto_line, *first), *others))
        if p.cursor.at_block_end and p.cursor.token.kind is not TokenKind.REMARK:
            raise p.cursor.error(SYNTAX_ERROR)
        return Conditional(p.rest_of_line())


class Destination(Form):
    """A label, a line number, or `(expr)` that computes a line number."""

    def starts(self, p: Parser) -> bool:
        """Whether one of them stands here."""
        return p.cursor.token.kind in (TokenKind.LABEL, TokenKind.NUMBER) or p.cursor.is_operator(
            "("
        )

    def parse(self, p: Parser) -> str | Expr:
        """Read it."""
        if p.cursor.token.kind is TokenKind.LABEL:
            return str(p.cursor.advance().value)
        return p.expressions.object_index()


class Value(Form):
    """A numeric expression, as far as it goes."""

    def starts(self, p: Parser) -> bool:
        """Whether anything stands here."""
        return not p.cursor.at_block_end

    def parse(self, p: Parser) -> Expr:
        """Read it."""
        return p.expressions.numeric()


class Step(Form):
    """`STEP expr` of FOR."""

    def __init__(self) -> None:
        super().__init__("STEP", optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether STEP stands here."""
        return p.cursor.is_word("STEP")

    def parse(self, p: Parser) -> Expr:
        """Read it."""
        p.cursor.advance()
        return p.expressions.numeric()
