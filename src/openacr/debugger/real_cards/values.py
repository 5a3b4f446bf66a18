"""What is attached to a program of a card over a link, and where its axes are."""

from __future__ import annotations

import re
from collections.abc import Iterator

from openacr.client import Card
from openacr.client.program_variables import Value

_SLAVE = re.compile(r'ATTACH SLAVE\d+ AXIS(\d+) "(\w+)"')
_MASTER = re.compile(r"ATTACH MASTER(\d+)")
_AXIS_PARTS = ("current position", "actual position", "following error", "ppu")


def axes_of(card: Card, program: int) -> dict[str, int]:
    """The axes attached to a program: their numbers by name."""
    lines = card.command("ATTACH", program=program)
    found = filter(None, map(_SLAVE.fullmatch, lines))
    return {match[2]: int(match[1]) for match in found}


def master_of(card: Card, program: int) -> int | None:
    """The master attached to a program."""
    lines = card.command("ATTACH", program=program)
    found = filter(None, map(_MASTER.fullmatch, lines))
    return next((int(match[1]) for match in found), None)


def axis_states(card: Card, program: int) -> Iterator[Value]:
    """The axes attached to a program: positions [units], error [counts]."""
    for name, number in axes_of(card, program).items():
        axis = card.axis(number)
        current, actual, error, ppu = map(
            float, card.read_many([axis.parameter(part) for part in _AXIS_PARTS])
        )
        per_unit = 1.0 / ppu if ppu else 1.0
        parts = {
            "commanded": current * per_unit,
            "actual": actual * per_unit,
            "following error (counts)": error,
        }
        elements = tuple(Value(part, f"{value:.9g}") for part, value in parts.items())
        yield Value(f"{name} (AXIS{number})", f"{actual * per_unit:.9g}", elements)
