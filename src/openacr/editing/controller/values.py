"""What the lines of a program name that has a value: parameters, flags, variables, elements."""

import re
from collections.abc import Iterable, Iterator, Mapping

from openacr.editing.marks import Kind, Mark

ARRAYS = ("LA", "SA", "DA", "$A")
_CONSTANT = re.compile(r"\s*\(\s*(\d+)\s*\)")


def values_in(
    text: str, marks: Iterable[Mark], targets: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """As it is written, and its name on the card: P12288, BIT516, LV0, LA0(3); each once.

    `targets` has what aliases stand for. Expressions, and elements whose index is one, have no
    value of their own.
    """
    found: dict[str, str] = {}
    is_declared = False  # DIM LV(2) has a count, no variable
    for mark in sorted(marks, key=lambda each: each.start):
        if mark.kind is Kind.COMMAND:
            is_declared = mark.name.startswith("DIM")
        elif is_declared or mark.is_definition:
            continue
        elif mark.kind is Kind.ALIAS:
            if name := targets.get(mark.name):
                found.setdefault(name, mark.name)
        elif name := value_name(text, mark):
            found.setdefault(name, name)
    for name, written in found.items():
        yield written, name


def value_name(text: str, mark: Mark) -> str:
    """The name of the value that a part of a line is; empty where it has no value."""
    if mark.number < 0:
        return ""
    if mark.kind in (Kind.PARAMETER, Kind.FLAG):
        return mark.name
    if mark.kind is not Kind.VARIABLE:
        return ""
    if not mark.name.startswith(ARRAYS):
        return mark.name
    index = _CONSTANT.match(text, mark.end)
    return f"{mark.name}({int(index[1])})" if index else ""
