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

import pytest
from tests.cli.fake_machine import FakeMachine
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.cli.results import AxisReport
from openacr.cli.run.command import MOST_S, limit_s
from openacr.errors import SourceError
from openacr.map.rows import programs, threads
from openacr.map.words import mf1
from openacr.messages import DIVIDE_BY_ZERO
from openacr.units import quantity

Run = Callable[..., Result]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "press"
    folder.mkdir()
    (folder / "setup.8k").write_text("DIM P(10)\n")
    return folder


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


@pytest.fixture
def run(machine: FakeMachine, project: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    monkeypatch.setattr("openacr.cli.run.controlled.load", lambda project: (machine, []))

    def invoke(*options: object) -> Result:
        return CliRunner().invoke(app, ["run", str(project), *(str(word) for word in options)])

    return invoke


def test_for_ends_the_run_at_its_tick(run: Run, machine: FakeMachine) -> None:
    assert run("--for", "0.25").exit_code == 0
    assert machine.tick == 500


def test_an_idle_card_ends_the_run_by_itself(run: Run, machine: FakeMachine) -> None:
    def world(card: FakeMachine) -> None:
        card.set_running(0, 10 < card.tick < 700)
        card.memory.I[mf1.word[0]] = mf1.IN_MOTION if 500 < card.tick < 1000 else 0

    machine.world = world
    assert run().exit_code == 0
    assert 1100 <= machine.tick <= 1300


def test_until_a_flag_is_set_ends_at_its_tick(run: Run, machine: FakeMachine) -> None:
    machine.world = lambda card: card.memory.set_bit(32, card.tick >= 333)
    assert run("--until", "32").exit_code == 0
    assert machine.tick == 333


def test_until_a_flag_is_clear_waits_for_it_to_be_set_first(run: Run, machine: FakeMachine) -> None:
    machine.world = lambda card: card.memory.set_bit(516, 200 <= card.tick < 777)
    assert run("--until", "-BIT516").exit_code == 0
    assert machine.tick == 777


def test_a_flag_that_does_not_come_is_mentioned(run: Run, machine: FakeMachine) -> None:
    result = run("--until", "32", "--for", "0.1")
    assert result.exit_code == 0
    assert "note: BIT32 set was not reached within 0.1 s" in result.stderr
    assert machine.tick == 200


def test_what_programs_print_passes_through_and_comes_first(run: Run, machine: FakeMachine) -> None:
    def world(card: FakeMachine) -> None:
        if card.tick == 5:
            card.hear("part ready\r\n")

    machine.world = world
    assert run("--for", "0.1").stdout.startswith("part ready\n")
    machine.tick = 0
    assert run("--for", "0.1", "--quiet").stdout == "part ready\n"


def test_the_closing_table_shows_axes_and_programs(run: Run, machine: FakeMachine) -> None:
    machine.reports = (
        AxisReport(0, 12.5, 12.499, 40.0, 100.25, 0.0125),
        AxisReport(1, 0.0, 0.0, 0.0, 0.0, 0.0),
    )
    machine.store_program(3)
    machine.memory.I[programs.parameters[3]] = 120
    machine.set_running(3, True)
    shown = run("--for", "0.1").stdout
    rows = [line.split() for line in shown.splitlines() if line.strip() and "─" not in line]
    assert rows[:4] == [
        ["axis", "position", "distance", "peak", "velocity", "peak", "following", "error"],
        ["0", "12.5000", "40.0000", "100.2500", "0.012500"],
        ["program", "state", "line", "error"],
        ["PROG3", "running", "120"],
    ]
    assert "0.1000 s simulated in 200 ticks" in shown


def test_a_program_that_ended_in_an_error_gives_exit_code_1(run: Run, machine: FakeMachine) -> None:
    machine.store_program(0)
    machine.memory.I[threads.error[0]] = DIVIDE_BY_ZERO.number
    result = run("--for", "0.1")
    assert result.exit_code == 1
    assert "Divide by zero" in result.stdout


def test_the_summary_has_the_promised_keys(run: Run, machine: FakeMachine, tmp_path: Path) -> None:
    machine.reports = (AxisReport(4, 12.5, 12.499, 40.0, 100.25, 0.0125),)
    machine.store_program(15)
    machine.memory.set_bit(33, True)
    machine.memory.set_bit(31, True)
    path = tmp_path / "summary.json"
    assert run("--for", "0.1", "--summary", path).exit_code == 0
    summary = json.loads(path.read_text())
    promised = ["time_s", "ticks", "digest", "speed", "axes", "programs", "flags", "events"]
    assert list(summary) == promised
    assert summary["time_s"] == 0.1
    assert summary["ticks"] == 200
    assert summary["digest"] == machine.memory.digest()
    assert summary["axes"] == {
        "4": {
            "position": 12.5,
            "actual": 12.499,
            "peak_velocity": 100.25,
            "peak_following_error": 0.0125,
        }
    }
    assert summary["programs"] == {
        "15": {"state": "idle", "line": 0, "error": None, "file": None, "file_line": None}
    }
    assert {31, 33} <= set(summary["flags"])
    assert 32 not in summary["flags"]


def test_json_keeps_standard_output_to_the_summary(run: Run, machine: FakeMachine) -> None:
    machine.world = lambda card: card.hear("X") if card.tick == 5 else None
    result = run("--for", "0.1", "--json")
    assert json.loads(result.stdout)["ticks"] == 200
    assert "X" in result.stderr


def test_a_trace_names_its_columns(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    assert run("--for", "0.1", "--trace", path).exit_code == 0
    assert path.read_text().splitlines()[:3] == [
        "time_s,axis_2_commanded,axis_2_actual,axis_2_velocity,axis_2_following_error",
        "0,0,0,0,0",
        "0.0005,1,1,1,0.001",
    ]


def test_a_long_run_is_recorded_more_sparsely(
    run: Run, machine: FakeMachine, tmp_path: Path
) -> None:
    run("--for", "0.5", "--trace", tmp_path / "run.csv")
    assert machine.recorded_every_tk == 1
    machine.period_s = 1e-6
    run("--for", "0.5", "--trace", tmp_path / "run.csv")
    assert machine.recorded_every_tk == 2
    run("--for", "0.5", "--trace", tmp_path / "run.csv", "--trace-every", "7")
    assert machine.recorded_every_tk == 7


def test_a_picture_is_drawn(run: Run, tmp_path: Path) -> None:
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
    run: Run, machine: FakeMachine, tmp_path: Path, options: tuple[str, ...], text: str
) -> None:
    before = sorted(tmp_path.rglob("*"))
    result = run(*(word.format(tmp=tmp_path) for word in options))
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert text in result.stderr
    assert result.stdout == ""
    assert machine.tick == 0
    assert sorted(tmp_path.rglob("*")) == before


def test_lines_the_card_refuses_are_all_shown_and_nothing_runs(
    run: Run, machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    refused = [SourceError("Unknown command", path="a.8k", line=line) for line in (3, 7)]
    monkeypatch.setattr("openacr.cli.run.controlled.load", lambda project: (machine, refused))
    result = run("--for", "0.1")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: a.8k:3: Unknown command\nerror: a.8k:7: Unknown")
    assert machine.tick == 0
    result = run("--for", "0.1", "--keep-going")
    assert result.exit_code == 0
    assert "warning: a.8k:3: Unknown command" in result.stderr
    assert machine.tick == 200


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


def test_the_scenario_of_the_project_is_played(
    run: Run, machine: FakeMachine, project: Path
) -> None:
    (project / "scenario.toml").write_text(
        """
        duration_s = 0.2
        [[at]]
        time_s = 0.05
        send = "RUN"
        checkpoint = "go"
        [[at]]
        when = {bit = 9}
        set = [1]
        [[expect]]
        flag = 1
        is = false
        [[expect]]
        name = "greeting"
        printed = "hello"
        """
    )
    machine.tick = 1000
    result = run("--json")
    assert result.exit_code == 1
    assert machine.typed == [(1100, "RUN", None)]
    assert machine.tick == 1400
    summary = json.loads(result.stdout)
    assert summary["scenario"]["checkpoints"] == {"start": 0.0, "go": 0.05, "end": 0.2}
    assert [item["ok"] for item in summary["scenario"]["expectations"]] == [True, False]
    assert "failed: greeting: expected printed 'hello', found nothing printed" in result.stderr
    assert "1 of 2 expectations met" in result.stderr
    assert "note: an action of the scenario never came: when BIT9 is set" in result.stderr


def test_a_button_of_a_scenario_reaches_the_card(
    run: Run, machine: FakeMachine, tmp_path: Path
) -> None:
    seen: list[int] = []

    def world(card: FakeMachine) -> None:
        if card.memory.bit(5):
            seen.append(card.tick)

    machine.world = world
    path = tmp_path / "press.toml"
    path.write_text("at = [{time_s = 0.01, press = [5], press_s = 0.01}]")
    assert run("--scenario", path, "--for", "0.1").exit_code == 0
    assert (seen[0], seen[-1]) == (21, 40)
    assert not machine.memory.bit(5)


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


def test_a_bar_shows_the_running_programs_below_what_they_print(tmp_path: Path) -> None:
    code = """
import time
from pathlib import Path
from tests.cli.fake_machine import FakeMachine
from openacr.cli.run.session import Options, Session

def world(card):
    card.set_running(7, True)
    if card.tick in (400, 1200):
        time.sleep(0.3)
        card.hear(f"at {card.tick}\\r\\n")

Session(Options(Path("x"), 1.0), FakeMachine(world), None).run()
"""
    host, terminal = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=terminal,
        stderr=terminal,
        cwd=Path(__file__).parents[2],
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
    run: Run, machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    machine.reports = (AxisReport(0, 12.5, 12.499, 40.0, 100.25, 0.0125),)
    shown = run("--for", "0.1").stdout
    for number in ("12.5000", "40.0000", "100.2500", "0.012500"):
        assert number in shown


def test_a_picture_alone_is_recorded_sparsely_with_its_peaks(
    run: Run, machine: FakeMachine, tmp_path: Path
) -> None:
    machine.period_s = 1e-5
    run("--for", "0.6", "--plot", tmp_path / "run.svg")
    assert (machine.recorded_every_tk, machine.keeps_peaks) == (2, True)
    run("--for", "0.6", "--plot", tmp_path / "run.svg", "--trace", tmp_path / "run.csv")
    assert (machine.recorded_every_tk, machine.keeps_peaks) == (1, False)


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
