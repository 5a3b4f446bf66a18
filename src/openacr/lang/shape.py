"""The shape of a line: the line with its numbers, strings and remarks blanked.

Lines of one shape have tokens of the same kinds and are parsed identically; they differ only
in values. A program of many thousand lines has few shapes, so a caller that caches the
meaning of a shape need not parse every line.

Why equal shapes have equal tokens: the lexer reads from left to right, and what is blanked
never decides how something is read. A run of up to nine digits stays a run of digits (ten
could be a LONG or a float); a string stays a string; what follows REM or an apostrophe has
no meaning. The first digit after `#` is kept: it decides whether there is such a device. A
line with longer runs of digits, `&` or characters beyond ASCII, one that is too long, one
with an exponent of three digits, which no float may hold, and one where REM may be the name
of a label are shapes of their own.
"""

import re
from collections.abc import Sequence

from openacr.lang.lexer import LINE_LIMIT

_STRING = re.compile(r'"[^"\n]*"')
# The word begins at R: a lookbehind in front of it would test every character of the text.
_REMARK = re.compile(r"[Rr](?<![\w$].)[Ee][Mm](?![A-Za-z$])[^\n]+")
_COMMENT = re.compile(r"'[^\n]+")
_DIGITS = re.compile(r"\d(?<!#.)\d{0,8}")
_LONG_RUN = "00"  # all that longer runs can become
_LONG_AFTER_NUMBER_SIGN = re.compile(r"#\d{10}")  # its first digit is kept, nine blanked
_FAR_EXPONENT = re.compile(r"[eE](?<=[\d.].)[+-]?\d{3}")
_TOGETHER = 200  # lines of one pass: in a thread, others wait a millisecond for it at most
_REM_AS_NAME = re.compile(r"[_OoBb][ \t]+[Rr][Ee][Mm]")  # after `_`, GOTO or GOSUB


def shape(line: str) -> str:
    """The shape of one line."""
    blanked = _blanked(line)
    return blanked if _is_regular(line, blanked) else line


def remark(line: str) -> str:
    """The text of the remark of a line without strings, without blanks at its end."""
    found = _REMARK.search(line)
    return found[0][3:].rstrip() if found else ""


def shapes(lines: Sequence[str]) -> list[str]:
    """The shapes of many lines, found in a few passes over a part of them at a time."""
    found: list[str] = []
    for first in range(0, len(lines), _TOGETHER):
        part = lines[first : first + _TOGETHER]
        text = "\n".join(part)
        blanked = _blanked(text)
        if _is_regular(text, blanked, max(map(len, part))):
            found += blanked.split("\n")
        else:
            found += map(shape, part)
    return found


def _is_regular(text: str, blanked: str, longest: int | None = None) -> bool:
    length = len(text) if longest is None else longest
    if length > LINE_LIMIT or not text.isascii() or _LONG_RUN in blanked:
        return False
    if "&" in text or "# " in blanked or "#\t" in blanked:
        return False
    if "#" in text and _LONG_AFTER_NUMBER_SIGN.search(text):
        return False
    return _FAR_EXPONENT.search(text) is None and _REM_AS_NAME.search(blanked) is None


def _blanked(text: str) -> str:
    if '"' in text:
        text = _STRING.sub('""', text)
    text = _REMARK.sub("REM", text)
    if "'" in text:
        text = _COMMENT.sub("'", text)
    return _DIGITS.sub("0", text)
