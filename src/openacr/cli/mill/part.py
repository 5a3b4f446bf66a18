"""`openacr mill part`: part programs from the parts library."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.printing import print_json, print_rich
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.cnc.parts.library import Ready
    from openacr.cnc.parts.part import Part
    from openacr.cnc.state.hosts import Cells

INCH, MM = "inch", "mm"


def complete_part(incomplete: str) -> list[str]:
    """Names of supplied parts with this beginning, for completion."""
    from openacr.cnc.parts.library import names

    return [name for name in names() if name.startswith(incomplete.upper())]


def make_part(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            help="Part; without it all parts are listed.",
            autocompletion=complete_part,
        ),
    ] = None,
    sizes: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="SIZE=VALUE", help="P200=4, 'length in x=4', P200=100mm."),
    ] = None,
    is_shown: Annotated[
        bool, typer.Option("--show", help="Describe the sizes instead of printing the program.")
    ] = False,
    is_asked: Annotated[
        bool, typer.Option("--ask", help="Ask for every size not given with --set.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE.TXT", help="Write the program to a file."),
    ] = None,
    tool: Annotated[
        int, typer.Option("--tool", metavar="D", help="Radius offset D; 0: from CMP RAD.")
    ] = 0,
    feed: Annotated[
        float | None, typer.Option("--feed", help="F; default: from the run set-up, or Cut Speed.")
    ] = None,
    unit: Annotated[
        str | None, typer.Option("--unit", metavar="inch|mm", help="Unit of the program.")
    ] = None,
    library: Annotated[
        Path | None, typer.Option("--library", metavar="FOLDER", help="Folder of other parts.")
    ] = None,
    store: Annotated[
        Path | None, typer.Option("--store", metavar="PATH", help="Store with the defaults.")
    ] = None,
    is_forced: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print parts, sizes or values as JSON.")
    ] = False,
) -> None:
    """List the parts of the library, or generate the program of one."""
    from openacr.cli.run.output import require_absent, require_writable
    from openacr.cnc.parts.library import FOLDER, names, part_named

    folder = library or FOLDER
    if name is None:
        _list([part_named(each, folder) for each in names(folder)], as_json)
        return
    part = part_named(name, folder)
    if out is not None:
        require_writable(out)
        require_absent(out, is_forced=is_forced)
    if is_shown:
        _show(part, as_json)
        return
    given = dict(_given(part, text) for text in sizes or [])
    if is_asked:
        given |= _asked(part, given)
    ready = _ready(part, given, tool, feed, unit, store)
    if out is not None:
        _write(out, ready)
    elif as_json:
        print_json(_values(ready))
    else:
        typer.echo(ready.program, nl=False)


def _ready(
    part: "Part",
    given: dict[int, float],
    tool: int,
    feed: float | None,
    unit: str | None,
    store: Path | None,
) -> "Ready":
    from openacr.cnc.parts.library import prepared
    from openacr.sysvar.location import open_to_read

    with open_to_read(store) as cells:
        is_metric = _is_metric(unit, cells)
        return prepared(part, given, cells, is_metric=is_metric, d_number=tool, feed=feed)


def _is_metric(unit: str | None, cells: "Cells") -> bool:
    from openacr.cnc.parts.library import begins_metric

    if unit is None:
        return begins_metric(cells)
    if unit not in (INCH, MM):
        raise UserError(f"unit {unit!r} is neither {INCH} nor {MM}")
    return unit == MM


def _given(part: "Part", text: str) -> tuple[int, float]:
    """Cell and value of `P200=4`, the value in the unit of the size."""
    from openacr.cnc.parts.library import LENGTHS, in_unit

    name, sign, value = text.partition("=")
    if not sign:
        raise UserError(f"--set {text}: write SIZE=VALUE, e.g. P200=4")
    size = part.size(name)
    number = value.strip().lower()
    unit = next((each for each in LENGTHS if number.endswith(each)), size.unit)
    try:
        if unit != size.unit and size.unit not in LENGTHS:
            raise ValueError
        return size.cell, in_unit(float(number.removesuffix(unit)), unit, size.unit)
    except ValueError:
        raise UserError(f"--set {text}: {size} takes {size.accepted}") from None


def _asked(part: "Part", given: dict[int, float]) -> dict[int, float]:
    """Ask for the sizes that were not given; a wrong answer is asked again."""
    answers = {}
    for size in part.sizes:
        while size.cell not in given and size.cell not in answers:
            question = f"P{size.cell} {size.text} ({size.accepted})"
            text = typer.prompt(question, default=f"{size.default:g}", err=True)
            try:
                cell, value = _given(part, f"P{size.cell}={text}")
            except UserError as error:
                typer.echo(f"error: {error}", err=True)
                continue
            if size.low <= value <= size.high:
                answers[cell] = value
            else:
                typer.echo(f"error: {size} = {value:g} ({size.accepted})", err=True)
    return answers


def _list(parts: list["Part"], as_json: bool) -> None:
    if as_json:
        print_json([{"name": part.name, "title": part.title} for part in parts])
        return
    from rich.box import SIMPLE
    from rich.table import Table

    table = Table("Part", "Description", "Sizes", box=SIMPLE)
    for part in parts:
        table.add_row(part.name, part.title, str(len(part.sizes)))
    print_rich(table)


def _show(part: "Part", as_json: bool) -> None:
    if as_json:
        print_json(part.data())
        return
    from rich.box import SIMPLE
    from rich.table import Table

    typer.echo(f"{part.name}: {part.title}")
    if part.start:
        typer.echo(f"starts at: {part.start}")
    table = Table("Cell", "Size", "Default", "Allowed", box=SIMPLE)
    for size in part.sizes:
        table.add_row(f"P{size.cell}", size.text, f"{size.default:g}", size.accepted)
    print_rich(table)
    for rule in part.rules:
        typer.echo(f"  must hold: {rule.text}")


def _values(ready: "Ready") -> dict[str, Any]:
    return {
        "name": ready.part.name,
        "unit": MM if ready.is_metric else INCH,
        "values": {f"P{cell}": value for cell, value in ready.values.items()},
        "program": ready.program,
    }


def _write(out: Path, ready: "Ready") -> None:
    from openacr.cli.run.output import write_text

    write_text(out, ready.program)
    typer.echo(f"{out}: {ready.part.title}")
