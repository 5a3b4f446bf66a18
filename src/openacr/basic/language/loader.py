"""What a reader of `.8K` program files does before the text reaches the card.

Published listings wrap lines at the page width, keep prompts in front of commands and
leave PROGRAM or ENDP out. A terminal shows none of this tolerance; it belongs to files.
"""

import gc
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache

from msgspec import Struct

from openacr.lang.lexer import LINE_LIMIT
from openacr.lang.shape import shape, shapes

_PROMPT = re.compile(r"\s*(?:SYS|P\d\d|PLC\d)>\s*", re.IGNORECASE)
_QUOTES = '"\u201c\u201d\u201e'
_APOSTROPHES = "'\u2018\u2019"
_REM = re.compile(r"(?<![A-Za-z])REM(?![A-Za-z])", re.IGNORECASE)
_OPEN_INPUT = re.compile(r'\s*INPUT\s*;?\s*(?:#\s*\d\s*[,;]?)?\s*(?:"[^"]*")?\s*[;,]?\s*', re.I)
_PROGRAM = re.compile(r"[\s:]*PROGRAM(?![A-Za-z])", re.IGNORECASE)
_ENDP = re.compile(r"[\s:]*ENDP(?![A-Za-z])", re.IGNORECASE)
_LEVEL = re.compile(r"[\s:]*(?:SYS(?![A-Za-z])|(?:PROG|PLC)\s*\d)", re.IGNORECASE)
_SLAVE_NAME = re.compile(r'ATTACH\s*SLAVE\s*\d+\s*AXIS\s*\d+\s*"([A-Za-z]{1,4})"', re.IGNORECASE)
_LABEL = re.compile(r"\s*_\s*[A-Za-z0-9]")
_FLOW = re.compile(
    r"\s*(?:IF|ELSEIF|ELSE|ENDIF|FOR|NEXT|WHILE|WEND|BREAK|GOTO|GOSUB|RETURN|END)(?![A-Za-z])",
    re.IGNORECASE,
)
_LINE_NUMBER = re.compile(r"[\s:]*\d")
_ONE_LINE_IF = re.compile(r"\s*IF(?![A-Za-z]).*?(?<![A-Za-z])THEN(?![A-Za-z])", re.IGNORECASE)
_LEVEL_BOUND = re.compile(
    r"\s*(?:(?:DRIVE|RES|JOG|MOV|CIRCC?W|SINE|TARC|INT|TRJ)(?![A-Za-z])"
    r"|DIM\s*(?:[LSD][VA]|\$[VA]|MBUF))",
    re.IGNORECASE,
)
_MOVE = re.compile(r"\s*([A-Za-z]{1,4})\s*[-+/(\d.\u2013\u2014\u2212]")
_DEFAULT_AXIS_NAMES = frozenset("XYZABCUVW")


class FileText(Struct, frozen=True):
    """A file as it is: its path and its lines."""

    path: str
    lines: list[str]


@dataclass(slots=True)  # files have many lines: a frozen one takes three times as long
class FileLine:
    """One line to send, the line of the file where it begins, and its shape.

    `rests` are the lines of the file that were joined to it: number, and column (from 1) where each
    begins in the text. `file` is set by readers of several files.
    """

    number: int
    text: str
    shape: str = field(default="", compare=False, repr=False)
    rests: tuple[tuple[int, int], ...] = field(default=(), compare=False, repr=False)
    file: FileText | None = field(default=None, compare=False, repr=False)

    def place(self, column: int) -> tuple[int, int]:
        """The line of the file and the column there, without its indentation, of a column."""
        for number, first in reversed(self.rests):
            if column >= first:
                return number, column - first + 1
        return self.number, column


class _Scan(Struct, frozen=True):
    """What a reader of files needs to know about a line; lines of one shape are alike.

    `code` is the line without its remark, its strings blanked.
    """

    code: str
    is_string_open: bool

    @property
    def open_parentheses(self) -> int:
        return self.code.count("(") - self.code.count(")")

    @property
    def blocks(self) -> list[str]:
        return self.code.split(":")

    @property
    def is_open(self) -> bool:
        """Whether the next line may be the rest of this one."""
        is_input = _OPEN_INPUT.fullmatch(self.blocks[-1]) is not None
        return self.is_string_open or self.open_parentheses > 0 or is_input


class _Role(Struct, frozen=True):
    """What a line is for; lines of one shape have the same role."""

    is_open: bool
    is_program: bool
    is_endp: bool
    is_level: bool
    is_program_text: bool


@contextmanager
def long_lived_objects() -> Iterator[None]:
    """Create many objects that all stay: looking for garbage among them is wasted time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def file_lines(text: str) -> list[FileLine]:
    """The lines to send to the card for a file, tolerances of published text applied."""
    joined = _joined(_numbered(text))
    roles = [_role(line.shape) for line in joined]
    if any(role.is_program for role in roles):
        return list(_closed(joined, roles))
    if any(role.is_program_text for role in roles):
        return list(_opened(joined))
    return joined


def _numbered(text: str) -> list[FileLine]:
    """Non-empty lines without prompts."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if ">" in text:
        lines = [
            line[prompt.end() :] if (prompt := _PROMPT.match(line)) else line for line in lines
        ]
    lines = [line.rstrip() for line in lines]
    numbered = zip(range(1, len(lines) + 1), lines, shapes(lines), strict=True)
    return [FileLine(number, line, kind) for number, line, kind in numbered if line]


def _joined(lines: list[FileLine]) -> list[FileLine]:
    """Lines that a page width has broken, put together again."""
    joined: list[FileLine] = []
    following = 0
    while following < len(lines):
        line, following = _whole(lines, following)
        joined.append(line)
    return joined


def _whole(lines: list[FileLine], first: int) -> tuple[FileLine, int]:
    """A line with its rest, and the index of the line after it.

    What stays open however many lines are added was not broken: it is a mistake of its line.
    """
    begun = lines[first]
    rests: tuple[tuple[int, int], ...] = ()
    text, following, is_open = begun.text, first + 1, _role(begun.shape).is_open
    while is_open and following < len(lines) and _continues(text, lines[following].text):
        rests += ((lines[following].number, len(text) + 2),)
        text = f"{text} {lines[following].text.lstrip()}"
        following += 1
        is_open = _scan(text).is_open
    if is_open or following == first + 1:
        return begun, first + 1
    return FileLine(begun.number, text, shape(text), rests), following


def _continues(text: str, following: str) -> bool:
    """Whether `following` is the rest of `text`, which leaves something open."""
    if len(text) + 1 + len(following) > LINE_LIMIT:
        return False
    if _scan(text).is_string_open:
        return sum(following.count(quote) for quote in _QUOTES) % 2 == 1
    return True


@lru_cache(maxsize=4096)
def _role(line: str) -> _Role:
    """The role of all lines of one shape."""
    scan = _scan(line)
    return _Role(
        is_open=scan.is_open,
        is_program=_PROGRAM.match(scan.code) is not None,
        is_endp=_ENDP.match(scan.code) is not None,
        is_level=_LEVEL.match(scan.code) is not None,
        is_program_text=_is_program_text(scan.code),
    )


def _scan(text: str) -> _Scan:
    """Split code from remark and comment; the content of strings becomes blanks.

    No card takes a line beyond LINE_LIMIT; what it goes on with plays no part.
    """
    code: list[str] = []
    in_string = False
    for place, character in enumerate(text[: LINE_LIMIT + 1]):
        if character in _QUOTES:
            in_string = not in_string
            code.append('"')
        elif in_string:
            code.append(" ")
        elif character in _APOSTROPHES or _REM.match(text, place):
            break
        else:
            code.append(character)
    return _Scan("".join(code), in_string)


def _is_program_text(code: str) -> bool:
    """Whether a line can stand in a program only: label, ENDP, flow but the one-line IF."""
    if _LINE_NUMBER.match(code):
        return False  # the card stores it by its number
    if _LABEL.match(code) or _ENDP.match(code):
        return True
    return any(_FLOW.match(block) for block in _flow_blocks(code))


def _flow_blocks(code: str) -> list[str]:
    """The blocks of a line, those after THEN excluded: they belong to the one-line IF."""
    match = _ONE_LINE_IF.search(code)
    return (code[: match.start()] if match else code).split(":")


def _opened(lines: list[FileLine]) -> Iterator[FileLine]:
    """Program text without PROGRAM, opened at the first statement that needs a program."""
    names = _DEFAULT_AXIS_NAMES | {
        name.upper() for line in lines for name in _SLAVE_NAME.findall(line.text)
    }
    is_open = False
    last = 0
    for line in lines:
        code = _scan(line.text).code
        if is_open and _LEVEL.match(code):
            yield FileLine(line.number, "ENDP")
            is_open = False
        elif not is_open and _needs_program(code, names):
            yield FileLine(line.number, "PROGRAM")
            is_open = True
        yield line
        if is_open and _ENDP.match(code):
            is_open = False
        last = line.number
    if is_open:
        yield FileLine(last, "ENDP")


def _needs_program(code: str, names: frozenset[str]) -> bool:
    if _LABEL.match(code) or _ONE_LINE_IF.match(code):
        return True
    for block in code.split(":"):
        move = _MOVE.match(block)
        if move and move[1].upper() in names:
            return True
        if _FLOW.match(block) or _LEVEL_BOUND.match(block):
            return True
    return False


def _closed(lines: list[FileLine], roles: list[_Role]) -> Iterator[FileLine]:
    """ENDP supplied where a program ends without one."""
    is_open = False
    for line, role in zip(lines, roles, strict=True):
        if is_open and role.is_level:
            yield FileLine(line.number, "ENDP")
            is_open = False
        yield line
        if role.is_program:
            is_open = True
        elif role.is_endp:
            is_open = False
    if is_open:
        yield FileLine(lines[-1].number, "ENDP")
