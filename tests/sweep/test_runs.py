"""A run of a sweep is the run of a card with these values, to the count."""

from pathlib import Path

import numpy as np
import pyarrow.parquet as parquet
import pytest
from tests.sweep.projects import axis_project, formula_project, rows_of, sweep_file

from openacr import Controller
from openacr.engine.samples import sample_of_flag
from openacr.plant.describe.load import load_world
from openacr.sweep.load import load_sweep
from openacr.sweep.run import Task, loaded, perform
from openacr.sweep.targets import project_of

STUDY = """
duration_s = 0.4
[vary.inertia]
machine = "AXIS2.motor.inertia_kgm2"
values = [2e-5, 6e-5]
[vary.far]
define = "DISTANCE"
values = [2, 1.25]
[vary.gain]
line = "AXIS2 PGAIN {}"
values = [0.02, 0.05]
[vary.ratio]
parameter = 12839
values = [0, 1]
[measures]
worst = "max(abs(AXIS2.following_error))"
top = "max(AXIS2.velocity)"
place = "at_end(AXIS2.actual)"
counts = "at_end(P12802)"
moving = "duration(BIT516)"
seen = "ever(BIT20)"
entered = "first_time(BIT20)"
stiff = "gain / inertia"
"""


def by_hand(folder: Path, inertia: float, far: float, gain: float) -> dict[str, float]:
    """The same run with files that were edited, on a card of its own."""
    other = folder / f"by-hand-{inertia}-{far}-{gain}"
    other.mkdir()
    for path in (folder / "p").iterdir():
        text = path.read_text().replace("2.0e-5", repr(inertia))
        (other / path.name).write_text(text.replace("DISTANCE 2", f"DISTANCE {far:g}"))
    card = Controller.from_project(other, world=load_world(other / "machine.toml"))
    card.send(f"SYS\rAXIS2 PGAIN {gain!r}\r")
    card.record(samples=[sample_of_flag(516)])
    card.send("SYS\rRUN ALL\r")
    entered = []
    for tick in range(1, 801):
        card.advance(1)
        if card.bit[20]:
            entered.append(tick)
    trace = card.trace()
    axis = trace.axes[2]
    return {
        "worst": float(np.abs(axis.following_error_u).max()),
        "top": float(axis.velocity_ups.max()),
        "place": card.axis(2).actual_u,
        "counts": float(card.p[12802]),
        "moving": float(trace.values.sum()) * 0.0005,
        "seen": float(bool(entered)),
        "entered": entered[0] * 0.0005 if entered else float("nan"),
        "stiff": gain / inertia,
    }


def test_every_run_equals_the_same_run_by_hand_to_the_count(tmp_path: Path) -> None:
    axis_project(tmp_path / "p")
    file = sweep_file(tmp_path, STUDY)
    rows = rows_of(file)
    assert len(rows) == 16
    assert len({row.outcome.measures[0] for row in rows}) == 8  # of inertia, distance and gain
    names = list(load_sweep(file).measures)
    for row in rows[::2]:
        inertia, far, gain, _ = row.point
        found = dict(zip(names, row.outcome.measures, strict=True))
        expected = by_hand(tmp_path, inertia, far, gain)
        assert found.pop("entered") == pytest.approx(expected.pop("entered"), abs=1e-9, nan_ok=True)
        assert found.pop("moving") == pytest.approx(expected.pop("moving"), abs=1e-9)
        assert found == expected
        assert (row.outcome.status, row.outcome.end) == ("ok", "time")
        assert row.outcome.time_s == pytest.approx(0.4, abs=1e-9)


def test_a_run_does_not_depend_on_the_runs_before_it_in_its_process(tmp_path: Path) -> None:
    axis_project(tmp_path / "p")
    study = load_sweep(sweep_file(tmp_path, STUDY))
    first, other = (2e-5, 2.0, 0.02, 0.0), (2e-5, 2.0, 0.05, 1.0)
    alone = perform(Task(0, first, study))
    perform(Task(1, other, study))
    assert perform(Task(2, first, study)) == alone


def test_the_parquet_file_has_a_row_for_each_run_in_the_order_of_the_design(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    rows_of(
        sweep_file(
            tmp_path,
            "[vary.a]\nparameter = 0\nvalues = [3, 1]\n[vary.b]\nparameter = 1\n"
            'range = [0, 1]\nsteps = 3\n[measures]\nboth = "at_end(P0) * 10 + at_end(P1)"\n',
        )
    )
    table = parquet.read_table(tmp_path / "study.parquet")
    assert table.column_names == ["a", "b", "both", "status", "end", "time_s", "error"]
    assert table.column("a").to_pylist() == [3, 3, 3, 1, 1, 1]
    assert table.column("b").to_pylist() == [0, 0.5, 1, 0, 0.5, 1]
    assert table.column("both").to_pylist() == [30, 30.5, 31, 10, 10.5, 11]
    assert set(table.column("status").to_pylist()) == {"ok"}
    assert set(table.column("end").to_pylist()) == {"idle"}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p", "study.parquet", "study.toml"]


@pytest.mark.parametrize(
    ("end", "status", "why", "error"),
    [
        ("until = 516\nduration_s = 5", "ok", "bit", ""),
        ("until = -516\nduration_s = 5", "ok", "bit", ""),
        ('until = "idle"', "ok", "idle", ""),
        ("duration_s = 0.05", "ok", "time", ""),
        ("until = 40\nduration_s = 0.05", "failed", "time",
         "BIT40 set was not reached within 0.05 s"),
    ],
)  # fmt: skip
def test_a_run_ends_as_a_run_of_a_project_ends(
    tmp_path: Path, end: str, status: str, why: str, error: str
) -> None:
    axis_project(tmp_path / "p")
    text = f'{end}\n[vary.d]\ndefine = "DISTANCE"\nvalues = [1]\n[measures]\nt = "end_time"\n'
    (row,) = rows_of(sweep_file(tmp_path, text))
    assert (row.outcome.status, row.outcome.end, row.outcome.error) == (status, why, error)
    assert row.outcome.measures[0] == row.outcome.time_s > 0.0


def test_a_program_that_ends_in_an_error_is_a_failed_run_with_its_line(tmp_path: Path) -> None:
    project = formula_project(tmp_path / "p")
    (project / "prog0.8k").write_text("PROGRAM\nIF (P0 = 2) THEN P50=1\nENDP\n")
    text = '[vary.a]\nparameter = 0\nvalues = [1, 2]\n[measures]\nx = "at_end(P0)"\n'
    good, bad = rows_of(sweep_file(tmp_path, text))
    assert good.outcome.status == "ok"
    assert bad.outcome.status == "failed"
    assert bad.outcome.error == f"PROG0: Undefined variable ({project / 'prog0.8k'}:2)"
    assert bad.outcome.measures == (2.0,)


def test_an_expectation_of_the_scenario_that_is_not_met_fails_the_run(tmp_path: Path) -> None:
    project = formula_project(tmp_path / "p")
    (project / "scenario.toml").write_text(
        'duration_s = 0.1\n[[at]]\ntime_s = 0.0\nsend = "PROG0\\rP9=P0+1\\r"\n'
        "[[expect]]\nname = 'small'\nparameter = 9\nbelow = 3\n"
    )
    text = '[vary.a]\nparameter = 0\nvalues = [1, 2]\n[measures]\nx = "at_end(P9)"\n'
    file = sweep_file(tmp_path, text)
    good, bad = rows_of(file)
    assert (good.outcome.status, good.outcome.measures) == ("ok", (2.0,))
    assert (bad.outcome.status, bad.outcome.measures) == ("failed", (3.0,))
    assert bad.outcome.error.startswith("expectation: small: expected")
    (tmp_path / "study.parquet").unlink()
    file.write_text(f'scenario = "none"\n{file.read_text()}')
    assert [row.outcome.measures for row in rows_of(file)] == [(0.0,), (0.0,)]


def test_a_line_that_a_value_makes_wrong_fails_that_run_alone(tmp_path: Path) -> None:
    project = axis_project(tmp_path / "p")
    (project / "prog0.8k").write_text("PROGRAM\nDWL 0.01\nENDP\n")
    (project / "setup.8k").write_text(SETUP_WITH_MEMORY)
    text = '[vary.m]\ndefine = "MOST"\nvalues = [4, 20]\n[measures]\nx = "end_time"\n'
    rows = rows_of(sweep_file(tmp_path, text))
    assert [row.outcome.status for row in rows] == ["ok", "failed"]
    assert f"{project / 'setup.8k'}:6: " in rows[1].outcome.error


SETUP_WITH_MEMORY = """SYS
DIM PROG0(4096)
DIM P(16)
DIM DEF(10)
#DEFINE MOST 4
P(MOST)=1
"""


def test_each_define_of_the_name_is_replaced_and_no_other(tmp_path: Path) -> None:
    project = axis_project(tmp_path / "p")
    (project / "plc0.8k").write_text("#define  distance   2\n")
    (project / "prog0.8k").write_text(
        "#DEFINE DISTANCETWO 2\n" + (project / "prog0.8k").read_text()
    )
    text = '[vary.d]\ndefine = "DISTANCE"\nvalues = [1.5]\n[measures]\nx = "end_time"\n'
    study = load_sweep(sweep_file(tmp_path, text))
    sources = {each.path.name: each.text for each in project_of(study, (1.5,)).sources}
    assert "#DEFINE DISTANCE 1.5\n" in sources["setup.8k"]
    assert sources["plc0.8k"] == "#define  distance   1.5\n"
    assert "#DEFINE DISTANCETWO 2\n" in sources["prog0.8k"]
    assert loaded(study, (1.5,)).axis(2).actual_u == 0.0
