"""Set-ups and references of the scope under names, kept where the panel runs."""

from typing import Annotated

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.errors import UserError
from openacr.panel.roles import Role
from openacr.panel.server.api import JSON, Body, Call, Query, endpoint, limited
from openacr.panel.server.kept_scopes import MOST_BYTES, Kind, ScopeFiles

Name = Annotated[str, Meta(min_length=1, max_length=120)]


class OfFile(Query, frozen=True):
    """A set-up or a reference by its name."""

    kind: Kind
    name: Name


class Stored(OfFile, frozen=True):
    """The same, and whether one of that name is replaced."""

    replace: bool = False


class Renamed(Body, frozen=True):
    """The new name of a set-up or reference."""

    kind: Kind
    name: Name
    to: Name


def _files(call: Call) -> ScopeFiles:
    """Those in the folder of the project, else beside the store of the machine."""
    installation = call.panel.installation
    store = installation.store.path
    root = installation.project or (None if store is None else store.parent)
    if root is None:
        raise UserError("this panel keeps nothing: its store is in memory")
    return ScopeFiles(root)


@endpoint("GET", "/scope/files", Role.SERVICE)
async def scope_files(call: Call) -> object:
    """The set-ups and references of the scope, which all browsers share."""
    return {"files": await run_in_threadpool(_files(call).entries)}


@endpoint("GET", "/scope/file", Role.SERVICE, query=OfFile)
async def scope_file(call: Call) -> Response:
    """A set-up or a reference, as it is stored."""
    text = await run_in_threadpool(_files(call).read, call.query.kind, call.query.name)
    return Response(text, media_type=JSON)


@endpoint("PUT", "/scope/file", Role.SERVICE, query=Stored, takes=JSON)
async def store_scope_file(call: Call) -> object:
    """Keep a set-up or a reference under a name; `conflict` where it is taken, unless `replace`.

    At most 64 of each kind, of 4 MB each.
    """
    query: Stored = call.query
    text = await limited(call.request, MOST_BYTES)
    files = _files(call)
    await run_in_threadpool(files.store, query.kind, query.name, text, replace=query.replace)
    return {"name": query.name}


@endpoint("POST", "/scope/rename", Role.SERVICE, body=Renamed)
async def rename_scope_file(call: Call) -> object:
    """Give a set-up or a reference another name; `conflict` where that is taken."""
    body: Renamed = call.body
    await run_in_threadpool(_files(call).rename, body.kind, body.name, body.to)
    return {"name": body.to}


@endpoint("DELETE", "/scope/file", Role.SERVICE, query=OfFile)
async def delete_scope_file(call: Call) -> object:
    """Delete a set-up or a reference."""
    await run_in_threadpool(_files(call).delete, call.query.kind, call.query.name)
    return {}
