"""`openacr schema`: JSON schemas of the TOML files a user writes, for editors."""

import json
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from msgspec import Struct

DRAFT = "https://json-schema.org/draft/2020-12/schema"


class Kind(StrEnum):
    """The files there are schemas of."""

    MACHINE = "machine"
    SCENARIO = "scenario"
    CONFIGURE = "configure"


def show_schema(
    kind: Annotated[
        Kind,
        typer.Argument(metavar="machine|scenario|configure", help="The file without its suffix."),
    ],
) -> None:
    """Print the JSON schema of machine.toml, scenario.toml or configure.toml.

    Editors complete and check a file by it. It has every key, type, range and choice; how the
    values of a file fit together is checked by `openacr check`.
    """
    typer.echo(json.dumps(schema_of(kind), indent=2))


def schema_of(kind: Kind) -> dict[str, Any]:
    """The schema, made of the types that the loader of the file converts to."""
    import msgspec

    from openacr.scenario.rules import AT_LEAST_ONE, EXACTLY_ONE

    body = msgspec.json.schema(_type_of(kind))
    parts = body["$defs"]
    for struct, sets in AT_LEAST_ONE.items():
        _require(parts, struct, "allOf", [{"anyOf": _each(keys)} for keys in sets])
    for struct, keys in EXACTLY_ONE.items():
        _require(parts, struct, "oneOf", _each(keys))
    return {"$schema": DRAFT, "title": f"{kind}.toml of openacr", **_without_null(body)}


def _type_of(kind: Kind) -> Any:
    from openacr.configure.answers import Answers
    from openacr.plant.schema import World
    from openacr.scenario.schema import Scenario

    return {Kind.MACHINE: World, Kind.SCENARIO: Scenario, Kind.CONFIGURE: Answers}[kind]


def _require(
    parts: dict[str, Any], struct: "type[Struct]", word: str, rules: list[dict[str, Any]]
) -> None:
    part = parts.get(struct.__name__)
    if part is not None:
        part[word] = rules


def _each(keys: tuple[str, ...]) -> list[dict[str, Any]]:
    return [{"required": [key]} for key in keys]


def _without_null(value: Any) -> Any:
    """The schema without null, which TOML does not have."""
    if isinstance(value, list):
        return [_without_null(each) for each in value if each != {"type": "null"}]
    if not isinstance(value, dict):
        return value
    kept = {key: _without_null(each) for key, each in value.items() if each is not None}
    alternatives = kept.get("anyOf", ())
    if len(alternatives) == 1 and "required" not in alternatives[0]:
        kept |= alternatives[0]
        del kept["anyOf"]
    return kept
