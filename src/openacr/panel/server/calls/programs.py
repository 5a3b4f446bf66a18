"""Part programs: files, texts, findings, paths."""

import os
import tempfile
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from typing import IO, Annotated, Literal

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.errors import UserError
from openacr.panel.control.operator.listing import Listing
from openacr.panel.control.operator.loaded import version_of
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.files import Folder, kind_of
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.panel.server.hello import MOST_UPLOAD
from openacr.panel.work.paths import check_text

MOST_CHECKED = 1 << 20
MOST_LINES = 2000
MOST_SHOWN = 32 << 20
PARTIAL = ".upload-"
LEFT_OVER_S = 3600.0  # since a part of an upload was written last: its process is gone
Dialect = Literal["", "auto", "acromill", "rs274ngc"]


class OfFolder(Query, frozen=True):
    """A folder inside the folder of programs."""

    folder: str = ""


class OfFile(Query, frozen=True):
    """A file in the folder of programs."""

    path: str
    dialect: Dialect = ""


class OfLines(Query, frozen=True):
    """Lines of a file, or of the loaded program."""

    path: str = ""
    first: Annotated[int, Meta(ge=1)] = 1
    lines: Annotated[int, Meta(ge=1, le=MOST_LINES)] = 200


class Rename(Body, frozen=True):
    """The old and the new name of a file."""

    path: str
    to: str


class Checked(Body, frozen=True):
    """A text that is being edited."""

    text: Annotated[str, Meta(max_length=MOST_CHECKED)]
    path: str = ""
    dialect: Dialect = ""


def folder_of(call: Call) -> Folder:
    """The folder of programs."""
    return Folder(call.panel.installation.programs)


def file_of(call: Call, path: str) -> Path:
    """A file in the folder of programs."""
    try:
        return folder_of(call).file(path)
    except UserError as error:
        raise PanelError("missing", str(error)) from None


def locked(call: Call) -> str:
    """The path of the program that is under way; empty if none is."""
    part = call.panel.station.part
    loaded = part.loaded
    return loaded.path if loaded is not None and part.executing.is_under_way else ""


def _require_unlocked(call: Call, path: str) -> None:
    if path.strip("/") and path.strip("/") == locked(call):
        raise PanelError("conflict", f"{path} is running: it can be changed when it has ended")


# --- lists and texts ------------------------------------------------------------------


@endpoint("GET", "/programs", query=OfFolder)
async def programs(call: Call) -> object:
    """List the part programs of a folder."""
    folder, running = folder_of(call), locked(call)

    def read() -> object:
        entries = folder.entries(call.query.folder)
        for entry in entries:
            entry["locked"] = entry["path"] == running
        return {"folder": call.query.folder.strip("/"), "entries": entries}

    return await run_in_threadpool(read)


@endpoint("GET", "/programs/text", query=OfLines)
async def text(call: Call) -> object:
    """Read lines of a file."""
    query: OfLines = call.query
    file = file_of(call, query.path)

    def read() -> object:
        listing = Listing(file)
        return {
            "path": query.path,
            "first": query.first,
            "lines": listing.lines(query.first, query.lines),
            "total": listing.total,
            "version": version_of(file),
            "locked": query.path == locked(call),
        }

    return await run_in_threadpool(read)


@endpoint("GET", "/programs/file", query=OfFile, gives="text/plain")
async def readfile_of(call: Call) -> Response:
    """Read a whole file; the ETag is its version."""
    file = file_of(call, call.query.path)
    if file.stat().st_size > MOST_SHOWN:
        raise PanelError("too_big", f"{file.name} is too big to be edited here: read it by lines")

    def read() -> Response:
        data = file.read_bytes()
        return Response(
            data,
            media_type="text/plain; charset=utf-8",
            headers={"ETag": f'"{version_of(file)}"', "Cache-Control": "no-cache"},
        )

    return await run_in_threadpool(read)


# --- changing files -------------------------------------------------------------------


@endpoint("PUT", "/programs/file", Role.OPERATE, query=OfFile, takes="text/plain")
async def writefile_of(call: Call) -> object:
    """Save a file: `If-Match` with its version, `*` to replace whatever is there, none: new."""
    return await _store_body(call)


@endpoint("POST", "/programs/upload", Role.OPERATE, query=OfFile, takes="application/octet-stream")
async def upload(call: Call) -> object:
    """Upload a new file of at most 256 MiB; with `If-Match: *` it may replace one."""
    return await _store_body(call)


async def _store_body(call: Call) -> object:
    expected = call.request.headers.get("if-match", "").strip('"')
    return await store(call, call.query.path, call.request.stream(), expected)


def place_for(call: Call, path: str) -> Path:
    """The place of a file that is to be stored; PanelError for a folder or a program that runs."""
    _require_unlocked(call, path)
    place = folder_of(call).at(path)
    if place == call.panel.installation.programs or place.is_dir():
        raise PanelError("bad", f"{path}: it is a folder")
    return place


async def store(call: Call, path: str, parts: AsyncIterator[bytes], expected: str) -> object:
    """Store a file whole or not at all; `expected` is the version it replaces, or `*`."""
    place = place_for(call, path)
    partial = await _received(parts, place)
    try:
        result = await run_in_threadpool(_replace, place, partial, path, expected)
    finally:
        partial.unlink(missing_ok=True)
    _note(call, path)
    return result


async def _received(parts: AsyncIterator[bytes], place: Path) -> Path:
    """What comes in, in a file beside the place it is for."""
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=PARTIAL, dir=place.parent)
        _remove_left_over(place.parent, os.fstat(handle).st_mtime)
    except OSError as error:
        raise _unwritable(place, error) from None
    partial, size = Path(name), 0
    try:
        with os.fdopen(handle, "wb") as file:
            async for part in parts:
                size += len(part)
                if size > MOST_UPLOAD:
                    raise PanelError("too_big", f"more than {MOST_UPLOAD} bytes are not taken")
                await run_in_threadpool(file.write, part)
            await run_in_threadpool(_settle, file)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise _unwritable(place, error) from None
    except BaseException:
        partial.unlink(missing_ok=True)
        raise
    return partial


def _remove_left_over(folder: Path, now_s: float) -> None:
    """Remove parts of uploads that a process left when it was killed; others are under way.

    `now_s` is the time of the disk, which may be another one than that of this computer.
    """
    for partial in folder.glob(f"{PARTIAL}*"):
        with suppress(OSError):
            if now_s - partial.stat().st_mtime > LEFT_OVER_S:
                partial.unlink()


def _settle(file: IO[bytes]) -> None:
    file.flush()
    os.fsync(file.fileno())


def _note(call: Call, path: str) -> None:
    """Tell the screens that a file is another one."""
    call.panel.control.call(lambda station: station.part.note_stored(path.strip("/")))
    call.panel.hub.broadcast({"event": "changed", "what": "programs", "path": path, "cells": []})


def _unwritable(place: Path, error: OSError) -> UserError:
    return UserError(f"{place.name} cannot be stored: {(error.strerror or str(error)).lower()}")


def _replace(place: Path, partial: Path, path: str, expected: str) -> object:
    if place.exists():
        if not expected:
            raise PanelError("conflict", f"{path} is there already")
        if expected not in ("*", version_of(place)):
            raise PanelError("conflict", f"{path} was changed meanwhile: read it again")
    elif expected not in ("", "*"):
        raise PanelError("conflict", f"{path} is not there any more")
    try:
        partial.chmod(0o644)
        partial.replace(place)
    except OSError as error:
        raise _unwritable(place, error) from None
    return {"path": path, "version": version_of(place), "bytes": place.stat().st_size}


@endpoint("DELETE", "/programs/file", Role.SETUP, query=OfFile)
async def deletefile_of(call: Call) -> object:
    """Delete a file."""
    file = file_of(call, call.query.path)
    _require_unlocked(call, call.query.path)
    try:
        await run_in_threadpool(file.unlink)
    except OSError as error:
        raise _unwritable(file, error) from None
    _note(call, call.query.path)
    return {}


@endpoint("POST", "/programs/rename", Role.OPERATE, body=Rename)
async def renamefile_of(call: Call) -> object:
    """Rename a file; the new name must be free."""
    file, to = file_of(call, call.body.path), folder_of(call).at(call.body.to)
    _require_unlocked(call, call.body.path)
    if to.exists():
        raise PanelError("conflict", f"{call.body.to} is there already")
    try:
        to.parent.mkdir(parents=True, exist_ok=True)
        file.rename(to)
    except OSError as error:
        raise _unwritable(to, error) from None
    _note(call, call.body.path)
    return {"path": call.body.to, "kind": kind_of(to)}


# --- findings ---------------------------------------------------------------


@endpoint("POST", "/check", body=Checked)
async def check(call: Call) -> object:
    """Check a text while it is edited: findings with line and column, predicted time."""
    body: Checked = call.body
    folder = folder_of(call).at(body.path).parent if body.path else call.panel.installation.programs
    store = call.panel.installation.store.path
    if store is None:
        raise UserError("the store is in memory")
    name = Path(body.path).name or "PROGRAM"
    dialect = "" if body.dialect == "auto" else body.dialect
    found = await call.panel.checks.run(check_text, body.text, name, folder, store, dialect)
    return {"findings": found.findings, **found.facts()}


@endpoint("GET", "/program")
async def program(call: Call) -> object:
    """The loaded program with its findings; null without one."""
    loaded = call.panel.station.part.loaded
    if loaded is None:
        return None
    return await run_in_threadpool(lambda: {**loaded.data(), "findings": loaded.findings()})


@endpoint("GET", "/program/listing", query=OfLines)
async def listing(call: Call) -> object:
    """Lines of the loaded program, as it was when it was loaded."""
    loaded = call.panel.station.part.loaded
    if loaded is None:
        raise PanelError("missing", "no program is loaded")
    query: OfLines = call.query
    lines = await run_in_threadpool(loaded.listing.lines, query.first, query.lines)
    return {"first": query.first, "lines": lines, "total": loaded.listing.total}
