"""Files that are kept under names where the panel runs: listed, read, stored, renamed, deleted."""

from typing import Annotated

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.panel.roles import Role
from openacr.panel.server.api import JSON, Body, Call, Query, endpoint, limited
from openacr.panel.server.kept import KeptFiles, root_of
from openacr.panel.server.kept_kinds import KINDS, KindWord

Name = Annotated[str, Meta(min_length=1, max_length=120)]


class OfKind(Query, frozen=True):
    """A kind: set-ups and references of the scope, measurements of tuning."""

    kind: KindWord


class OfFile(OfKind, frozen=True):
    """A file by its kind and name."""

    name: Name


class Stored(OfFile, frozen=True):
    """The same, and whether one of that name is replaced."""

    replace: bool = False


class Renamed(Body, frozen=True):
    """The new name of a file."""

    kind: KindWord
    name: Name
    to: Name


def _files(call: Call, kind: KindWord) -> KeptFiles:
    installation = call.panel.installation
    return KeptFiles(root_of(installation.project, installation.store.path), kind)


@endpoint("GET", "/kept", Role.SERVICE, query=OfKind)
async def list_kept(call: Call) -> object:
    """The files of a kind by name, which all browsers share; how many of how many bytes may be.

    Of each its bytes and the time of its last change; of a measurement its axis and its time, too.
    """
    kind = KINDS[call.query.kind]
    files = await run_in_threadpool(_files(call, call.query.kind).entries)
    return {"files": files, "most": kind.most, "most_bytes": kind.most_bytes}


@endpoint("GET", "/kept/file", Role.SERVICE, query=OfFile)
async def read_kept(call: Call) -> Response:
    """A kept file, as PUT takes it."""
    text = await run_in_threadpool(_files(call, call.query.kind).read, call.query.name)
    return Response(text, media_type=JSON)


@endpoint("PUT", "/kept/file", Role.SERVICE, query=Stored, takes=JSON)
async def store_kept(call: Call) -> object:
    """Keep a file under a name; `conflict` where it is taken, unless `replace`.

    How many of how many bytes may be of a kind is in the answer of `GET /kept`.
    """
    query: Stored = call.query
    text = await limited(call.request, KINDS[query.kind].most_bytes)
    files = _files(call, query.kind)
    await run_in_threadpool(files.store, query.name, text, replace=query.replace)
    return {"name": query.name}


@endpoint("POST", "/kept/rename", Role.SERVICE, body=Renamed)
async def rename_kept(call: Call) -> object:
    """Give a kept file another name; `conflict` where that is taken."""
    body: Renamed = call.body
    await run_in_threadpool(_files(call, body.kind).rename, body.name, body.to)
    return {"name": body.to}


@endpoint("DELETE", "/kept/file", Role.SERVICE, query=OfFile)
async def delete_kept(call: Call) -> object:
    """Delete a kept file."""
    await run_in_threadpool(_files(call, call.query.kind).delete, call.query.name)
    return {}
