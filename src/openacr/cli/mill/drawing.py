"""`openacr mill import`: a DXF drawing as a part program."""

from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.drawing import finite, positive
from openacr.cli.printing import print_json
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.cnc.dxf import Conversion, Options
    from openacr.sysvar import Store

NO_DEPTH = "the path is cut at Z0: set the depth with --cut-z"


class Direction(StrEnum):
    """Direction around closed chains, by name or by its number in the guide."""

    CW = "cw"
    CCW = "ccw"
    ZERO = "0"
    ONE = "1"


def import_drawing(
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FILE.dxf]",
            help="Drawing; without it the drawings here are listed.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FILE.TXT", help="Program; default: beside the drawing."
        ),
    ] = None,
    is_drill: Annotated[
        bool, typer.Option("--drill", help="Drill points and circle centres instead of cutting.")
    ] = False,
    direction: Annotated[
        Direction,
        typer.Option(
            "--direction", help="Direction of closed chains: 0 = cw, 1 = ccw.", show_choices=True
        ),
    ] = Direction.CW,
    layer: Annotated[str, typer.Option("--layer", help="Only this layer; default: all.")] = "",
    epsilon: Annotated[
        float | None, typer.Option("--epsilon", help="Ends closer than this are joined.")
    ] = None,
    safe_height: Annotated[
        float | None, typer.Option("--safe-height", help="Z between chains and holes.")
    ] = None,
    cut_z: Annotated[
        float | None, typer.Option("--cut-z", help="Z of the path; default: 0, the surface.")
    ] = None,
    drill_z: Annotated[float | None, typer.Option("--drill-z", help="Bottom of holes.")] = None,
    drill_r: Annotated[float | None, typer.Option("--drill-r", help="R level of holes.")] = None,
    feed: Annotated[
        float | None, typer.Option("--feed", help="F of the path, or of the holes.")
    ] = None,
    tool: Annotated[
        int,
        typer.Option("--tool", metavar="D", help="Compensate closed chains for radius D; 0: off."),
    ] = 0,
    lead: Annotated[
        float | None, typer.Option("--lead", help="Radius of lead-in and lead-out, with --tool.")
    ] = None,
    store: Annotated[
        Path | None, typer.Option("--store", metavar="PATH", help="Store with the defaults.")
    ] = None,
    is_asked: Annotated[
        bool, typer.Option("--ask", help="Ask for the name of the program.")
    ] = False,
    is_forced: Annotated[
        bool, typer.Option("--force", help="Overwrite an existing program.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Convert a DXF drawing to a part program: a path, or holes to drill."""
    from openacr.cli.run.output import require_absent, require_writable, write_text
    from openacr.cnc.dxf import Options, Pattern, convert
    from openacr.cnc.parts.library import tool_radius
    from openacr.sysvar.location import open_to_read
    from openacr.sysvar.tabs import CONTROL

    if file is None:
        _list_drawings(as_json)
        return
    target = out or file.with_suffix(".TXT")
    if is_asked:
        target = _asked(target)
    require_absent(target, is_forced=is_forced)
    require_writable(target)
    with open_to_read(store) as cells:
        options = Options(
            pattern=Pattern.DRILL if is_drill else Pattern.PATH,
            is_counter_clockwise=direction in (Direction.CCW, Direction.ONE),
            layer=layer,
            is_metric=cells.is_metric,
            epsilon=positive("--epsilon", _given(epsilon, cells, CONTROL.epsilon_for_compensation)),
            safe_height=finite(
                "--safe-height", _given(safe_height, cells, CONTROL.dxf_safe_height)
            ),
            cut_z=finite("--cut-z", cut_z or 0.0),
            drill_bottom=finite("--drill-z", _given(drill_z, cells, CONTROL.dxf_drill_z)),
            drill_level=finite("--drill-r", _given(drill_r, cells, CONTROL.dxf_drill_r)),
            drill_feed=positive("--feed", _given(feed, cells, CONTROL.dxf_drill_f)),
            feed=None if feed is None else positive("--feed", feed),
            d_number=tool,
            radius=tool_radius(cells, tool) if tool else 0.0,
            lead=positive("--lead", _given(lead, cells, CONTROL.default_lead_in_radius)),
        )
    conversion = convert(file, options)
    write_text(target, conversion.text)
    if cut_z is None and not is_drill:
        conversion = replace(conversion, notes=(*conversion.notes, NO_DEPTH))
    _report(conversion, options, target, as_json)


def _list_drawings(as_json: bool) -> None:
    """The drawings of the present folder, whatever the case of their suffix."""
    found = sorted(path.name for path in _files(Path(), ".DXF"))
    if as_json:
        print_json(found)
        return
    for name in found:
        typer.echo(name)
    if not found:
        typer.echo("there are no drawings (*.dxf) here")


def _asked(target: Path) -> Path:
    """Ask for the name of the program, after listing the existing ones."""
    there = sorted(path.name for path in _files(target.parent, ".TXT"))
    if there:
        typer.echo(f"existing: {', '.join(there)}", err=True)
    name = typer.prompt("Name of the program", default=target.name, err=True)
    return target.with_name(name if Path(name).suffix else f"{name}.TXT")


def _files(folder: Path, suffix: str) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if path.suffix.upper() == suffix]
    except OSError as error:
        raise UserError(f"{folder}: cannot be read: {(error.strerror or '').lower()}") from None


def _given(value: float | None, cells: "Store", n: int) -> float:
    return cells.read(n) if value is None else value


def _report(conversion: "Conversion", options: "Options", target: Path, as_json: bool) -> None:
    unit = "mm" if conversion.is_metric else "inch"
    if as_json:
        record = {
            "program": str(target),
            "pattern": options.pattern.value,
            "unit": unit,
            "summary": conversion.summary,
            "notes": conversion.notes,
        }
        print_json(record)
        return
    for note in conversion.notes:
        typer.echo(f"note: {note}", err=True)
    typer.echo(f"{target}: {conversion.summary}, in {unit}")
