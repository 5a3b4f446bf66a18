"""`--trace` of `mill run` and `mill time`: setpoints of the axes over time, as CSV or Parquet.

The columns are `t_s` (seconds since the start), the axes by their names in small letters
(setpoints in the units of the machine) and `line` (of the program; 0 before its first move).
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Rows = NDArray[np.float64]

ToTrace = Annotated[
    Path | None,
    typer.Option("--trace", help="Write setpoints and lines over time (.csv, .parquet)."),
]
Every = Annotated[
    float | None,
    typer.Option(
        "--every",
        metavar="SECONDS",
        help="Time between rows of the trace; default: the servo period.",
    ),
]


def require_trace(path: Path | None, every_s: float | None) -> None:
    """Refuse a trace that cannot be written, before anything is read or moved."""
    from openacr.cli.run import output

    if path is None:
        if every_s is not None:
            raise UserError("--every is the time between rows of a trace: give --trace as well")
        return
    if every_s is not None and not 0.0 < every_s < float("inf"):
        raise UserError(f"--every {every_s:g}: give a number of seconds above 0")
    output.require_trace(path)
    output.require_writable(path)


@contextmanager
def trace_file(path: Path, axes: Sequence[str]) -> "Iterator[Callable[[Rows], None]]":
    """Open a trace for rows; the file is moved into place at the end, however it ends."""
    from openacr.cli.run import output

    names = ["t_s", *(name.lower() for name in axes), "line"]
    writer = _csv if path.suffix.lower() == ".csv" else _parquet
    with output.replacing(path) as partial, writer(partial, names) as write:

        def guarded(rows: "Rows") -> None:
            try:
                write(rows)
            except OSError as error:  # a full disk
                raise unwritable(path, error) from None

        yield guarded


@contextmanager
def _csv(path: Path, names: list[str]) -> "Iterator[Callable[[Rows], None]]":
    # Nine digits are finer than a pulse of any axis, and a tick of days of run.
    form = ",".join(["%.9g"] * (len(names) - 1) + ["%d"]) + "\n"
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write(",".join(names) + "\n")
        yield lambda rows: file.writelines(form % tuple(row) for row in rows.tolist())


@contextmanager
def _parquet(path: Path, names: list[str]) -> "Iterator[Callable[[Rows], None]]":
    import pyarrow
    import pyarrow.parquet

    kinds = [pyarrow.float64()] * (len(names) - 1) + [pyarrow.int64()]
    schema = pyarrow.schema(list(zip(names, kinds, strict=True)))

    def table(rows: "Rows") -> Any:
        columns = [*rows.T[:-1], rows[:, -1].astype(int)]
        return pyarrow.table(dict(zip(names, columns, strict=True)), schema)

    with pyarrow.parquet.ParquetWriter(path, schema) as file:
        yield lambda rows: file.write_table(table(rows))
