"""The OpenAPI document of `/api`, made from the table of calls."""

import re
from collections.abc import Iterable
from importlib.metadata import version
from typing import Any

import msgspec

from openacr.panel.commands.registry import Command
from openacr.panel.server.api import JSON, Endpoint
from openacr.panel.wire import described

_NAMED = re.compile(r"\{(\w+)\}")
COMMAND = "/commands/{name}"  # each command has a path of its own
REFERENCE = "#/components/schemas/{name}"
REFUSAL = {
    "type": "object",
    "properties": {
        "error": {
            "type": "object",
            "properties": {"code": {"type": "string"}, "text": {"type": "string"}},
            "required": ["code", "text"],
        }
    },
}


def document(endpoints: Iterable[Endpoint], commands: Iterable[Command]) -> dict[str, Any]:
    """The document; commands of the WebSocket are extensions: `x-commands`, `x-frames`."""
    rows, orders = list(endpoints), list(commands)
    kinds: list[Any] = [kind for row in rows for kind in (row.query, row.body) if kind is not None]
    kinds += [order.args for order in orders]
    schemas, components = msgspec.json.schema_components(
        list(dict.fromkeys(kinds)), ref_template=REFERENCE
    )
    by_kind = dict(zip(dict.fromkeys(kinds), schemas, strict=True))
    paths: dict[str, Any] = {}
    for row in rows:
        paths.setdefault(f"/api{row.path}", {})[row.method.lower()] = _operation(row, by_kind)
    given = paths.pop(f"/api{COMMAND}", {})
    for order in orders if given else ():
        paths[f"/api{COMMAND}".format(name=order.name)] = {"post": _command(order, by_kind)}
    return {
        "openapi": "3.1.0",
        "info": {"title": "openacr panel", "version": version("openacr")},
        "paths": paths,
        "components": {
            "schemas": {**components, "Refusal": REFUSAL},
            "securitySchemes": {"session": {"type": "apiKey", "in": "cookie", "name": "openacr"}},
        },
        "x-commands": {
            order.name: {
                "summary": order.summary,
                **({"description": order.more} if order.more else {}),
                **({"titles": order.titles} if order.titles else {}),
                "role": order.role.word,
                "needs_control": order.needs_control,
                "args": by_kind[order.args],
            }
            for order in orders
        },
        "x-frames": described.document(),
    }


def _command(order: Command, by_kind: dict[Any, Any]) -> dict[str, Any]:
    """A command as a call of its own."""
    body = {"required": True, "content": {JSON: {"schema": by_kind[order.args]}}}
    return {**_described(order.name, order.text, order.role.word, JSON), "requestBody": body}


def _operation(row: Endpoint, by_kind: dict[Any, Any]) -> dict[str, Any]:
    role = None if row.is_open else row.role.word
    operation = _described(row.handler.__name__, row.text, role, row.gives)
    operation["parameters"] = [*_places(row), *_queries(row)]
    if row.body is not None:
        operation["requestBody"] = {
            "required": True,
            "content": {JSON: {"schema": by_kind[row.body]}},
        }
    elif row.takes:
        operation["requestBody"] = {"required": True, "content": {row.takes: {}}}
    return operation


def _described(name: str, text: str, role: str | None, gives: str) -> dict[str, Any]:
    """What calls have in common; without a role it is open."""
    first, _, rest = text.partition("\n")
    operation: dict[str, Any] = {
        "summary": first,
        "operationId": name,
        "x-role": role,
        "responses": {
            "200": {"description": "done", "content": {gives: {}}},
            "default": {
                "description": "refused",
                "content": {JSON: {"schema": {"$ref": REFERENCE.format(name="Refusal")}}},
            },
        },
    }
    if rest.strip():
        operation["description"] = rest.strip()
    if role is not None:
        operation["security"] = [{"session": []}]
    return operation


def _places(row: Endpoint) -> list[dict[str, Any]]:
    return [
        {"name": name, "in": "path", "required": True, "schema": {"type": "string"}}
        for name in _NAMED.findall(row.path)
    ]


def _queries(row: Endpoint) -> list[dict[str, Any]]:
    if row.query is None:
        return []
    schema = next(iter(msgspec.json.schema(row.query)["$defs"].values()))
    required = set(schema.get("required", ()))
    return [
        {"name": name, "in": "query", "required": name in required, "schema": kind}
        for name, kind in schema.get("properties", {}).items()
    ]
