"""The command line around a real card."""

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.controller import Controller

BOX = """\
DIM P(10)
PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
ATTACH SLAVE1 AXIS1 "Y"
PPU X 8000 Y 8000
PROGRAM
PBOOT
ACC 1000 DEC 1000 STP 1000 VEL 50
FOR P0 = 1 TO 2
X10 Y5
X0 Y5
INH -516
SET 32 : DWL 0.05 : CLR 32
PRINT "part"; P0
NEXT
P1 = 77
ENDP
"""


@pytest.fixture
def box(tmp_path: Path) -> Path:
    path = tmp_path / "box.8k"
    path.write_text(BOX)
    return path


def run(path: Path, *options: object) -> Result:
    return CliRunner().invoke(app, ["run", str(path), *(str(word) for word in options)])


def summary_of(path: Path, *options: object) -> dict[str, Any]:
    summary: dict[str, Any] = json.loads(run(path, "--json", *options).stdout)
    return summary


def test_a_program_runs_to_its_end_and_is_reported(box: Path) -> None:
    result = run(box)
    assert result.exit_code == 0
    assert "part" in result.stdout.splitlines()[0]
    summary = summary_of(box)
    assert summary["axes"]["0"]["position"] == 0.0
    assert summary["axes"]["1"]["position"] == 5.0
    assert summary["axes"]["0"]["actual"] == pytest.approx(0.0, abs=0.05)
    assert summary["axes"]["0"]["peak_velocity"] == pytest.approx(50.0, rel=0.01)
    assert summary["axes"]["0"]["peak_following_error"] > 0.0
    assert summary["programs"]["0"] == {
        "state": "idle", "line": 120, "error": None, "file": None, "file_line": None,
    }  # fmt: skip
    assert summary["ticks"] == round(summary["time_s"] / 0.0005)


def test_the_same_run_ends_in_the_same_state(box: Path) -> None:
    first, second = (summary_of(box, "--for", "1.5") for _ in range(2))
    assert first["digest"] == second["digest"]
    assert first["time_s"] == second["time_s"] == 1.5


def test_until_an_output_is_set_stops_the_card_there(box: Path) -> None:
    summary = summary_of(box, "--until", "32", "--for", "10")
    assert 32 in summary["flags"]
    assert 0.4 < summary["time_s"] < 1.2
    later = summary_of(box, "--until", "-32", "--for", "10")
    assert later["time_s"] - summary["time_s"] == pytest.approx(0.05, abs=0.02)


def test_a_trace_holds_every_tick_in_units(box: Path, tmp_path: Path) -> None:
    path = tmp_path / "box.csv"
    run(box, "--for", "0.5", "--trace", path)
    head, *rows = path.read_text().splitlines()
    columns = head.split(",")
    assert columns[:3] == ["time_s", "axis_0_commanded", "axis_0_actual"]
    values = [[float(value) for value in row.split(",")] for row in rows]
    assert len(values) == 1000
    assert values[-1][0] == pytest.approx(0.5)
    assert max(row[1] for row in values) == pytest.approx(10.0, abs=1e-4)


def test_a_picture_names_the_axes_of_the_program(box: Path, tmp_path: Path) -> None:
    path = tmp_path / "box.svg"
    assert run(box, "--plot", path).exit_code == 0
    for text in ("X (axis 0)", "Y (axis 1)", "path, master 0", "BIT32"):
        assert text in path.read_text()


def test_a_program_that_fails_gives_exit_code_1(tmp_path: Path) -> None:
    path = tmp_path / "bad.8k"
    path.write_text("DIM P(10)\nPROG2\nPROGRAM\nPBOOT\nP0 = 0\nP1 = 1 / P0\nENDP\n")
    result = run(path, "--json")
    assert result.exit_code == 1
    summary = json.loads(result.stdout)
    assert summary["programs"]["2"] == {
        "state": "error", "line": 40, "error": "Divide by zero", "file": str(path), "file_line": 6,
    }  # fmt: skip


def test_lines_the_card_refuses_are_shown_with_file_and_line(tmp_path: Path) -> None:
    path = tmp_path / "bad.8k"
    path.write_text("DIM P(10)\nFOO\nPROG0\nBAR 5\n")
    result = run(path)
    assert result.exit_code == 2
    assert result.stderr.splitlines() == [
        f"error: {path}:2: Unknown command",
        "    FOO",
        f"error: {path}:4: Unknown command",
        "    BAR 5",
        f"`openacr check {path}` shows more about each",
    ]


def test_a_scenario_drives_a_project(box: Path, tmp_path: Path) -> None:
    project = tmp_path / "cell"
    project.mkdir()
    (project / "setup.8k").write_text("DIM P(10)\n")
    (project / "prog0.8k").write_text("PROGRAM\nINH 5\nSET 33\nINPUT P2\nPRINT P2\nENDP\n")
    (project / "scenario.toml").write_text(
        """
        duration_s = 2
        [[at]]
        time_s = 0.1
        send = "PROG0\\rLRUN\\r"
        [[at]]
        time_s = 0.5
        press = [5]
        [[at]]
        when = {bit = 33, becomes = true}
        checkpoint = "seen"
        [[at]]
        after = "seen"
        delay_s = 0.2
        send = "42\\r"
        [[expect]]
        between = ["start", "seen"]
        duration_s = 0.5
        tolerance = 0.02
        [[expect]]
        after = "seen"
        program = 0
        state = "inhibited"
        delay_s = 0.1
        [[expect]]
        parameter = 2
        is = 42
        [[expect]]
        printed = ["P00>", "42"]
        """
    )
    result = run(project)
    assert result.exit_code == 0, result.output
    assert "4 of 4 expectations met" in result.stderr


def test_control_x_in_a_scenario_ends_the_program(box: Path, tmp_path: Path) -> None:
    path = tmp_path / "stop.toml"
    path.write_text(
        """
        [[at]]
        time_s = 0.3
        key = "ctrl-x"
        [[expect]]
        time_s = 0.2
        program = 0
        state = "inhibited"
        [[expect]]
        program = 0
        state = "idle"
        """
    )
    result = run(box, "--scenario", path, "--for", "1")
    assert result.exit_code == 0, result.output


def test_the_pure_form_of_the_core_ends_in_the_same_state(box: Path) -> None:
    code = "import openacr.cli.main as m; m.main()"
    digests = []
    for pure in ("0", "1"):
        done = subprocess.run(
            [sys.executable, "-c", code, "run", str(box), "--for", "0.3", "--json", "--quiet"],
            capture_output=True,
            check=True,
            env={"OPENACR_PURE": pure, "PATH": ""},
        )
        digests.append(json.loads(done.stdout)["digest"])
    assert digests[0] == digests[1]


def test_an_interrupted_run_ends_with_130_and_what_there_is(tmp_path: Path) -> None:
    path = tmp_path / "loop.8k"
    path.write_text('PROG0\nPROGRAM\nPBOOT\nPRINT "on"\n_a\nDWL 0.01\nGOTO a\nENDP\n')
    process = subprocess.Popen(
        [
            *(sys.executable, "-u", "-m", "openacr.cli.main", "run", "loop.8k"),
            *("--for", "1000000", "--summary", "s.json", "--trace", "t.csv"),
        ],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    process.stdout.readline()  # the program runs
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate()
    assert process.returncode == 130
    assert b"Traceback" not in errors
    assert b"note: interrupted after " in errors
    assert json.loads((tmp_path / "s.json").read_text())["time_s"] < 1000000
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["loop.8k", "s.json", "t.csv"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full device")
def test_output_that_cannot_be_written_is_one_line(box: Path) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "openacr.cli.main", "run", str(box), "--for", "0.1"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1] == (
        "error: output cannot be written: No space left on device"
    )


def stored(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "stored.8k"
    path.write_text(text)
    return path


HELLO = 'PROG0\nPROGRAM\nPRINT "zero"\nENDP\nPROG3\nPROGRAM\nPRINT "three"\nENDP\n'


def test_without_pboot_and_scenario_every_program_is_started(tmp_path: Path) -> None:
    result = run(stored(tmp_path, HELLO), "--for", "0.1")
    assert sorted(result.stdout.splitlines()[:2]) == ["three", "zero"]
    assert result.stderr == (
        "note: no program starts by itself: starting PROG0, PROG3 as RUN ALL does\n"
    )
    quiet = run(stored(tmp_path, HELLO), "--for", "0.1", "--quiet")
    assert sorted(quiet.stdout.split()) == ["three", "zero"]
    assert quiet.stderr == ""


def test_a_program_that_starts_by_itself_starts_alone(tmp_path: Path) -> None:
    text = HELLO.replace('PRINT "three"', 'PBOOT\nPRINT "three"\nDWL 1')
    result = run(stored(tmp_path, text), "--for", "0.1", "--quiet")
    assert result.stdout == "three\n"


def test_with_a_scenario_only_the_scenario_starts_programs(tmp_path: Path) -> None:
    scenario = tmp_path / "typed.toml"
    scenario.write_text('at = [{time_s = 0.05, send = "PROG3\\rRUN\\r"}]')
    result = run(stored(tmp_path, HELLO), "--for", "0.2", "--quiet", "--scenario", scenario)
    assert result.stdout == "three\n"


@pytest.mark.parametrize(
    ("line", "number", "message"),
    [
        ("P1 = 1/0", 20, "Divide by zero"),
        ("MASTER9 VEL 5", 20, "Invalid argument"),
        ("IF (P1)", 20, "IF without ENDIF"),
    ],
)
def test_an_error_names_program_line_and_text(
    tmp_path: Path, line: str, number: int, message: str
) -> None:
    text = f'DIM P(10)\nPROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nPROGRAM\n{line}\nENDP\n'
    path = stored(tmp_path, text)
    result = run(path, "--for", "0.1", "--quiet")
    assert result.exit_code == 1
    place = f"{path}:6: PROG0 line {number}"
    assert result.stderr == f"error: {place}: {message}\n    {line}\n"


def test_a_program_started_again_has_no_error_any_more(tmp_path: Path) -> None:
    path = stored(tmp_path, "DIM P(10)\nPROG0\nPROGRAM\nP1 = 1 / P0\nENDP\n")
    scenario = tmp_path / "twice.toml"
    scenario.write_text(
        'at = [{time_s = 0, send = "PROG0\\rRUN\\r"}, {time_s = 0.05, send = "P0 = 2\\rRUN\\r"}]\n'
        'expect = [{time_s = 0.04, program = 0, state = "error"}, {program = 0, state = "idle"}]'
    )
    assert run(path, "--for", "0.1", "--scenario", scenario).exit_code == 0


def test_a_restart_of_the_card_does_not_turn_back_the_time_of_the_run(tmp_path: Path) -> None:
    path = stored(tmp_path, "REM nothing\n")
    scenario = tmp_path / "reboot.toml"
    scenario.write_text('at = [{time_s = 0.05, send = "SYS\\rREBOOT\\r"}]')
    assert summary_of(path, "--for", "0.2", "--scenario", scenario)["ticks"] == 400


def test_a_sparse_picture_keeps_its_peaks(box: Path, tmp_path: Path) -> None:
    path = tmp_path / "long.html"
    assert run(box, "--for", "100", "--plot", path).exit_code == 0
    # 200000 ticks are recorded in 40000 rows; the peak is that of the closing table.
    peak = summary_of(box, "--for", "100")["axes"]["0"]["peak_following_error"]
    data = json.loads(path.read_text().split('type="application/json">')[1].split("</script>")[0])
    assert max(map(abs, data["axes"][0]["error"])) == pytest.approx(peak, rel=1e-3)


def test_strings_and_remarks_are_shown_as_they_were_written(tmp_path: Path) -> None:
    path = tmp_path / "text.8k"
    path.write_text('PROG0\nPROGRAM\nPBOOT\nREM “zero” – naïve\nPRINT "20 µm, it’s"\nENDP\n')
    listed = CliRunner().invoke(app, ["list", str(path)])
    assert listed.stdout.splitlines()[3:5] == [" REM “zero” – naïve", ' PRINT "20 µm, it’s"']
    assert run(path).stdout.splitlines()[0] == "20 µm, it’s"


def test_typographic_text_may_be_typed_on_the_console() -> None:
    card = Controller()
    assert card.send("PRINT “3 – 1 = ”;3 – 1\r").endswith("\r\n3 \xe2\x80\x93 1 = 2\r\nSYS>")
