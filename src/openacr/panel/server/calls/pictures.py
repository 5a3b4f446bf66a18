"""Pictures of part programs: the tool path, and what stock removal leaves of the blank."""

from pathlib import Path

from starlette.responses import JSONResponse, Response

from openacr.panel.control.operator.orders import PanelError
from openacr.panel.server.api import Call, Query, endpoint
from openacr.panel.server.calls.programs import Dialect, file_of
from openacr.panel.server.stocks import Share


class OfPath(Query, frozen=True):
    """A file, else the loaded program."""

    path: str = ""
    dialect: Dialect = ""


def _program(call: Call) -> tuple[Path, str]:
    """The file a call is about, and its dialect."""
    loaded = call.panel.station.part.loaded
    if call.query.path:
        file, dialect = file_of(call, call.query.path), call.query.dialect
    elif loaded is not None:
        file, dialect = loaded.file, loaded.dialect
    else:
        raise PanelError("missing", "no program is loaded")
    return file, "" if dialect == "auto" else dialect


def _block(call: Call, tag: str, packed: bytes) -> Response:
    """A block of bytes, gzip; 304 where the browser has it."""
    headers = {"ETag": f'"{tag}"', "Cache-Control": "no-cache", "Content-Encoding": "gzip"}
    if call.request.headers.get("if-none-match") == headers["ETag"]:
        return Response(status_code=304, headers={"ETag": headers["ETag"]})
    return Response(packed, media_type="application/octet-stream", headers=headers)


@endpoint("GET", "/path", query=OfPath, gives="application/octet-stream")
async def path(call: Call) -> Response:
    """The tool path as one block of bytes; 202 while it is being computed."""
    tag, found = await call.panel.paths.of(*_program(call))
    if found is None:
        return JSONResponse({"job": tag}, status_code=202)
    return _block(call, tag, found.packed)


@endpoint("GET", "/stock", query=OfPath, gives="application/octet-stream")
async def stock(call: Call) -> Response:
    """What stock removal leaves, as one block of bytes; 202 with the share done while computed."""
    tag, found = await call.panel.stocks.of(*_program(call))
    if isinstance(found, Share):
        return JSONResponse({"job": tag, "done": round(found.done, 3)}, status_code=202)
    return _block(call, tag, found)


@endpoint("DELETE", "/stock")
async def stop_stock(call: Call) -> object:
    """Stop computing a stock."""
    call.panel.stocks.stop()
    return {}
