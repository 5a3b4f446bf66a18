"""What a campaign keeps and repeats: parts, lost runs, journals of failed runs."""

import math
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from tests.sweep.projects import Here, formula_project, rows_of, sweep_file

from openacr.sweep import campaign
from openacr.sweep.campaign import Campaign, Progress, keep_journals
from openacr.sweep.load import load_sweep
from openacr.sweep.results import Results
from openacr.sweep.run import LOST, Outcome

STUDY = '[vary.a]\nparameter = 0\nvalues = [1, 2, 3, 4, 5]\n[measures]\nx = "at_end(P0) ** 2"\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    formula_project(tmp_path / "p")
    return sweep_file(tmp_path, STUDY)


def test_a_resumed_sweep_keeps_the_parts_it_finds(file: Path) -> None:
    path, study = file.with_suffix(".parquet"), load_sweep(file)
    for value in (1.0, 2.0):
        results = Results(path, study)
        results.add((value,), Outcome((value**2,)))
        results.write()
        results.close()
    parts = sorted(each.name for each in path.with_name("study.parquet.parts").glob("0*"))
    assert parts == ["000001.parquet", "000002.parquet"]
    results = Results(path, study)
    assert {point: row.outcome.measures for point, row in results.rows.items()} == {
        (1.0,): (1.0,),
        (2.0,): (4.0,),
    }
    results.close()


def test_what_is_in_a_part_is_newer_than_what_is_in_the_file(file: Path) -> None:
    path, study = file.with_suffix(".parquet"), load_sweep(file)
    results = Results(path, study)
    results.add((1.0,), Outcome((math.nan,), LOST, "the worker process died"))
    results.finish([(1.0,)])
    results.add((1.0,), Outcome((1.0,)))
    results.write()
    results.close()
    results = Results(path, study)
    assert results.rows[1.0,].outcome == Outcome((1.0,))
    results.close()


def test_a_run_that_was_lost_is_done_again(file: Path) -> None:
    path, study = file.with_suffix(".parquet"), load_sweep(file)
    results, progress = Results(path, study), Progress()
    results.add((1.0,), Outcome((math.nan,), LOST, "the worker process died"))
    results.add((2.0,), Outcome((4.0,)))
    with Here() as pool:
        rows = Campaign(study, results, pool, progress).run()
    results.close()
    assert (progress.found, progress.done, progress.total) == (1, 5, 5)
    assert [row.outcome.measures for row in rows] == [(1.0,), (4.0,), (9.0,), (16.0,), (25.0,)]


@dataclass(slots=True)
class Waiting(Progress):
    """Notes how many results are not on disk, and has no clock that asks for them."""

    results: Results | None = None
    counts: list[int] = field(default_factory=list)

    def show(self) -> None:
        assert self.results is not None
        self.counts.append(self.results.waiting)

    def is_due(self) -> bool:
        return False


def test_results_are_written_when_the_most_are_waiting(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign, "MOST_WAITING", 2)
    study = load_sweep(file)
    results = Results(file.with_suffix(".parquet"), study)
    progress = Waiting(results=results)
    with Here() as pool:
        Campaign(study, results, pool, progress).run()
    results.close()
    assert progress.counts == [0, 1, 2, 1, 2, 1]


def test_a_repeated_value_counts_as_done(file: Path) -> None:
    file.write_text(file.read_text().replace("[1, 2, 3, 4, 5]", "[1, 2, 1, 1]"))
    progress = Progress()
    rows = rows_of(file, progress=progress)
    assert (len(rows), progress.total, progress.done, progress.found) == (4, 4, 4, 0)


def test_the_first_failed_runs_have_a_journal_each(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign, "MOST_JOURNALS", 2)
    (file.parent / "p" / "prog0.8k").write_text("PROGRAM\nIF (P0 > 1) THEN P50=1\nENDP\n")
    said: list[Path] = []
    rows = rows_of(file)
    assert [row.outcome.status for row in rows] == ["ok", *["failed"] * 4]
    with Here() as pool:
        keep_journals(load_sweep(file), rows, pool, file.parent / "kept", said.append)
    names = ["run-000001.journal", "run-000002.journal"]
    assert [path.name for path in said] == names
    assert sorted(path.name for path in (file.parent / "kept").iterdir()) == names
