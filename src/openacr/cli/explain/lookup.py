"""`openacr param` and `openacr flag`: what a number or name on the card means."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.printing import print_json, print_rich
from openacr.errors import MapError, UserError
from openacr.map import Flag, Parameter, find_flag, find_parameter, flags_of
from openacr.map.explain import facts_of, has_meaning, object_of
from openacr.map.numbers import FLAG_LAST, PUBLIC_COUNT

if TYPE_CHECKING:
    from rich.table import Table

PARAMETER_HINT = f"a number 0..{PUBLIC_COUNT - 1}, or words of a name"
FLAG_HINT = f"a number 0..{FLAG_LAST}, or words of a name"
SHOWN = 60  # of what was found by name

What = Annotated[
    str,
    typer.Argument(
        metavar="NUMBER|NAME", help="Number or name, e.g. 12291, 'axis 2 following error'."
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print all findings as a JSON array.")]


def show_parameter(text: What, json: AsJson = False) -> None:
    """Explain a parameter: meaning, type, access, packet address."""
    try:
        found = find_parameter(text)
    except MapError as error:
        raise UserError(f"{error} ({PARAMETER_HINT})") from None
    if json:
        print_json([_parameter_fields(parameter) for parameter in found])
    elif len(found) > 1:
        shown = found[:SHOWN]
        print_rich(_choice(shown, [parameter.kind.value for parameter in shown], "Type", "P"))
        _say_more(len(found) - len(shown))
    else:
        _print_parameter(found[0])


def show_flag(text: What, json: AsJson = False) -> None:
    """Explain a flag: meaning, access, update speed, parameter that holds it."""
    try:
        found = find_flag(text)
    except MapError as error:
        raise UserError(f"{error} ({FLAG_HINT})") from None
    if json:
        print_json([_flag_fields(flag) for flag in found])
    elif len(found) > 1:
        shown = found[:SHOWN]
        print_rich(
            _choice(shown, [f"P{flag.parameter}.{flag.bit}" for flag in shown], "Word", "BIT")
        )
        _say_more(len(found) - len(shown))
    else:
        _print_flag(found[0])


def _say_more(count: int) -> None:
    if count > 0:
        typer.echo(f"and {count} more; say more of the name, or --json for all", err=True)


def _print_parameter(parameter: Parameter) -> None:
    title = f"P{parameter.number}  {parameter.name}"
    _print_facts(title, parameter.description, facts_of(parameter))
    named = [flag for flag in flags_of(parameter.number) if has_meaning(flag)]
    if named:
        print_rich(_choice(named, [flag.description for flag in named], "Meaning", "BIT"))


def _print_flag(flag: Flag) -> None:
    _print_facts(f"BIT{flag.number}  {flag.name}", flag.description, facts_of(flag))


def _print_facts(title: str, description: str, facts: dict[str, str]) -> None:
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim", no_wrap=True)
    table.add_column()
    for name, value in facts.items():
        table.add_row(f"  {name}", Text(value))
    print_rich(Text(title, style="bold"))
    if description:
        print_rich(Text(description))
    print_rich(table)


def _choice(
    found: Sequence[Parameter | Flag], last: list[str], heading: str, letter: str
) -> "Table":
    from rich.box import SIMPLE
    from rich.table import Table
    from rich.text import Text

    table = Table("Number", "Name", "Object", heading, box=SIMPLE)
    for record, detail in zip(found, last, strict=True):
        table.add_row(
            f"{letter}{record.number}", Text(record.name), object_of(record), Text(detail)
        )
    return table


def _parameter_fields(parameter: Parameter) -> dict[str, Any]:
    packet = parameter.packet
    return {
        "number": parameter.number,
        "name": parameter.name,
        "type": parameter.kind.value,
        "access": parameter.access.value,
        "object": parameter.object,
        "index": parameter.index,
        "section": parameter.section,
        "packet": packet
        and {"code": packet.code, "group_index": packet.group_index, "mask": packet.mask},
        "description": parameter.description,
        "unit": parameter.unit,
        "default": parameter.default,
        "reference": parameter.ref,
        "erratum": parameter.erratum,
        "flags": [flag.number for flag in flags_of(parameter.number)],
    }


def _flag_fields(flag: Flag) -> dict[str, Any]:
    return {
        "number": flag.number,
        "name": flag.name,
        "printed": flag.printed,
        "access": flag.access.value,
        "speed": flag.speed.value,
        "parameter": flag.parameter,
        "bit": flag.bit,
        "mask": flag.mask,
        "object": flag.object,
        "index": flag.index,
        "section": flag.section,
        "description": flag.description,
        "reference": flag.ref,
        "erratum": flag.erratum,
    }
