"""Log-in, log-out, who am I."""

import asyncio
import time
from math import ceil
from typing import Annotated, Literal
from urllib.parse import parse_qs

from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, RedirectResponse, Response

from openacr.panel.control.operator.orders import PanelError
from openacr.panel.roles import Role
from openacr.panel.server.accounts import LASTS_S
from openacr.panel.server.api import Body, Call, endpoint

Secret = Annotated[str, Meta(max_length=256)]
_one_at_a_time = asyncio.Lock()


class LogIn(Body, frozen=True):
    """A role and its password."""

    role: Literal["view", "operate", "setup", "service"]
    password: Secret


async def log_in(call: Call, role: Role, password: str) -> str:
    """Check a password; the token of the session, PanelError where it is wrong."""
    accounts, now_s = call.panel.accounts, time.monotonic()
    if (wait_s := accounts.delays.wait_s(call.address, now_s)) > 0.0:
        raise PanelError("slow", f"too many wrong passwords: wait {ceil(wait_s)} s")
    async with _one_at_a_time:
        is_right = await run_in_threadpool(accounts.is_right, role, password)
    if not is_right:
        accounts.note_failure(role, call.address, now_s)
        raise PanelError("login", f"that is not the password of the role {role.word}")
    return accounts.begin(role, call.address, now_s)


def _with_cookie(call: Call, answer: Response, token: str) -> Response:
    is_secure = call.request.url.scheme == "https"
    answer.set_cookie(
        call.panel.cookie,
        token,
        max_age=round(LASTS_S),
        httponly=True,
        samesite="strict",
        secure=is_secure,
    )
    return answer


@endpoint("POST", "/login", body=LogIn, is_open=True)
async def login(call: Call) -> Response:
    """Log in with a role and its password; the answer sets the cookie of the session."""
    role = Role.of(call.body.role)
    token = await log_in(call, role, call.body.password)
    return _with_cookie(call, JSONResponse({"role": role.word}), token)


@endpoint("POST", "/login/form", takes="application/x-www-form-urlencoded", is_open=True)
async def login_form(call: Call) -> Response:
    """Log in from a plain form with the fields `role` and `password`; leads to the screens."""
    from openacr.panel.server.api import limited

    fields = parse_qs((await limited(call.request, 4096)).decode("utf-8", "replace"))
    try:
        role = Role.of(fields.get("role", ["operate"])[0])
        token = await log_in(call, role, fields.get("password", [""])[0][:256])
    except (PanelError, ValueError):
        return RedirectResponse("/login?wrong=1", status_code=303)
    return _with_cookie(call, RedirectResponse("/", status_code=303), token)


@endpoint("POST", "/logout", is_open=True)
async def logout(call: Call) -> Response:
    """End the session of this cookie; its connections end with it."""
    token = call.request.cookies.get(call.panel.cookie)
    if token:
        call.panel.accounts.end(token)
        for connection in [c for c in call.panel.connections if c.token == token]:
            connection.drop(4401, "logged out")
    answer = JSONResponse({})
    answer.delete_cookie(call.panel.cookie)
    return answer


@endpoint("GET", "/me", is_open=True)
async def me(call: Call) -> dict[str, object]:
    """The role of the caller, and whether a log-in is needed."""
    panel = call.panel
    role = panel.accounts.role_of(call.request.cookies.get(panel.cookie))
    return {
        "role": role.word if role is not None else None,
        "roles": [each.word for each in Role if role is not None and each <= role],
        "login": panel.accounts.are_asked,
    }
