"""Positions in a text."""

from msgspec import Struct


class Span(Struct, frozen=True):
    """A span of one line: `line` and `column` count from 1, `length` in characters."""

    line: int
    column: int
    length: int = 1

    def marker(self, text: str) -> str:
        """The line with a row of carets under this span."""
        return f"{text}\n{' ' * (self.column - 1)}{'^' * max(1, self.length)}"
