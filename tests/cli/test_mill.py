"""`openacr mill check`, `time` and `run`: part programs at the command line."""

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.sysvar import Store

REPEAT_FOREVER = 250_013
SQUARE = """\
G90 F60
G0 X1 Y1
G1 X2
Y2
G2 X1 Y1 I1 J2
M2
"""


def program(folder: Path, text: str) -> str:
    file = folder / "PART.NC"
    file.write_text(text)
    return str(file)


def mill(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *words])
    return result.exit_code, result.output


def as_json(*words: str) -> Any:
    result = CliRunner().invoke(app, ["mill", *words, "--json"])
    return json.loads(result.stdout)


def test_a_difference_is_shown_in_words_or_short_numbers() -> None:
    from openacr.cnc.interpreter.replay import Difference

    def shown(name: str, value: float | tuple[float, ...]) -> str:
        return Difference(name, 0.0, 0.0).shown(value)

    assert shown("position", (0.0, -0.7874015748031497, 12.0)) == "0 -0.7874 12"
    assert (shown("spindle speed", 3000.0), shown("spindle", 4.0)) == ("3000", "counter-clockwise")
    assert (shown("coolant", 3.0), shown("output 32", 1.0)) == ("mist and flood", "on")


def test_check_counts_moves_lengths_and_extents(tmp_path: Path) -> None:
    found = as_json("check", program(tmp_path, SQUARE))
    assert found["lines"] == 6
    assert (found["errors"], found["warnings"]) == ([], [])
    assert found["moves"] == {"rapid": 1, "feed": 2, "arc": 1, "dwell": 0}
    assert found["length"]["rapid"] == pytest.approx(2**0.5)
    assert found["length"]["feed"] == pytest.approx(2 + 0.5 * 3.14159265)
    assert found["extents"] == {"min": [1.0, 1.0, 0.0], "max": [2.0, 2.0, 0.0]}
    assert found["end"] == {"X": 1.0, "Y": 1.0, "Z": 0.0}


def test_check_shows_errors_with_line_column_and_mark(tmp_path: Path) -> None:
    code, text = mill("check", program(tmp_path, "G90\nG1 X1 G0\nG1 X1 X2\n"))
    assert code == 1
    assert "PART.NC:2:7: E201" in text
    assert "    G1 X1 G0\n          ^" in text
    assert "PART.NC:3:7: E202" in text


def test_time_is_that_of_the_run_within_a_percent(tmp_path: Path) -> None:
    file = program(tmp_path, SQUARE)
    assert as_json("time", file)["time_s"] == pytest.approx(
        as_json("run", file)["time_s"], rel=0.01
    )


def test_time_of_a_tolerance_is_that_of_the_run_and_exact_that_of_a_real_card(
    tmp_path: Path,
) -> None:
    rounding = program(tmp_path, ";dialect rs274ngc\nG64 P.01\nF900 G1 X1\nY1\nX0\nY0\nM2\n")
    time_s = as_json("time", rounding)["time_s"]
    assert time_s == pytest.approx(as_json("run", rounding)["time_s"], rel=0.02)
    exact_s = as_json("time", rounding, "--exact")["time_s"]
    free = program(tmp_path, ";dialect rs274ngc\nG64\nF900 G1 X1\nY1\nX0\nY0\nM2\n")
    assert exact_s == as_json("time", free)["time_s"]
    assert exact_s < time_s - 0.03  # real axes have to jump


def test_run_ends_where_the_program_ends(tmp_path: Path) -> None:
    code, text = mill("run", program(tmp_path, SQUARE))
    assert code == 0
    assert "X   1.0000 Y   1.0000 Z   0.0000" in text


def test_a_program_with_errors_is_not_run(tmp_path: Path) -> None:
    code, text = mill("run", program(tmp_path, "G90 F60\nG1 X1\nQQ\n"))
    assert code == 1
    assert "PART.NC:3" in text
    assert "moves" not in text


@pytest.mark.parametrize("command", ["check", "time", "run"])
def test_errors_of_a_program_are_json_where_that_is_asked_for(command: str, tmp_path: Path) -> None:
    (error,) = as_json(command, program(tmp_path, "G90 F60\nG1 X1\nQQ\n"))["errors"]
    assert (error["code"], error["line"], error["block"]) == ("E105", 3, "QQ")


def test_a_single_move_is_counted_as_one(tmp_path: Path) -> None:
    part = program(tmp_path, "G90 F60\nG1 X1\nM2\n")
    assert "1 move)" in mill("time", part)[1]
    assert "1 move)" in mill("run", part)[1]


@pytest.mark.parametrize("jerk", [0, 20_000])
def test_a_run_counts_the_moves_of_planned_paths_like_others(jerk: int, tmp_path: Path) -> None:
    assert CliRunner().invoke(app, ["sysvar", "set", f"P650015={jerk}"]).exit_code == 0
    part = program(tmp_path, "G20 G64 P.001 F60\nG1 X1\nY1\nG0 Z1\nG1 X0 Y0\nM30\n")
    assert as_json("run", part)["moves"] == 4
    assert "4 moves)" in mill("time", part)[1]


def test_an_error_at_run_time_is_an_alarm_with_its_line(tmp_path: Path) -> None:
    code, text = mill("run", program(tmp_path, "G90 F600\nP5=0\nG1 X1\nG1 X(1/P5)\nM2\n"))
    assert code == 1
    assert "alarm 60" in text
    assert "PART.NC:4" in text


def test_no_operator_is_needed_on_the_virtual_machine(tmp_path: Path) -> None:
    text = 'F600\nM3 S100\nT3 M6\nM122\nM0\nG1 X1\nINPUT "size", P200\nG1 Y(P200)\nM2\n'
    found = as_json("run", program(tmp_path, text), "--answer", "P200=0.5")
    assert found["alarms"] == []
    assert found["end"]["X"] == 1.0
    assert found["end"]["Y"] == 0.5


def test_a_missing_answer_is_alarm_61(tmp_path: Path) -> None:
    found = as_json("run", program(tmp_path, 'F600\nINPUT "size", P200\nG1 Y(P200)\nM2\n'))
    assert [alarm["code"] for alarm in found["alarms"]] == [61]


def test_what_a_virtual_run_writes_is_forgotten(tmp_path: Path) -> None:
    mill("run", program(tmp_path, "F60\nP150=7\nG1 X.1\nM2\n"))
    result = CliRunner().invoke(app, ["sysvar", "get", "P150", "--json"])
    assert json.loads(result.stdout)[0]["value"] == 0


def test_start_at_a_line_goes_there_first(tmp_path: Path) -> None:
    found = as_json("run", program(tmp_path, SQUARE), "--line", "5", "--safe-z", "1")
    assert found["end"] == {"X": 1.0, "Y": 1.0, "Z": 0.0}
    code, text = mill("run", program(tmp_path, SQUARE), "--line", "9")
    assert code == 2
    assert "the program has lines 1 to 6" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("check", "nowhere.nc"), "nowhere.nc: no such file"),
        (("run", "PART", "--answer", "size"), "write it as P200=1.5"),
        (("check", "PART", "--dialect", "klingon"), "choose one of acromill"),
    ],
)
def test_mistakes_of_the_user_are_said_in_one_line(
    tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    file = program(tmp_path, SQUARE)
    code, text = mill(*(file if word == "PART" else word for word in words))
    assert code == 2
    assert said in text


def test_the_dialect_may_stand_in_the_file(tmp_path: Path) -> None:
    _, text = mill("check", program(tmp_path, ";dialect elvish\nG1 X1\n"))
    assert "unknown dialect elvish: choose one of" in text


@pytest.mark.req("MILL-START-NOCARD")
def test_no_card_is_said_as_such(tmp_path: Path) -> None:
    code, text = mill("run", program(tmp_path, SQUARE), "--host", "127.0.0.1:1")
    assert code == 2
    assert "NO CARD FOUND" in text


def batch_of(folder: Path, text: str) -> str:
    (folder / "ONE.NC").write_text("F600\nG1 X1\n(MSG, one)\nM2\n")
    (folder / "TWO.NC").write_text("F600\nG1 X0\n(MSG, two)\nM2\n")
    file = folder / "SHIFT.BAT"
    file.write_text(text)
    return str(file)


@pytest.mark.req("MILL-BATCH-ORDER")
def test_a_batch_runs_its_programs_in_order(tmp_path: Path) -> None:
    code, text = mill("batch", batch_of(tmp_path, "ONE.NC\nTWO.NC L2\nONE.NC\n"))
    assert code == 0
    said = [line for line in text.split() if line in ("one", "two")]
    assert said == ["one", "two", "two", "one"]


def test_a_batch_with_a_faulty_program_does_not_start(tmp_path: Path) -> None:
    file = batch_of(tmp_path, "ONE.NC\nTWO.NC\n")
    (tmp_path / "TWO.NC").write_text("QQ\n")
    code, text = mill("batch", file)
    assert code == 1
    assert "TWO.NC:1" in text
    assert "one" not in text.split()


def test_what_ends_a_program_ends_its_batch(tmp_path: Path) -> None:
    file = batch_of(tmp_path, "ONE.NC\nTWO.NC\n")
    (tmp_path / "ONE.NC").write_text("P5=0\nF600\nG1 X(1/P5)\nM2\n")
    code, text = mill("batch", file)
    assert code == 1
    assert "alarm 60" in text
    assert "two" not in text.split()


def mdi(typed: str | None, *words: str) -> tuple[int, list[str]]:
    result = CliRunner().invoke(app, ["mill", "mdi", *words], input=typed)
    return result.exit_code, result.output.splitlines()


def test_mdi_blocks_run_on_the_virtual_machine_one_by_one() -> None:
    code, places = mdi(None, "G91 F600 G1 X1", "X1 Y-0.5")
    assert code == 0
    assert [place.split()[:4] for place in places] == [
        ["X", "1.0000", "Y", "0.0000"],
        ["X", "2.0000", "Y", "-0.5000"],
    ]


def test_mdi_blocks_can_be_piped_in_and_kept_as_a_program(tmp_path: Path) -> None:
    kept = tmp_path / "KEPT.NC"
    code, places = mdi("G90 F600\n\nG1 X1.5\n", "--save", str(kept))
    assert (code, len(places)) == (0, 2)
    assert kept.read_text() == "G90 F600\nG1 X1.5\n"
    assert as_json("run", str(kept))["end"]["X"] == 1.5


def test_a_bad_mdi_block_is_refused_and_the_good_ones_before_it_are_kept(tmp_path: Path) -> None:
    kept = tmp_path / "KEPT.NC"
    code, lines = mdi(None, "G1 F600 X1", "G1 Q", "--save", str(kept))
    assert code != 0
    assert "MDI:1:" in lines[-1]
    assert kept.read_text() == "G1 F600 X1\n"


def test_m_codes_of_the_machine_lie_beside_its_store(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mcodes").mkdir()
    (tmp_path / "mcodes" / "M50.TXT").write_text("G1 X(#1*2)\nRET\n")
    assert CliRunner().invoke(app, ["sysvar", "set", "cut speed=20"]).exit_code == 0
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    file = program(elsewhere, "M50 X1.5\nM2\n")
    assert as_json("check", file)["end"]["X"] == 3.0
    code, text = mill("run", file)
    assert code == 0
    assert "X   3.0000" in text
    code, places = mdi(None, "F600", "M50 X2")
    assert (code, places[-1].split()[:2]) == (0, ["X", "4.0000"])


def test_another_tool_in_the_spindle_bars_a_start_at_a_line_unless_overridden(
    tmp_path: Path,
) -> None:
    part = program(tmp_path, "T5 M6\nF600 G0 Z1\nG1 X1\nG1 X2\nM2\n")
    code, text = mill("run", part, "--line", "4")
    assert (code, "--any-tool" in text) == (2, True)
    code, _ = mill("run", part, "--line", "4", "--any-tool")
    assert code == 0


def test_repeat_forever_does_not_hold_a_virtual_run(tmp_path: Path) -> None:
    with Store(tmp_path / "sysvar.db") as store:
        store.write(REPEAT_FOREVER, 1)
    assert as_json("run", program(tmp_path, SQUARE))["passes"] == 1


@pytest.mark.req("MILL-SYS-PROBE-NONE")
def test_check_refuses_a_probing_move_where_the_store_has_no_probe(tmp_path: Path) -> None:
    part = "parts/probe_corner.nc"
    code, text = mill("check", part)
    assert (code, "probe_corner.nc:7:1: E243" in text, "no probe input" in text) == (1, True, True)
    code, text = mill("run", part, "--quiet")
    assert (code, "no probe input" in text) == (1, True)
    with Store(tmp_path / "sysvar.db") as store:
        store.write(600_000, 24)
    assert mill("check", part)[0] == 0
    assert mill("run", part, "--quiet")[0] == 0


def test_block_skip_leaves_slashed_lines_out(tmp_path: Path) -> None:
    part = tmp_path / "S.NC"
    part.write_text("F60\n" + "G1 X.1\n/G1 Y.1\n" * 3 + "M2\n")
    for words, y in ((["--block-skip"], 0.0), ([], 0.1)):
        result = CliRunner().invoke(app, ["mill", "run", str(part), "--json", *words])
        assert json.loads(result.output)["end"]["Y"] == y


def test_check_tests_soft_limits_with_the_offsets_of_the_store(tmp_path: Path) -> None:
    file = program(tmp_path, "G90 G54 F60\nG1 X1\nX1.75 Y1\nM2\n")
    with Store(tmp_path / "sysvar.db") as store:
        for number, value in ((200_000, 2.0), (200_001, -2.0), (200_002, 0.0), (271, 1.0)):
            store.write(number, value)
    assert mill("check", file)[0] == 0
    with Store(tmp_path / "sysvar.db") as store:
        store.write(910, 0.5)  # G54 of X
    code, text = mill("check", file)
    assert code == 1
    beyond = "axis X would go to 2.25, 0.25 beyond its limit 2"
    assert f"PART.NC:3:1: E401 target beyond soft limit: {beyond}\n" in text
    assert "    X1.75 Y1\n    ^\n" in text
    result = CliRunner().invoke(app, ["mill", "check", file, "--json"])
    assert result.exit_code == 1
    found = json.loads(result.stdout)["errors"]
    assert [(one["code"], one["line"], one["block"]) for one in found] == [("E401", 3, "X1.75 Y1")]


def test_lengths_in_json_have_the_digits_they_mean(tmp_path: Path) -> None:
    found = as_json("check", program(tmp_path, "F10 G1 X.1\nX.3\nG2 X.5 Y.2 I.3 J.2\nM2\n"))
    assert found["end"] == {"X": 0.5, "Y": 0.2, "Z": 0.0}
    assert found["length"] == {"rapid": 0.0, "feed": 1.2424778}


def test_findings_name_a_file_with_the_folder_the_user_gave(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = Path("parts")
    folder.mkdir()
    (folder / "MACRO.TXT").write_text("G1 X\n")
    program(folder, "G1 X1 F10\nG555\nM2\n$I MACRO.TXT\n")
    code, output = mill("check", "parts/PART.NC")
    assert code == 1
    assert "parts/PART.NC:2:1: E203 " in output
    assert "parts/MACRO.TXT:1:5: E105 " in output
    assert [each["file"] for each in as_json("check", "parts/PART.NC")["errors"]] == [
        "parts/MACRO.TXT",
        "parts/PART.NC",
    ]
    for command in ("time", "list", "run", "plot"):
        assert "parts/PART.NC:2:1: E203 " in mill(command, "parts/PART.NC")[1], command
