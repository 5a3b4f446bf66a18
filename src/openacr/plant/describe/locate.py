"""Find the line and column of a key in a TOML text.

The parser of the standard library gives positions only for syntax errors. This scanner reads a
text known to be valid TOML and records where each key was written, which is all that
messages about wrong values need.
"""

import re
from collections.abc import Iterator

Path = tuple[str | int, ...]
Place = tuple[int, int]

_KEY = r"(?:[A-Za-z0-9_-]+|\"[^\"]*\"|'[^']*')"
_DOTTED = rf"{_KEY}(?:\s*\.\s*{_KEY})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_DOTTED})\s*\]")
_ASSIGNMENT = re.compile(rf"\s*({_DOTTED})\s*=")
_INLINE_KEY = re.compile(rf"[{{,]\s*({_DOTTED})\s*=")
_PART = re.compile(_KEY)
_MULTILINE = re.compile(r'"""(?:\\.|[^\\])*?"""|' + r"'''.*?'''", re.DOTALL)
_STRING_OR_COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|' + r"'[^'\n]*'|#[^\n]*")


def places(text: str) -> dict[Path, Place]:
    """Line and column of every table and key, both counted from 1."""
    found: dict[Path, Place] = {}
    arrays: dict[Path, int] = {}
    table: Path = ()
    for number, line in _logical_lines(_MULTILINE.sub(_blank, text)):
        if header := _HEADER.match(line):
            table = _open_table(_parts(header[2]), header[1] == "[[", arrays)
            for depth in range(1, len(table) + 1):
                found.setdefault(table[:depth], (number, header.start(2) + 1))
        elif assignment := _ASSIGNMENT.match(line):
            path = table + _parts(assignment[1])
            found.setdefault(path, (number, assignment.start(1) + 1))
            for inner in _INLINE_KEY.finditer(line, assignment.end()):
                found.setdefault(path + _parts(inner[1]), (number, inner.start(1) + 1))
    return found


def nearest(found: dict[Path, Place], path: Path) -> Place:
    """Place of `path`, or of the closest table around it; (0, 0) for the file as a whole."""
    while path:
        if path in found:
            return found[path]
        path = path[:-1]
    return (0, 0)


def _blank(match: re.Match[str]) -> str:
    return '""' + "\n" * match[0].count("\n")


def _parts(dotted: str) -> Path:
    return tuple(part.strip("\"'") for part in _PART.findall(dotted))


def _open_table(parts: Path, is_array: bool, arrays: dict[Path, int]) -> Path:
    """Path of a table header, with the index of the latest element of every array in it."""
    path: Path = ()
    for position, part in enumerate(parts):
        path = (*path, part)
        if is_array and position == len(parts) - 1:
            arrays[path] = arrays.get(path, -1) + 1
        if path in arrays:
            path = (*path, arrays[path])
    return path


def _logical_lines(text: str) -> Iterator[tuple[int, str]]:
    """Lines that begin a statement; those inside a list that is still open are skipped."""
    depth = 0
    for number, line in enumerate(text.splitlines(), 1):
        if depth == 0:
            yield number, line
        bare = _STRING_OR_COMMENT.sub("", line)
        if depth or not _HEADER.match(line):
            depth += bare.count("[") - bare.count("]")
