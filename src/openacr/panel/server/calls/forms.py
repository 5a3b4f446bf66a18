"""Forms: pages of settings with their values."""

from starlette.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, Response

from openacr.errors import MapError
from openacr.panel.control.operator.orders import PanelError, RoleError
from openacr.panel.forms.catalogue import FORMS
from openacr.panel.forms.form import Form
from openacr.panel.forms.values import RefusedError, form_data, row_data, save
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.sysvar import Store

MOST_FOUND = 100


class Page(Query, frozen=True):
    """Which axis, and which rows of a long table."""

    axis: int | None = None
    first: int = 1
    count: int = 20


class Values(Body, frozen=True):
    """Values by cell number, written as an operator writes them."""

    values: dict[str, str]


class Search(Query, frozen=True):
    """Words of a name, or a number."""

    text: str


def form_of(call: Call) -> Form:
    """The form in the path of a call."""
    name = call.request.path_params["name"].upper()
    if name not in FORMS:
        raise PanelError("missing", f"there is no form {name}")
    return FORMS[name]


@endpoint("GET", "/forms")
async def forms(call: Call) -> object:
    """List the forms with their titles, menus and roles."""
    return {
        "forms": [
            {
                "name": form.name,
                "title": form.title,
                "section": form.section,
                "role": form.role.word,
                "per_axis": form.is_per_axis,
                "paged": form.is_paged,
                "key": form.key,
                "may_save": call.role >= form.role,
            }
            for form in FORMS.values()
        ]
    }


@endpoint("GET", "/forms/{name}", query=Page)
async def form(call: Call) -> object:
    """Read a form: rows with units, limits, help and values."""
    page: Page = call.query
    chosen, store = form_of(call), call.panel.installation.store

    def read() -> object:
        return form_data(chosen, store, axis=page.axis, first=page.first, count=page.count)

    return await run_in_threadpool(read)


@endpoint("PUT", "/forms/{name}", body=Values)
async def save_form(call: Call) -> Response:
    """Store values of a form: all of them, or none with the reason of each refused one."""
    chosen, store = form_of(call), call.panel.installation.store
    if call.role < chosen.role:
        raise RoleError(chosen.role)
    try:
        stored = await run_in_threadpool(save, chosen, store, call.body.values)
    except RefusedError as error:
        about = {"code": "refused", "text": str(error)}
        return JSONResponse({"stored": {}, "refused": error.refused, "error": about}, 422)
    return JSONResponse({**stored, "refused": {}})


@endpoint("GET", "/settings/search", query=Search)
async def search(call: Call) -> object:
    """Find cells by a number or by words of their name."""
    store = call.panel.installation.store

    def find() -> object:
        try:
            found = store.find(call.query.text)
        except MapError:
            found = []
        places = _places(store)
        return {
            "cells": [
                {**row_data(store, each), "form": places.get(each.number)}
                for each in found[:MOST_FOUND]
                if each.number in places
            ]
        }

    return await run_in_threadpool(find)


def _places(store: Store) -> dict[int, str]:
    """The form of each cell."""
    return {cell: form.name for form in FORMS.values() for cell in form.all_cells(store)}
