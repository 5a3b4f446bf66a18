"""`openacr mill plot`: a picture of the tool path of a part program."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill import (
    FAILED,
    AtStore,
    Dialect,
    PartProgram,
    loaded,
    opened_store,
    show_findings,
)
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.cnc.program import Program
    from openacr.cnc.survey import Survey
    from openacr.mill.plot import ToolPath
    from openacr.sysvar import Store

DRAWN = "XYZ"
DEFAULT_UNIT, CHORD_TOLERANCE = 250_001, 650_016


def plot_program(
    file: PartProgram,
    picture: Annotated[
        Path | None,
        typer.Argument(
            metavar="[PICTURE]", help="PNG, SVG or HTML file; else FILE.html beside FILE."
        ),
    ] = None,
    store: AtStore = None,
    dialect: Dialect = None,
) -> None:
    """Draw the tool path of a part program: PNG, SVG, or HTML to turn and zoom."""
    from openacr.cli.output import require_writable, write_whole
    from openacr.cli.plots.formats import require
    from openacr.cli.plots.toolpath import Scene, draw_path

    target = picture or file.with_suffix(".html")
    require(target)
    require_writable(target)
    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        survey, path = _surveyed(program, cells, name)
        unit = "mm" if cells.read(DEFAULT_UNIT) else "inch"
    show_findings(survey.findings)
    drawing = path.finished()
    if not len(drawing.kinds):
        raise UserError(f"{file}: nothing moves")
    names = tuple(letter for letter in DRAWN if letter in survey.letters)
    scene = Scene(drawing, file.name, names, unit, has_errors=bool(survey.errors))
    write_whole(target, lambda partial: draw_path(scene, partial))
    typer.echo(f"{target}: {sum(survey.move_cnts.values()) - survey.move_cnts['dwell']} moves")
    if survey.errors:
        raise typer.Exit(FAILED)


def _surveyed(program: "Program", cells: "Store", dialect: str) -> "tuple[Survey, ToolPath]":
    from openacr.cnc.interpreter import Options
    from openacr.cnc.load import axes_of
    from openacr.cnc.survey import survey
    from openacr.mill.plot import ToolPath

    letters = axes_of(cells)
    drawn = tuple(letters[letter] for letter in DRAWN if letter in letters)
    if len(drawn) < 2:
        raise UserError("two of the axes X, Y and Z are needed for a picture")
    path = ToolPath(drawn, cells.read(CHORD_TOLERANCE))
    found = survey(program, cells, dialect, Options(watch=path), look=path.add)
    return found, path
