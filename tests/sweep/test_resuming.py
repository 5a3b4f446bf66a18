"""A sweep that was ended goes on where it was; its file is never damaged."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pyarrow as arrow
import pyarrow.parquet as parquet
import pytest
from tests.sweep.projects import Here, axis_project, formula_project, rows_of, sweep_file

from openacr.errors import UserError
from openacr.sweep.campaign import Campaign, Progress
from openacr.sweep.load import load_sweep
from openacr.sweep.results import Results

ROOT = Path(__file__).parents[2]
FEW = """
[vary.a]
parameter = 0
values = [1, 2]
[measures]
x = "at_end(P0) ** 2"
"""
MANY = """
duration_s = 4
[vary.gain]
line = "AXIS2 PGAIN {}"
range = [0.01, 0.05]
steps = 100
[measures]
worst = "max(abs(AXIS2.following_error))"
counts = "at_end(P12802)"
"""
PATIENCE_S = 100.0


def test_a_sweep_that_is_killed_goes_on_with_the_runs_that_are_missing(tmp_path: Path) -> None:
    axis_project(tmp_path / "p")
    file = sweep_file(tmp_path, MANY)
    command = [sys.executable, "-m", "openacr.cli.main", "sweep", str(file), "--workers", "1"]
    parts = tmp_path / "study.parquet.parts"
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE) as process:
        end_s = time.monotonic() + PATIENCE_S
        while len(list(parts.glob("0*.parquet"))) < 1:
            assert time.monotonic() < end_s
            assert process.poll() is None
            time.sleep(0.005)
        process.kill()
    kept = sum(parquet.read_table(path).num_rows for path in parts.glob("0*.parquet"))
    assert 1 <= kept < 100
    assert not (tmp_path / "study.parquet").exists()
    again = subprocess.run([*command, "--json"], cwd=ROOT, capture_output=True, check=True)
    report = json.loads(again.stdout)
    assert (report["runs"], report["ok"], report["found"]) == (100, 100, kept)
    assert not parts.exists()
    table = parquet.read_table(tmp_path / "study.parquet")
    rows_of(file, output=tmp_path / "whole.parquet")
    assert table.equals(parquet.read_table(tmp_path / "whole.parquet"))


def found_of(file: Path, **options: bool) -> tuple[int, int]:
    """How many runs a sweep has, and how many of them were in its file."""
    study, progress = load_sweep(file), Progress()
    results = Results(file.with_suffix(".parquet"), study, **options)
    try:
        with Here() as pool:
            rows = Campaign(study, results, pool, progress).run()
    finally:
        results.close()
    return len(rows), progress.found


def test_a_run_that_is_in_the_file_is_not_done_again(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, FEW)
    assert found_of(file) == (2, 0)
    assert found_of(file) == (2, 2)
    assert found_of(file, is_new=True) == (2, 0)
    file.write_text(file.read_text().replace("[1, 2]", "[1, 3, 2, 1]"))
    assert found_of(file) == (4, 2)
    assert parquet.read_table(tmp_path / "study.parquet").column("x").to_pylist() == [1, 9, 4]


def test_results_of_other_values_stay_after_those_of_the_design(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, FEW)
    rows_of(file)
    file.write_text(file.read_text().replace("[1, 2]", "[5, 2]"))
    assert found_of(file) == (2, 1)
    assert parquet.read_table(tmp_path / "study.parquet").column("a").to_pylist() == [5, 2, 1]


@pytest.mark.parametrize(
    ("old", "new"),
    [("** 2", "** 3"), ("parameter = 0", "parameter = 1"), ("[vary.a]", "every_tk = 2\n[vary.a]"),
     ("[vary.a]", "duration_s = 3\n[vary.a]"), ("[vary.a]", "until = 516\n[vary.a]")],
)  # fmt: skip
def test_results_of_another_sweep_are_refused(tmp_path: Path, old: str, new: str) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, FEW)
    rows_of(file)
    before = (tmp_path / "study.parquet").read_bytes()
    file.write_text(file.read_text().replace(old, new))
    with pytest.raises(UserError, match=r"study\.parquet: results of another sweep: project,"):
        rows_of(file)
    assert (tmp_path / "study.parquet").read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p", "study.parquet", "study.toml"]


def test_a_changed_program_makes_it_another_sweep(tmp_path: Path) -> None:
    project = formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, FEW)
    rows_of(file)
    (project / "prog0.8k").write_text("PROGRAM\nP5=1\nENDP\n")
    with pytest.raises(UserError, match="results of another sweep"):
        rows_of(file)


def test_a_changed_device_makes_it_another_sweep(tmp_path: Path) -> None:
    project = axis_project(tmp_path / "p")
    (project / "gripper.py").write_text("WIDTH = 1\n")
    file = sweep_file(tmp_path, FEW)
    rows_of(file)
    (project / "gripper.py").write_text("WIDTH = 2\n")
    with pytest.raises(UserError, match="results of another sweep"):
        rows_of(file)


@pytest.mark.parametrize("content", [b"", b"PAR1 no table PAR1", b"a,b\n1,2\n"])
def test_a_file_that_is_not_of_results_is_refused_and_kept(tmp_path: Path, content: bytes) -> None:
    formula_project(tmp_path / "p")
    path = tmp_path / "study.parquet"
    path.write_bytes(content)
    with pytest.raises(UserError, match=r"study\.parquet: not a file of results \(--new writes"):
        rows_of(sweep_file(tmp_path, FEW))
    assert path.read_bytes() == content


def test_a_table_of_another_program_is_refused(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    parquet.write_table(arrow.table({"a": [1.0]}), tmp_path / "study.parquet")
    with pytest.raises(UserError, match="results of another sweep"):
        rows_of(sweep_file(tmp_path, FEW))


def test_a_file_has_one_writer_at_a_time(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    file = sweep_file(tmp_path, FEW)
    first = Results(tmp_path / "study.parquet", load_sweep(file))
    with pytest.raises(UserError, match=r"study\.parquet: another sweep is writing it"):
        rows_of(file)
    first.close()
    assert len(rows_of(file)) == 2
