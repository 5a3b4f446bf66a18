"""Read and convert TOML files of users; errors give their position in the file."""

import math
import re
import tomllib
from collections.abc import Iterable, Iterator
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from openacr.errors import FaultyFileError, SourceError, read_bytes
from openacr.plant.describe.locate import Path as Steps
from openacr.plant.describe.locate import nearest, places

MOST_MESSAGES = 100
MOST_DEPTH = 32
_STRINGS = re.compile(
    r'"""(?:\\.|[^\\])*?"""'
    r"|'''.*?'''"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'[^'\n]*'"
    r"|#[^\n]*",
    re.DOTALL,
)
_DEEP_KEY = re.compile(rf'(?:[\w-]+|")(?:[ \t]*\.[ \t]*(?:[\w-]+|")){{{MOST_DEPTH}}}')
_BRACKET = re.compile(r"[\[\]{}]")
Kind = TypeVar("Kind")

# Messages of the converter: a sentence and a path; some sentences are replaced elsewhere.
UNKNOWN = re.compile(r"Object contains unknown field `(.*)`")
MISSING = re.compile(r"Object missing required field `(.*)`")
LENGTH = re.compile(r"Expected `array` of (at least )?length \d+.*")
_WHERE = re.compile(r"(.*?)(?: - at `\$(.*)`)?", re.DOTALL)
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+)\]")
_SYNTAX = re.compile(r"(.*?)(?: \(at line (\d+), column (\d+)\)| \(at end of document\))?")


def read_text(path: Path) -> str:
    """Read the text of a file; UserError or SourceError if impossible."""
    data = read_bytes(path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SourceError("the file is not UTF-8 text", path=str(path), line=line) from None


def parse(text: str, path: str) -> dict[str, Any]:
    """Parse the tables of a text; SourceError if it is not TOML."""
    require_shallow(text, path)
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


def require_shallow(text: str, path: str) -> None:
    """SourceError where tables are nested deeper than any file of a user is.

    The parser takes time and memory with the square of the depth of a key (1.6 GB for 40 kB) and
    ends in a RecursionError for lists, so it is looked at before.
    """
    bare = _STRINGS.sub('"', text)
    found = _DEEP_KEY.search(bare)
    depth = 0
    for each in _BRACKET.finditer(bare):
        depth += 1 if each[0] in "[{" else -1
        if depth > MOST_DEPTH and (found is None or each.start() < found.start()):
            found = each
            break
    if found is not None:
        line = text.count("\n", 0, found.start()) + 1 if bare == text else 0
        raise SourceError(f"tables are nested deeper than {MOST_DEPTH}", path=path, line=line)


def wrong(text: str, path: str, steps: Steps, what: str, hint: str = "") -> SourceError:
    """An error of a key or table, at its position in the file."""
    line, column = nearest(places(text), steps)
    return SourceError(what, path=path, line=line, column=column, hint=hint)


def refuse(found: Iterable[SourceError]) -> None:
    """Raise all errors found in a file together; return if there are none."""
    errors = list(dict.fromkeys(map(_key, found)))
    if len(errors) == 1:
        raise errors[0].error
    if errors:
        raise FaultyFileError(each.error for each in errors)


@dataclass(frozen=True, slots=True)
class _Key:
    """An error by what it prints, so that equal ones are reported once."""

    text: str
    error: SourceError = field(compare=False)


def _key(error: SourceError) -> _Key:
    return _Key(str(error), error)


def convert_all(raw: dict[str, Any], kind: type[Kind]) -> tuple[Kind | None, list[str]]:
    """Convert the tables of a file; None and every message of the converter if any is wrong.

    The converter ends at the first mistake. It is left out of a copy, and the next is looked for:
    a wrong value with its key, a table that lacks a key as a whole. Paths in the messages are
    those of the file.
    """
    rest, messages = deepcopy(raw), list[str]()
    removed: dict[Steps, list[int]] = {}
    while len(messages) < MOST_MESSAGES:
        try:
            found = msgspec.convert(rest, kind)
        except msgspec.ValidationError as error:
            what, steps = complaint_of(str(error))
            place = _original(steps, removed)
            unknown, missing = UNKNOWN.fullmatch(what), MISSING.fullmatch(what)
            key = (missing or unknown or [None, None])[1]
            is_shortened = LENGTH.fullmatch(what) and removed.get(place)
            if not (is_shortened or (missing and (*place, key) in removed)):
                messages.append(f"{what} - at `{_path(place)}`")
            wrong_steps = (*steps, key) if unknown and key else steps
            if not _leave_out(rest, wrong_steps, removed):
                break
        else:
            return (None if messages else found), messages
    return None, messages


def _original(steps: Steps, removed: dict[Steps, list[int]]) -> Steps:
    """The steps in the file to what is at `steps` once some of its parts were left out."""
    place: Steps = ()
    for step in steps:
        if isinstance(step, int):
            for index in sorted(removed.get(place, [])):
                step += index <= step
        place = (*place, step)
    return place


def _leave_out(rest: Any, steps: Steps, removed: dict[Steps, list[int]]) -> bool:
    """Take away what is at `steps`; False if that is the file as a whole."""
    if not steps:
        return False
    place = _original(steps, removed)
    for step in steps[:-1]:
        rest = rest[step]
    del rest[steps[-1]]
    if isinstance(place[-1], int):
        removed.setdefault(place[:-1], []).append(place[-1])
    else:
        removed.setdefault(place, [])
    return True


def _path(steps: Steps) -> str:
    return "$" + "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)


def not_finite(value: object, steps: Steps = ()) -> Iterator[Steps]:
    """The paths of infinities and NaN, which pass every comparison of ranges."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from not_finite(inner, (*steps, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from not_finite(inner, (*steps, index))
    elif isinstance(value, float) and not math.isfinite(value):
        yield steps


def complaint_of(message: str) -> tuple[str, Steps]:
    """Split a message of the converter into its sentence and the path it refers to.

    `[...]` (some value of a mapping) ends what is known of a path.
    """
    found = _WHERE.fullmatch(message)
    sentence, where = (found[1], found[2] or "") if found else (message, "")
    steps = _STEP.findall(where.partition("[...]")[0])
    return sentence, tuple(key or int(index) for key, index in steps)
