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
    BRIDGE = "bridge"
    SWEEP = "sweep"


def show_schema(
    kind: Annotated[
        Kind,
        typer.Argument(
            metavar="machine|scenario|configure|bridge|sweep",
            help="The kind of file.",
        ),
    ],
) -> None:
    """Print the JSON schema of machine, scenario, configure, bridge or sweep files.

    Editors complete and check a file by it. It has every key, type, range and choice; how the
    values of a file fit together is checked by `openacr check`, of a sweep by `openacr sweep`.
    """
    typer.echo(json.dumps(schema_of(kind), indent=2))


def schema_of(kind: Kind) -> dict[str, Any]:
    """The schema, made of the types that the loader of the file converts to."""
    import msgspec

    from openacr.bridge.settings import EXACTLY_ONE as OF_BRIDGES
    from openacr.scenario.rules import AT_LEAST_ONE
    from openacr.scenario.rules import EXACTLY_ONE as OF_SCENARIOS
    from openacr.sweep.schema import EXACTLY_ONE as OF_SWEEPS

    body = msgspec.json.schema(_type_of(kind))
    parts = body["$defs"]
    for struct, sets in AT_LEAST_ONE.items():
        _require(parts, struct, "anyOf", sets)
    for struct, sets in (OF_SCENARIOS | OF_BRIDGES | OF_SWEEPS).items():
        _require(parts, struct, "oneOf", sets)
    return {"$schema": DRAFT, "title": f"{kind}.toml of openacr", **_without_null(body)}


def _type_of(kind: Kind) -> Any:
    from openacr.bridge.settings import BridgeFile
    from openacr.configure.answers import Answers
    from openacr.plant.describe.schema import World
    from openacr.scenario.schema import Scenario
    from openacr.sweep.schema import kind_for_editors

    return {
        Kind.MACHINE: World,
        Kind.SCENARIO: Scenario,
        Kind.CONFIGURE: Answers,
        Kind.BRIDGE: BridgeFile,
        Kind.SWEEP: kind_for_editors(),
    }[kind]


def _require(
    parts: dict[str, Any], struct: "type[Struct]", word: str, sets: tuple[tuple[str, ...], ...]
) -> None:
    """Of each set of keys an entry has one (`oneOf`) or at least one (`anyOf`)."""
    part = parts.get(struct.__name__)
    if part is not None:
        part["allOf"] = [{word: [{"required": [key]} for key in keys]} for keys in sets]


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
