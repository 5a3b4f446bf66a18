"""Resolve a parameter or flag given by number, by name, or by object and name."""

import re
from collections.abc import Iterable, Mapping
from functools import cache
from typing import TypeAlias

from openacr.errors import MapError, UserError
from openacr.map import Flag, Parameter, find_flag, find_parameter, flags, parameters

What: TypeAlias = int | str
_ITEM = re.compile(r"(BIT|P)\s*(\d+)", re.IGNORECASE)


def parameter_number(what: What) -> int:
    """The parameter number for `12288`, `"P12288"` or `"axis0.current position"`."""
    if isinstance(what, int):
        return what
    return _parameters().get(what.lower()) or _only(what, find_parameter(what))


def flag_number(what: What) -> int:
    """The flag number for `516`, `"BIT516"` or `"master0.in motion"`."""
    if isinstance(what, int):
        return what
    return _flags().get(what.lower()) or _only(what, find_flag(what))


def named(text: str) -> Parameter | Flag:
    """The parameter of this name or number, else the flag; UserError where there is neither."""
    try:
        return parameters()[parameter_number(text)]
    except MapError as error:
        no_parameter = error
    try:
        return flags()[flag_number(text)]
    except MapError as error:
        number = re.fullmatch(r"(P|BIT)\d+", text, re.IGNORECASE)
        if number is None:
            raise UserError(f"no parameter and no flag is named {text!r}") from None
        raise (no_parameter if number[1].upper() == "P" else error) from None


def _only(text: str, found: Iterable[Parameter] | Iterable[Flag]) -> int:
    numbers = [record.number for record in found]
    if len(numbers) != 1:
        some = ", ".join(str(number) for number in numbers[:3])
        raise UserError(f"{text!r} has {len(numbers)} matches ({some}, ...): name the object too")
    return numbers[0]


@cache
def full_names() -> dict[str, Parameter | Flag]:
    """Parameters, else flags, by full names such as `axis0.current position`."""
    return {
        **{name: flags()[number] for name, number in _flags().items()},
        **{name: parameters()[number] for name, number in _parameters().items()},
    }


@cache
def _parameters() -> dict[str, int]:
    """Numbers by full name, for frequent requests; all other names are searched."""
    return _full_names(parameters().values())


@cache
def _flags() -> dict[str, int]:
    return _full_names(flags().values())


def _full_names(records: Iterable[Parameter] | Iterable[Flag]) -> dict[str, int]:
    """Numbers by names such as `axis0.current position`; ambiguous names are omitted."""
    found: dict[str, int] = {}
    several: set[str] = set()
    for record in records:
        index = "" if record.index is None else record.index
        name = f"{record.object}{index}.{record.name}".lower()
        several |= {name} & found.keys()
        found[name] = record.number
    return {name: number for name, number in found.items() if name not in several}


def item_names(targets: Mapping[str, str]) -> dict[str, str]:
    """The aliases of flags and parameters by these: BIT36, P12290; `targets`: what each stands for.

    Of several aliases the last one that was defined.
    """
    found = ((name, _ITEM.fullmatch(text)) for name, text in targets.items())
    return {f"{each[1].upper()}{int(each[2])}": name for name, each in found if each}
