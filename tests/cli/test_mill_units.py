"""Reports name the unit of their lengths."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.live import online
from openacr.cli.main import app
from openacr.cli.mill import check
from openacr.sysvar import Store


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("a.nc").write_text("G21 F600 G0 X10\nG1 X60.8 A90\nM2\n")
    with Store(tmp_path / "sysvar.db") as cells:
        cells.write(203_012, 1.0)
    return tmp_path


def mill(*words: str) -> Result:
    result = CliRunner().invoke(app, ["mill", *words])
    assert result.exit_code == 0, result.output
    return result


def test_a_metric_program_is_checked_in_millimetres(store: Path) -> None:
    lines = mill("check", "a.nc").stdout.splitlines()
    assert lines[2:5] == [
        "length: 50.8 mm at feed, 10 mm at rapid",
        "  X: 10.0000 to 60.8000 mm",
        "  A: 0.0000 to 90.0000 deg",
    ]
    data = json.loads(mill("check", "a.nc", "--json").stdout)
    assert data["unit"] == "mm"
    assert data["length"] == pytest.approx({"rapid": 10.0, "feed": 50.8})
    assert data["end"] == pytest.approx({"X": 60.8, "Y": 0.0, "Z": 0.0, "A": 90.0})
    assert data["extents"]["max"] == pytest.approx([60.8, 0.0, 0.0, 90.0])


def test_a_run_names_the_unit_of_its_places(store: Path) -> None:
    text = mill("run", "a.nc").stdout
    assert text.rstrip().endswith("A  90.0000 inch")
    data = json.loads(mill("run", "a.nc", "--json").stdout)
    assert data["unit"] == "inch"
    assert data["end"]["X"] == pytest.approx(60.8 / 25.4, abs=1e-4)
    with Store(store / "sysvar.db") as cells:
        cells.write(850_030, 21)
    assert mill("run", "a.nc").stdout.rstrip().endswith(" mm")
    assert json.loads(mill("run", "a.nc", "--json").stdout)["unit"] == "inch"


def test_a_path_jerk_is_part_of_the_time(store: Path) -> None:
    times: dict[str, list[float]] = {command: [] for command in ("check", "time")}
    for jerk in (0.0, 100.0):
        with Store(store / "sysvar.db") as cells:
            cells.write(650_015, jerk)
        for command, found in times.items():
            assert mill(command, "a.nc").stderr == ""
            found.append(json.loads(mill(command, "a.nc", "--json").stdout)["time_s"])
    run = json.loads(mill("run", "a.nc", "--json").stdout)["time_s"]
    assert times["check"] == times["time"]
    assert times["time"][0] < times["time"][1] == pytest.approx(run, abs=0.02)


def test_a_planned_path_is_timed_with_its_jerk_and_names_the_line_that_costs_most(
    store: Path,
) -> None:
    program = b"G21 G90 G94\nF3000 G64 P0.02\nG1 X10\nX10 Y10\nX0 Y10\nX0 Y0\nM2\n"
    (store / "b.ngc").write_bytes(program)
    with Store(store / "sysvar.db") as cells:
        cells.write(650_015, 400.0)
        cells.write(650_000, 600.0)
    data = json.loads(mill("check", "b.ngc", "--json").stdout)
    assert data["planned"]["moves"] == 4
    assert data["planned"]["line"] in (3, 4, 5, 6)
    assert data["planned"]["lost_s"] == pytest.approx(data["time_s"] - 0.8, abs=0.02)
    assert "planned with tolerance and jerk: 4 moves" in mill("check", "b.ngc").stdout
    run = json.loads(mill("run", "b.ngc", "--json").stdout)
    assert run["time_s"] == pytest.approx(data["time_s"], abs=0.002)


@pytest.mark.parametrize("command", ["check", "time"])
def test_a_terminal_gets_an_estimate_and_the_lines_while_a_path_is_planned(
    command: str, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[tuple[int, int | None]] = []

    @contextmanager
    def bar(title: str) -> Iterator[Callable[[int, int | None], None]]:
        assert title == "b.ngc"
        yield lambda line, total: shown.append((line, total))

    (store / "b.ngc").write_bytes(b"G21 G90 G94 G17\nF3000 G64 P0.02\nG1 X10\nX10 Y10\nX0\nM2\n")
    monkeypatch.setattr(online, "progress_bar", bar)
    cases = ((False, 400.0, ""), (True, 0.0, ""), (True, 400.0, "about 0:0"))
    for is_attended, jerk, said in cases:
        monkeypatch.setattr(check, "is_attended", lambda answer=is_attended: answer)
        with Store(store / "sysvar.db") as cells:
            cells.write(650_015, jerk)
        error = mill(command, "b.ngc").stderr.replace("b.ngc: dialect", "dialect")
        about = [line for line in error.splitlines() if not line.startswith("dialect")]
        assert [line[: len(said)] for line in about] == [said] * bool(said)
        assert shown == ([(3, 6), (4, 6), (5, 6)] if said else [])
