"""The parts of a line of a part program, also of one that cannot be read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from openacr.cnc.codes import dialects as _registered  # noqa: F401 - fills the table
from openacr.cnc.codes.ngc.named import PREDEFINED
from openacr.cnc.codes.table import DIALECTS, Code, Dialect
from openacr.editing.marks import Kind, Mark

_PART = re.compile(
    r"""(?P<comment>\([^)]*\)?|;.*)
  | (?P<string>"[^"]*"?)
  | (?P<routine>O\s*(?:<[^<>]*>|\d+))
  | (?P<named>\#\s*<[^<>]*>?)
  | (?P<parameter>[P\#][ \t]*\d+)
  | (?P<include>\$I[ \t]*(?P<file>[^;(]*))
  | (?P<letters>[A-Z]{2,})
  | (?P<word>[A-Z@^][ \t]*[-+]?[ \t]*(?:\d[\d ]*\.?\d*|\.\d+))
  | (?P<letter>[A-Z])
  | (?P<number>\d+\.?\d*|\.\d+)
    """,
    re.VERBOSE | re.IGNORECASE,
)
_COMMENT_IN_TEXT = re.compile(r"\([^)]*\)?|;.*")
_DIGITS = re.compile(r"\d+")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)")
ROUTINE_WORDS = frozenset(
    ("SUB", "ENDSUB", "CALL", "RETURN", "WHILE", "ENDWHILE", "DO", "IF", "ELSEIF", "ELSE", "ENDIF",
     "REPEAT", "ENDREPEAT", "BREAK", "CONTINUE")
)  # fmt: skip
_JUMPS = frozenset(("GOTO", "GOSUB"))
_MACROS, _SUBPROGRAM = frozenset(("G65", "G66")), "M98"


@lru_cache(maxsize=1 << 16)
def marks_of(text: str, dialect: str) -> tuple[Mark, ...]:
    """The parts of a line."""
    return tuple(_Marks(text, DIALECTS[dialect]).marks())


def routine_name(text: str) -> str:
    """The name of an O-word as programs compare it."""
    inner = text.strip()[1:].strip().strip("<>").upper()
    name = re.sub(r"[ \t]", "", inner)
    return (name.lstrip("0") or "0") if name.isdigit() else name


class _Marks:
    """Goes through the parts of a line."""

    def __init__(self, text: str, dialect: Dialect) -> None:
        self.text, self.dialect = text, dialect
        self.grammar, self.table = dialect.grammar, dialect.table
        self.is_jump = False  # a label comes next
        self.code = ""  # whose P is a label or an O number
        self.routine = ""  # the O-word of this line
        self.kind = ""  # what the O-word does
        self.is_first = True

    def marks(self) -> Iterator[Mark]:
        if self.text.strip() == "%":
            return
        at = 0
        while found := _PART.search(self.text, at):
            at = found.end()
            kind = found.lastgroup
            if kind == "file":
                kind = "include"
            if kind == "comment" and not self._is_comment(found):
                at = found.start() + 1  # a parenthesis of an expression
                continue
            yield from getattr(self, f"_{kind}")(found)
            if kind != "comment":
                self.is_first = False

    def _is_comment(self, found: re.Match[str]) -> bool:
        """Whether parentheses hold a remark: in acromill they may hold an expression."""
        if self.grammar.brackets != "()" or found[0].startswith(";"):
            return True
        before = self.text[: found.start()].rstrip()
        return not before or before[-1].isdigit() or before[-1] in ").%"

    def _comment(self, found: re.Match[str]) -> Iterator[Mark]:
        yield Mark(found.start(), found.end(), Kind.REMARK)

    def _string(self, found: re.Match[str]) -> Iterator[Mark]:
        yield Mark(found.start(), found.end(), Kind.STRING)

    def _include(self, found: re.Match[str]) -> Iterator[Mark]:
        yield Mark(found.start(), found.start() + 2, Kind.COMMAND, "$I")
        yield Mark(found.start("file"), found.end("file"), Kind.STRING)

    def _routine(self, found: re.Match[str]) -> Iterator[Mark]:
        if not self.is_first and not self.text[: found.start()].strip().upper().startswith("N"):
            yield from self._split(found)
            return
        name = routine_name(found[0])
        rest = _COMMENT_IN_TEXT.sub("", self.text[found.end() :]).split()
        self.kind = rest[0].upper() if rest else ""
        is_definition = self.kind in ("SUB", "")
        place = _place_of_name(found)
        yield Mark(
            found.start(), found.end(), Kind.ROUTINE, name, is_definition=is_definition, place=place
        )

    def _split(self, found: re.Match[str]) -> Iterator[Mark]:
        yield Mark(found.start(), found.start() + 1, Kind.UNKNOWN, found[0][0])

    def _named(self, found: re.Match[str]) -> Iterator[Mark]:
        if not self.grammar.has_names:
            return
        place = _place_of_name(found)
        name = re.sub(r"[ \t]", "", self.text[slice(*place)]).upper()
        rest = self.text[found.end() :].lstrip()
        is_written = rest.startswith("=")
        row = PREDEFINED.get(name)
        yield Mark(
            found.start(), found.end(), Kind.NAMED, name, row=row,
            is_definition=is_written and row is None, place=place,
        )  # fmt: skip

    def _parameter(self, found: re.Match[str]) -> Iterator[Mark]:
        letter, number = found[0][0].upper(), int(_DIGITS.findall(found[0])[0])
        if letter not in self.grammar.parameters or (letter == "P" and self._is_word(found)):
            yield from self._word(found)
        else:
            yield Mark(found.start(), found.end(), Kind.CELL, f"{letter}{number}", number)

    def _is_word(self, found: re.Match[str]) -> bool:
        """Whether a P with a number is a word of its block, not a parameter."""
        before = self.text[: found.start()].rstrip()
        if self.code:
            return True
        follows = self.text[found.end() :].lstrip()[:1]
        is_value = bool(before) and (before[-1] in '(=+-*/<>,;"' or before[-1].isalpha())
        return not is_value and follows not in ("=", "+", "-", "*", "/", "<", ">", ")")

    def _word(self, found: re.Match[str]) -> Iterator[Mark]:
        letter = found[0][0].upper()
        numbers = _NUMBER.findall(re.sub(r"[ \t]", "", found[0][1:]))
        value = float(numbers[0]) if numbers else 0.0
        start, end = found.start(), found.start() + len(found[0].rstrip())
        if letter == "N" and self.is_first and self.dialect.labels and value == int(value):
            place = (end - len(_DIGITS.findall(found[0])[0]), end)
            name = str(int(value))
            yield Mark(start, end, Kind.LABEL, name, is_definition=True, place=place)
        elif letter in "GM":
            row = (self.table.gcodes if letter == "G" else self.table.mcodes).get(value)
            self._note(f"{letter}{value:g}")
            yield Mark(start, end, Kind.CODE, f"{letter}{value:g}", row=row)
        elif letter == "P" and self.code:
            kind = Kind.LABEL if self.code in _MACROS else Kind.ROUTINE
            yield Mark(start, end, kind, str(int(abs(value))), place=(start + 1, end))
        else:
            yield Mark(start, end, Kind.WORD, letter, row=self.table.letters.get(letter))

    def _note(self, code: str) -> None:
        is_call = code in _MACROS or (code == _SUBPROGRAM and self.grammar.has_o_words)
        self.code = code if is_call and isinstance(self._row(code), Code) else self.code

    def _row(self, code: str) -> Code | None:
        table = self.table.gcodes if code[0] == "G" else self.table.mcodes
        return table.get(float(code[1:]))

    def _letters(self, found: re.Match[str]) -> Iterator[Mark]:
        """Words of letters: statements, functions, operators; else letters with values."""
        at, end = found.start(), found.end()
        text = self.text.upper()
        while at < end:
            word, kind = self._longest(text[at:end])
            yield Mark(at, at + len(word), kind, word)
            self.is_jump = word in _JUMPS
            at += len(word)

    def _longest(self, letters: str) -> tuple[str, Kind]:
        for size in range(len(letters), 1, -1):
            word = letters[:size]
            if word in self.grammar.functions or word in self.grammar.states or word == "EXISTS":
                return word, Kind.FUNCTION
            if word in self.grammar.statements or word == "THEN":
                return word, Kind.COMMAND
            if word in self.grammar.operators or word == "NOT":
                return word, Kind.OPERATOR
            if self.kind and word in ROUTINE_WORDS:
                return word, Kind.COMMAND
        return letters[0], Kind.WORD

    def _letter(self, found: re.Match[str]) -> Iterator[Mark]:
        letter = found[0].upper()
        yield Mark(
            found.start(), found.end(), Kind.WORD, letter, row=self.table.letters.get(letter)
        )

    def _number(self, found: re.Match[str]) -> Iterator[Mark]:
        if self.is_jump and found[0].isdigit():
            yield Mark(found.start(), found.end(), Kind.LABEL, str(int(found[0])))
        else:
            yield Mark(found.start(), found.end(), Kind.NUMBER)
        self.is_jump = False


def _place_of_name(found: re.Match[str]) -> tuple[int, int]:
    """The columns of a name in angle brackets, or of the number of an O-word."""
    inner = re.search(r"<([^<>]*)|(\d+)", found[0])
    if inner is None:
        return found.span()
    group = 1 if inner[1] is not None else 2
    return found.start() + inner.start(group), found.start() + inner.end(group)
