"""LINK: a part program is received over a serial line and kept as a file of the folder."""

from collections.abc import AsyncIterator
from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.config.communications import Line
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, endpoint
from openacr.panel.server.calls.programs import place_for, store


class Receive(Body, frozen=True):
    """The file, and the port it comes from; without one that of the COMMUNICATIONS page."""

    path: Annotated[str, Meta(min_length=1)]
    port: str = ""
    replace: bool = False


@endpoint("GET", "/link")
async def link(call: Call) -> object:
    """The reception under way or the last one: state, file, port, bytes, lines, why it failed."""
    return call.panel.receptions.data()


@endpoint("POST", "/link", Role.OPERATE, body=Receive)
async def receive(call: Call) -> object:
    """Begin to receive a part program over a serial line; it is kept once it is complete."""
    body: Receive = call.body
    if place_for(call, body.path).exists() and not body.replace:
        raise PanelError("conflict", f"{body.path} is there already", exists=True)
    installation = call.panel.installation
    line = Line.of(installation.store, body.port)
    if installation.kind == "serial" and line.port == installation.target:
        raise UserError(f"{line.port} is the port of the card: choose another one")

    async def keep(program: bytes) -> object:
        return await store(call, body.path, _whole(program), "*" if body.replace else "")

    await call.panel.receptions.begin(line, body.path, keep)
    return call.panel.receptions.data()


@endpoint("DELETE", "/link", Role.OPERATE)
async def cancel(call: Call) -> object:
    """End the reception under way; nothing is kept."""
    await call.panel.receptions.cancel()
    return call.panel.receptions.data()


async def _whole(program: bytes) -> AsyncIterator[bytes]:
    yield program
