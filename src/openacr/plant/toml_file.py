"""TOML files of users: read, converted, and what is wrong said with its place."""

import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from openacr.errors import SourceError, read_bytes
from openacr.plant.locate import Path as Steps
from openacr.plant.locate import nearest, places

# What the converter says: a sentence and a path; some sentences are said better elsewhere.
UNKNOWN = re.compile(r"Object contains unknown field `(.*)`")
MISSING = re.compile(r"Object missing required field `(.*)`")
_WHERE = re.compile(r"(.*?)(?: - at `\$(.*)`)?", re.DOTALL)
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+)\]")
_SYNTAX = re.compile(r"(.*?)(?: \(at line (\d+), column (\d+)\)| \(at end of document\))?")


def read_text(path: Path) -> str:
    """The text of a file; UserError or SourceError if it cannot be read."""
    data = read_bytes(path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SourceError("the file is not UTF-8 text", path=str(path), line=line) from None


def parse(text: str, path: str) -> dict[str, Any]:
    """The tables of a text; SourceError where it is no TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _SYNTAX.fullmatch(str(error))
        sentence, line, column = found.groups() if found else (str(error), None, None)
        raise SourceError(
            sentence[:1].lower() + sentence[1:],
            path=path,
            line=int(line or text.count("\n") + 1),
            column=int(column or 0),
        ) from None


def wrong(text: str, path: str, steps: Steps, what: str, hint: str = "") -> SourceError:
    """What is wrong with a key or table, at the place where it stands."""
    line, column = nearest(places(text), steps)
    return SourceError(what, path=path, line=line, column=column, hint=hint)


def not_finite(value: object, steps: Steps = ()) -> Iterator[Steps]:
    """Where infinities and NaN stand: they pass every comparison of ranges."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from not_finite(inner, (*steps, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from not_finite(inner, (*steps, index))
    elif isinstance(value, float) and not math.isfinite(value):
        yield steps


def complaint_of(message: str) -> tuple[str, Steps]:
    """A message of the converter as its sentence and the steps to what it speaks of.

    `[...]` (some value of a mapping) ends what is known of a path.
    """
    found = _WHERE.fullmatch(message)
    sentence, where = (found[1], found[2] or "") if found else (message, "")
    steps = _STEP.findall(where.partition("[...]")[0])
    return sentence, tuple(key or int(index) for key, index in steps)
