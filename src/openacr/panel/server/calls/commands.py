"""The commands of the panel as calls, for scripts that need no connection of their own."""

import asyncio
from contextlib import suppress
from typing import Any

import msgspec

from openacr.panel.control.operator.orders import Order, PanelError
from openacr.panel.control.operator.people import Person, next_client
from openacr.panel.server.api import MOST_JSON, Call, endpoint, limited, refusal
from openacr.panel.server.openapi import COMMAND


@endpoint("POST", COMMAND, takes="application/json")
async def give_command(call: Call) -> object:
    """Give a command of the WebSocket by its name, with its arguments as an object; its result.

    The caller is connected as long as this takes: control that is free is taken meanwhile, and
    what belongs to a connection (a held key, a watched value) ends with it.
    """
    control, name = call.panel.control, call.request.path_params["name"]
    args = await _arguments(call)
    person = Person(next_client(), call.role, call.address)
    loop = asyncio.get_running_loop()
    answered: asyncio.Future[dict[str, Any]] = loop.create_future()

    def answer(found: dict[str, Any]) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(_answer, answered, found)

    control.call(lambda station: station.join(person))
    try:
        control.put(Order(person, name, args, control.now_s(), answer))
        found = await answered
    finally:
        control.call(lambda station: station.leave(person.client))
    return found["result"] if found["ok"] else refusal(found["error"])


async def _arguments(call: Call) -> dict[str, Any]:
    data = await limited(call.request, MOST_JSON)
    try:
        return msgspec.json.decode(data or b"{}", type=dict[str, Any])
    except (ValueError, RecursionError) as error:
        raise PanelError("bad", f"{call.request.url.path}: {error}") from None


def _answer(answered: "asyncio.Future[dict[str, Any]]", found: dict[str, Any]) -> None:
    if not answered.done():  # the caller has gone
        answered.set_result(found)
