"""The card: its parameters and flags with their names, operator variables."""

import asyncio
from typing import Annotated

from msgspec import Meta
from starlette.concurrency import run_in_threadpool

from openacr.map import flags, parameters
from openacr.map.block import Access
from openacr.mill.config.pparm import LAST, OperatorParameters
from openacr.panel.control.orders import PanelError
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.sysvar.schema import CARD_VARIABLES

MOST = 500


class Browse(Query, frozen=True):
    """Words of a name, an object (AXIS, MASTER ...) and its number."""

    text: str = ""
    object: str = ""
    index: int | None = None
    first: Annotated[int, Meta(ge=0)] = 0
    count: Annotated[int, Meta(ge=1, le=MOST)] = 100


class Variables(Body, frozen=True):
    """Operator variables by number: {"5": 1.5}."""

    values: dict[str, float]


def _fits(query: Browse, name: str, number: int, thing: str, index: int | None) -> bool:
    if query.object and thing.lower() != query.object.lower():
        return False
    if query.index is not None and index != query.index:
        return False
    words = query.text.lower().lstrip("p").split() if query.text else []
    full = f"{thing}{'' if index is None else index} {name} {number}".lower()
    return all(word in full for word in words)


@endpoint("GET", "/card/parameters", query=Browse)
async def card_parameters(call: Call) -> object:
    """Find parameters of the card by words, object and number."""
    query: Browse = call.query

    def find() -> object:
        found = [
            each
            for each in parameters().values()
            if _fits(query, each.name, each.number, each.object, each.index)
        ]
        return {
            "total": len(found),
            "objects": sorted({each.object for each in parameters().values()}),
            "parameters": [
                {
                    "number": each.number,
                    "name": each.name,
                    "object": each.object,
                    "index": each.index,
                    "section": each.section,
                    "unit": each.unit,
                    "kind": each.kind.name,
                    "doc": each.description,
                    "writable": each.access is not Access.READ,
                }
                for each in found[query.first : query.first + query.count]
            ],
        }

    return await run_in_threadpool(find)


@endpoint("GET", "/card/flags", query=Browse)
async def card_flags(call: Call) -> object:
    """Find flags of the card by words, object and number."""
    query: Browse = call.query

    def find() -> object:
        found = [
            each
            for each in flags().values()
            if _fits(query, each.name, each.number, each.object, each.index)
        ]
        return {
            "total": len(found),
            "flags": [
                {
                    "number": each.number,
                    "name": each.name,
                    "object": each.object,
                    "index": each.index,
                    "parameter": each.parameter,
                    "bit": each.bit,
                    "doc": each.description,
                    "writable": each.access is not Access.READ,
                }
                for each in found[query.first : query.first + query.count]
            ],
        }

    return await run_in_threadpool(find)


# --- P PARM ---------------------------------------------------------------------------


@endpoint("GET", "/pparm")
async def pparm(call: Call) -> object:
    """The operator variables P0 to P199: those of the card and those of the store."""

    def read(station: Station) -> list[float]:
        session = station.machine
        on_card = session.machine.read_rows(list(CARD_VARIABLES))
        return [*on_card, *(session.cells.read(n) for n in range(len(CARD_VARIABLES), LAST + 1))]

    values = await asyncio.wrap_future(call.panel.control.call(read))
    return {"values": values}


@endpoint("PUT", "/pparm", Role.OPERATE, body=Variables)
async def write_pparm(call: Call) -> object:
    """Set operator variables, one after the other."""
    try:
        wanted = {int(key.lstrip("Pp")): value for key, value in call.body.values.items()}
    except ValueError:
        raise PanelError("bad", "variables are named by their numbers: {'5': 1.5}") from None

    def write(station: Station) -> dict[str, float]:
        session = station.machine
        variables = OperatorParameters(session.cells, session.card)
        for number, value in wanted.items():
            variables.write(number, value)
        return {str(number): variables.read(number) for number in wanted}

    return {"values": await asyncio.wrap_future(call.panel.control.call(write))}
