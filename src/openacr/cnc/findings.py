"""What is wrong, or doubtful, in a part program: code, place and words."""

from dataclasses import dataclass

from openacr.errors import UserError


@dataclass(frozen=True, slots=True)
class Finding:
    """An error (`E105`) or warning (`W212`) at a line and column, both from 1."""

    code: str
    text: str
    file: str
    line: int
    column: int = 1
    hint: str = ""
    block: str = ""  # the line as written

    @property
    def is_error(self) -> bool:
        """Whether the program may not be started."""
        return self.code.startswith("E")

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: {self.code} {self.text}"
        return f"{place} ({self.hint})" if self.hint else place


class BlockError(UserError):
    """A block cannot act; nothing of it has happened."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(str(finding))
        self.finding = finding
