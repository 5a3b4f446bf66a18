"""Where a key stands in a TOML text: line and column for error messages.

The standard reader gives no positions. This one needs none of TOML's values: it follows
the headers and the keys in front of `=`, which is enough to point at the right line.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile

Step = str | int

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"\s*([A-Za-z0-9_.\"'-]+)\s*=")
_STEP = re.compile(r"\.([A-Za-z0-9_-]+)|\[(\d+)\]")
_LONG_STRING = re.compile(r'"""|\'\'\'')


def steps(path: str) -> list[Step]:
    """Split a path like `$.at[2].when` into its steps."""
    return [int(index) if index else name for name, index in _STEP.findall(path)]


def locate(text: str, path: Sequence[Step]) -> tuple[int, int]:
    """Find the line and column of the deepest part of `path` that stands in the text."""
    best, place = 0, (1, 1)
    for line, column, found, content in _entries(text):
        common = _common(found, path)
        if common == len(found) and common >= best:
            best, place = common, (line, column)
            rest = path[common:]
            if rest and isinstance(rest[-1], str):
                place = (line, _within(content, rest[-1], column))
    return place


def _within(content: str, key: str, otherwise: int) -> int:
    """Give the column of a key inside an inline table on this line."""
    match = re.search(rf"[{{,]\s*({re.escape(key)})\s*=", content)
    return match.start(1) + 1 if match else otherwise


def _common(found: Sequence[Step], path: Sequence[Step]) -> int:
    return len(list(takewhile(lambda pair: pair[0] == pair[1], zip(found, path, strict=False))))


def _entries(text: str) -> Iterator[tuple[int, int, list[Step], str]]:
    """Every header and key: line, column, path from the root, and the whole line."""
    table: list[Step] = []
    counts: dict[str, int] = {}
    in_string = False
    for number, content in enumerate(text.splitlines(), start=1):
        was_inside = in_string
        in_string ^= len(_LONG_STRING.findall(content)) % 2 == 1
        if was_inside:
            continue
        if header := _HEADER.match(content):
            table = _table(header[2], header[1] == "[[", counts)
            yield number, header.start(2) + 1, table, content
        elif key := _KEY.match(content):
            yield number, key.start(1) + 1, [*table, *_names(key[1])], content


def _names(dotted: str) -> list[str]:
    return [name.strip(" \"'") for name in dotted.split(".")]


def _table(dotted: str, is_array: bool, counts: dict[str, int]) -> list[Step]:
    """Turn a header into its path; each `[[name]]` counts one up."""
    path: list[Step] = []
    names = _names(dotted)
    for depth, name in enumerate(names):
        path.append(name)
        key = ".".join(names[: depth + 1])
        if is_array and depth == len(names) - 1:
            counts[key] = counts.get(key, -1) + 1
        if key in counts:
            path.append(counts[key])
    return path
