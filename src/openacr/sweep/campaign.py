"""All runs of a sweep: those that are not done yet, on the workers of a pool."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from openacr.errors import unwritable
from openacr.sweep import design, optimising
from openacr.sweep.results import Results, Row, is_to_be_done
from openacr.sweep.run import FAILED, LOST, Outcome, Task, perform
from openacr.sweep.study import Point, Study
from openacr.workers import Done, Pool

MOST_WAITING = 1000  # results in memory that are not on disk
MOST_JOURNALS = 20


@dataclass(slots=True)
class Progress:
    """What a campaign reports while it runs; a caller with a clock overrides it."""

    total: int = 0
    done: int = 0  # of these, runs found in the file included
    found: int = 0  # in the file

    def show(self) -> None:
        """The counts have changed."""

    def is_due(self) -> bool:
        """Whether what is not on disk is to be written now."""
        return True


@dataclass(slots=True)
class Campaign:
    """A sweep being done."""

    study: Study
    results: Results
    pool: Pool
    progress: Progress = field(default_factory=Progress)

    def run(self) -> list[Row]:
        """Do all runs; the rows in their order. What is done is on disk also after an interrupt."""
        try:
            points = self._optimise() if self.study.optimise else self._sweep()
        finally:
            self.results.write()
        self.results.finish(points)
        return [self.results.rows[point] for point in points]

    def _sweep(self) -> list[Point]:
        points = design.points(self.study.quantities, self.study.design)
        self.progress.total = len(points)
        self._do(points)
        return points

    def _optimise(self) -> list[Point]:
        """Trials in batches of a size of its own: any number of workers finds the same."""
        search = optimising.Search(self.study)
        self.progress.total = search.trials
        points: list[Point] = []
        while batch := search.ask():
            self._do(batch)
            search.answer([self._wanted(self.results.rows[point]) for point in batch])
            points += batch
        return points

    def _wanted(self, row: Row) -> float:
        """The measure that is searched for; NaN of a run that failed."""
        optimise = self.study.optimise
        name = optimise and (optimise.minimise or optimise.maximise)
        if row.outcome.status != "ok" or not name:
            return math.nan
        return row.outcome.measures[list(self.study.measures).index(name)]

    def _do(self, points: Sequence[Point]) -> None:
        """Do those of these runs that are not in the file."""
        chosen = list(dict.fromkeys(points))
        missing = [point for point in chosen if is_to_be_done(self.results.rows.get(point))]
        repeated = len(points) - len(chosen)
        self.progress.found += len(chosen) - len(missing)
        self.progress.done += len(chosen) - len(missing) + repeated
        self.progress.show()
        tasks = (Task(number, point, self.study) for number, point in enumerate(missing))
        for task, outcome in self._outcomes(tasks):
            self.results.add(task.point, outcome)
            self.progress.done += 1
            self.progress.show()
            if self.results.waiting >= MOST_WAITING or self.progress.is_due():
                self.results.write()

    def _outcomes(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Outcome]]:
        for each in self.pool.results(perform, tasks):
            if isinstance(each, Done):
                yield each.task, each.result
            else:
                none = (math.nan,) * len(self.study.measures)
                yield each.task, Outcome(none, LOST, each.reason)


def keep_journals(
    study: Study, rows: list[Row], pool: Pool, folder: Path, say: Callable[[Path], None]
) -> None:
    """Do the first failed runs again with a journal of each, into a folder: `openacr replay`."""
    failed = [number for number, row in enumerate(rows) if row.outcome.status == FAILED]
    tasks = [
        Task(number, rows[number].point, study, is_journalled=True)
        for number in failed[:MOST_JOURNALS]
    ]
    for each in pool.results(perform, tasks):
        if isinstance(each, Done) and each.result.journal:
            path = folder / f"run-{each.task.number:06}.journal"
            try:
                folder.mkdir(exist_ok=True)
                path.write_bytes(each.result.journal)
            except OSError as error:
                raise unwritable(path, error) from None
            say(path)
