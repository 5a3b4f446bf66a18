"""`openacr sweep` as a user sees it."""

import json
import shutil
from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from tests.sweep.projects import formula_project, sweep_file
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.sweep.load import load_sweep
from openacr.sweep.run import Task, perform

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = """
[vary.a]
parameter = 0
values = [1, 2, 4]
[vary.b]
parameter = 1
values = [5, 3]
[measures]
product = "at_end(P0) * at_end(P1)"
none = "first_time(P0 > 9)"
"""


def run(*words: object, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["sweep", *map(str, words)])
    assert result.exit_code == code, result.output
    return result.output


def test_the_report_counts_runs_and_has_measures_and_what_matters(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, STUDY)
    picture = tmp_path / "x.png"
    report = json.loads(run(file, "--workers", 1, "--json", "--plot", picture))
    assert {key: report[key] for key in ("runs", "found", "ok", "failed", "lost")} == {
        "runs": 6, "found": 0, "ok": 6, "failed": 0, "lost": 0,
    }  # fmt: skip
    assert report["results"] == str(tmp_path / "study.parquet")
    assert report["measures"]["product"] == {
        "min": 3.0, "mean": pytest.approx(28 / 3), "max": 20.0,
        "sigma": pytest.approx((119 - (28 / 3) ** 2) ** 0.5),
    }  # fmt: skip
    assert report["measures"]["none"] == dict.fromkeys(("min", "mean", "max", "sigma"))
    assert report["what_matters"]["product"]["a"]["rank_correlation"] > 0.7
    assert report["best"] is None
    assert picture.read_bytes()[:4] == b"\x89PNG"
    text = run(file)
    assert "6 runs: 6 ok, 0 failed, 0 lost, 6 found in the file; " in text
    assert f"results: {tmp_path / 'study.parquet'}" in text
    assert run(file, "--quiet") == ""


def test_failed_runs_are_named_and_their_journals_can_be_replayed(tmp_path: Path) -> None:
    project = formula_project(tmp_path / "p")
    (project / "prog0.8k").write_text("PROGRAM\nIF (P0 = 2) THEN P50=1\nENDP\n")
    text = run(sweep_file(tmp_path, STUDY), "--workers", 1, code=1)
    assert "6 runs: 4 ok, 2 failed, 0 lost" in text
    assert f"failed: run 2: PROG0: Undefined variable ({project / 'prog0.8k'}:2)" in text
    journals = sorted((tmp_path / "study.failures").iterdir())
    assert [path.name for path in journals] == ["run-000002.journal", "run-000003.journal"]
    replayed = CliRunner().invoke(app, ["replay", str(journals[0])])
    assert replayed.exit_code == 0, replayed.output


def test_a_search_shows_its_best_run(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    text = '[optimise]\nmaximise = "product"\ntrials = 9\n' + STUDY
    report = json.loads(run(sweep_file(tmp_path, text), "--workers", 1, "--json"))
    assert report["runs"] == 9
    best = report["best"]
    assert best["product"] == best["a"] * best["b"] == report["measures"]["product"]["max"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("-o", "x.csv"), "error: x.csv: results end in .parquet"),
        (("--workers", "2", "--scheduler", "x"), "error: --workers and --scheduler exclude each"),
        (("--plot", "x.html"), "error: x.html: pictures of sweeps end in .png or .svg"),
        (("--plot", "x.pdf"), "error: x.pdf: pictures of sweeps end in .png or .svg"),
        (("-o", "nowhere/x.parquet"), "error: nowhere/x.parquet: cannot be written: there is no"),
    ],
)
def test_what_cannot_be_written_is_refused_before_anything_runs(
    tmp_path: Path, words: tuple[str, ...], message: str
) -> None:
    formula_project(tmp_path / "p")
    text = run(sweep_file(tmp_path, STUDY), *words, code=2)
    assert text.startswith(message)
    assert not (tmp_path / "study.parquet").exists()


def test_a_mistake_in_the_file_is_also_an_object(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, STUDY.replace("[1, 2, 4]", '"x"'))
    result = CliRunner().invoke(app, ["sweep", str(file), "--json"])
    assert result.exit_code == 2
    (error,) = json.loads(result.stdout)["errors"]
    assert (error["line"], error["column"]) == (5, 1)
    assert error["message"] == 'vary.a.values is "x"; it must be a list of values, each a number'


@pytest.mark.parametrize("name", ["gains", "best", "tolerances"])
def test_a_sweep_of_the_examples_can_be_run(tmp_path: Path, name: str) -> None:
    shutil.copytree(EXAMPLES / "tuning", tmp_path / "tuning")
    study = load_sweep(tmp_path / "tuning" / f"{name}.toml")
    tuned = {"pgain": 0.05, "dgain": 0.00021, "ffvel": 1.5e-6, "ffacc": 1.99e-7, "rotor": 2e-5,
             "friction": 0.0077}  # fmt: skip
    outcome = perform(Task(0, tuple(tuned[each] for each in study.quantities), study))
    assert (outcome.status, outcome.error, outcome.time_s) == ("ok", "", 2.5)
    measures = dict(zip(study.measures, outcome.measures, strict=True))
    assert 1.0 < measures["worst"] < 4.0  # 2 counts in step 10 of the session, which has FFVEL


def test_the_file_of_results_is_made_where_it_is_named(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    target = tmp_path / "other.parquet"
    run(sweep_file(tmp_path, STUDY), "-o", target, "--workers", 1, "--quiet")
    assert parquet.read_table(target).num_rows == 6
    assert not (tmp_path / "study.parquet").exists()
