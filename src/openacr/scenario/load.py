"""Read a scenario file and refuse, with its place, everything that could not be played."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from math import isfinite
from pathlib import Path

import msgspec

from openacr.errors import SourceError
from openacr.plant.locate import nearest, places
from openacr.project import read_bytes
from openacr.scenario.rules import STRUCT_OF_KEY, Step, allowed_keys, problems
from openacr.scenario.schema import Key, Scenario, State

_PATH = re.compile(r"^(.*?)(?: - at `(\$.*)`)?$", re.DOTALL)
_UNKNOWN = re.compile(r"Object contains unknown field `(.*)`")
_MISSING = re.compile(r"Object missing required field `(.*)`")
_STEP = re.compile(r"\.([A-Za-z0-9_-]+)|\[(\d+)\]")
_TOML_PLACE = re.compile(r"\s*\(at line (\d+), column (\d+)\)|\s*\(at end of document\)")


def load_scenario(path: Path) -> Scenario:
    """Read and check the scenario file at `path`."""
    data = read_bytes(path)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SourceError("scenario files are UTF-8 text", path=str(path), line=line) from None
    return parse_scenario(text, str(path))


def parse_scenario(text: str, path: str = "scenario.toml") -> Scenario:
    """Check the text of a scenario; the first thing wrong is raised with its place."""
    try:
        raw = tomllib.loads(text)
        for where in _not_finite(raw, ()):
            raise _at(text, path, where, "numbers have to be finite")
        scenario = msgspec.convert(raw, Scenario)
    except tomllib.TOMLDecodeError as error:
        raise _syntax(error, text, path) from None
    except msgspec.ValidationError as error:
        raise _wrong(str(error), text, path) from None
    for problem in problems(scenario):
        raise _at(text, path, problem.steps, problem.text, problem.hint)
    return scenario


def _not_finite(value: object, where: tuple[Step, ...]) -> Iterator[tuple[Step, ...]]:
    """Find infinities and NaN: they pass every comparison of ranges."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _not_finite(inner, (*where, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _not_finite(inner, (*where, index))
    elif isinstance(value, float) and not isfinite(value):
        yield where


def _at(text: str, path: str, where: Sequence[Step], what: str, hint: str = "") -> SourceError:
    line, column = nearest(places(text), tuple(where))
    return SourceError(what, path=path, line=line, column=column, hint=hint)


def _steps(path: str) -> list[Step]:
    """Split a path like `$.at[2].when` into its steps."""
    return [int(index) if index else name for name, index in _STEP.findall(path)]


def _syntax(error: tomllib.TOMLDecodeError, text: str, path: str) -> SourceError:
    message = str(error)
    place = _TOML_PLACE.search(message)
    what = _TOML_PLACE.sub("", message)
    if place and place[1]:
        return SourceError(what, path=path, line=int(place[1]), column=int(place[2]))
    return SourceError(what, path=path, line=text.count("\n") + 1)


def _wrong(message: str, text: str, path: str) -> SourceError:
    """Turn the converter's sentence about a path into one about a line."""
    match = _PATH.match(message)
    what, where = (match[1], _steps(match[2] or "")) if match else (message, [])
    if unknown := _UNKNOWN.fullmatch(what):
        allowed = ", ".join(allowed_keys(where))
        return _at(
            text, path, [*where, unknown[1]], f"unknown key `{unknown[1]}`", f"allowed: {allowed}"
        )
    if missing := _MISSING.fullmatch(what):
        return _at(text, path, where, f"`{missing[1]}` is missing")
    name = next((step for step in reversed(where) if isinstance(step, str)), "")
    what = (what[:1].lower() + what[1:]).replace(" | null", "")  # TOML has no null
    return _at(text, path, where, f"{name}: {what}" if name else what, _choices(name))


def _choices(name: str) -> str:
    kinds: dict[str, type[Key] | type[State]] = {"key": Key, "state": State}
    if name in kinds:
        return "allowed: " + ", ".join(member.value for member in kinds[name])
    if name in STRUCT_OF_KEY:
        return "keys: " + ", ".join(allowed_keys([name]))
    return ""
