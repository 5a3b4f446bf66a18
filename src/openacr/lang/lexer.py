"""Cut a line of AcroBASIC into tokens.

Words are letters only, so `ACC10`, `SET32` and `AXIS12` fall into a word and a number
without blanks. Everything a word may mean is left to the parser.
"""

import re
from collections.abc import Iterable, Iterator
from enum import IntEnum
from math import inf
from typing import NamedTuple

from openacr.errors import CardError
from openacr.lang.source import Span
from openacr.messages import LINE_TOO_LONG, MATH_ERROR, SYNTAX_ERROR, Message

LINE_LIMIT = 255
LONG_LIMIT = 2147483647


class TokenKind(IntEnum):
    """The kind of a token."""

    WORD = 1
    NUMBER = 2
    STRING = 3
    OPERATOR = 4
    LABEL = 5  # `_name`, and the name after GOTO or GOSUB
    REMARK = 6
    END = 7


class Token(NamedTuple):
    """One token.

    `text` is the source text (words in upper case compare with `word`), `value` the
    number, the content of the string, the name of the label or the text of the remark;
    for a word it is the upper-case form.
    """

    kind: TokenKind
    text: str
    value: str | int | float
    line: int
    column: int

    @property
    def span(self) -> Span:
        """The position of the token."""
        return Span(self.line, self.column, len(self.text))


class LexError(CardError):
    """A character or number that cannot be read."""

    def __init__(self, message: Message, span: Span) -> None:
        super().__init__(message)
        self.span = span


# An exponent belongs to a number only if E directly follows the digits and a digit
# (or a signed one) directly follows the E: `5 DEC` and `X1ENC` hold none. The name
# after GOTO or GOSUB is one token even if it contains digits.
_TOKEN = re.compile(
    r"""[ \t]*(?:
    (?P<remark>[Rr][Ee][Mm](?![A-Za-z$]).*)
  | (?P<jump>[Gg][Oo](?:[Tt][Oo]|[Ss][Uu][Bb]))(?![A-Za-z$])
        (?:[ \t]*_?[ \t]*(?P<target>[A-Za-z][A-Za-z0-9]*))?
  | (?P<word>\$?[A-Za-z]+\$?)
  | (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
  | (?P<operator>\*\*|<<|>>|<>|<=|>=|[-+*/=<>(),;:\#?!])
  | (?P<label>_[ \t]*[A-Za-z0-9]+)
  | (?P<based>&[Hh][0-9A-Fa-f]{1,8}(?![0-9A-Fa-f])|&[Bb][01]{1,32}(?![01]))
  | (?P<string>"(?:[^"]|"")*"?)
  | (?P<comment>'.*)
  | (?P<end>$)
  | (?P<unknown>.)
    )""",
    re.VERBOSE,
)
_REMARK, _JUMP, _TARGET, _WORD, _NUMBER, _OPERATOR, _LABEL, _BASED, _STRING, _COMMENT, _END = range(
    1, 12
)
_A_WORD, _A_NUMBER, _A_OPERATOR = (
    TokenKind.WORD,
    TokenKind.NUMBER,
    TokenKind.OPERATOR,
)  # cheaper in the loop
_words: dict[str, str] = {}  # upper-case forms: the words of a program are few
_numbers: dict[str, int] = {str(value): value for value in range(1, 1000)}
_KNOWN_WORDS = 4096


def tokens(line: str | bytes, number: int = 1) -> list[Token]:
    """All tokens of one line, the last one of kind END; LexError if one cannot be read."""
    text = line if isinstance(line, str) and line.isascii() else plain(line)
    if len(text) > LINE_LIMIT:
        raise LexError(LINE_TOO_LONG, Span(number, LINE_LIMIT + 1))
    found: list[Token] = []
    add, new = found.append, tuple.__new__
    for match in _TOKEN.finditer(text):
        group = match.lastindex
        start = match.start(group) + 1  # type: ignore[arg-type]
        part = match[group]  # type: ignore[index]
        if group == _WORD:
            word = _words.get(part) or _upper(part)
            add(new(Token, (_A_WORD, part, word, number, start)))
        elif group == _NUMBER:
            value = _numbers.get(part) or decimal(part)
            if value == inf:
                raise LexError(MATH_ERROR, Span(number, start, len(part)))
            add(new(Token, (_A_NUMBER, part, value, number, start)))
        elif group == _OPERATOR:
            add(new(Token, (_A_OPERATOR, part, part, number, start)))
        elif group == _STRING:
            add(Token(TokenKind.STRING, part, _content(part), number, start))
        elif group == _JUMP or group == _TARGET:
            word = match["jump"]
            add(Token(TokenKind.WORD, word, word.upper(), number, match.start(_JUMP) + 1))
            if group == _TARGET:
                add(Token(TokenKind.LABEL, part, part, number, start))
        elif group == _LABEL:
            add(Token(TokenKind.LABEL, part, part[1:].strip(), number, start))
        elif group == _BASED:
            add(Token(TokenKind.NUMBER, part, _based(part), number, start))
        elif group == _REMARK:
            add(Token(TokenKind.REMARK, part[:3], part[3:].rstrip(), number, start))
        elif group == _COMMENT or group == _END:
            add(Token(TokenKind.END, "", "", number, start))
            break
        else:
            raise LexError(SYNTAX_ERROR, Span(number, start))
    return found


def spelled(found: Iterable[Token]) -> str:
    """The line whose tokens these are, one character per byte, each in its column.

    A comment after an apostrophe is not a token and is omitted.
    """
    text = ""
    for token in found:
        part = token.text + str(token.value) if token.kind is TokenKind.REMARK else token.text
        text = text.ljust(token.column - 1) + part
    return text.rstrip()


def _upper(word: str) -> str:
    """The upper-case form, remembered while there is room."""
    upper = word.upper()
    if len(_words) < _KNOWN_WORDS:
        _words[word] = upper
    return upper


def decimal(text: str) -> int | float:
    """The value of a decimal number: an integer if it is written as a LONG, else a float."""
    if text.isdigit():
        whole = int(text)
        return whole if whole <= LONG_LIMIT else float(whole)
    return float(text)


def _based(text: str) -> int:
    """The signed 32-bit value of `&H...` or `&B...`."""
    value = int(text[2:], 16 if text[1] in "Hh" else 2)
    return value - 2**32 if value >= 2**31 else value


def _content(text: str) -> str:
    closed = len(text) > 1 and text.count('"') % 2 == 0
    return text[1 : -1 if closed else None].replace('""', '"')


# Typographic characters, as UTF-8 sequences (tried first) and as single bytes.
_QUOTE = "\x84\x93\x94"
_APOSTROPHE = "\x91\x92"
_DASH = "\x96\x97"
_UTF8 = {
    "\xe2\x80\x9c": '"', "\xe2\x80\x9d": '"', "\xe2\x80\x9e": '"',
    "\xe2\x80\x98": "'", "\xe2\x80\x99": "'",
    "\xe2\x80\x93": "-", "\xe2\x80\x94": "-", "\xe2\x88\x92": "-",
    "\xc2\xa0": " ",
}  # fmt: skip
_SINGLE = (
    dict.fromkeys(_QUOTE, '"')
    | dict.fromkeys(_APOSTROPHE, "'")
    | dict.fromkeys(_DASH, "-")
    | {"\xa0": " "}
)
_ASCII_FORM = _UTF8 | _SINGLE
_CHARACTER = re.compile(
    r"[\xc2-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}|[\xf0-\xf4][\x80-\xbf]{3}|.",
    re.DOTALL,
)
_REM_AHEAD = re.compile(r"(?<![A-Za-z$])REM(?![A-Za-z$])", re.IGNORECASE)


def plain(line: str | bytes) -> str:
    """The line as the lexer reads it, one character per byte, typography made ASCII.

    Strings and remarks keep their apostrophes and dashes as sent; typographic double
    quotes open and close strings like the plain one.
    """
    text = line.decode("latin-1") if isinstance(line, bytes) else line
    if text.isascii():
        return text
    if not isinstance(line, bytes):
        text = text.encode("utf-8", "surrogateescape").decode("latin-1")
    return "".join(_plain_parts(text))


def column_in(line: str, column: int) -> int:
    """The column of the character that the lexer reads at a column of the plain line, from 1."""
    if line.isascii():
        return column
    for place in range(len(line)):
        if len(plain(line[: place + 1])) >= column:
            return place + 1
    return len(line) + max(1, column - len(plain(line)))


def _plain_parts(text: str) -> Iterator[str]:
    in_string = False
    at = 0
    while at < len(text):
        if not in_string and _REM_AHEAD.match(text, at):
            yield text[at:]
            return
        character = _CHARACTER.match(text, at)[0]  # type: ignore[index]
        form = _ASCII_FORM.get(character, character)
        if form == '"':
            in_string = not in_string
        elif in_string:
            form = character
        yield form
        at += len(character)
