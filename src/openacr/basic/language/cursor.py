"""A cursor over the tokens of a line, with the errors to raise at its position."""

from __future__ import annotations

from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.messages import SYNTAX_ERROR, Message

_ENDS = TokenKind.END, TokenKind.REMARK
_ACCEPTED = TokenKind.OPERATOR, TokenKind.WORD


class StatementError(CardError):
    """A line that cannot be read, with the place where reading stopped."""

    def __init__(self, message: Message, span: Span, detail: object = "") -> None:
        super().__init__(message, detail)
        self.span = span


class Cursor:
    """The tokens of a line and the position reached in them."""

    def __init__(self, found: list[Token]) -> None:
        self.tokens = found
        self.position = 0

    @property
    def token(self) -> Token:
        """The token at the cursor; the last one is of kind END."""
        return self.tokens[self.position]

    def ahead(self, count: int) -> Token:
        """The token `count` places after the cursor."""
        return self.tokens[min(self.position + count, len(self.tokens) - 1)]

    def advance(self) -> Token:
        """Take the token at the cursor."""
        token = self.tokens[self.position]
        if token.kind is not TokenKind.END:
            self.position += 1
        return token

    @property
    def at_block_end(self) -> bool:
        """Whether the block ends here."""
        token = self.tokens[self.position]
        return token.kind in _ENDS or (token.value == ":" and token.kind is TokenKind.OPERATOR)

    def is_operator(self, text: str) -> bool:
        """Whether this operator stands here."""
        token = self.tokens[self.position]
        return token.value == text and token.kind is TokenKind.OPERATOR

    def is_word(self, *words: str) -> bool:
        """Whether one of these words (upper case) stands here."""
        token = self.tokens[self.position]
        return token.value in words and token.kind is TokenKind.WORD

    def accept(self, text: str) -> bool:
        """Take this operator or word if it stands here."""
        token = self.tokens[self.position]
        if token.value == text and token.kind in _ACCEPTED:
            self.position += 1
            return True
        return False

    def expect(self, text: str) -> None:
        """Take this operator or word; anything else is a syntax error."""
        if not self.accept(text):
            raise self.error(SYNTAX_ERROR)

    def error(self, message: Message, detail: object = "") -> StatementError:
        """The error to raise at the cursor."""
        return StatementError(message, self.token.span, detail)

    def error_from(self, start: int, message: Message) -> StatementError:
        """The error to raise for all that was read since the position `start`."""
        first, last = self.tokens[start], self.tokens[max(start, self.position - 1)]
        length = last.column + len(last.text) - first.column
        return StatementError(message, Span(first.span.line, first.column, length))
