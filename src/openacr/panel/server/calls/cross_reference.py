"""Where all programs and PLCs of the card read and write parameters, flags, aliases and labels."""

import re
from collections.abc import Iterable, Mapping

from msgspec.structs import asdict
from starlette.concurrency import run_in_threadpool

from openacr.client.effects import Op
from openacr.client.stored import ListedLine, aliases, listing, rooms
from openacr.client.talk import Talk
from openacr.editing.controller.cross_reference import Use, uses
from openacr.map import Flag, Parameter, flags, parameters
from openacr.panel.server.api import Call, endpoint
from openacr.panel.server.calls.card import data_of
from openacr.panel.server.calls.on_card import talked

_NUMBERED = re.compile(r"(P|BIT)(\d+)")


@endpoint("GET", "/card/uses")
async def card_uses(call: Call) -> object:
    """Every parameter, flag, alias and label of the programs on the card: who reads, who writes.

    `item` is what the card itself says of a parameter or flag; `target` what an alias stands for.
    """
    texts, targets = await talked(call.panel, _read)
    return {"names": await run_in_threadpool(table, texts, targets)}


def _read(talk: Talk) -> Op[tuple[dict[str, list[ListedLine]], dict[str, str]]]:
    found = {}
    for level in (yield from rooms(talk)):
        found[str(level)] = yield from listing(talk, level)
    return found, (yield from aliases(talk))


def table(
    texts: Mapping[str, Iterable[ListedLine]], targets: Mapping[str, str]
) -> list[dict[str, object]]:
    """The names with their uses, as the screens show them."""
    lines = {name: [(line.number, line.text) for line in found] for name, found in texts.items()}
    order = {program: place for place, program in enumerate(lines)}
    named: dict[str, list[Use]] = {}
    for use in sorted(uses(lines, targets), key=lambda each: (order[each.program], each.line)):
        named.setdefault(use.name, []).append(use)
    return [
        {
            "name": name,
            "item": _item(name),
            "target": targets.get(name, ""),
            "uses": [asdict(each) for each in named[name]],
        }
        for name in sorted(named, key=_order)
    ]


def _item(name: str) -> dict[str, object] | None:
    found = _NUMBERED.fullmatch(name)
    if found is None:
        return None
    table: Mapping[int, Parameter | Flag] = parameters() if found[1] == "P" else flags()
    record = table.get(int(found[2]))
    return None if record is None else data_of(record)


def _order(name: str) -> tuple[bool, str, int]:
    """Names first, then parameters and flags by their numbers."""
    found = _NUMBERED.fullmatch(name)
    return (True, found[1], int(found[2])) if found else (False, name, 0)
