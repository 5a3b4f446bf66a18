"""State of rs274ngc programs: names, M61, M66, M70 to M73, polar words, computed codes."""

import pytest
from tests.cnc.programs import Bench, Run, made, run

from openacr.cnc.canonical import Line, PathMode, Say, SetCell, WaitBit
from openacr.cnc.codes.ngc.contexts import FIELDS
from openacr.cnc.codes.ngc.named import PREDEFINED
from openacr.cnc.codes.ngc.parameters import axes_by_letter
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.state.cells import TOOL_IN_SPINDLE
from openacr.cnc.state.shadow import Shadow
from openacr.sysvar.tabs import AXIS


def ngc(text: str, cells: dict[int, float] | None = None, **more: object) -> Run:
    return run(text.replace("|", "\n"), cells, dialect="rs274ngc", **more)  # type: ignore[arg-type]


def fault(text: str, dialect: str = "rs274ngc") -> str:
    """The first error, at load or in the run; empty without one."""
    done = made(text.replace("|", "\n"), dialect=dialect, axes=5)
    if done.interpreter.program.errors:
        return str(done.interpreter.program.errors[0])
    try:
        list(done.interpreter.entries())
    except BlockError as error:
        return str(error.finding)
    return ""


POLAR = "E236 polar coordinates not possible here"
RANGE = "E222 value out of range"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("#<_x>=2", "1:1: E212 parameter is read only: #<_x>"),
        ("G1 F1 X1|#<_ini[a]b>=2", "2:1: E212 parameter is read only: #<_ini[a]b>"),
        ("#5403=1", "1:1: E212 parameter is read only: #5403"),
        ("#5399=1", "1:1: E212 parameter is read only: #5399"),
        ("G[0-1]", "1:1: E203 unknown G code: G-1"),
        ("X1 G[1.05]", "1:4: E204 integer expected"),
        ("#1=1.05|X1 G#1", "2:4: E204 integer expected"),
        ("G[1/0]", "1:1: E210 arithmetic error: division by zero"),
        ("G[10**300]", "1:1: E204 integer expected"),
        ("#1=1|G#1 G0 X1", "2:5: E201 two codes of one group: G0"),
        ("#1=1|G0 G#1 X1", "2:4: E201 two codes of one group: G1"),
        ("#1=3.5|M#1", "2:1: E204 integer expected"),
        ("#1=200|M#1", "2:1: E205 unknown M code: M200"
                       " (a code of the dialect acromill: --dialect acromill)"),
        ("#1=4|G#1", f"2:1: {RANGE}: P is missing (P 0 to 1e+06)"),
        ("M66", f"1:1: {RANGE}: P is missing (P 0 to 31)"),
        ("M66 P1 L5", f"1:8: {RANGE}: L5 (L 0 to 4)"),
        ("M66 P1 L3 Q0", f"1:11: {RANGE}: Q0 (Q above 0, or L0)"),
        ("M66 P1 L3 Q-1", f"1:11: {RANGE}: Q-1 (Q 0 to 1e+06)"),
        ("M66 P1.5", "1:5: E204 integer expected: P"),
        ("M66 P32", f"1:5: {RANGE}: P32 (P 0 to 31)"),
        ("M61", f"1:1: {RANGE}: Q is missing (Q 0 to 999)"),
        ("M61 Q-1", f"1:5: {RANGE}: Q-1 (Q 0 to 999)"),
        ("M61 Q1.5", "1:5: E204 integer expected: Q"),
        ("M61 Q1000", f"1:5: {RANGE}: Q1000 (Q 0 to 999)"),
        ("M72", "1:1: E265 no modal state is kept (M70 or M73 keeps it, in the same call)"),
        ("M70|M71|M72", "3:1: E265 no modal state is kept (M70 or M73 keeps it, in the same call)"),
        ("M70|o1 call|M2|o1 sub|M72|o1 endsub",
         "5:1: E265 no modal state is kept (M70 or M73 keeps it, in the same call)"),
        ("M70|G41.1 D.1 G1 F10 X1|M72",
         "3:1: E311 plane, scale or rotation change with compensation"
         " (compensation and its plane are not restored)"),
        ("G0 @5", f"1:4: {POLAR} (at the origin the angle is needed, with G90)"),
        ("G91 G0 @5 ^1", f"1:8: {POLAR} (at the origin the angle is needed, with G90)"),
        ("G0 ^1 @5 X1", f"1:4: {POLAR} (@ and ^ take the place of X and Y)"),
        ("G0 @5 Y1", f"1:4: {POLAR} (@ and ^ take the place of X and Y)"),
        ("G18 G0 @5 ^1", f"1:8: {POLAR} (polar coordinates lie in the XY plane: G17)"),
        ("G28 @1 ^1", f"1:5: {POLAR} (not with G28)"),
        ("G53 G0 @1 ^1", f"1:8: {POLAR} (not with G53)"),
        ("G10 L2 P1 ^1", f"1:11: {POLAR} (not with G10)"),
        ("G92 @1 ^1", f"1:5: {POLAR} (not with G92)"),
        ("G52 @1 ^1", f"1:5: {POLAR} (not with G52)"),
        ("G5.1 @1 ^1 I1", f"1:6: {POLAR} (not with G5.1)"),
        ("G0 @", "1:5: E105 value expected after letter"),
        ("G0 @1 @2", "1:7: E202 word given twice: @"),
        ("M99", "1:1: E261 RET without GOSUB (M99 ends a subroutine; M30 ends a program)"),
        ("G52", "1:1: E206 word has no meaning in this block (G52 X0 Y0 Z0 ends the shift)"),
        ("G43.1",
         "1:1: E206 word has no meaning in this block (the offset is given by axis words)"),
        ("G43.2", f"1:1: {RANGE} (H or axis words, not both)"),
        ("G43.2 H1 X1", f"1:7: {RANGE} (H or axis words, not both)"),
        ("G38.2", "1:1: E206 word has no meaning in this block (axis words are needed)"),
        ("G0 G38.2 X1", "1:4: E201 two codes of one group: G38.2"),
        ("G91 G53 G0 X1", "1:1: E206 word has no meaning in this block"
                          " (machine positions are absolute: G90)"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_with_its_place(text: str, found: str) -> None:
    assert fault(text) == f"PROGRAM:{found}"


def test_a_machine_without_y_has_no_polar_coordinates() -> None:
    done = made("G0 @1 ^0", axes=1, dialect="rs274ngc")
    assert [str(each) for each in done.interpreter.program.errors] == [
        "PROGRAM:1:4: E207 axis not configured: Y"
    ]


def test_polar_words_are_exact_at_right_angles() -> None:
    assert ngc("G0 @2 ^90|^180|^-30").ends == [(0, 2, 0), (-2, 0, 0), (1.732050808, -1, 0)]


def test_polar_lengths_are_in_active_units_and_angles_are_not() -> None:
    assert ngc("G21 G0 @50.8 ^90|G91 @25.4 ^90").ends == [(0, 2, 0), (-3, 0, 0)]


def test_computed_codes_exist_in_both_dialects() -> None:
    assert run("P200=1\nG(P200-1) X1\nG#200 X2 F10").moves == ["R X1", "L X2"]
    assert run("M(3+P200) S100").story == ["M3 S100", "end"]
    assert run("P200=10\nG65 P5 M(P200)\nM2\nN5 G0 X#15\nRET").moves == ["R X10"]
    text = "P200=81\nG(P200) X1 Z-1 R1 F10\nG80\nM2\n$I CYCLES.TXT"
    assert run(text).moves == ["R X1", "R X1 Z1", "L X1 Z-1", "R X1"]
    assert fault("G(80+1) X1 Z-1 R1", "acromill").startswith("PROGRAM:1:1: E251")


def test_a_computed_code_is_computed_at_every_pass() -> None:
    text = "F10|#1=0|o1 while [#1 LT 3]|G[#1 MOD 2] X#1 Y1|#1=[#1+1]|o1 endwhile"
    assert ngc(text).moves == ["R Y1", "L X1 Y1", "R X2 Y1"]


def test_a_computed_code_waits_for_the_machine() -> None:
    done = run("G0 X1\nP3=1\nG(P3) X2 F10")
    assert done.moves == ["R X1", "L X2"]


@pytest.mark.parametrize("name", PREDEFINED)
def test_every_name_has_a_value_and_exists(name: str) -> None:
    done = ngc(f"F10 G1 X1|#1=#<{name}>|#2=EXISTS[#<{name}>]|G0 Y#2")
    assert done.error is None
    assert done.moves[-1] == "R X1 Y1"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G21 G0 X25.4 A90|(DEBUG,#<_x> #<_a> #5420 #5423 #<_abs_x>)", "25.4 90 25.4 90 25.4"),
        ("G10 L2 P1 X3|G0 X1|(DEBUG,#<_x> #<_abs_x>)", "1 4"),
        ("G21|F254|(DEBUG,#<_feed>)", "254"),
        ("G20 F10|G21|(DEBUG,#<_feed>)", "254"),
        ("G81 X1 Z-1 R1 F1|(DEBUG,#<_motion_mode>)", "810"),
        ("(DEBUG,#<_motion_mode>)", "10"),
        ("G43.1 X1|(DEBUG,#<_tool_offset>)", "1"),
        ("M3 S5|M5|(DEBUG,#<_spindle_on> #<_spindle_cw> #<_rpm>)", "0 0 5"),
        ("(DEBUG,#<_line>)", "1"),
        ("(DEBUG,#<_task> #<_b> #<_u>)", "1 0 0"),
        ("G21 T2 M6|(DEBUG,#5403 #5410 #5400)", "31.75 12.7 2"),
    ],
)
def test_names_show_the_state_in_active_units(text: str, said: str) -> None:
    done = ngc(text, {2002: 1.25, 1002: 0.25}, axes=4)
    assert f"say {said}" in done.story


def test_m61_says_which_tool_is_in_the_spindle() -> None:
    done = ngc("M61 Q3|T3 M6|T4 M6")
    (cell,) = [
        e for e in done.of(SetCell) if isinstance(e, SetCell) and e.parameter == TOOL_IN_SPINDLE
    ]
    assert cell.value == 3
    assert [text for text in done.story if text.startswith("tool")] == ["tool 4"]
    dry = ngc("M61 Q3|G43|G0 Z0", {2003: 2.0}, options=Options(is_dry=True))
    assert not dry.of(SetCell)
    assert dry.moves == ["R Z2"]


@pytest.mark.parametrize(
    ("line", "wait"),
    [
        ("M66 P3 L1 Q2", (3, True, True, 2.0)), ("M66 P3 L2 Q.5", (3, False, True, 0.5)),
        ("M66 P3 L3", (3, True, False, float("inf"))), ("M66 P3 L4 Q9", (3, False, False, 9.0)),
    ],
)  # fmt: skip
def test_m66_waits_for_states_and_edges(line: str, wait: tuple[int, bool, bool, float]) -> None:
    (entry,) = ngc(line).of(WaitBit)
    assert isinstance(entry, WaitBit)
    assert (entry.bit, entry.is_on, entry.is_edge, entry.limit_s) == wait


@pytest.mark.parametrize(
    ("line", "bits", "value"),
    [
        ("M66 P3", {3}, 1), ("M66 P3", set(), 0), ("M66 P3 L0 Q5", {3}, 1),
        ("M66 P3 L3 Q1", {3}, 1), ("M66 P3 L3 Q1", set(), -1),
        ("M66 P3 L1 Q1", {3}, 1), ("M66 P3 L1 Q1", set(), -1),
        ("M66 P3 L4 Q1", set(), 0), ("M66 P3 L4 Q1", {3}, -1),
        ("M66 P3 L2 Q1", set(), 0), ("M66 P3 L2 Q1", {3}, -1),
    ],
)  # fmt: skip
def test_m66_says_what_it_found(line: str, bits: set[int], value: float) -> None:
    done = ngc(f"{line}|G0 X[5+#5399]", machine=Bench(bits=bits))
    assert done.ends == [(5 + value, 0, 0)]
    inverted = ngc(f"{line}|G0 X[5+#5399]", {251_003: 1.0}, machine=Bench(bits={3} - bits))
    assert inverted.ends == [(5 + value, 0, 0)]


def test_the_state_kept_by_m70_is_that_of_its_call() -> None:
    text = "G91|M70|o1 call|X1|G90|M72|X1|M2|o1 sub|M73|G90|M71|o1 endsub"
    assert ngc(f"F10 G1 X1|{text}").ends == [(1, 0, 0), (2, 0, 0)]


def test_a_length_and_its_addition_are_restored() -> None:
    cells = {2001: 1.0, 2002: 2.0}
    done = ngc("G43 H1|G43.2 X1|M70|G43 H2|G0 X0 Z0|M72|G0 X0 Z0", cells)
    assert done.ends == [(0, 0, 2), (1, 0, 1)]


def test_spindle_and_coolant_are_switched_only_where_they_differ() -> None:
    story = ngc("M3 S100 M8|M70|M72|S200|M72|M9|M7|M72").story
    assert story == [
        "M3 S100", "coolant 01", "M3 S200", "M3 S100", "coolant 00", "coolant 10", "coolant 01",
        "end",
    ]  # fmt: skip
    dry = ngc("M3 S100|M70|M5|M72", options=Options(is_dry=True)).story
    assert dry == ["end"]


def test_g38_stays_active_as_in_linuxcnc() -> None:
    done = ngc("F10 G38.3 X1|Y2|G0 X0")
    assert done.moves == ["P X1", "P X1 Y2", "R Y2"]
    many = "F10 G38.3 X1|F20|F30|X2|F40|Y1|G0 X0"
    for options in (Options(), Options(has_batches=True)):
        assert ngc(many, options=options).moves == ["P X1", "P X2", "P X2 Y1", "R Y1"]
    assert fault("F10 G38.3 X1|Y2 R1") == "PROGRAM:2:4: E206 word has no meaning in this block: R"


@pytest.mark.parametrize(
    ("text", "story"),
    [
        ("S100 M3 G0 Z2|G86 Z-1 R1 P.5|G80",
         ["M3 S100", "R Z2", "R Z1", "L Z-1", "dwell 0.5", "M5 S100", "R Z2", "orient 0",
          "M3 S100"]),
        ("S100 M4 G0 Z2|G86 Z-1 R1|G80",
         ["M4 S100", "R Z2", "R Z1", "L Z-1", "M5 S100", "R Z2", "orient 0", "M4 S100"]),
        ("G0 Z2|G89 Z-1 R1 P.5|G80", ["R Z2", "R Z1", "L Z-1", "dwell 0.5", "L Z2"]),
        ("G0 Z2|G99 G89 Z-1 R1|G80", ["R Z2", "R Z1", "L Z-1", "L Z1"]),
    ],
)  # fmt: skip
def test_cycles_of_linuxcnc_that_differ(text: str, story: list[str]) -> None:
    assert ngc(f"F10|{text}").story == [*story, "end"]


def test_the_cycles_of_the_guide_stay_as_they_are() -> None:
    text = "F10 G0 Z2\nS100 M3 G86 Z-1 R1 P.5\nG89 Z-1 R1 P.5\nG80\nM2\n$I CYCLES.TXT"
    assert run(text).story == [
        "R Z2", "M3 S100", "R Z1", "L Z-1", "R Z2", "R Z1", "L Z-1", "dwell 0.5", "R Z2", "end",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "moves"),
    [
        ("F10 G 1 X 2 . 5 Y 1 0", ["L X2.5 Y10"]), ("F10 G1 X1 2.5", ["L X12.5"]),
        ("F10 G1 X. 5 Y - 1 .", ["L X0.5 Y-1"]), ("F10 G1 X[1 2+ 3]", ["L X15"]),
    ],
)  # fmt: skip
def test_blanks_mean_nothing(text: str, moves: list[str]) -> None:
    assert ngc(text).moves == moves


def test_blanks_end_a_number_in_the_dialect_of_the_guide() -> None:
    assert fault("F10 G1 X1 2", "acromill") == "PROGRAM:1:11: E104 unexpected character"


@pytest.mark.parametrize("field", FIELDS)
def test_every_field_of_the_modal_state_comes_back(field: str) -> None:
    changes = "F20 G21|G18|G91|G43 H1|G99|G61|G64 P.5|G90.1|G93|M4 S200|M7 M8|M49"
    text = f"M70|(MSG,before)|{changes}|(MSG,between)|M72|(MSG,after)"
    done = made(text.replace("|", "\n"), {2001: 1.0}, dialect="rs274ngc")
    seen = [
        getattr(done.interpreter.modal, field)
        for entry in done.interpreter.entries()
        if isinstance(entry, Say)
    ]
    before, between, after = seen
    assert before == after
    assert before != between or field == "path"


def test_the_path_mode_comes_back() -> None:
    done = ngc("F10 G61|M70|G64 P.5|M72|G1 X1")
    (line,) = done.of(Line)
    assert isinstance(line, Line)
    assert (line.pace.mode, line.pace.tolerance_u) == (PathMode.EXACT, 0.0)


def test_m70_alone_restores_nothing_at_the_end_of_a_subroutine() -> None:
    text = "F10 G91|o1 call|G1 X1|X1|M2|o1 sub|{}|G90|o1 endsub"
    assert ngc(text.format("M70")).ends == [(1, 0, 0)]
    assert ngc(text.format("M73")).ends == [(1, 0, 0), (2, 0, 0)]


def test_numbers_of_points_count_letters_not_axes(monkeypatch: pytest.MonkeyPatch) -> None:
    names = {AXIS.name[axis]: letter for axis, letter in enumerate("ZXAY")}
    monkeypatch.setattr(Shadow, "read_text", lambda _, n: names.get(n, "CBUV"[n % 4]))
    text = "G21 G0 X25.4 Y50.8 Z76.2 A30|(DEBUG,#5420 #5421 #5422 #5423)"
    assert "say 25.4 50.8 76.2 30" in ngc(text, axes=4).story
    done = ngc("#5221=1 #5222=2 #5223=3 #5224=4|G0 X0 Y0 Z0 A0|#5161=7|#5162=#5161", axes=4)
    assert [done.p(910 + axis) for axis in range(5)] == [3, 1, 4, 2, 0]
    assert done.entries[0].end[:4] == (3, 1, 4, 2)  # type: ignore[union-attr]
    assert (done.p(280 + 1), done.p(280 + 3)) == (7, 7)


def test_letters_without_an_axis_have_the_numbers_that_are_left() -> None:
    assert axes_by_letter({"X": 0, "Y": 1, "Z": 2}) == list(range(8))
    assert axes_by_letter({"Y": 0, "Z": 4, "X": 2}) == [2, 0, 4, 1, 3, 5, 6, 7]
    assert axes_by_letter({"W": 0, "X": 1}) == [1, 0, 2, 3, 4, 5, 6, 7]


def test_polar_words_without_a_motion_are_refused() -> None:
    done = ngc("F10 G80|@1 ^30")
    assert done.error is not None
    assert (done.error.code, done.error.column) == ("E206", 1)
