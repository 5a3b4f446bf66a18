"""`openacr mill ballscrew`: tables that compensate errors of ballscrews."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AtStore
from openacr.cli.sysvar.change import Password, require_service
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.card.ballscrew import Table
    from openacr.sysvar import Store

OfAxis = Annotated[str, typer.Argument(metavar="AXIS", help="Name of the axis, e.g. X.")]


def import_table(
    axis: OfAxis,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Lines like X1E.00175.")],
    store: AtStore = None,
    password: Password = None,
) -> None:
    """Check the table of an axis, copy it beside the store and switch it on."""
    from openacr.mill.card.ballscrew import read
    from openacr.mill.card.ballscrew_store import keep, summary
    from openacr.sysvar.location import open_to_write
    from openacr.sysvar.tabs import OFFSETS

    with open_to_write(store) as cells:
        number, name = _axis(cells, axis)
        table = read(file, name)
        require_service(cells, [OFFSETS.ballscrew_on[number]], password)
        kept = keep(cells, number, table, is_on=True)
    typer.echo(f"{kept}: {summary(table)}; active from the next start")


def export_table(
    axis: OfAxis,
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="Output file; default: standard output.")
    ] = None,
    store: AtStore = None,
) -> None:
    """Write the ballscrew table of an axis to a file."""
    from openacr.mill.card.ballscrew_store import kept
    from openacr.sysvar.location import open_to_read
    from openacr.sysvar.tabs import OFFSETS

    with open_to_read(store) as cells:
        number, name = _axis(cells, axis)
        table = kept(cells, number, name)
    if table is None:
        raise UserError(f"axis {name} has no ballscrew table (P{OFFSETS.ballscrew_file[number]})")
    _give(table, file)


def make_table(
    axis: OfAxis,
    file: Annotated[
        Path,
        typer.Argument(
            metavar="MEASURED", help="File of positions, each with its measured values."
        ),
    ],
    home: Annotated[float, typer.Option("--home", help="Position of the reference point.")] = 0.0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="Output file; default: standard output."),
    ] = None,
    store: AtStore = None,
) -> None:
    """Compute the table of an axis from measured positions.

    An entry is the setpoint minus the mean of its measured values.
    """
    from openacr.mill.card.ballscrew import measured
    from openacr.sysvar.location import open_to_read

    with open_to_read(store) as cells:
        _, name = _axis(cells, axis)
    _give(measured(file, name, home), out)


def _axis(cells: "Store", axis: str) -> tuple[int, str]:
    """Number and name of a configured axis."""
    from openacr.cnc.loading.load import axes_of

    letters = axes_of(cells)
    name = axis.strip().upper()
    if name not in letters:
        raise UserError(f"axis {axis} is not configured; configured are {' '.join(letters)}")
    return letters[name], name


def _give(table: "Table", file: Path | None) -> None:
    from openacr.cli.run.output import require_writable, write_text
    from openacr.mill.card.ballscrew_store import summary

    if file is None:
        typer.echo(table.text(), nl=False)
        return
    require_writable(file)
    write_text(file, table.text())
    typer.echo(f"{file}: {summary(table)}")
