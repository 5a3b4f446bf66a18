"""Compare a program text with the card's listing of it, as numbered lines of tokens.

A card does not keep the spelling, so a text and its listing are compared token by token.
Comments that begin with an apostrophe and empty lines are not stored at all.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from msgspec import Struct

from openacr.errors import CardError
from openacr.lang.lexer import TokenKind, tokens

HIDDEN_STEP = 10

Meaning: TypeAlias = tuple[object, ...]
_NUMBERED = re.compile(r"\s*(\d+)(?:\s+(.*))?")
_FORCED_NUMBERS = re.compile(r"\s*\d+\s+PROGRAM(?![A-Za-z])", re.IGNORECASE)
_PROGRAM = re.compile(r"\s*PROGRAM(?![A-Za-z])", re.IGNORECASE)
_MISPRINT = re.compile(r"PROGRAM\s*\d*\s*(_.*)", re.IGNORECASE)
_LEVEL_OR_NEW = re.compile(r"\s*(?:REM.*|'.*|(?:(?:SYS|PROG|PLC|NEW)\s*\d*\s*))", re.IGNORECASE)


class Sent(Struct, frozen=True):
    """A stored line and the line of the file it came from."""

    text: str
    line: int


@dataclass(slots=True)
class Stored:
    """The lines sent for one program or PLC, under their numbers, hidden or not."""

    lines: dict[int, Sent] = field(default_factory=dict)
    is_whole: bool = False  # entered with PROGRAM: nothing else remains stored

    def add(self, text: str, line: int) -> None:
        """Record a line that was entered."""
        numbered = _NUMBERED.fullmatch(text)
        if numbered and not (numbered[2] or "").strip():
            self.lines.pop(int(numbered[1]), None)
        elif numbered:
            self.lines[int(numbered[1])] = Sent(numbered[2], line)
        elif meaning(text):
            for part in _parts(text):
                self.lines[self._next()] = Sent(part, line)

    def _next(self) -> int:
        last = max(self.lines, default=0)
        return last - last % HIDDEN_STEP + HIDDEN_STEP

    def difference(self, listed: Sequence[str]) -> tuple[int, str] | None:
        """The first line listed differently: its line in the file, and the difference."""
        sent = [self.lines[number] for number in sorted(self.lines)]
        shown = plain(listed) if self.is_whole else self._under_numbers(listed)
        for wanted, found in zip(sent, shown, strict=False):
            if meaning(wanted.text) != meaning(found):
                return wanted.line, f"the card lists {found.strip()!r}"
        if len(shown) < len(sent):
            return sent[len(shown)].line, "the card does not list this line"
        if len(shown) > len(sent):
            return sent[-1].line if sent else 0, f"the card also lists {shown[len(sent)].strip()!r}"
        return None

    def _under_numbers(self, listed: Iterable[str]) -> list[str]:
        """The listed lines whose numbers were sent; older lines may be between them."""
        found = filter(None, map(_NUMBERED.fullmatch, listed))
        by_number = {int(match[1]): match[2] or "" for match in found}
        return [by_number.get(number, "") for number in sorted(self.lines)]


def meaning(text: str) -> Meaning:
    """The tokens of a line, without their spelling."""
    try:
        found = tokens(text.strip())
    except CardError:
        return (text.strip(),)
    return tuple(
        _token(token.kind, token.value) for token in found if token.kind is not TokenKind.END
    )


def _token(kind: TokenKind, value: str | int | float) -> tuple[TokenKind, object]:
    if kind is TokenKind.REMARK:
        return kind, str(value).strip()
    return (kind, float(value)) if kind is TokenKind.NUMBER else (kind, value)


def _parts(text: str) -> list[str]:
    """Split a line as a card does: PROGRAM and a label after it become two lines."""
    found = _MISPRINT.fullmatch(text.strip())
    return ["PROGRAM", found[1]] if found else [text]


def plain(listed: Sequence[str]) -> list[str]:
    """A listing without the numbers that BIT5651 adds in front of free-form text."""
    if listed and _FORCED_NUMBERS.match(listed[0]):
        return [line.lstrip().partition(" ")[2] for line in listed]
    return list(listed)


def is_free_form(text: str) -> bool:
    """Whether PROGRAM opens the text; otherwise its lines are numbered."""
    return _PROGRAM.match(text) is not None


def is_numbered(text: str) -> bool:
    """Whether all program text in a file is numbered, like the listing of such a program."""
    lines = [line for line in text.splitlines() if line.strip()]
    numbered = [line for line in lines if _NUMBERED.fullmatch(line)]
    others = [line for line in lines if not _NUMBERED.fullmatch(line)]
    return bool(numbered) and all(_LEVEL_OR_NEW.fullmatch(line) for line in others)
