"""The world around the card: what the pane World draws, and the files of its bodies."""

from typing import Annotated

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.errors import read_bytes
from openacr.panel.control.machine.about import axes
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, Query, endpoint


class OfAxis(Query, frozen=True):
    """An axis of machine.toml."""

    axis: Annotated[int, Meta(ge=0, le=15)]


@endpoint("GET", "/world")
async def world(call: Call) -> object:
    """The links of the machine with their switches, inputs, possible faults, and devices."""

    def about(station: Station) -> object:
        return station.world.about(axes(station.installation.store))

    return await call.panel.ask(about)


@endpoint("GET", "/world/body", query=OfAxis, gives="application/octet-stream")
async def body(call: Call) -> Response:
    """The file (STL or glTF) with the body of an axis that machine.toml names."""
    path = await call.panel.ask(lambda station: station.world.file(call.query.axis))
    data = await run_in_threadpool(lambda: read_bytes(path))
    return Response(data, media_type="application/octet-stream")
