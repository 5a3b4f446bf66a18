"""What a line of a controller file means for the lines around it, known from its text alone."""

import re
from functools import lru_cache
from itertools import pairwise

from msgspec import Struct

from openacr.basic.language.registry import Level
from openacr.lang.shape import shape

_LEVEL = re.compile(r"[\s:]*(?:(SYS)(?![A-Za-z])|(PROG|PLC)\s*(\d{1,3})(?!\d))", re.IGNORECASE)
_PROGRAM = re.compile(r"[\s:]*PROGRAM(?![A-Za-z])", re.IGNORECASE)
_ENDP = re.compile(r"[\s:]*ENDP(?![A-Za-z])", re.IGNORECASE)
_LABEL = re.compile(r"[ \t]*_[ \t]*([A-Za-z0-9]+)")
_NUMBER = re.compile(r"[ \t]*(\d+)")
_DEFINE = re.compile(r"#\s*DEFINE\s+([A-Za-z]\w*)\s*([^:']*)", re.IGNORECASE)
_SLAVE = re.compile(r'ATTACH\s*SLAVE\s*\d+\s*AXIS\s*(\d+)\s*"([A-Za-z]{1,4})"', re.IGNORECASE)
_WORDS = re.compile(r"(?<![A-Za-z_])(?:IF|FOR|WHILE|NEXT|ENDIF|WEND|THEN|ELSE)(?![A-Za-z])")
_REMARK = re.compile(r"\s*(?:REM(?![A-Za-z$])|')", re.IGNORECASE)
_LEVELS = {"SYS": Level.SYS, "PROG": Level.PROG, "PLC": Level.PLC}
_OPENING, _CLOSING = frozenset(("IF", "FOR", "WHILE")), frozenset(("NEXT", "ENDIF", "WEND"))


class Facts(Struct, frozen=True):
    """What one line says."""

    level: tuple[Level, int] | None = None
    opens_program: bool = False
    ends_program: bool = False
    label: str = ""  # a name, or a line number
    alias: tuple[str, str] | None = None  # name and target
    axis: tuple[str, int] | None = None  # name and number
    opens: int = 0  # blocks opened
    closes: int = 0  # blocks closed
    is_remark: bool = False


NOTHING = Facts()


@lru_cache(maxsize=1 << 16)
def facts_of(line: str) -> Facts:
    """The facts of a line."""
    if _REMARK.match(line):
        return Facts(is_remark=True)
    level = _LEVEL.match(line)
    label = _LABEL.match(line) or _NUMBER.match(line)
    define, slave = _DEFINE.search(line), _SLAVE.search(line)
    opens, closes = _blocks(line)
    found = Facts(
        level=_level(level) if level else None,
        opens_program=_PROGRAM.match(line) is not None,
        ends_program=_ENDP.match(line) is not None,
        label=label[1] if label else "",
        alias=(define[1], define[2].strip()) if define else None,
        axis=(slave[2].upper(), int(slave[1])) if slave else None,
        opens=opens,
        closes=closes,
    )
    return NOTHING if found == NOTHING else found


def _level(found: re.Match[str]) -> tuple[Level, int]:
    word = (found[1] or found[2]).upper()
    return _LEVELS[word], int(found[3] or 0)


def _blocks(line: str) -> tuple[int, int]:
    """Blocks a line opens and closes; one that opens and closes the same counts for neither."""
    words: list[str] = _WORDS.findall(shape(line).upper())
    if "THEN" in words:  # the rest of a one-line IF belongs to it
        words = words[: words.index("IF")] if "IF" in words else []
    opens = sum(word in _OPENING for word in words)
    opens -= sum(pair == ("ELSE", "IF") for pair in pairwise(words))
    closes = sum(word in _CLOSING for word in words)
    both = min(opens, closes)
    return opens - both, closes - both
