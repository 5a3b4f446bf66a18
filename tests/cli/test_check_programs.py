"""`openacr check`: what only shows when a program is looked at as a whole."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.controller import Controller
from openacr.project import find_project

SETUP = """\
DIM P(10)
DIM DEF(5)
#DEFINE Count P9
#DEFINE Beyond P10
PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
DIM LV(5)
DIM $V(2,10)
DIM LA(1)
DIM LA0(10)
"""


def check(path: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["check", str(path), *options])


def faults(folder: Path, *lines: str, setup: str = SETUP) -> list[str]:
    """What is said about a program after the set-up, one text per fault."""
    (folder / "setup.8k").write_text(setup)
    path = folder / "prog0.8k"
    path.write_text("\n".join(["PROGRAM", *lines, "ENDP", ""]))
    shown = check(path).stdout.splitlines()
    return [
        line.split("prog0.8k:")[1]
        for line in shown
        if "prog0.8k:" in line and "no errors" not in line
    ]


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (("IF (P0)", "SET 32", "ELSE", "ELSE", "ENDIF"), ["5:1: ELSE without IF"]),
        (("ENDIF", "WEND", "BREAK"), ["2:1: ENDIF without IF", "3:1: WEND without WHILE",
                                      "4:1: BREAK without loop"]),
        (("WHILE (P0)", "IF (P1)", "WEND"), ["3:1: IF without ENDIF"]),
        (("FOR P0 = 1 TO 3 : IF (P1)", "NEXT", "NEXT"), ["2:19: IF without ENDIF",
                                                         "4:1: NEXT without FOR"]),
        (("FOR P0 = 1 TO 3", "WHILE (P1)"), ["2:1: FOR without NEXT", "3:1: WHILE without WEND"]),
    ],
)  # fmt: skip
def test_each_level_that_does_not_fit_is_found(
    tmp_path: Path, lines: tuple[str, ...], found: list[str]
) -> None:
    shown = [text.split(" (")[0].lower() for text in faults(tmp_path, *lines)]
    assert shown == [text.lower() for text in found]


def test_a_one_line_if_opens_no_level(tmp_path: Path) -> None:
    assert faults(tmp_path, "IF (P0) THEN SET 32", "IF (P1) THEN P0 = 1 : P1 = 2") == []


def test_jumps_to_line_numbers_are_followed(tmp_path: Path) -> None:
    lines = ("100 P0 = 1", "110 GOTO 100", "120 GOSUB 130")
    (tmp_path / "prog0.8k").write_text("\n".join([*lines, ""]))
    assert "prog0.8k:3:11: Line not found: 130" in check(tmp_path / "prog0.8k").stdout


def test_a_line_number_out_of_range_is_refused(tmp_path: Path) -> None:
    (tmp_path / "prog0.8k").write_text("1000000 P0 = 1\n0 P0 = 2\n")
    assert "2 errors" in check(tmp_path / "prog0.8k").stderr


def test_a_goto_out_of_a_block_is_a_warning(tmp_path: Path) -> None:
    lines = ("_Top", "WHILE (P0)", "IF (P1)", "GOTO Inner", "GOTO Top", "ENDIF", "_Inner", "WEND")
    assert faults(tmp_path, *lines) == [
        "5:6: warning: GOTO out of the IF of line 4 (let ENDIF close the block and jump past it)",
        "6:6: warning: GOTO out of the IF of line 4 (let ENDIF close the block and jump past it)",
    ]


def test_a_goto_within_its_block_is_fine(tmp_path: Path) -> None:
    assert faults(tmp_path, "WHILE (P0)", "_In", "IF (P1) THEN GOTO In", "WEND", "GOTO In") == []


def test_warnings_alone_are_no_failure(tmp_path: Path) -> None:
    path = tmp_path / "prog0.8k"
    path.write_text("PROGRAM\nFOR P0 = 1 TO 2\nGOTO Out\nNEXT\n_Out\nENDP\n")
    result = check(path)
    assert (result.exit_code, result.stderr) == (0, "1 warning\n")
    (fault,) = json.loads(check(path, "--json").stdout)
    assert (fault["severity"], fault["line"], fault["column"]) == ("warning", 3, 6)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("P10 = 1", ["2:1: Undefined variable (DIM P makes P0 to P9)"]),
        ("P9 = 1 : P12288 = 4096", []),
        ("P0 = LV4 + LV5", ["2:12: Undefined variable (DIM LV makes LV0 to LV4)"]),
        ("SV0 = 1", ["2:1: Undefined variable (no DIM SV was read)"]),
        ("DV(P0) = 1", ["2:1: Undefined variable (no DIM DV was read)"]),
        ("PRINT $V1; $V2", ["2:12: Undefined variable (DIM $V makes $V0 to $V1)"]),
        ("LA1(3) = 1 : LA0(3) = 2", ["2:1: Undefined variable (DIM LA makes LA0 to LA0)"]),
        ("Count = 1", []),
        ("Beyond = 1", ["2:1: Undefined variable (DIM P makes P0 to P9)"]),
        ('PRINT "LV99" : REM SV3', []),
        ("P(P0+500) = 1", []),
    ],
)
def test_variables_without_a_dimension_are_found(
    tmp_path: Path, line: str, found: list[str]
) -> None:
    assert faults(tmp_path, line) == found


def test_a_program_may_dimension_its_own_variables(tmp_path: Path) -> None:
    assert faults(tmp_path, "DIM SV(3)", "SV2 = 1") == []
    assert faults(tmp_path, "DIM SV(P0)", "SV200 = 1") == []


def test_each_missing_variable_is_reported_once(tmp_path: Path) -> None:
    assert len(faults(tmp_path, "SV0 = 1", "SV0 = 2", "SV1 = SV0")) == 2


def test_without_any_dim_sizes_are_not_judged(tmp_path: Path) -> None:
    path = tmp_path / "prog0.8k"
    path.write_text("PROGRAM\nLV0 = 1\nENDP\n")
    assert check(path).exit_code == 0
    assert "Undefined variable" in check(tmp_path).stdout  # a project is all there is


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("EXC X(1,2,3)", "2:13: Syntax error (written: EXC axis {value|(plus,minus)} ...)"),
        ("CIRCW X(1)", "2:11: Syntax error (written: CIRCW axis(target,center) ...)"),
        ("P0 = SIN(1,2)", "2:6: Syntax error (written: SIN(number))"),
        ("MASK P4096 (1)", "2:15: Syntax error (written: MASK Pn (nandmask,ormask))"),
        ("ACC 5 5", "2:7: Syntax error (written: ACC {value})"),
        ("VEL", None),
    ],
)
def test_wrong_argument_counts_are_found(tmp_path: Path, line: str, found: str | None) -> None:
    assert faults(tmp_path, line) == ([found] if found else [])


def test_lines_of_a_known_shape_are_judged_by_their_values(tmp_path: Path) -> None:
    found = faults(
        tmp_path,
        "LV0 = 1", "LV9 = 1", "GOTO a1", "GOTO a2", "_a1", f"_{'b' * 32}", f"_{'c' * 33}",
        "PRINT #1, 5", "PRINT #9, 5",
    )  # fmt: skip
    assert [text.split(" (")[0] for text in found] == [
        "3:1: Undefined variable",
        "5:6: Label not found: a2",
        "8:35: Syntax error",
        "10:9: Syntax error",
    ]


def test_an_axis_that_is_not_attached_is_named(tmp_path: Path) -> None:
    (found,) = faults(tmp_path, "X10", "Y10")
    assert found.startswith("3:1: Unknown command")


def test_names_with_digits_are_fine_where_the_machine_has_a_card_for_them(tmp_path: Path) -> None:
    setup = SETUP.replace("Count P9", "Count1 P9")
    (tmp_path / "setup.8k").write_text(setup)
    (tmp_path / "prog0.8k").write_text("PROGRAM\nCount1 = 5 : PRINT Count1\nENDP\n")
    assert "setup.8k:3:1: Illegal name" in check(tmp_path).stdout
    (tmp_path / "machine.toml").write_text("[card]\ndigits_in_names = true\n")
    assert "no errors" in check(tmp_path).stdout
    assert "no errors" in check(tmp_path / "prog0.8k").stdout


@pytest.mark.req("MILL-TUNE-21")
def test_a_low_pass_above_a_tenth_of_the_servo_rate_is_warned_of(tmp_path: Path) -> None:
    fast = SETUP + "PERIOD 0.0002\nLOPASS X500\nLOPASS X501\n"
    (tmp_path / "setup.8k").write_text(fast)
    (tmp_path / "prog0.8k").write_text("PROGRAM\nLOPASS X500\nIF (P0) THEN LOPASS X 600\nENDP\n")
    shown = check(tmp_path)
    assert shown.exit_code == 0
    assert [line for line in shown.stdout.splitlines() if ".8k:" in line] == [
        f"{tmp_path}/setup.8k:14:9: warning: LOPASS above a tenth of the servo rate "
        "(at most 500 Hz at PERIOD 0.0002)",
        f"{tmp_path}/prog0.8k:3:23: warning: LOPASS above a tenth of the servo rate "
        "(at most 500 Hz at PERIOD 0.0002)",
    ]
    assert shown.stderr == "2 warnings\n"


def test_the_usual_servo_rate_allows_200_hz(tmp_path: Path) -> None:
    lines = ("LOPASS X200 : LOPASS X200.5", "AXIS0 LOPASS 200", "AXIS0 LOPASS 300", "LOPASS X(P0)")
    places = [text.split(" warning")[0] for text in faults(tmp_path, *lines)]
    assert places == ["2:23:", "4:14:"]


def test_the_servo_period_may_be_set_after_the_filter(tmp_path: Path) -> None:
    assert faults(tmp_path, "LOPASS X500", "PERIOD 0.0002") == []


def test_the_machine_file_may_tell_the_servo_period(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text("[card]\nperiod_s = 0.0001\n")
    (tmp_path / "setup.8k").write_text(SETUP + "LOPASS X1000\nLOPASS X1001\n")
    (fault,) = json.loads(check(tmp_path, "--json").stdout)
    assert (fault["line"], fault["column"], fault["severity"]) == (13, 9, "warning")


def test_a_path_tolerance_is_warned_of_because_real_cards_have_none(tmp_path: Path) -> None:
    text = (
        "an extension of openacr: real cards refuse it"
        " (it limits corners between straight moves, not the turn of arcs, TARC, SINE and TRJ)"
    )
    lines = ("LOOK ON LOOK TOL 0.01", "LOOK ANG (1,2)", "IF (P0) THEN LOOK TOL 0")
    assert faults(tmp_path, *lines) == [f"2:9: warning: {text}", f"4:14: warning: {text}"]
    assert "2:1: warning" in check(_written(tmp_path, "PROG0\nLOOK TOL 1\n")).stdout


def test_eplc_is_warned_of_because_no_card_has_the_board(tmp_path: Path) -> None:
    text = "no modelled card has an ETHERNET Powerlink board: BIT16648 stays clear"
    lines = ("INH 16648", "IF (NOT BIT16649) THEN EPLC ON", "EPLC OFF")
    assert faults(tmp_path, *lines) == [f"3:24: warning: {text}", f"4:1: warning: {text}"]
    assert "2:1: warning" in check(_written(tmp_path, "PROG0\nEPLC ON\n")).stdout


def _written(folder: Path, text: str) -> Path:
    path = folder / "typed.8k"
    path.write_text(text)
    return path


def test_parameters_flags_and_axes_that_no_card_has_are_errors(tmp_path: Path) -> None:
    lines = (
        "P99999 = 3", "SET 1 99999", "INH -17664", "CLR BIT40000", "AXIS20 PPU 5",
        "P0 = P39999 + BIT(17664)", "IF (BIT1) THEN SET 32 : SET 20000", "PPU AXIS0 5 AXIS8 5",
    )  # fmt: skip
    found = [fault.split(" (")[0] for fault in faults(tmp_path, *lines)]
    assert found == [
        "2:2: Invalid parameter", "3:7: Invalid bit", "4:6: Invalid bit",
        "5:8: Invalid bit", "6:5: Invalid argument", "7:7: Invalid parameter",
        "7:19: Invalid bit", "8:29: Invalid bit", "9:17: Invalid argument",
    ]  # fmt: skip


def test_the_last_of_its_kind_exists(tmp_path: Path) -> None:
    lines = (
        "SET 17663 BIT17663",
        "INH -17663",
        "AXIS7 PPU 5",
        "P12288 = P4096",
        "X20000 : DWL 99999",
    )
    assert faults(tmp_path, *lines) == []


def test_numbers_in_lines_executed_at_once_are_checked(tmp_path: Path) -> None:
    setup = SETUP + "#DEFINE Nowhere P99999\nAXIS8 PPU 5\nSET 17664\n"
    (tmp_path / "setup.8k").write_text(setup)
    shown = check(tmp_path / "setup.8k").stdout
    for place in (
        "12:18: Invalid parameter",
        "13:5: Invalid argument",
        "14:5: Invalid bit",
    ):
        assert f"setup.8k:{place}" in shown


def test_config_of_other_hardware_is_warned_of_as_it_acts_later(tmp_path: Path) -> None:
    path = tmp_path / "setup.8k"
    path.write_text(
        "CONFIG\n  CONFIG ENC4 DAC4 NONE NONE\nCONFIG XIO 1\nCONFIG CLEAR\n"
        "CONFIG ENC8 DAC4 DAC4 ADC8\n"
    )
    result = check(path)
    notice = "warning: CONFIG acts after ESAVE and REBOOT"
    found = [line.split("setup.8k:")[1] for line in result.stdout.splitlines() if notice in line]
    assert found == [f"2:3: {notice}"]
    assert (result.exit_code, result.stderr) == (0, "1 warning\n")


@pytest.mark.parametrize("option", [("--program", "3"), ("--plc", "0"), ()])
def test_a_file_is_checked_for_the_program_or_plc_that_is_named(
    tmp_path: Path, option: tuple[str, ...]
) -> None:
    path = tmp_path / "mine.8k"
    path.write_text("10 LD 1\n20 OUT 32\n" if option[:1] == ("--plc",) else "PROGRAM\nP0=1\nENDP\n")
    result = check(path, *option)
    assert (result.exit_code == 0) is bool(option), result.output


def test_a_named_program_is_read_after_the_set_up_beside_it(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text('PROG2\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "Q"\n')
    path = tmp_path / "mine.8k"
    path.write_text("PROGRAM\nQ1\nENDP\n")
    assert check(path, "--program", "2").exit_code == 0
    assert "2:1: Unknown command" in check(path, "--program", "1").stdout


def test_options_without_a_meaning_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.8k"
    path.write_text("PROGRAM\nENDP\n")
    both = check(path, "--program", "0", "--plc", "0")
    whole = check(tmp_path, "--program", "0")
    assert (both.exit_code, whole.exit_code) == (2, 2)
    assert "--program and --plc exclude each other" in both.output
    assert "do not apply to a folder" in whole.output


def room(folder: Path, *setup: str, **files: str) -> list[str]:
    """What is said about the memory of a project."""
    (folder / "setup.8k").write_text("".join(f"{line}\n" for line in setup))
    for name, text in files.items():
        (folder / f"{name}.8k").write_text(text)
    found = check(folder).stdout.splitlines()
    return [line.rsplit("/", 1)[1] for line in found if line.startswith(f"{folder}/")]


LINE_BYTES = 4 + 4 + 4 + 4 + 4  # number, P, 0, =, 1


def test_programs_larger_than_their_memory_are_found(tmp_path: Path) -> None:
    program = "PROGRAM\nP0=1\nP0=1\n:\nENDP\n"
    whole = 8 + 2 * LINE_BYTES + 8
    enough = f"DIM P(1)\nDIM PROG9({whole})".split("\n")
    assert room(tmp_path, *enough, prog9=program) == []
    for short in (whole - 1, whole - 8):
        lines = room(tmp_path, "DIM P(1)", f"DIM PROG9({short})", prog9=program)
        hint = f"the text takes {whole} bytes, there is room for {short}"
        assert lines == [f"prog9.8k:5:1: Out of memory ({hint})"]
    (first,) = room(tmp_path, "DIM P(1)", prog9=program)
    assert first.startswith("prog9.8k:1:1: Out of memory (PROG9 has no memory yet: DIM PROG9(200)")


def test_a_text_takes_the_place_of_the_one_before_it(tmp_path: Path) -> None:
    program = "PROGRAM\nP0=1\nENDP\n"
    whole = 8 + LINE_BYTES + 8
    setup = ("DIM P(1)", f"DIM PROG0({whole})", "PROG0", *program.split("\n"))
    assert room(tmp_path, *setup, prog0=program) == []


def test_variables_take_from_the_memory_of_their_program(tmp_path: Path) -> None:
    program = "PROGRAM\nLV0=1\nENDP\n"
    whole = 8 + LINE_BYTES + 8
    for size, found in ((whole + 12, 0), (whole + 11, 1)):
        lines = room(tmp_path, f"DIM PROG1({size})", "PROG1", "DIM LV(3)", prog1=program)
        assert len(lines) == found, lines


def test_dims_the_card_refuses_are_found(tmp_path: Path) -> None:
    assert room(
        tmp_path,
        *("DIM PROG0(100)", "DIM PROG0(100)", "DIM P(4097)", "DIM DEF(100000)", "PROG0"),
        *("DIM LV(26)", "DIM LV(25)", "SYS", "NEW ALL", "CLEAR", "DIM PROG0(4)"),
    ) == [
        "setup.8k:2:1: Re-dimensioned block",
        "setup.8k:3:1: Invalid argument",
        "setup.8k:4:1: Out of memory",
        "setup.8k:6:1: Out of memory",
    ]


def test_a_plc_needs_its_memory(tmp_path: Path) -> None:
    rungs = "10 LD 1\n20 OUT 32\n"
    assert room(tmp_path, "DIM PLC0(16)", plc0=rungs) == []
    hint = "the text takes 16 bytes, there is room for 15"
    assert room(tmp_path, "DIM PLC0(15)", plc0=rungs) == [f"plc0.8k:2:1: Out of memory ({hint})"]


def test_check_finds_what_a_card_refuses_for_lack_of_memory(tmp_path: Path) -> None:
    """The same lines, in the same files, as a card that loads the project."""
    setup = ("DIM PROG0(40)", "DIM PROG0(40)", "DIM P(3)", "PROG0", "DIM LV(6)", "DIM $V(2,9)")
    found = room(tmp_path, *setup, prog0="PROGRAM\nP0=1\nENDP\n", plc3="10 LD 1\n20 OUT 32\n")
    _, errors = Controller.load(find_project(tmp_path))
    refused = {(Path(str(error.path)).name, error.line) for error in errors}
    places = {(line.split(":")[0], int(line.split(":")[1])) for line in found}
    assert places == {("setup.8k", 2), ("setup.8k", 6), ("prog0.8k", 2), ("plc3.8k", 1)}
    assert places <= refused


def test_a_computed_size_ends_the_arithmetic(tmp_path: Path) -> None:
    assert room(tmp_path, "DIM P(5)", "P0=8", "DIM PROG0(P0)", prog0="PROGRAM\nP0=1\nENDP\n") == []
    assert room(tmp_path, "DIM P(5)", "IF (P0) THEN DIM PROG0(8)", "DIM PROG0(8)") == []
    assert room(tmp_path, "DIM P(5)", "DIM PROG0(P0)", "DIM PROG1(8)", "DIM PROG1(8)") == []


def test_a_program_for_which_no_set_up_is_known_has_its_memory(tmp_path: Path) -> None:
    path = tmp_path / "prog9.8k"
    path.write_text("PROGRAM\nP12288=1\nENDP\n")
    assert check(path).exit_code == 0


@pytest.mark.parametrize(("line", "hint"), [
    ("CONFIG ENC8 STEPPER8 NONE NONE", "STEPPER8 for module 0: known are NONE, DAC2,"),
    ("CONFIG ENC5 DAC4 NONE NONE", "ENC5 for the encoders: known are NONE, ENC2,"),
    ("CONFIG ENC8 DAC4 DACSTEP2 NONE", "DACSTEP2 for module 1: known are NONE, DAC2,"),
    ("CONFIG ENC8 DAC4 NONE ADC4", "ADC4 for module 2: known are NONE, ADC8"),
])  # fmt: skip
def test_config_words_that_the_card_refuses_are_found(tmp_path: Path, line: str, hint: str) -> None:
    assert Controller().send(f"{line}\r").endswith("Invalid argument\r\nSYS>")
    (tmp_path / "setup.8k").write_text(f"{line}\n")
    shown = check(tmp_path)
    assert shown.exit_code == 1
    assert f"setup.8k:1:1: Invalid argument ({hint}" in shown.stdout
    for right in ("CONFIG ENC2 DACSTEP4 NONE NONE", "CONFIG CLEAR", "CONFIG"):
        (tmp_path / "setup.8k").write_text(f"{right}\n")
        assert "Invalid argument" not in check(tmp_path).stdout


@pytest.mark.parametrize(("line", "hint"), [
    ("IF (P0=1) THENP12544=0", "letters without a blank are one word: write THEN P"),
    ("GOTOP", "letters without a blank are one word: write GOTO P"),
    ("STARTP", "no command, alias or axis of this program has this name"),
    ("FSTATT", "did you mean FSTAT?"),
    ("VELL 5", "did you mean VEL?"),
])  # fmt: skip
def test_a_wrong_word_is_hinted_at_where_there_is_one_like_it(
    tmp_path: Path, line: str, hint: str
) -> None:
    (found,) = faults(tmp_path, line)
    assert f"({hint})" in found


def test_digits_end_a_word_and_letters_do_not(tmp_path: Path) -> None:
    assert faults(tmp_path, "IF (BIT0OR BIT1) THEN P1=2") == []


AT_ONCE = "warning: an output right after a move is set when the move begins"


@pytest.mark.parametrize(("lines", "places"), [
    (("X10", "SET 32"), [(3, 1)]),
    (("X10", "CLR 63"), [(3, 1)]),
    (("X/10", "BIT34=1"), [(3, 1)]),
    (("X10 : SET 33", "SET 34"), [(2, 7)]),
    (("X10", "REM then", "SET 35"), [(4, 1)]),
    (("X10", "INH -516", "SET 36"), []),
    (("X10", "P0=1", "SET 37"), []),
    (("X10", "SET 64"), []),
    (("X10", "SET 31"), []),
    (("SET 38", "X10"), []),
    (("JOG ABS X10", "SET 39"), []),
])  # fmt: skip
def test_an_output_right_after_a_move_is_warned_of(
    tmp_path: Path, lines: tuple[str, ...], places: list[tuple[int, int]]
) -> None:
    found = [text for text in faults(tmp_path, *lines) if AT_ONCE in text]
    assert [text.split(": ")[0] for text in found] == [f"{y}:{x}" for y, x in places]


@pytest.mark.parametrize(("programs", "warned"), [
    ((8, 9), [8]), ((14, 15), [14]), ((8,), []), ((7, 8), []), ((0, 7), []),
])  # fmt: skip
@pytest.mark.parametrize("wait", ["DWL 1", "INH 24"])
def test_a_wait_in_programs_that_share_a_slice_is_warned_of_once(
    tmp_path: Path, programs: tuple[int, ...], warned: list[int], wait: str
) -> None:
    setup = "".join(f"DIM PROG{n}(2000)\n" for n in programs if n > 7)
    (tmp_path / "setup.8k").write_text(setup)
    for n in programs:
        body = f"{wait}\n{wait}\n" if n == programs[0] else "P1=1\n"
        (tmp_path / f"prog{n}.8k").write_text(f"PROGRAM\n{body}ENDP\n")
    shown = [line for line in check(tmp_path).stdout.splitlines() if "share a time slice" in line]
    assert [line.split(":")[0] for line in shown] == [f"{tmp_path}/prog{n}.8k" for n in warned]


@pytest.mark.parametrize(("lines", "text"), [
    (("AXIS0 JOG VEL 35", "AXIS0 JOG DEC 0.1"), "a stop from JOG VEL 35 takes 350 s"),
    (("AXIS0 JOG DEC 0.5", "AXIS0 JOG VEL 31"), "a stop from JOG VEL 31 takes 62 s"),
    (("AXIS0 JOG VEL 30", "AXIS0 JOG DEC 0.5"), None),
    (("AXIS0 JOG VEL 35", "AXIS1 JOG DEC 0.1"), None),
    (("AXIS0 DZL 0.1",), "DZL is in whole pulses: 0.1 is 0"),
    (("AXIS1 DZU -2.5",), "DZU is in whole pulses: -2.5 is -2"),
    (("AXIS0 DZL 3",), None),
])  # fmt: skip
def test_settings_that_are_hardly_meant_are_warned_of(
    tmp_path: Path, lines: tuple[str, ...], text: str | None
) -> None:
    (tmp_path / "setup.8k").write_text("".join(f"{line}\n" for line in lines))
    shown = check(tmp_path)
    assert shown.exit_code == 0
    assert ("warning" in shown.stdout) is (text is not None)
    assert text is None or text in shown.stdout


@pytest.mark.parametrize("word", ["DZL", "DZU", "FFVC"])
def test_whole_pulses_are_looked_for_in_stored_programs_too(tmp_path: Path, word: str) -> None:
    found = faults(tmp_path, f"AXIS0 {word} 3", f"AXIS0 {word} 2.5")
    assert [text.split(": ", 1)[1] for text in found] == [
        f"warning: {word} is in whole pulses: 2.5 is 2"
    ]


def test_the_axis_of_a_name_and_of_a_number_is_the_same(tmp_path: Path) -> None:
    found = faults(tmp_path, "JOG VEL X35", "AXIS0 JOG DEC 0.1")
    assert [text.split(" (")[0] for text in found] == [
        "3:7: warning: a stop from JOG VEL 35 takes 350 s"
    ]


def test_a_part_of_a_program_gets_one_hint_that_axes_are_not_attached(tmp_path: Path) -> None:
    path = tmp_path / "part.8k"
    path.write_text("PROG0\nX10 Y5\nY3\nACC 100\nX/20\n")
    shown = [line for line in check(path).stdout.splitlines() if "part.8k:" in line]
    assert len(shown) == 1
    assert shown[0].startswith(f"{path}:2:1: Unknown command (no axis is attached: ATTACH")
    path.write_text("X10 Y5\nSP3\nACC 100\n")
    assert check(path, "--axes", "X,Y,SP").exit_code == 0
    assert "2:1: Unknown command" in check(path, "--axes", "XY").stdout
    wrong = check(path, "--axes", "X1")
    assert wrong.exit_code == 2
    assert "'1' is no name of an axis" in str(wrong.exception) + wrong.output


def test_a_text_without_memory_is_refused_with_its_cure(tmp_path: Path) -> None:
    path = tmp_path / "prog9.8k"
    path.write_text("PROGRAM\nSET 128\nENDP\n")
    text = "prog9.8k:1:1: Out of memory (PROG9 has no memory yet: DIM PROG9("
    shown = check(tmp_path).stdout
    assert text in shown
    cure = shown.split(": DIM ")[1].split(" at SYS")[0]
    (tmp_path / "setup.8k").write_text(f"DIM {cure}\n")
    assert "no errors" in check(tmp_path).stdout
    (tmp_path / "setup.8k").write_text("DIM PROG9(10)\n")
    assert "there is room for 10)" in check(tmp_path).stdout


@pytest.mark.parametrize(("setup", "text"), [
    ("RUN PROG3", "PROG3 is empty here: nothing is started"),
    ("PROG3\nRUN", "PROG3 is empty here: nothing is started"),
    ("LRUN PROG3", "PROG3 is empty here: nothing is started"),
    ("RUN PLC1", "PLC1 is empty here: nothing is started"),
    ("RUN ALL", None),
    ("PROG3\n10 SET 128\nRUN", None),
    ("PROG3\n10 SET 128\nNEW\nRUN", "PROG3 is empty here: nothing is started"),
])  # fmt: skip
def test_a_start_of_an_empty_program_is_warned_of(
    tmp_path: Path, setup: str, text: str | None
) -> None:
    (tmp_path / "setup.8k").write_text(f"{setup}\n")
    (tmp_path / "prog3.8k").write_text("PROGRAM\nSET 128\nENDP\n")
    shown = check(tmp_path)
    assert shown.exit_code == 0
    assert ("is empty here" in shown.stdout) is (text is not None)
    assert text is None or f"warning: {text}" in shown.stdout
