"""`openacr run`: when it ends, what it says and writes, and what it refuses beforehand."""

import json
import os
import pty
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.cli.run.command import MOST_S, limit_s
from openacr.cli.run.controlled import ControlledMachine
from openacr.controller import Controller
from openacr.project import find_project
from openacr.units import quantity

Run = Callable[..., Result]


AXIS = ("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS2 "Z"', "PPU Z1000")
PERIOD_S = 0.0005
MOVE = (*AXIS, "10 ACC 0 DEC 0 STP 0 VEL 10", "20 Z5")  # 1000 ticks


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "press"
    folder.mkdir()
    (folder / "setup.8k").write_text("DIM P(10)\n")
    return folder


def entered(project: Path, *lines: str) -> None:
    """Lines of the set-up; those with numbers are programs."""
    (project / "setup.8k").write_text("\n".join(("DIM P(10)", *lines, "")))


@pytest.fixture
def run(project: Path) -> Run:
    def invoke(*options: object) -> Result:
        return CliRunner().invoke(app, ["run", str(project), *(str(word) for word in options)])

    return invoke


def summary_of(result: Result) -> dict[str, Any]:
    """The summary of a run with --json."""
    assert result.exit_code == 0, result.stderr
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def tick_before(summary: dict[str, Any]) -> float:
    """The seconds of a run that is a tick shorter."""
    return float((summary["ticks"] - 1) * PERIOD_S)


def test_for_ends_the_run_at_its_tick(run: Run) -> None:
    assert summary_of(run("--for", "0.25", "--json"))["ticks"] == 500


def test_an_idle_card_ends_the_run_by_itself(run: Run, project: Path) -> None:
    entered(project, *MOVE, "PROG1", "10 DWL 0.35")
    assert summary_of(run("--json"))["ticks"] == 1200


def test_until_a_flag_is_set_ends_at_its_tick(run: Run, project: Path) -> None:
    entered(project, "PROG0", "10 DWL 0.1", "20 SET 32", "30 DWL 1")
    found = summary_of(run("--until", "32", "--json"))
    assert 200 < found["ticks"] < 210
    assert 32 in found["flags"]
    assert 32 not in summary_of(run("--for", tick_before(found), "--json"))["flags"]


def test_until_a_flag_is_clear_waits_for_it_to_be_set_first(run: Run, project: Path) -> None:
    entered(project, "PROG0", "5 DWL 0.1", *MOVE[1:])
    found = summary_of(run("--until", "-BIT516", "--json"))
    assert 1200 < found["ticks"] < 1210
    assert 516 not in found["flags"]
    assert 516 in summary_of(run("--for", tick_before(found), "--json"))["flags"]


def test_a_flag_that_does_not_come_is_mentioned(run: Run) -> None:
    result = run("--until", "32", "--for", "0.1", "--json")
    assert "note: BIT32 set was not reached within 0.1 s" in result.stderr
    assert summary_of(result)["ticks"] == 200


def test_what_programs_print_passes_through_and_comes_first(run: Run, project: Path) -> None:
    entered(project, "PROG0", '10 PRINT "part ready"')
    assert run("--for", "0.1").stdout.startswith("part ready\n")
    assert run("--for", "0.1", "--quiet").stdout == "part ready\n"


def test_the_closing_table_shows_axes_and_programs(run: Run, project: Path) -> None:
    entered(project, *MOVE, "PROG3", "110 DWL 0.2", "120 GOTO 120")
    shown = run("--for", "0.6").stdout
    rows = [line.split() for line in shown.splitlines() if line.strip() and "─" not in line]
    assert rows[:5] == [
        ["axis", "position", "distance", "peak", "velocity", "peak", "following", "error"],
        ["2", "5.0000", "5.0000", "10.0000", "0.164000"],
        ["program", "state", "line", "error"],
        ["PROG0", "idle", "20"],
        ["PROG3", "running", "120"],
    ]
    assert "0.6000 s simulated in 1200 ticks" in shown


def test_a_program_that_ended_in_an_error_gives_exit_code_1(run: Run, project: Path) -> None:
    entered(project, "PROG0", "10 P1 = 1/0")
    result = run("--for", "0.1")
    assert result.exit_code == 1
    assert "Divide by zero" in result.stdout


def test_the_summary_has_the_promised_keys(run: Run, project: Path, tmp_path: Path) -> None:
    entered(project, "DIM PROG15(1000)", *MOVE, "PROG15", "10 SET 33 : SET 63")
    path = tmp_path / "summary.json"
    assert run("--for", "0.6", "--summary", path).exit_code == 0
    summary = json.loads(path.read_text())
    promised = ["time_s", "ticks", "digest", "speed", "axes", "programs", "flags", "events"]
    assert list(summary) == promised
    assert summary["time_s"] == 0.6
    assert summary["ticks"] == 1200
    card, _ = Controller.load(find_project(project))
    card.send("RUN ALL\r")
    card.advance(1200)
    assert summary["digest"] == card.digest()
    axis = summary["axes"]["2"]
    assert axis.pop("peak_velocity") == pytest.approx(10.0)
    assert axis.pop("peak_following_error") == pytest.approx(0.164)
    assert axis == {"position": 5.0, "actual": 5.0}
    assert summary["programs"]["15"] == {
        "state": "idle", "line": 10, "error": None, "file": None, "file_line": None,
    }  # fmt: skip
    assert {33, 63} <= set(summary["flags"])
    assert 32 not in summary["flags"]


def test_json_keeps_standard_output_to_the_summary(run: Run, project: Path) -> None:
    entered(project, "PROG0", '10 PRINT "X"')
    result = run("--for", "0.1", "--json")
    assert summary_of(result)["ticks"] == 200
    assert "X" in result.stderr


def test_a_trace_names_its_columns(run: Run, project: Path, tmp_path: Path) -> None:
    entered(project, *MOVE)
    path = tmp_path / "run.csv"
    assert run("--for", "0.1", "--trace", path).exit_code == 0
    head, first = path.read_text().splitlines()[:2]
    assert head == "time_s,axis_2_commanded,axis_2_actual,axis_2_velocity,axis_2_following_error"
    assert first == "0.0005,0,0,0,0"


@pytest.mark.parametrize(("options", "every"), [((), 2), (("--trace-every", "7"), 7)])
def test_a_long_run_is_recorded_more_sparsely(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...], every: int
) -> None:
    path = tmp_path / "run.csv"
    run("--for", "0.05", "--trace", path)
    assert len(path.read_text().splitlines()) == 1 + 100
    monkeypatch.setattr("openacr.cli.run.session.TRACE_SAMPLES", 99)
    run("--for", "0.05", "--trace", path, *options)
    assert len(path.read_text().splitlines()) == 1 - -100 // every


def test_a_picture_is_drawn(run: Run, project: Path, tmp_path: Path) -> None:
    entered(project, *MOVE)
    assert run("--for", "0.1", "--plot", tmp_path / "run.svg").exit_code == 0
    assert "axis 2" in (tmp_path / "run.svg").read_text()
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["run.svg"]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--for", "0"), "error: --for 0: give a number of seconds above 0"),
        (("--for", "nan"), "error: --for nan: give a number"),
        (("--until", "soon"), "error: --until soon: give `idle`, a flag"),
        (("--until", "99999"), "error: "),
        (("--trace", "{tmp}/a.xls"), "a.xls: traces end in .csv or .parquet"),
        (("--trace", "{tmp}/none/a.csv"), "a.csv: cannot be written: there is no folder"),
        (("--summary", "{tmp}/press"), "press: cannot be written: it is a folder"),
        (("--plot", "{tmp}/a.gif"), "a.gif: pictures end in .png, .svg or .html"),
        (
            ("--summary", "{tmp}/a.csv", "--trace", "{tmp}/a.csv"),
            "a.csv: two results cannot go into one file",
        ),
        (("--scenario", "{tmp}/none.toml"), "none.toml: cannot be read: no such file"),
    ],
)
def test_bad_input_is_refused_before_anything_runs(
    run: Run, tmp_path: Path, options: tuple[str, ...], text: str
) -> None:
    before = sorted(tmp_path.rglob("*"))
    result = run(*(word.format(tmp=tmp_path) for word in options))
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert text in result.stderr
    assert result.stdout == ""
    assert sorted(tmp_path.rglob("*")) == before


def test_lines_the_card_refuses_are_all_shown_and_nothing_runs(run: Run, project: Path) -> None:
    entered(project, "", "NOTHING", "", "", "", "AT ALL")
    file = project / "setup.8k"
    result = run("--for", "0.1")
    assert (result.exit_code, result.stdout) == (2, "")
    first, second = [line for line in result.stderr.splitlines() if line.startswith("error: ")]
    assert first.startswith(f"error: {file}:3:") and "Unknown command" in first
    assert second.startswith(f"error: {file}:7:") and "Unknown command" in second
    result = run("--for", "0.1", "--keep-going", "--json")
    assert f"warning: {file}:3:" in result.stderr
    assert summary_of(result)["ticks"] == 200


def test_a_parquet_trace_without_its_library_says_what_to_install(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("openacr.cli.run.output.find_spec", lambda name: None)
    result = run("--trace", tmp_path / "a.parquet")
    assert result.exit_code == 2
    assert "pip install pyarrow" in result.stderr


def test_an_existing_result_stays_when_the_input_is_wrong(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text("old")
    assert run("--summary", path, "--for", "-1").exit_code == 2
    assert path.read_text() == "old"


def test_the_scenario_of_the_project_is_played(run: Run, project: Path) -> None:
    (project / "scenario.toml").write_text(
        """
        duration_s = 0.2
        [[at]]
        time_s = 0.05
        send = "P1=P6916\\r"
        checkpoint = "go"
        [[at]]
        when = {bit = 9}
        set = [1]
        [[expect]]
        parameter = 1
        is = 50
        [[expect]]
        name = "greeting"
        printed = "hello"
        """
    )
    result = run("--json")
    assert result.exit_code == 1
    summary = json.loads(result.stdout)
    assert summary["ticks"] == 400
    assert summary["scenario"]["checkpoints"] == {"start": 0.0, "go": 0.05, "end": 0.2}
    assert [item["ok"] for item in summary["scenario"]["expectations"]] == [True, False]
    assert (
        "failed: greeting: expected printed 'hello', found no 'hello' in 'P1=P6916" in result.stderr
    )
    assert "1 of 2 expectations met" in result.stderr
    assert "note: an action of the scenario never came: when BIT9 is set" in result.stderr


def test_a_button_of_a_scenario_reaches_the_card(run: Run, project: Path, tmp_path: Path) -> None:
    entered(project, "PROG0", "10 INH 5 : PRINT P6916", "20 INH -5 : PRINT P6916")
    path = tmp_path / "press.toml"
    path.write_text(
        'at = [{time_s = 0, send = "RUN ALL\\r"}, {time_s = 0.01, press = [5], press_s = 0.01}]'
    )
    # A program waits in slices of 1 ms.
    assert run("--scenario", path, "--for", "0.1").stdout.split()[:2] == ["11", "21"]


def test_real_time_takes_its_time(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[float] = []
    monkeypatch.setattr("openacr.cli.run.session.time.sleep", slept.append)
    assert run("--for", "1", "--realtime").exit_code == 0
    assert max(slept) > 0.5


def test_a_wrong_scenario_is_shown_with_its_line(run: Run, project: Path) -> None:
    (project / "scenario.toml").write_text("[[at]]\ntime_s = 1\nsett = [1]")
    result = run()
    assert result.exit_code == 2
    assert "scenario.toml:3:1: unknown key `sett`" in result.stderr


def test_a_bar_shows_the_running_programs_below_what_they_print(project: Path) -> None:
    entered(
        project, "PROG7", '10 DWL 0.2 : PRINT "at 400"', '20 DWL 0.4 : PRINT "at 1200"', "30 DWL 9"
    )
    host, terminal = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "openacr", "run", str(project), "--for", "1", "--realtime"],
        stdout=terminal,
        stderr=terminal,
    )
    os.close(terminal)
    shown = b""
    with suppress(OSError):  # the terminal is gone with the process
        while data := os.read(host, 4096):
            shown += data
    os.close(host)
    assert process.wait() == 0
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown.decode())
    assert "PROG7" in text
    assert "/ 1 s" in text
    assert re.search(r"\rat 400\r\n.*PROG7.*\rat 1200\r\n", text, re.DOTALL)
    assert "1.0000 s simulated" in text


def test_a_narrow_terminal_hides_no_numbers(
    run: Run, project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entered(project, *MOVE)
    monkeypatch.setenv("COLUMNS", "30")
    shown = run("--for", "0.6").stdout
    for number in ("5.0000", "10.0000", "0.164000"):
        assert number in shown


def test_a_picture_alone_is_recorded_sparsely_with_its_peaks(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorded: list[tuple[int, bool]] = []
    record = ControlledMachine.record

    def noted(machine: ControlledMachine, every_tk: int, **options: Any) -> None:
        recorded.append((every_tk, options["keep_peaks"]))
        record(machine, every_tk, **options)

    monkeypatch.setattr(ControlledMachine, "record", noted)
    monkeypatch.setattr("openacr.cli.run.session.PLOT_SAMPLES", 100)
    run("--for", "0.1", "--plot", tmp_path / "run.svg")
    run("--for", "0.1", "--plot", tmp_path / "run.svg", "--trace", tmp_path / "run.csv")
    assert recorded == [(2, True), (1, False)]


@pytest.mark.parametrize("seconds", ["0", "1e300", "10000001", "1e9h"])
def test_a_run_lasts_more_than_nothing_and_at_most_ten_million_seconds(
    run: Run, seconds: str
) -> None:
    refused = run("--for", seconds)
    assert refused.exit_code == 2
    number = f"{quantity(seconds, 's'):g}"
    text = f"--for {number}: give a number of seconds above 0, at most 10000000"
    assert text in " ".join(refused.stderr.split())


def test_a_run_may_be_as_long_as_the_limit() -> None:
    assert limit_s(MOST_S, None) == 10_000_000.0


GANTRY = Path(__file__).parents[2] / "examples" / "gantry"


def test_a_run_without_a_machine_names_the_switches_that_stop_it(tmp_path: Path) -> None:
    for name in ("setup.8k", "prog0.8k"):
        (tmp_path / name).write_text((GANTRY / name).read_text())
    note = (
        f"note: {tmp_path} has no machine.toml, so inputs 0, 1, 3, 4, 6, 7 are open: to the set-up"
        " these are limit switches that have been reached (axes 0, 1, 2), and nothing moves"
        f" (`openacr configure --machine {tmp_path}` prints a first machine.toml)\n"
    )
    assert note in CliRunner().invoke(app, ["run", str(tmp_path), "--for", "0.1"]).stderr
    setup = tmp_path / "setup.8k"
    setup.write_text(setup.read_text() + "SYS\nAXIS0 HLIM 0\nAXIS1 HLIM 2\nCLR BIT16209\n")
    stderr = CliRunner().invoke(app, ["run", str(tmp_path), "--for", "0.1"]).stderr
    assert "so inputs 4, 6 are open" in stderr
    (tmp_path / "machine.toml").write_text("")
    stderr = CliRunner().invoke(app, ["run", str(tmp_path), "--for", "0.1"]).stderr
    assert "no machine.toml" not in stderr


def test_the_limit_of_a_run_is_a_time_with_or_without_a_unit() -> None:
    def lived(text: str) -> Result:
        return CliRunner().invoke(app, ["run", str(GANTRY), "--for", text, "--json"])

    assert json.loads(lived("250ms").stdout)["time_s"] == 0.25
    refused = lived("ten")
    assert refused.exit_code == 2
    assert refused.stderr == (
        "error: --for ten: give a number, with or without a unit"
        " (us, ms, s, sec, min, h), such as 90 or 10min\n"
    )


@pytest.mark.parametrize(
    ("value", "shown"), [('"ten"', '"ten"'), ("0", "0"), ("1.1e7", "11000000.0"), ("true", "true")]
)
def test_a_duration_that_is_none_is_named_with_unit_and_range(
    tmp_path: Path, value: str, shown: str
) -> None:
    (tmp_path / "s.toml").write_text(f"duration_s = {value}\n")
    command = ["run", str(GANTRY), "--scenario", str(tmp_path / "s.toml")]
    assert CliRunner().invoke(app, command).stderr == (
        f"error: {tmp_path}/s.toml:1:1: duration_s is {shown};"
        " it must be a number above 0 to 1e+07 (seconds)\n"
    )
