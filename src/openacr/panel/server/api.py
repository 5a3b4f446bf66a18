"""The table of HTTP calls under `/api`: path, role, what comes in, what goes out."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from openacr.client import ConnectionLostError
from openacr.errors import OpenacrError
from openacr.panel.control.operator.orders import PanelError, failure
from openacr.panel.roles import Role
from openacr.panel.server.panel import ENDS, Panel

MOST_JSON = 4 << 20
JSON = "application/json"
STATUS = {
    "role": 403,
    "login": 401,
    "missing": 404,
    "conflict": 409,
    "too_big": 413,
    "slow": 429,
    "bad": 400,
    "lost": 503,
    "busy": 503,
    "internal": 500,
}


class Query(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """Values of the query of a call."""


class Body(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """The JSON body of a call."""


@dataclass(frozen=True, slots=True)
class Call:
    """One call as its handler gets it."""

    panel: Panel
    request: Request
    role: Role
    query: Any = None
    body: Any = None

    @property
    def address(self) -> str:
        """The address of the caller."""
        return self.request.client.host if self.request.client else ""


Handler = Callable[[Call], Awaitable[object]]


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One row of the table."""

    method: str
    path: str
    role: Role
    handler: Handler
    query: type[Query] | None = None
    body: type[Body] | None = None
    takes: str = ""  # media type of a raw body
    gives: str = JSON
    is_open: bool = False  # also without a log-in

    @property
    def text(self) -> str:
        """What it does."""
        return self.handler.__doc__ or ""


ENDPOINTS: list[Endpoint] = []


def endpoint(
    method: str,
    path: str,
    role: Role = Role.VIEW,
    *,
    query: type[Query] | None = None,
    body: type[Body] | None = None,
    takes: str = "",
    gives: str = JSON,
    is_open: bool = False,
) -> Callable[[Handler], Handler]:
    """Declare a call."""

    def declare(handler: Handler) -> Handler:
        ENDPOINTS.append(
            Endpoint(method, path, role, handler, query, body, takes, gives, is_open=is_open)
        )
        return handler

    return declare


def routes(panel: Panel) -> list[BaseRoute]:
    """The routes of all calls."""
    return [
        Route(f"/api{each.path}", _served(panel, each), methods=[each.method]) for each in ENDPOINTS
    ]


def _served(panel: Panel, row: Endpoint) -> Callable[[Request], Awaitable[Response]]:
    async def serve(request: Request) -> Response:
        try:
            role = panel.accounts.role_of(request.cookies.get(panel.cookie))
            if not row.is_open:
                if role is None:
                    raise PanelError("login", "log in first")
                if role < row.role:
                    raise PanelError(
                        "role", f"this needs the role {row.role.word}", needs=row.role.word
                    )
            call = Call(
                panel,
                request,
                role if role is not None else Role.VIEW,
                _query(request, row.query),
                await _body(request, row.body),
            )
            result = await row.handler(call)
        except asyncio.CancelledError:  # at its end the server waits for no card
            return refused(PanelError("busy", ENDS))
        except (OpenacrError, ConnectionLostError) as error:
            return refused(error)
        if isinstance(result, Response):
            return result
        # Long answers take a while; the loop carries the stops of all browsers meanwhile.
        return Response(await run_in_threadpool(_encoded, result), media_type=JSON)

    return serve


def _encoded(result: object) -> bytes:
    return msgspec.json.encode(result, enc_hook=float)  # numbers of arrays are no plain floats


def refused(error: Exception) -> Response:
    """The answer to a call that is refused."""
    return refusal(failure(error))


def refusal(about: dict[str, Any]) -> Response:
    """The answer to a call that is refused, from what browsers get of an error."""
    status = STATUS.get(about["code"], 422)
    return JSONResponse({"error": about}, status_code=status)


def _query(request: Request, kind: type[Query] | None) -> Any:
    given = dict(request.query_params)
    try:
        return msgspec.convert(given, kind or Query, strict=False)
    except msgspec.ValidationError as error:
        raise PanelError("bad", f"{request.url.path}: {error}") from None


async def _body(request: Request, kind: type[Body] | None) -> Any:
    if kind is None:
        return None
    data = await limited(request, MOST_JSON)
    try:
        return msgspec.json.decode(data or b"{}", type=kind, strict=True)
    except (ValueError, RecursionError) as error:
        raise PanelError("bad", f"{request.url.path}: {error}") from None


async def limited(request: Request, most: int) -> bytes:
    """The body of a request; PanelError if it is longer than `most` bytes."""
    parts, size = [], 0
    async for part in request.stream():
        size += len(part)
        if size > most:
            raise PanelError("too_big", f"more than {most} bytes are not taken")
        parts.append(part)
    return b"".join(parts)
