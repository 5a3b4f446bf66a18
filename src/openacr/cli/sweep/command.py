"""`openacr sweep`: run a project many times with other values, and compare what was measured."""

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.cli.sweep.report import Report
    from openacr.sweep.results import Results, Row
    from openacr.sweep.study import Study
    from openacr.workers import Pool

FAILED = 1
INTERRUPTED = 130
MOST_WORKERS = 1024


def sweep(
    file: Annotated[Path, typer.Argument(metavar="FILE.toml", help="The sweep.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Results (.parquet); default: FILE.parquet."),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=1, max=MOST_WORKERS, help="Processes on this computer; default: one for each core."
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Run on the Dask cluster of this scheduler."),
    ] = None,
    is_new: Annotated[
        bool, typer.Option("--new", help="Do all runs, also those in the file of results.")
    ] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw measures against quantities (.png, .svg).")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress and no tables.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Run a project many times with other values, and tabulate what is measured.

    The file names the project, what is varied and what is measured. Results are kept run by
    run: a sweep that was interrupted goes on where it was. Exit code 1: runs failed.
    """
    from openacr.sweep.load import load_sweep

    target = output or file.with_suffix(".parquet")
    _check_outputs(target, plot, workers, scheduler)
    study = load_sweep(file)
    from openacr.sweep.results import Results

    results = Results(target, study, is_new=is_new)
    try:
        wanted = _Wanted(plot, not quiet and not as_json, as_json)
        code = _run(study, results, _pool(workers, scheduler), wanted)
    finally:
        results.close()
    raise typer.Exit(code)


def _check_outputs(
    target: Path, plot: Path | None, workers: int | None, scheduler: str | None
) -> None:
    """Refuse what could not be written, before anything runs."""
    from openacr.cli.run import output

    if target.suffix.lower() != ".parquet":
        raise UserError(f"{target}: results end in .parquet")
    if workers is not None and scheduler is not None:
        raise UserError("--workers and --scheduler exclude each other")
    output.require_different((target, plot))
    output.require_writable(target)
    if plot is not None:
        from openacr.cli.plots import IMAGES, require

        require(plot, "of sweeps", IMAGES)
        output.require_writable(plot)


@dataclass(frozen=True, slots=True)
class _Wanted:
    """What a sweep is to show and write besides its results."""

    plot: Path | None
    is_shown: bool
    as_json: bool


def _run(study: "Study", results: "Results", pool: "Pool", wanted: _Wanted) -> int:
    """Do the runs and say what came out; the exit code."""
    from openacr.cli.signals import terminations_as_interrupts
    from openacr.cli.sweep.progress import progress_for
    from openacr.cli.sweep.report import report_on
    from openacr.sweep.campaign import Campaign, keep_journals

    began_s = time.perf_counter()
    journals: list[Path] = []
    try:
        with terminations_as_interrupts(), pool:
            with progress_for(is_shown=wanted.is_shown) as progress:
                rows = Campaign(study, results, pool, progress).run()
            folder = results.path.with_suffix(".failures")
            keep_journals(study, rows, pool, folder, journals.append)
    except KeyboardInterrupt:
        done = counted(len(results.rows), "run")
        typer.echo(f"interrupted: {done} in {results.path}; the same command goes on", err=True)
        return INTERRUPTED
    wall_s = time.perf_counter() - began_s
    if wanted.plot is not None:
        _draw(study, rows, results.path.stem, wanted.plot)
    report = report_on(study, results.path, rows, progress.found, journals, pool.deaths, wall_s)
    _say(report, wanted)
    return FAILED if report.failed or report.lost else 0


def _pool(workers: int | None, scheduler: str | None) -> "Pool":
    from openacr.workers import ClusterPool, LocalPool

    return LocalPool(workers) if scheduler is None else ClusterPool(scheduler)


def _draw(study: "Study", rows: "list[Row]", title: str, path: Path) -> None:
    from openacr.cli.plots.sweep_image import write_scatter
    from openacr.cli.run.output import write_whole

    write_whole(path, lambda partial: write_scatter(study, rows, title, partial))


def _say(report: "Report", wanted: _Wanted) -> None:
    from openacr.cli.sweep.report import show

    if wanted.as_json:
        typer.echo(json.dumps(report.data(), indent=1))
    elif wanted.is_shown:
        show(report)
