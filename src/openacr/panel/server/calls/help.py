"""Help texts, and the description of this interface."""

from starlette.concurrency import run_in_threadpool

from openacr.errors import MapError
from openacr.panel.commands.all import COMMANDS
from openacr.panel.control.orders import PanelError
from openacr.panel.helps import HELPS
from openacr.panel.server.api import ENDPOINTS, Call, endpoint
from openacr.panel.server.openapi import document
from openacr.sysvar.lookup import known
from openacr.sysvar.values import accepted


@endpoint("GET", "/help")
async def help_keys(call: Call) -> object:
    """The keys of all help texts, with their titles."""
    return {"keys": {key: title for key, (title, _text) in HELPS.items()}}


@endpoint("GET", "/help/{key}")
async def help_text(call: Call) -> object:
    """The help text of a menu, a command, or a cell by its number."""
    key = call.request.path_params["key"]
    if key in HELPS:
        title, text = HELPS[key]
        return {"title": title, "text": text}
    if key in COMMANDS:
        return {"title": key, "text": (COMMANDS[key].do.__doc__ or "").strip()}
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
