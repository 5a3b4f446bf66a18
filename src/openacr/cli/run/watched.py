"""The values that `--watch` records beside the axes: parameters, flags, inputs and outputs."""

import re

from openacr.cli.results import Watched
from openacr.errors import MapError, UserError

_NUMBERED = re.compile(r"(P|BIT|IN|OUT)\s*(\d{1,7})", re.IGNORECASE)
FIRST_OUTPUT, IO_LAST = 32, 31
HINT = "write P12290, BIT516, IN3, OUT0, or the name of one parameter or flag"


def watched(texts: list[str]) -> tuple[Watched, ...]:
    """Read what is to be recorded; each value once, in the order given."""
    from openacr.engine.samples import SAMPLES

    found = tuple(dict.fromkeys(_watched(text) for text in texts))
    if len(found) > SAMPLES:
        raise UserError(f"--watch: {len(found)} values; at most {SAMPLES} are recorded at once")
    return found


def _watched(text: str) -> Watched:
    numbered = _NUMBERED.fullmatch(text.strip())
    if numbered is None:
        return _named(text)
    kind, number = numbered[1].upper(), int(numbered[2])
    if kind in ("IN", "OUT") and number > IO_LAST:
        raise UserError(f"--watch {text}: inputs and outputs are 0..{IO_LAST}")
    if kind == "P":
        return _parameter(text, number)
    return _flag(text, number + (FIRST_OUTPUT if kind == "OUT" else 0))


def _parameter(text: str, number: int) -> Watched:
    from openacr.map import parameters

    found = parameters().get(number)
    if found is None:
        raise UserError(f"--watch {text}: there is no parameter P{number}")
    whose = "" if found.index is None else f" {found.object.lower()} {found.index}"
    title = f"{found.name}{whose} (P{number})"
    return Watched(f"P{number}", title, found.unit, False, number)


def _flag(text: str, number: int) -> Watched:
    from openacr.map import flag

    try:
        found = flag(number)
    except MapError as error:
        raise UserError(f"--watch {text}: {error}") from None
    return Watched(f"BIT{number}", found.name, "", True, number)


def _named(text: str) -> Watched:
    """The one parameter or flag with this name."""
    from openacr.map import find_flag, find_parameter

    names: list[str] = []
    for find, read in ((find_parameter, _parameter), (find_flag, _flag)):
        try:
            found = find(text)
        except MapError:
            continue
        if len(found) == 1:
            return read(text, found[0].number)
        names += [f"{one.object} {one.index}: {one.name}" for one in found[:2]]
    if names:
        several = "; ".join(names)
        raise UserError(f"--watch {text}: the name of more than one ({several} ...): {HINT}")
    raise UserError(f"--watch {text}: there is no such parameter or flag: {HINT}")
