"""Help texts, and the description of this interface."""

from typing import Literal

from starlette.concurrency import run_in_threadpool

from openacr.errors import MapError
from openacr.panel.commands.all import COMMANDS
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.helps import HELPS, Page
from openacr.panel.server.api import ENDPOINTS, Call, Query, endpoint
from openacr.panel.server.openapi import document
from openacr.sysvar.lookup import known
from openacr.sysvar.values import accepted


class OfLanguage(Query, frozen=True):
    """A language of the screens."""

    language: Literal["en", "de"] = "en"


def _pages() -> dict[str, Page]:
    """All pages by their keys: those of screens, and those of commands."""
    of_commands = (row.page for row in COMMANDS.values() if row.page is not None)
    return {page.key: page for page in (*HELPS, *of_commands)}


@endpoint("GET", "/help", query=OfLanguage)
async def help_keys(call: Call) -> object:
    """The keys of all help texts, with their titles."""
    language = call.query.language
    pages = {key: page.data(language)["title"] for key, page in _pages().items()}
    named = {row.name: row.titles[language] for row in COMMANDS.values() if row.titles}
    return {"keys": pages | named}


@endpoint("GET", "/help/{key}", query=OfLanguage)
async def help_text(call: Call) -> object:
    """The help text of a menu, a command, or a cell by its number.

    Those of commands and cells are in English in every language.
    """
    key = call.request.path_params["key"]
    if (page := _pages().get(key)) is not None:
        return page.data(call.query.language)
    if key in COMMANDS:
        row = COMMANDS[key]
        return {"title": row.titles.get(call.query.language, key), "text": row.text}
    if key.lstrip("Pp").isdecimal():
        store = call.panel.installation.store
        try:
            found = known(int(key.lstrip("Pp")))
        except MapError as error:
            raise PanelError("missing", str(error)) from None
        words = accepted(found, store.is_metric, store.letter_of(found))
        return {"title": str(found), "text": f"{found.row.doc}\n\nIt takes {words}."}
    raise PanelError("missing", f"there is no help on {key}")


@endpoint("GET", "/openapi.json", is_open=True)
async def openapi(call: Call) -> object:
    """The interface as an OpenAPI document, made from the handlers."""
    return await run_in_threadpool(lambda: document(ENDPOINTS, COMMANDS.values()))
