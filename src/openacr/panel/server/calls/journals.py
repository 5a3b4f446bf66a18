"""Journals of served cards, left on the computer of the panel, to investigate a problem."""

from contextlib import suppress
from datetime import datetime
from operator import itemgetter
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse

from openacr.controller.ring import journals
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint


class OfJournal(Query, frozen=True):
    """A journal, by its path in the list."""

    path: str


@endpoint("GET", "/journals", Role.SERVICE)
async def list_journals(call: Call) -> object:
    """The journals of `openacr serve` on this computer, the latest first."""
    return {"journals": await run_in_threadpool(_entries, call.panel.journals)}


@endpoint("GET", "/journals/file", Role.SERVICE, query=OfJournal, gives="application/octet-stream")
async def journal_file(call: Call) -> object:
    """A journal as a file, for `openacr replay`."""
    query: OfJournal = call.query
    found = await run_in_threadpool(_found, call.panel.journals)
    place = found.get(query.path)
    if place is None:
        raise PanelError("missing", f"{query.path}: there is no such journal")
    name = query.path.replace("/", "-")
    return FileResponse(place, media_type="application/octet-stream", filename=name)


def _found(root: Path | None) -> dict[str, Path]:
    """The journals in the folders of a folder, by `FOLDER/FILE`: what is outside has no name."""
    if root is None or not root.is_dir():
        return {}
    places = [
        place
        for folder in root.iterdir()
        if folder.is_dir() and not folder.is_symlink()
        for place in journals(folder)
        if place.is_file() and not place.is_symlink()
    ]
    return {f"{place.parent.name}/{place.name}": place for place in places}


def _entries(root: Path | None) -> list[dict[str, Any]]:
    entries = []
    for name, place in _found(root).items():
        with suppress(FileNotFoundError):  # a card that is served drops its oldest ones
            stat = place.stat()
            changed = datetime.fromtimestamp(stat.st_mtime).astimezone()
            entries.append(
                {
                    "path": name,
                    "bytes": stat.st_size,
                    "changed": changed.isoformat(timespec="seconds"),
                }
            )
    return sorted(entries, key=itemgetter("changed", "path"), reverse=True)
