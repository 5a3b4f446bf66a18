"""What an editor shows about a word: Markdown made of the rows that the reference pages show.

Each language adds the rows that it alone has, when it is imported.
"""

from collections.abc import Iterable
from functools import singledispatch

import openacr.map as card_map
from openacr.map import explain, flags_of
from openacr.map.lookup import Flag, Parameter


@singledispatch
def markdown(row: object) -> str:
    """Everything about a row of a table; empty for anything else."""
    return ""


@markdown.register
def _(row: Parameter) -> str:
    named = [flag for flag in flags_of(row.number) if explain.has_meaning(flag)]
    facts = listed(explain.facts_of(row))
    facts += [f"* BIT{flag.number}: {flag.name}" for flag in named]
    return page(f"P{row.number} {row.name}", row.description, facts)


@markdown.register
def _(row: Flag) -> str:
    return page(f"BIT{row.number} {row.name}", row.description, listed(explain.facts_of(row)))


def parameter(number: int) -> Parameter | None:
    """The parameter of a card with this number, if there is one that has a meaning."""
    return card_map.parameter(number) if number in card_map.parameter_names() else None


def flag(number: int) -> Flag | None:
    """The flag of a card with this number, if there is one that has a meaning."""
    return card_map.flag(number) if number in card_map.flag_names() else None


def short(record: Parameter | Flag) -> str:
    """The name of a parameter or flag with its object: `axis 0 current position`."""
    place = explain.object_of(record)
    return record.name if place.lower() in record.name.lower() else f"{place}: {record.name}"


def listed(facts: dict[str, str]) -> list[str]:
    """Facts as items of a list."""
    return [f"* {name}: {value}" for name, value in facts.items()]


def page(heading: str, text: str, facts: Iterable[str]) -> str:
    """A heading, a text and facts; what is empty is left out."""
    parts = [f"**{heading}**", text, "\n".join(facts)]
    return "\n\n".join(part for part in parts if part)
