"""Measurements of servo tuning that are kept under names: listed, read, kept, renamed, deleted."""

from typing import Annotated

from msgspec import Meta
from starlette.concurrency import run_in_threadpool

from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.panel.work.tunings import MOST, Name, Tuning, Tunings, folder_of

Number = Annotated[int, Meta(ge=1, lt=1 << 31)]


class OfTuning(Query, frozen=True):
    """A measurement by its number."""

    number: Number


class New(Body, frozen=True):
    """A measurement, of this panel or of a file, and the name it gets."""

    name: Name
    tuning: Tuning


class Renamed(Body, frozen=True):
    """A measurement by its number, and its new name."""

    number: Number
    name: Name


def _kept(call: Call) -> Tunings:
    return Tunings(folder_of(call.panel.installation.store.path))


@endpoint("GET", "/tunings", Role.SERVICE)
async def list_tunings(call: Call) -> object:
    """The kept measurements by number: name, axis, when it was made, bytes; how many there may be.

    They are files in a folder beside the store.
    """
    return {"tunings": await run_in_threadpool(_kept(call).entries), "most": MOST}


@endpoint("GET", "/tunings/file", Role.SERVICE, query=OfTuning)
async def tuning_file(call: Call) -> object:
    """A kept measurement with its name, as a file has it that POST /tunings takes again."""
    return await run_in_threadpool(_kept(call).read, call.query.number)


@endpoint("POST", "/tunings", Role.SERVICE, body=New)
async def keep_tuning(call: Call) -> object:
    """Keep a measurement under a name that none has; its number."""
    body: New = call.body
    return {"number": await run_in_threadpool(_kept(call).keep, body.name, body.tuning)}


@endpoint("POST", "/tunings/rename", Role.SERVICE, body=Renamed)
async def rename_tuning(call: Call) -> object:
    """Give a kept measurement another name."""
    body: Renamed = call.body
    await run_in_threadpool(_kept(call).rename, body.number, body.name)
    return {}


@endpoint("DELETE", "/tunings", Role.SERVICE, query=OfTuning)
async def delete_tuning(call: Call) -> object:
    """Delete a kept measurement."""
    await run_in_threadpool(_kept(call).delete, call.query.number)
    return {}
