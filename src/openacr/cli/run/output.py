"""The files a run writes: checked before the run, written whole or not at all after it.

A trace has one row per recorded tick: `time_s`, then for every axis n that has a master or has
moved `axis_n_commanded`, `axis_n_actual` (units), `axis_n_velocity` (units/s) and
`axis_n_following_error` (units), then what `--watch` names (`P12290` in its own unit, `BIT516`
as 0 or 1).
"""

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    from openacr.cli.plots import Curves
    from openacr.cli.plots.curves import Array

TRACE_FORMATS = (".csv", ".parquet")


def require_writable(path: Path) -> None:
    """Refuse a file that could not be written, without touching what is there."""
    if path.is_dir():
        raise UserError(f"{path}: cannot be written: it is a folder")
    if not path.parent.is_dir():
        raise UserError(f"{path}: cannot be written: there is no folder {path.parent}")
    existed = path.exists()
    try:
        with path.open("ab"):
            pass
    except OSError as error:
        raise unwritable(path, error) from None
    if not existed:
        path.unlink()


def require_absent(path: Path, *, is_forced: bool) -> None:
    """Refuse to overwrite a file without --force; a terminal or pipe is written to."""
    if path.is_file() and not is_forced:
        raise UserError(f"{path} is there already (--force overwrites it, -o names another)")


def require_different(paths: Iterable[Path | None]) -> None:
    """Refuse to write two results into one file."""
    seen: set[Path] = set()
    for path in paths:
        if path is None:
            continue
        if path.resolve() in seen:
            raise UserError(f"{path}: two results cannot go into one file")
        seen.add(path.resolve())


def require_trace(path: Path) -> None:
    """Refuse a trace of a kind that cannot be written here."""
    suffix = path.suffix.lower()
    if suffix not in TRACE_FORMATS:
        raise UserError(f"{path}: traces end in {' or '.join(TRACE_FORMATS)}")
    if suffix == ".parquet" and find_spec("pyarrow") is None:
        raise UserError(
            f"{path}: .parquet traces need pyarrow: pip install pyarrow; a .csv trace needs nothing"
        )


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A file beside `path` that takes its place at the end, also after an interrupt or an error."""
    if path.exists() and not path.is_file():  # a terminal, a pipe, /dev/null
        yield path
        return
    partial = path.with_name(f".{path.stem}.partial{path.suffix}")
    try:
        yield partial
    finally:
        if partial.exists():
            try:
                os.replace(partial, path)
            except OSError as error:
                raise unwritable(path, error) from None


def write_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Let `write` fill a file beside `path` that takes its place when it is complete."""
    if path.exists() and not path.is_file():  # a terminal, a pipe, /dev/null
        write(path)
        return
    partial = path.with_name(f".{path.stem}.partial{path.suffix}")
    try:
        write(partial)
        os.replace(partial, path)
    except OSError as error:
        raise unwritable(path, error) from None
    finally:
        with suppress(OSError):
            partial.unlink()


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all."""
    write_whole(path, lambda partial: _write_bytes(partial, text.encode()))


def write_summary(path: Path, summary: dict[str, Any]) -> None:
    """Write the summary as indented JSON."""
    write_text(path, summary_text(summary))


def _write_bytes(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def summary_text(summary: dict[str, Any]) -> str:
    """Give the summary as indented JSON."""
    import msgspec

    return msgspec.json.format(msgspec.json.encode(summary), indent=2).decode() + "\n"


def write_trace(path: Path, curves: "Curves") -> None:
    """Write the recorded curves as CSV or Parquet."""
    is_csv = path.suffix.lower() == ".csv"
    write_whole(path, lambda partial: (_write_csv if is_csv else _write_parquet)(partial, curves))


def trace_columns(curves: "Curves") -> Iterator[tuple[str, "Array"]]:
    """Name the columns of a trace."""
    from openacr.controller.trace import QUANTITIES

    yield "time_s", curves.time_s
    for axis in curves.used:
        values = (axis.commanded_u, axis.actual_u, axis.velocity_ups, axis.following_error_u)
        for quantity, column in zip(QUANTITIES, values, strict=True):
            yield f"axis_{axis.number}_{quantity}", column
    for one in curves.watched:
        yield one.watched.column, one.values


def _write_csv(path: Path, curves: "Curves") -> None:
    columns = dict(trace_columns(curves))
    # Nine digits keep every count of a position below 1e9, ten every 32-bit word; repr of a
    # float would double the file.
    watched = len(curves.watched)
    form = ",".join(["%.9g"] * (len(columns) - watched) + ["%.10g"] * watched)
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    with path.open("w", encoding="ascii", newline="\n") as file:
        lines = (form % row for row in rows)
        file.writelines(f"{line}\n" for line in chain([",".join(columns)], lines))


def _write_parquet(path: Path, curves: "Curves") -> None:
    import pyarrow
    import pyarrow.parquet

    pyarrow.parquet.write_table(pyarrow.table(dict(trace_columns(curves))), path)
