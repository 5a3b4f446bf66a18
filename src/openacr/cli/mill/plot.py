"""`openacr mill plot`: a picture of the tool path of a part program."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import (
    FAILED,
    AtStore,
    Dialect,
    PartProgram,
    in_folder,
    loaded,
    opened_store,
    printable,
    show_findings,
)
from openacr.errors import UserError
from openacr.mill.plan.pictures.quantities import Quantity
from openacr.wording import counted

if TYPE_CHECKING:
    from collections.abc import Sequence

    from openacr.cli.plots.toolpath import Scene
    from openacr.cnc.interpreter.survey import Survey
    from openacr.cnc.program.program import Program
    from openacr.mill.plan.pictures.path_motion import Motion
    from openacr.mill.plan.pictures.tool_path import ToolPath
    from openacr.sysvar import Store

DRAWN = "XYZ"


def plot_program(
    file: PartProgram,
    picture: Annotated[
        Path | None,
        typer.Argument(metavar="[PICTURE]", help="PNG, SVG or HTML file; default: FILE.html."),
    ] = None,
    store: AtStore = None,
    dialect: Dialect = None,
    by_tool: Annotated[
        bool, typer.Option("--by-tool", help="One colour per tool, as Color via D Codes.")
    ] = False,
    is_stock: Annotated[
        bool, typer.Option("--stock", help="Draw what is left of the blank: PNG or SVG.")
    ] = False,
    colour: Annotated[
        Quantity | None,
        typer.Option(help="Colour the path by the motion that is planned: PNG or SVG."),
    ] = None,
) -> None:
    """Draw the tool path of a part program: PNG, SVG or interactive HTML."""
    from openacr.cli.plots.formats import IMAGES, require
    from openacr.cli.run.output import require_different, require_writable, write_whole

    if colour and (is_stock or by_tool):
        raise UserError(
            f"--colour {colour} with --{'stock' if is_stock else 'by-tool'}: "
            "one picture has one of them"
        )
    only = "--stock" if is_stock else "--colour" if colour else ""
    target = picture or file.with_suffix(".png" if only else ".html")
    require(target, *((f"with {only}", IMAGES) if only else ()))
    require_different((file, target))
    require_writable(target)
    if is_stock:
        _plot_stock(file, target, store, dialect)
        return
    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        scene, survey = scene_of(program, cells, name, by_tool=by_tool, colour=colour)
    show_findings(in_folder(survey.findings, file))
    if not len(scene.drawing.kinds):
        if survey.errors:
            raise typer.Exit(FAILED)
        raise UserError(f"{file}: no moves to draw")
    _require_known(file, scene)
    if scene.is_cut:
        typer.echo(f"note: the picture shows the first {scene.point_cnt:,} points", err=True)
    write_whole(target, lambda partial: _draw(scene, partial))
    move_cnt = sum(survey.move_cnts.values()) - survey.move_cnts["dwell"]
    typer.echo(f"{target}: {counted(move_cnt, 'move')}")
    if survey.errors:
        raise typer.Exit(FAILED)


def _draw(scene: "Scene", path: Path) -> None:
    """A scene in the format of the file name."""
    if path.suffix.lower() == ".html":
        from openacr.cli.plots.toolpath_page import write_page as write
    else:
        from openacr.cli.plots.toolpath_image import write_image as write
    write(scene, path)


def _plot_stock(file: Path, target: Path, store: Path | None, dialect: str | None) -> None:
    """Draw what is left of the blank, and name the lines where something is wrong."""
    from openacr.cli.plots.stock_image import write_stock
    from openacr.cli.run.output import write_whole
    from openacr.mill.plan.pictures.removal import removal

    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        found = removal(program, cells, name)
    title = file.name.encode("utf-8", "replace").decode()
    write_whole(target, lambda partial: write_stock(found, title, partial))
    unit = "mm³" if found.is_metric else "inch³"
    typer.echo(f"{target}: {found.stock.removed:.4g} {unit} removed")
    for lines, text in (
        (found.rapid_lines, "a rapid goes through material"),
        (found.below_lines, "the cut goes below the blank"),
    ):
        for line in lines:
            typer.echo(f"{printable(str(file))}:{line}: {text}", err=True)


def scene_of(
    program: "Program",
    cells: "Store",
    dialect: str,
    *,
    by_tool: bool = False,
    colour: Quantity | None = None,
) -> "tuple[Scene, Survey]":
    """The picture of a program, and the survey from reading it."""
    from openacr.cli.plots.toolpath import Scene
    from openacr.cnc.loading.load import axes_of
    from openacr.mill.config.readout import Readout
    from openacr.mill.config.view import View
    from openacr.sysvar.tabs import CONTROL

    letters = axes_of(cells)
    names = tuple(letter for letter in DRAWN if letter in letters)
    axes = tuple(letters[letter] for letter in names)
    if len(axes) < 2:
        raise UserError("two of the axes X, Y and Z are needed for a picture")
    survey, path, motion = _surveyed(program, cells, dialect, axes, colour)
    view = View.of(cells, survey.tools, by_tool=by_tool)
    path.has_tools = view.has_tool_colors
    readout, is_metric = Readout(cells), bool(cells.read(CONTROL.default_units))
    scene = Scene(
        path.finished(),
        Path(program.main.text.name).name.encode("utf-8", "replace").decode(),
        names,
        "mm" if is_metric else "inch",
        low=_of_axes(survey.low, axes),
        high=_of_axes(survey.high, axes),
        view=view,
        digits=tuple(readout.format(axis, is_metric=is_metric).right for axis in axes),
        has_errors=bool(survey.errors),
        is_cut=motion.is_cut if motion else path.is_full,
        motion=motion,
    )
    return scene, survey


def _of_axes(values: "Sequence[float]", axes: tuple[int, ...]) -> tuple[float, ...]:
    """Three values for a picture; a machine without Z is at height 0."""
    return (*(values[axis] for axis in axes), 0.0)[:3]


def _surveyed(
    program: "Program",
    cells: "Store",
    dialect: str,
    axes: tuple[int, ...],
    colour: Quantity | None,
) -> "tuple[Survey, ToolPath, Motion | None]":
    from openacr.cnc.interpreter.interpreter import Options
    from openacr.cnc.interpreter.survey import survey
    from openacr.mill.plan.pictures.tool_path import ToolPath
    from openacr.sysvar.tabs import SPEEDS

    path = ToolPath(axes, cells.read(SPEEDS.chord_tolerance))
    options = Options(watch=path)
    if colour is None:
        return survey(program, cells, dialect, options, look=path.add), path, None
    from openacr.mill.config.settings import Settings
    from openacr.mill.plan.estimate.checking import Watchers, surveyed
    from openacr.mill.plan.pictures.path_motion import PathMotion

    reader = PathMotion(Settings(cells), axes, colour)
    watchers = Watchers(reader, look=path.add)
    found, _ = surveyed(program, cells, dialect, watchers, options=options)
    return found, path, reader.finished()


def _require_known(file: Path, scene: "Scene") -> None:
    """Refuse a picture of a quantity that no move has."""
    from openacr.sysvar.tabs import SPEEDS

    if scene.motion is not None and not scene.motion.known.any():
        raise UserError(
            f"{file}: no move has a planned {scene.motion.quantity}; paths are planned where Path"
            f" jerk (P{SPEEDS.path_jerk}) and a tolerance (G64 P, or P{SPEEDS.path_tolerance})"
            " are above 0"
        )
