"""`openacr mill ballscrew`: tables that compensate errors of ballscrews."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AtStore
from openacr.cli.sysvar.change import Password, require_service
from openacr.errors import UserError
from openacr.wording import counted

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
    from openacr.cli.run.output import require_writable, write_text
    from openacr.mill.card.ballscrew import read
    from openacr.sysvar.location import open_to_write
    from openacr.sysvar.tabs import OFFSETS

    with open_to_write(store) as cells:
        number, name = _axis(cells, axis)
        table = read(file, name)
        require_service(cells, [OFFSETS.ballscrew_on[number]], password)
        kept = _folder(cells) / f"ballscrew_{name}.txt"
        require_writable(kept)
        write_text(kept, table.text())
        with cells.transaction():
            cells.write_text(OFFSETS.ballscrew_file[number], kept.name)
            cells.write(OFFSETS.ballscrew_on[number], 1)
    typer.echo(f"{kept}: {_summary(table)}; active from the next start")


def export_table(
    axis: OfAxis,
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="Output file; default: standard output.")
    ] = None,
    store: AtStore = None,
) -> None:
    """Write the ballscrew table of an axis to a file."""
    from openacr.mill.card.ballscrew import read
    from openacr.sysvar.location import open_to_read
    from openacr.sysvar.tabs import OFFSETS

    with open_to_read(store) as cells:
        number, name = _axis(cells, axis)
        kept = cells.read_text(OFFSETS.ballscrew_file[number])
        if not kept:
            raise UserError(
                f"axis {name} has no ballscrew table (P{OFFSETS.ballscrew_file[number]})"
            )
        table = read(_folder(cells) / kept, name)
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


def _folder(cells: "Store") -> Path:
    """Beside the store; the folder one stands in for one that is not made yet."""
    return cells.path.parent if cells.path else Path()


def _give(table: "Table", file: Path | None) -> None:
    from openacr.cli.run.output import require_writable, write_text

    if file is None:
        typer.echo(table.text(), nl=False)
        return
    require_writable(file)
    write_text(file, table.text())
    typer.echo(f"{file}: {_summary(table)}")


def _summary(table: "Table") -> str:
    first, last = table.entries[0][0], table.entries[-1][0]
    positions = counted(len(table.entries), "position")
    largest = max(abs(error) for _, error in table.entries)
    return f"{positions} from {first:g} to {last:g}, largest error {largest:g}"
