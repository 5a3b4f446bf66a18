"""`mill run --trace` and `mill time --trace`: setpoints over time in files."""

import csv
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

PROGRAM = """\
G20 G90
G0 X1
G1 X2 F60

Y1 F30
G4 F0.1
G1 X1.5 Y0.5
M30
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "PART.NC"
    path.write_text(PROGRAM)
    return str(path)


def mill(*words: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *map(str, words)])
    return result.exit_code, result.output


def rows_of(path: Path) -> tuple[list[str], list[list[float]]]:
    with path.open() as file:
        head, *rows = csv.reader(file)
    return head, [[float(text) for text in row] for row in rows]


def test_a_run_writes_setpoints_of_every_servo_period_with_their_lines(
    file: str, tmp_path: Path
) -> None:
    path = tmp_path / "run.csv"
    assert mill("run", file, "--quiet", "--trace", path)[0] == 0
    head, rows = rows_of(path)
    assert head == ["t_s", "x", "y", "z", "line"]
    steps = [b[0] - a[0] for a, b in pairwise(rows)]
    assert steps == pytest.approx([0.0005] * len(steps))
    assert rows[0][0] == pytest.approx(0.0005)
    assert rows[-1][1:] == [1.5, 0.5, 0.0, 7.0]
    # each line is that of the move the setpoint lies on
    for _, x, y, _, line in rows:
        if 0.001 < x < 0.999:
            assert (y, line) == (0.0, 2.0)
        elif 1.001 < x < 1.999 and y == 0.0:
            assert line == 3.0
        elif x == 2.0 and 0.001 < y < 0.999:
            assert line == 5.0
        elif x == y + 1.0 and x < 1.999:
            assert line == 7.0
    assert {row[-1] for row in rows} == {0.0, 2.0, 3.0, 5.0, 7.0}


def test_the_trace_of_the_plan_is_that_of_the_run(file: str, tmp_path: Path) -> None:
    run, plan = tmp_path / "run.csv", tmp_path / "plan.csv"
    assert mill("run", file, "--quiet", "--trace", run)[0] == 0
    code, shown = mill("time", file, "--trace", plan, "--json")
    assert code == 0
    ran, planned = rows_of(run)[1], rows_of(plan)[1]
    assert f'"time_s": {planned[-1][0]:.4f}' in shown
    # between the rests of the program both follow the same curve, from whenever each has begun
    for line in (3.0, 5.0, 7.0):
        along = [[row[:4] for row in rows if row[-1] == line] for rows in (ran, planned)]
        starts = [
            next(
                row[0] for row in part if abs(row[1] - part[0][1]) + abs(row[2] - part[0][2]) > 0.01
            )
            for part in along
        ]
        places = {round((row[0] - starts[0]) / 0.0005): row[1:] for row in along[0]}
        common = [(row, places[k]) for row in along[1]
                  if (k := round((row[0] - starts[1]) / 0.0005)) in places]  # fmt: skip
        assert len(common) > 100
        for row, place in common:
            assert row[1:] == pytest.approx(place, abs=0.001)  # one period at the feed


@pytest.mark.parametrize("command", ["run", "time"])
def test_rows_are_as_far_apart_as_asked(command: str, file: str, tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    assert mill(command, file, "--trace", path, "--every", "0.05")[0] == 0
    times = [row[0] for row in rows_of(path)[1]]
    steps = [b - a for a, b in pairwise(times[:-1])]
    assert steps == pytest.approx([0.05] * len(steps))
    assert len(steps) > 30


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--every", "0.1"), "--every is the time between rows of a trace"),
        (("--trace", "t.csv", "--every", "0"), "--every 0: give a number of seconds above 0"),
        (("--trace", "t.xls"), "t.xls: traces end in .csv or .parquet"),
        (("--trace", "no/t.csv"), "t.csv: cannot be written: there is no folder no"),
    ],
)
@pytest.mark.parametrize("command", ["run", "time"])
def test_a_trace_that_cannot_be_written_is_refused_at_once(
    command: str, options: tuple[str, ...], message: str, file: str,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    code, output = mill(command, file, *options)
    assert (code, message in output) == (2, True)
    assert not (tmp_path / "t.csv").exists()


def test_more_rows_than_servo_periods_are_refused(file: str, tmp_path: Path) -> None:
    code, output = mill("run", file, "--trace", tmp_path / "t.csv", "--every", "0.0001")
    assert code == 2
    assert "a row every 0.0001 s: the servo period is 0.0005 s" in output


def test_a_card_at_a_link_is_not_traced(file: str, tmp_path: Path) -> None:
    code, output = mill("run", file, "--host", "localhost:1", "--trace", tmp_path / "t.csv")
    assert code == 2
    assert "--trace: only the virtual machine records the setpoints" in output
    assert "openacr replay JOURNAL --trace" in output


def test_parquet_without_its_package_is_refused(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    code, output = mill("time", file, "--trace", tmp_path / "t.parquet")
    assert code == 2
    assert "t.parquet: .parquet traces need pyarrow" in output
