"""The card: its parameters and flags with their names, operator variables."""

from collections.abc import Iterable, Sequence
from typing import Annotated, TypeVar

from msgspec import Meta
from starlette.concurrency import run_in_threadpool

from openacr.client.names import named
from openacr.client.panels import PANELS, Row, panel_named, record_of
from openacr.client.search import search
from openacr.map import Flag, Parameter, flags, parameters
from openacr.map.block import Access
from openacr.mill.config.pparm import LAST, OperatorParameters
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.sysvar.schema import CARD_VARIABLES

T = TypeVar("T")
MOST = 500
NO_OBJECT = "none"


class Browse(Query, frozen=True):
    """Words of a name, an object (AXIS, MASTER ...; `none`: without one) and its number."""

    text: str = ""
    object: str = ""
    index: int | None = None
    first: Annotated[int, Meta(ge=0)] = 0
    count: Annotated[int, Meta(ge=1, le=MOST)] = 100


class Named(Query, frozen=True):
    """Names or numbers of parameters and flags, with semicolons between them."""

    names: Annotated[str, Meta(max_length=8000)]


class Words(Query, frozen=True):
    """Some words of a name, or a number, and how many are wanted."""

    text: Annotated[str, Meta(max_length=200)]
    count: Annotated[int, Meta(ge=1, le=MOST)] = 20


class Variables(Body, frozen=True):
    """Operator variables by number: {"5": 1.5}."""

    values: dict[str, float]


def _fits(query: Browse, each: Parameter | Flag) -> bool:
    if query.object and (each.object or NO_OBJECT).lower() != query.object.lower():
        return False
    if query.index is not None and each.index != query.index:
        return False
    words = query.text.lower().split()
    index = "" if each.index is None else each.index
    full = f"{each.object}{index} {each.name} {_id(each)}".lower()
    return all(word in full for word in words)


def _id(each: Parameter | Flag) -> str:
    return f"{'BIT' if isinstance(each, Flag) else 'P'}{each.number}"


def data_of(each: Parameter | Flag) -> dict[str, object]:
    """A parameter or flag as the screens show it."""
    common: dict[str, object] = {
        "id": _id(each),
        "number": each.number,
        "name": each.name,
        "object": each.object,
        "index": each.index,
        "section": each.section,
        "doc": each.description,
        "writable": each.access is not Access.READ,
    }
    if isinstance(each, Flag):
        return {**common, "parameter": each.parameter, "bit": each.bit}
    return {**common, "unit": each.unit, "kind": each.kind.name}


@endpoint("GET", "/card/parameters", query=Browse)
async def card_parameters(call: Call) -> object:
    """Find parameters of the card by words, object and number."""
    query: Browse = call.query

    def find() -> object:
        found = [each for each in parameters().values() if _fits(query, each)]
        return {
            "total": len(found),
            "objects": sorted({each.object for each in parameters().values()}),
            "parameters": [data_of(each) for each in _page(query, found)],
        }

    return await run_in_threadpool(find)


@endpoint("GET", "/card/flags", query=Browse)
async def card_flags(call: Call) -> object:
    """Find flags of the card by words, object and number."""
    query: Browse = call.query

    def find() -> object:
        found = [each for each in flags().values() if _fits(query, each)]
        return {"total": len(found), "flags": [data_of(each) for each in _page(query, found)]}

    return await run_in_threadpool(find)


def _page(query: Browse, found: Sequence[T]) -> Sequence[T]:
    return found[query.first : query.first + query.count]


@endpoint("GET", "/card/groups", query=Browse)
async def card_groups(call: Call) -> object:
    """The objects of the card with the counts of the parameters and flags that are found."""
    query: Browse = call.query

    def find() -> object:
        counts: dict[tuple[str, int | None], list[int]] = {}
        tables: tuple[Iterable[Parameter | Flag], ...] = (parameters().values(), flags().values())
        for place, records in enumerate(tables):
            for each in records:
                if _fits(query, each):
                    group = (each.object or NO_OBJECT, each.index)
                    counts.setdefault(group, [0, 0])[place] += 1
        return {
            "groups": [
                {"object": thing, "index": index, "parameters": some, "flags": others}
                for (thing, index), (some, others) in counts.items()
            ]
        }

    return await run_in_threadpool(find)


@endpoint("GET", "/card/named", query=Named)
async def card_named(call: Call) -> object:
    """Parameters and flags by name or number (`P12288;BIT516;axis0.actual position`), in order."""
    names = [name.strip() for name in call.query.names.split(";")]
    return await run_in_threadpool(
        lambda: {"items": [data_of(named(name)) for name in names if name]}
    )


@endpoint("GET", "/card/search", query=Words)
async def card_search(call: Call) -> object:
    """The parameters and flags whose names fit some words best, the best first."""
    query: Words = call.query
    return await run_in_threadpool(
        lambda: {"items": [data_of(each) for each in search(query.text, query.count)]}
    )


# --- panels of status -----------------------------------------------------------------


class OfPanel(Query, frozen=True):
    """A panel by its name."""

    name: str


@endpoint("GET", "/card/panels")
async def card_panels(call: Call) -> object:
    """The panels of status: axes, masters, programs ..."""
    return {"panels": [{"name": each.name, "title": each.title} for each in PANELS]}


@endpoint("GET", "/card/panel", query=OfPanel)
async def card_panel(call: Call) -> object:
    """The rows of a panel with what each of them is of each object; null where it has none."""
    panel = panel_named(call.query.name)

    def row(row: Row) -> dict[str, object]:
        found = [record_of(row, thing) for thing in panel.objects]
        name = row.name.format(object="").strip()
        return {"name": name, "items": [each and data_of(each) for each in found]}

    return await run_in_threadpool(
        lambda: {
            "objects": panel.objects,
            "groups": [
                {"title": group.title, "rows": [row(each) for each in group.rows]}
                for group in panel.groups
            ],
        }
    )


# --- P PARM ---------------------------------------------------------------------------


@endpoint("GET", "/pparm")
async def pparm(call: Call) -> object:
    """The operator variables P0 to P199: those of the card and those of the store."""

    def read(station: Station) -> list[float]:
        session = station.link.required
        on_card = session.machine.read_rows(list(CARD_VARIABLES))
        return [*on_card, *(session.cells.read(n) for n in range(len(CARD_VARIABLES), LAST + 1))]

    values = await call.panel.ask(read)
    return {"values": values}


@endpoint("PUT", "/pparm", Role.OPERATE, body=Variables)
async def write_pparm(call: Call) -> object:
    """Set operator variables, one after the other."""
    try:
        wanted = {int(key.lstrip("Pp")): value for key, value in call.body.values.items()}
    except ValueError:
        raise PanelError("bad", "variables are named by their numbers: {'5': 1.5}") from None

    def write(station: Station) -> dict[str, float]:
        session = station.link.required
        variables = OperatorParameters(session.cells, session.card)
        for number, value in wanted.items():
            variables.write(number, value)
        return {str(number): variables.read(number) for number in wanted}

    return {"values": await call.panel.ask(write)}
