"""Ballscrew compensation: the table of an axis, read, checked, stored, and switched."""

from typing import Annotated, Any

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.errors import UserError
from openacr.mill.card.ballscrew import MOST_BYTES, Table, parse
from openacr.mill.card.ballscrew_store import keep, kept
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.forms.form import axes_of
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.sysvar import Store
from openacr.sysvar.tabs import OFFSETS

Axis = Annotated[int, Meta(ge=0, le=7)]


class OfAxis(Query, frozen=True):
    """An axis of the machine, by its number."""

    axis: Axis = 0


class Text(Body, frozen=True):
    """A table of an axis as the file that is imported: lines like X1E.00175."""

    axis: Axis
    text: Annotated[str, Meta(max_length=MOST_BYTES)]


class Kept(Body, frozen=True):
    """The table of an axis, and whether it is on; without a text the stored one is switched."""

    axis: Axis
    is_on: bool
    text: Annotated[str, Meta(max_length=MOST_BYTES)] | None = None


@endpoint("GET", "/ballscrew", query=OfAxis)
async def read_table(call: Call) -> object:
    """Read the ballscrew table of an axis: positions from the reference point, with errors."""
    store, axis = call.panel.installation.store, call.query.axis
    return await run_in_threadpool(_data, store, axis)


@endpoint("GET", "/ballscrew/file", query=OfAxis, gives="text/plain")
async def export_table(call: Call) -> Response:
    """Export the ballscrew table of an axis as a file."""
    store, axis = call.panel.installation.store, call.query.axis
    name = _name(store, axis)
    table = await run_in_threadpool(kept, store, axis, name)
    if table is None:
        raise PanelError("missing", f"axis {name} has no ballscrew table")
    headers = {"Content-Disposition": f'attachment; filename="ballscrew_{name}.txt"'}
    return Response(table.text(), media_type="text/plain", headers=headers)


@endpoint("POST", "/ballscrew/check", body=Text)
async def check_table(call: Call) -> object:
    """Check a table that is imported or edited, and give its positions in order."""
    name = _name(call.panel.installation.store, call.body.axis)
    table = await run_in_threadpool(lambda: parse(call.body.text, name))
    return {"entries": table.entries}


@endpoint("PUT", "/ballscrew", Role.SERVICE, body=Kept)
async def store_table(call: Call) -> object:
    """Store the ballscrew table of an axis and switch it; it counts once the machine rests."""
    store, body = call.panel.installation.store, call.body
    name = _name(store, body.axis)

    def work() -> object:
        table = kept(store, body.axis, name) if body.text is None else parse(body.text, name)
        if table is not None:
            keep(store, body.axis, table, is_on=body.is_on)
        elif body.is_on:
            raise UserError(f"axis {name} has no ballscrew table: import or enter one")
        return _data(store, body.axis)

    stored = await run_in_threadpool(work)
    cells = frozenset({OFFSETS.ballscrew_file[body.axis]})  # its name stays, its content does not
    call.panel.control.call(lambda station: station.settings.note_stored(cells))
    return stored


def _name(store: Store, axis: int) -> str:
    names = dict(axes_of(store))
    if axis not in names:
        raise UserError(f"axis {axis} is not configured")
    return names[axis]


def _data(store: Store, axis: int) -> dict[str, Any]:
    name = _name(store, axis)
    table, problem = Table(name, ()), ""
    try:
        table = kept(store, axis, name) or table
    except UserError as error:  # the file was removed, or is damaged
        problem = str(error)
    return {
        "axis": axis,
        "name": name,
        "axes": [{"index": index, "name": letter} for index, letter in axes_of(store)],
        "unit": "mm" if store.is_metric else "inch",
        "is_on": bool(store.read(OFFSETS.ballscrew_on[axis])),
        "entries": table.entries,
        "problem": problem,
    }
