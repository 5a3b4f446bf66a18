"""What is said of a sweep at its end: counts, measures, and what matters."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer

from openacr.lang.characters import shown
from openacr.sweep.results import Row
from openacr.sweep.run import FAILED, LOST, OK
from openacr.sweep.sensitivity import what_matters
from openacr.sweep.study import Study
from openacr.wording import counted

MOST_ERRORS = 5
COLUMNS = 100


@dataclass(frozen=True, slots=True)
class Report:
    """The outcome of a sweep."""

    path: Path
    runs: int
    found: int  # in the file when the sweep began
    ok: int
    failed: int
    lost: int
    simulated_s: float
    wall_s: float
    deaths: int
    journals: list[Path]
    errors: list[str]  # of the first failed runs
    measures: dict[str, dict[str, float | None]]
    matters: dict[str, dict[str, dict[str, float | None]]]
    best: dict[str, float] | None

    def data(self) -> dict[str, Any]:
        """The report as JSON data."""
        return {
            "results": str(self.path),
            "runs": self.runs,
            "found": self.found,
            "ok": self.ok,
            "failed": self.failed,
            "lost": self.lost,
            "simulated_s": round(self.simulated_s, 6),
            "wall_s": round(self.wall_s, 3),
            "worker_deaths": self.deaths,
            "journals": [str(path) for path in self.journals],
            "errors": self.errors,
            "measures": self.measures,
            "what_matters": self.matters,
            "best": self.best,
        }


def report_on(
    study: Study,
    path: Path,
    rows: list[Row],
    found: int,
    journals: list[Path],
    deaths: int,
    wall_s: float,
) -> Report:
    """Collect the outcome of all runs."""
    states = [row.outcome.status for row in rows]
    table = np.array([row.outcome.measures for row in rows], dtype=float)
    errors = [f"run {n}: {row.outcome.error}" for n, row in enumerate(rows) if row.outcome.error]
    return Report(
        path,
        len(rows),
        found,
        states.count(OK),
        states.count(FAILED),
        states.count(LOST),
        sum(row.outcome.time_s for row in rows),
        wall_s,
        deaths,
        journals,
        errors[:MOST_ERRORS],
        {name: _spread(table[:, k]) for k, name in enumerate(study.measures)},
        what_matters(study, [row.point for row in rows], table),
        _best(study, rows),
    )


def _spread(values: Any) -> dict[str, float | None]:
    usable = values[np.isfinite(values)]
    if not len(usable):
        return dict.fromkeys(("min", "mean", "max", "sigma"))
    return {
        "min": float(usable.min()),
        "mean": float(usable.mean()),
        "max": float(usable.max()),
        "sigma": float(usable.std()),
    }


def _best(study: Study, rows: list[Row]) -> dict[str, float] | None:
    """Quantities and measures of the best trial of a search; None of other sweeps."""
    if study.optimise is None:
        return None
    name = study.optimise.minimise or study.optimise.maximise or ""
    sign = 1.0 if study.optimise.minimise else -1.0
    column = list(study.measures).index(name)
    usable = [
        row
        for row in rows
        if row.outcome.status == OK and math.isfinite(row.outcome.measures[column])
    ]
    if not usable:
        return None
    best = min(usable, key=lambda row: sign * row.outcome.measures[column])
    numbers = (*best.point, *best.outcome.measures)
    return dict(zip((*study.quantities, *study.measures), numbers, strict=True))


def show(report: Report) -> None:
    """Print the report as tables."""
    from rich.console import Console

    console = Console(width=max(COLUMNS, Console().width))
    typer.echo(
        f"{counted(report.runs, 'run')}: {report.ok} ok, {report.failed} failed,"
        f" {report.lost} lost, {report.found} found in the file;"
        f" {report.simulated_s:.6g} s simulated in {report.wall_s:.3g} s"
    )
    _table(console, "measure", report.measures)
    for measure, found in report.matters.items():
        _table(console, f"what matters for {measure}", found)
    if report.best is not None:
        best: dict[str, dict[str, float | None]] = {
            name: {"best": value} for name, value in report.best.items()
        }
        _table(console, "best run", best)
    typer.echo(f"results: {report.path}")
    if report.deaths:
        deaths = counted(report.deaths, "worker process")
        typer.echo(f"note: died: {deaths}; what they did was done again", err=True)
    for error in report.errors:
        typer.echo(f"failed: {shown(error)}", err=True)
    for path in report.journals[:1]:
        journals = counted(len(report.journals), "journal")
        typer.echo(f"{journals} in {path.parent}: openacr replay {path}", err=True)


def _table(console: Any, title: str, rows: dict[str, dict[str, float | None]]) -> None:
    from rich.table import Table

    heads = next(iter(rows.values()), {})
    table = Table(title, *(head.replace("_", " ") for head in heads), box=None, pad_edge=False)
    for name, values in rows.items():
        table.add_row(name, *("-" if v is None else f"{v:.6g}" for v in values.values()))
    console.print(table)
