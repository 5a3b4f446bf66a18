"""One fault of a file: where, what the card would say, and what may help."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Fault:
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
