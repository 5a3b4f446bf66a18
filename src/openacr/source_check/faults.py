"""One fault of a file: where, what the card would say, and what may help."""

from collections.abc import Sequence

from msgspec import Struct

from openacr.basic.language.loader import FileLine
from openacr.lang.lexer import column_in
from openacr.lang.source import Span


class Fault(Struct, frozen=True):
    """A fault and its place; a warning is something the card accepts."""

    path: str
    line: int
    column: int
    length: int
    message: str
    hint: str
    text: str
    severity: str = "error"

    @property
    def is_warning(self) -> bool:
        """Whether the card would accept this."""
        return self.severity == "warning"

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        kind = "warning: " if self.is_warning else ""
        return f"{self.path}:{self.line}:{self.column}: {kind}{self.message}{hint}"

    @property
    def marker(self) -> str:
        """The line with carets below the place."""
        width = max(1, min(self.length, len(self.text) - self.column + 1))
        blanks = "".join("\t" if c == "\t" else " " for c in self.text[: self.column - 1])
        return f"{self.text}\n{blanks}{'^' * width}"


def place_of(line: FileLine, span: Span | None, originals: Sequence[str]) -> tuple[int, int, int]:
    """Line, column and length in a file as it is; without a span those of the whole line."""
    number, column = line.place(column_in(line.text, span.column)) if span else (line.number, 1)
    original = originals[number - 1].rstrip()
    begin = len(original) - len(original.lstrip()) + 1
    if number != line.number:
        shift = begin - 1  # it was joined to another line without its indentation
    else:  # a prompt in front of the line was taken away before it was read
        first = line.text[: line.rests[0][1] - 2] if line.rests else line.text
        shift = len(original) - len(first) if original.endswith(first) else 0
    column = max(begin, column + shift) if span else begin
    return number, min(column, len(original) + 1), span.length if span else len(original)
