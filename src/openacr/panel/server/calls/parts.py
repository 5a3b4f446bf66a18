"""The library of parts, and drawings to import."""

from dataclasses import replace
from typing import Annotated, Any

import msgspec
from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.cnc.parts.library import FOLDER, begins_metric, names, part_named
from openacr.errors import UserError
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.library import ready
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, Query, endpoint
from openacr.panel.server.calls.programs import folder_of
from openacr.panel.work.paths import draw_text
from openacr.sysvar import Store

Height = Annotated[float, Meta(ge=-1e6, le=1e6)]
Above = Annotated[float, Meta(gt=0.0, le=1e6)]
NO_DEPTH = "the path is cut at Z0: set the depth of the cut"


class Sizes(Body, frozen=True):
    """Sizes of a part by cell, `{"P200": 4}`; the others have their defaults."""

    values: dict[str, float] = msgspec.field(default_factory=dict)
    tool: Annotated[int, Meta(ge=0, le=400)] = 0


class OfDrawing(Query, frozen=True):
    """A drawing in the folder of programs."""

    path: str


class Import(Body, frozen=True):
    """How a drawing becomes a program; what is not given is as the store says."""

    path: str
    output: str
    direction: Annotated[int, Meta(ge=0, le=1)] = 0
    layer: Annotated[str, Meta(max_length=256)] = ""
    drill: bool = False
    cut_z: Height | None = None
    safe_height: Height | None = None
    drill_z: Height | None = None
    drill_r: Height | None = None
    feed: Above | None = None
    tool: Annotated[int, Meta(ge=0, le=400)] = 0
    lead: Above | None = None
    replace: bool = False


@endpoint("GET", "/parts")
async def parts(call: Call) -> object:
    """List the parts of the library with their sizes."""

    def read() -> object:
        return {
            "parts": [part_named(name).data() for name in names(FOLDER)],
            "metric": begins_metric(call.panel.installation.store),
        }

    return await run_in_threadpool(read)


@endpoint("POST", "/parts/{name}/path", body=Sizes, gives="application/octet-stream")
async def part_path(call: Call) -> Response:
    """The path of a part with these sizes, as `/api/path` gives it; 422 for sizes that clash."""
    panel = call.panel
    store = panel.installation.store
    name = call.request.path_params["name"]
    text = (await run_in_threadpool(ready, name, call.body.values, store, call.body.tool)).program
    if store.path is None:
        raise UserError("the store is in memory")
    found = await panel.checks.run(draw_text, text, name.upper(), store.path)
    headers = {"Content-Encoding": "gzip", "Cache-Control": "no-store"}
    return Response(found.packed, media_type="application/octet-stream", headers=headers)


@endpoint("GET", "/dxf/layers", query=OfDrawing)
async def layers(call: Call) -> object:
    """The layers of a drawing."""
    file = folder_of(call).file(call.query.path)

    def read() -> object:
        from openacr.cnc.dxf.reading import layers_of

        return {"layers": layers_of(file)}

    return await run_in_threadpool(read)


@endpoint("POST", "/dxf", Role.OPERATE, body=Import)
async def import_drawing(call: Call) -> object:
    """Convert a drawing of the folder to a program of the folder."""
    body: Import = call.body
    folder = folder_of(call)
    file, target = folder.file(body.path), folder.at(body.output)
    if target.exists() and not body.replace:
        raise PanelError("conflict", f"{body.output} is there already")

    def convert() -> object:
        from openacr.cnc.dxf import convert

        conversion = convert(file, _options(body, call.panel.installation.store))
        if body.cut_z is None and not body.drill:
            conversion = replace(conversion, notes=(*conversion.notes, NO_DEPTH))
        try:
            target.write_text(conversion.text, encoding="utf-8", newline="\n")
        except OSError as error:
            raise UserError(f"{target.name} cannot be stored: {error.strerror}") from None
        return {
            "path": body.output,
            "summary": conversion.summary,
            "notes": list(conversion.notes),
            "unit": "mm" if conversion.is_metric else "inch",
            "text": conversion.text[: 1 << 20],
        }

    return await run_in_threadpool(convert)


def _options(body: Import, store: Store) -> Any:
    from openacr.cnc.dxf import Options, Pattern
    from openacr.cnc.parts.library import tool_radius
    from openacr.sysvar.tabs import CONTROL

    def given(value: float | None, cell: int) -> float:
        return store.read(cell) if value is None else value

    return Options(
        pattern=Pattern.DRILL if body.drill else Pattern.PATH,
        is_counter_clockwise=body.direction == 1,
        layer=body.layer,
        is_metric=store.is_metric,
        epsilon=store.read(CONTROL.epsilon_for_compensation),
        safe_height=given(body.safe_height, CONTROL.dxf_safe_height),
        cut_z=body.cut_z or 0.0,
        drill_bottom=given(body.drill_z, CONTROL.dxf_drill_z),
        drill_level=given(body.drill_r, CONTROL.dxf_drill_r),
        drill_feed=given(body.feed, CONTROL.dxf_drill_f),
        feed=body.feed,
        d_number=body.tool,
        radius=tool_radius(store, body.tool) if body.tool else 0.0,
        lead=given(body.lead, CONTROL.default_lead_in_radius),
    )
