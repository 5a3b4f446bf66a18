"""`openacr dxf`: a DXF drawing as an AcroBASIC program of moves."""

from math import isfinite
from pathlib import Path
from typing import Annotated

import typer

from openacr.errors import UserError

EPSILON = {False: 0.002, True: 0.05}  # inches, millimetres
OUTPUTS = range(32, 4096)
PROGRAMS = range(8)  # whose masters have the flags that end a program


def convert_drawing(
    file: Annotated[Path, typer.Argument(metavar="DRAWING.dxf", help="Drawing.")],
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="progN.8k", help="Program, for PROGN.")
    ] = Path("prog0.8k"),
    layer: Annotated[str, typer.Option("--layer", help="Only this layer; default: all.")] = "",
    is_ccw: Annotated[
        bool, typer.Option("--ccw", help="Closed chains counter-clockwise; default: clockwise.")
    ] = False,
    is_inch: Annotated[
        bool, typer.Option("--inch", help="A drawing that states no unit is in inches, not mm.")
    ] = False,
    epsilon: Annotated[
        float | None,
        typer.Option("--epsilon", help="Ends closer than this are joined; 0.05 mm or 0.002 inch."),
    ] = None,
    axes: Annotated[str, typer.Option("--axes", help="Names of the axes.")] = "X,Y,Z",
    feed: Annotated[
        float | None, typer.Option("--vel", help="VEL along the path; default: of the set-up.")
    ] = None,
    rapid: Annotated[
        float | None, typer.Option("--rapid", help="VEL between the chains; default: as before.")
    ] = None,
    ramp: Annotated[
        float | None,
        typer.Option("--acc", help="ACC, DEC and STP; with it the path only stops at corners."),
    ] = None,
    safe_height: Annotated[
        float | None, typer.Option("--safe-height", help="Z between chains, with --cut-z.")
    ] = None,
    cut_z: Annotated[
        float | None, typer.Option("--cut-z", help="Z of the path, with --safe-height.")
    ] = None,
    output: Annotated[
        int | None, typer.Option("--output", metavar="BIT", help="On while a path is cut.")
    ] = None,
    is_forced: Annotated[
        bool, typer.Option("--force", help="Overwrite an existing program.")
    ] = False,
) -> None:
    """Convert a DXF drawing to an AcroBASIC program of coordinated moves."""
    from openacr.cli.run.output import require_absent, require_writable, write_text
    from openacr.cnc.dxf import Options, convert_to_moves
    from openacr.cnc.dxf.motion import MotionMachine
    from openacr.project import Place, place_of

    place, number = place_of(out)
    if place is not Place.PROGRAM or number not in PROGRAMS:
        raise UserError(f"{out}: name the program prog0.8k to prog7.8k, for its PROG level")
    if (safe_height is None) is not (cut_z is None):
        raise UserError("--safe-height and --cut-z belong together: give both, or neither")
    if output is not None and output not in OUTPUTS:
        raise UserError(f"--output {output}: it must be a bit, {OUTPUTS[0]} to {OUTPUTS[-1]}")
    levels = None
    if safe_height is not None and cut_z is not None:
        levels = finite("--safe-height", safe_height), finite("--cut-z", cut_z)
    require_absent(out, is_forced=is_forced)
    require_writable(out)
    options = Options(
        is_counter_clockwise=is_ccw,
        layer=layer,
        is_metric=not is_inch,
        epsilon=positive("--epsilon", EPSILON[not is_inch] if epsilon is None else epsilon),
    )
    machine = MotionMachine(
        program=number,
        axes=_names(axes, 2 if levels is None else 3),
        feed=_rate("--vel", feed),
        rapid=_rate("--rapid", rapid),
        ramp=_rate("--acc", ramp),
        levels=levels,
        output=output,
    )
    conversion = convert_to_moves(file, options, machine)
    write_text(out, conversion.text)
    for note in conversion.notes:
        typer.echo(f"note: {note}", err=True)
    unit = "mm" if conversion.is_metric else "inch"
    typer.echo(f"{out}: {conversion.summary}, in {unit}")


def _names(text: str, needed: int) -> tuple[str, ...]:
    names = tuple(name.strip() for name in text.split(","))
    if len(names) < needed or not all(name.isalpha() for name in names):
        raise UserError(f"--axes {text}: give {needed} names of letters, like X,Y,Z")
    return names


def finite(option: str, value: float) -> float:
    """The value of an option that may be any number; UserError for infinity and NaN."""
    if not isfinite(value):
        raise UserError(f"{option} {value:g}: it must be a number")
    return value


def positive(option: str, value: float) -> float:
    """The value of an option that must be a number above 0; UserError."""
    if not 0.0 < value < float("inf"):
        raise UserError(f"{option} {value:g}: it must be above 0")
    return value


def _rate(option: str, value: float | None) -> float | None:
    return None if value is None else positive(option, value)
