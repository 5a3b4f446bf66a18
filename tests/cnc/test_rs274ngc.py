"""Programs of other controls: the rs274ngc dialect."""

import math
from pathlib import Path

import pytest
from tests.cnc.programs import Bench, Run, errors, run, shown

from openacr.cnc.canonical import Arc, Line, PathMode, Probe
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.loading.load import Folders
from openacr.cnc.state.cells import SPIRALS


def ngc(text: str | Path, cells: dict[int, float] | None = None, **more: object) -> Run:
    return run(text, cells, dialect="rs274ngc", **more)  # type: ignore[arg-type]


def wrong(text: str) -> list[str]:
    return errors(text, dialect="rs274ngc")


@pytest.mark.parametrize(
    ("text", "moves"),
    [
        ("#1=3 G1 F10 X#1", ["L 0"][:0]),
        ("#1=3|#2=#1|G1 F10 X#1 Y[#2*2]", ["L X3 Y6"]),
        ("#<r>=2|#<_g>=3|G1 F10 X#<r> Y#<_G>", ["L X2 Y3"]),
        ("G1 F10 X[EXISTS[#<a>]] Y[1 LT 2]", ["L Y1"]),
        ("G1 F10 X[5 MOD 3] Y[-1 MOD 3] (comment)", ["L X2 Y2"]),
        ("G1 F10 X-[2] YABS[-4]", ["L X-2 Y4"]),
        ("(P is no parameter)|G4 P2|G1 F10 X1", ["L X1"]),
        ("G20 F10 G1 X1|G53 G0 X2|X3", ["L X1", "R X2", "R X3"]),
        ("G0 G90 X1|G91 X1", ["R X1", "R X2"]),
        ("G90.1|G2 F10 X2 I1 J0", ["A X2 about 1,0 -180"]),
        ("G3 F10 X2 R1", ["A X2 about 1,0 180"]),
        ("G43.1 Z1|G0 Z0|G49|G0 Z0", ["R Z1", "R 0"]),
        ("G80|G0 X1|G81 R.1 Z-1 X2|M30|X9",
         ["R X1", "R X1 Z0.1", "R X2 Z0.1", "L X2 Z-1", "R X2 Z0.1"]),
    ],
)  # fmt: skip
def test_programs_move_as_they_say(text: str, moves: list[str]) -> None:
    assert ngc(text.replace("|", "\n")).moves == moves


def test_assignments_act_after_the_block() -> None:
    done = ngc("#1=5\n#1=6 #2=#1\nG1 F10 X#1 Y#2")
    assert done.moves == ["L X6 Y5"]


@pytest.mark.parametrize(
    ("text", "moves"),
    [
        ("F10|O4 i f [0]|G1 X1|O4 else if [1]|X2|o4 el se|X3|O4 end\tif (o)|Y1",
         ["L X2", "L X2 Y1"]),
        ("F10 G91|O1 repeat [2]|O2 repeat [2]|X1|O2 endrepeat|Y1|O1 endrepeat",
         ["L X1", "L X2", "L X2 Y1", "L X3 Y1", "L X4 Y1", "L X4 Y2"]),
        ("O7 sub|G1 F10 X1|M99|O7 endsub|M98 P7|M2", ["L X1"]),
        ("G2 F10 X1 Y1 R1", ["A X1 Y1 about 1,0 -90"]),
        ("G3 F10 X2 R-1.25", ["A X2 about 1,-0.75 254"]),
        ("G90.1|G1 F10 X1 Y1|G2 X3 Y1 I2 J1", ["L X1 Y1", "A X3 Y1 about 2,1 -180"]),
        ("G91.1|G1 F10 X1 Y1|G2 X3 Y1 I1 J0", ["L X1 Y1", "A X3 Y1 about 2,1 -180"]),
        ("G91 G91.1 F10|G1 X1|G2 X2 I1", ["L X1", "A X3 about 2,0 -180"]),
        ("#2=3|#3=7|G1 F10 X##2 Y#[1+1]", ["L X7 Y3"]),
        ("#<Tool Size>=2|G1 F10 X#<toolsize>", ["L X2"]),
        ("#<_n>=1|O1 sub|#<_n>=2|O1 endsub|O1 call|G1 F10 X#<_n>", ["L X2"]),
        ("#31=4|O1 sub|#31=5|O1 endsub|O1 call|G1 F10 X#31", ["L X5"]),
        ("#30=4|O1 sub|#30=5|O1 endsub|O1 call|G1 F10 X#30", ["L X4"]),
        ("o<box> sub|g1 f10 x#1|o<box> endsub|o<BOX> call [3]|m2", ["L X3"]),
        ("#3=101|o#3 call|o[#3+1] call|m2|o101 sub|g1 f10 x1|o101 endsub|o102 sub|y1|o102 endsub",
         ["L X1", "L X1 Y1"]),
        ("O1000|G1 F10 X1|M98 P7|X2|M30|O7 (sub)|Y1|M99", ["L X1", "L X1 Y1", "L X2 Y1"]),
        ("O1 sub|O2 repeat [3]|G91 G1 F10 X1|O3 if [#1 EQ 1]|O1 return|O3 endif|O2 endrepeat|"
         "O1 endsub|O1 call [1]|O1 call [0]", ["L X1", "L X2", "L X3", "L X4"]),
        ("G20 G1 F10 X1|G21 X50.8", ["L X1", "L X2"]),
        ("%|G1 F10 X1|%|X2", ["L X1"]),
        ("G41.1 D.5 G1 F10 X1|X2|G40 X3 Y1", ["L X1 Y0.25", "L X2 Y0.25", "L X3 Y1"]),
        ("G42.1 D.5 G1 F10 X1|X2|G40 X3 Y1", ["L X1 Y-0.25", "L X2 Y-0.25", "L X3 Y1"]),
        ("G41 D1 G1 F10 X1|X2|G40 X3", ["L X1 Y0.5", "L X2 Y0.5", "L X3"]),
        ("T2 M6|G41 G1 F10 X1|X2|G40 X3", ["L X1 Y0.125", "L X2 Y0.125", "L X3"]),
    ],
)  # fmt: skip
def test_programs_of_other_controls_are_read_as_meant(text: str, moves: list[str]) -> None:
    assert ngc(text.replace("|", "\n"), {1001: 0.5, 1002: 0.125}).moves == moves


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("(MSG, hello #1)", "hello #1"), ("(msg,hello)", "hello"), ("(DEBUG, a #1 b)", "a 5 b"),
        ("(print,#<_name>, #<Local> P1)", "2.5, 7 P1"), ("(LOG, #1)", "5"),
        ("(DEBUG, #<none>)", "######"),
    ],
)  # fmt: skip
def test_comments_speak(text: str, said: str) -> None:
    done = ngc(f"#1=5\n#<_name>=2.5\n#<local>=7\n{text}\n(only a comment)\n(LOGOPEN, x)")
    assert done.story == [f"say {said}", "end"]


def test_subroutines_may_stand_in_files_of_their_own(tmp_path: Path) -> None:
    (tmp_path / "square.ngc").write_text(
        "o<square> sub\no1 repeat [2]\ng91 g1 x#1\no<step> call\no1 endrepeat\no<square> endsub\n"
    )
    (tmp_path / "STEP.NGC").write_text("o<step> sub\ng91 g1 y1\no<step> endsub\nm2\n")
    program = tmp_path / "main.ngc"
    program.write_text("f10\no1 repeat [2]\no<square> call [3]\no1 endrepeat\nm2\n")
    done = ngc(program)
    assert done.moves[-1] == "L X12 Y4"
    assert len(done.moves) == 8
    program.write_text("o<nowhere> call\n")
    assert errors(program, dialect="rs274ngc") == ["E220"]


def test_a_program_that_is_run_again_begins_its_loops_anew() -> None:
    done = ngc("G91 F10\nO1 repeat [2]\nG1 X1\nM2\nO1 endrepeat")
    assert done.moves == ["L X1"]
    for n in range(2, 5):
        assert [shown(entry) for entry in done.interpreter.entries()] == [f"L X{n}", "end"]


@pytest.mark.parametrize(
    ("text", "tolerance"),
    [("G64", 0.0), ("G64 P.01", 0.01), ("G64 P0.01 Q0.02", 0.01), ("G64 P0", 0.0),
     ("G21 G64 P2.54|G20", 0.1), ("G64 P.01|G64", 0.0), ("G64 P.01|G61|G64", 0.0)],
)  # fmt: skip
def test_a_path_tolerance_is_taken(text: str, tolerance: float) -> None:
    (line,) = ngc(f"{text}\nG1 F10 X1".replace("|", "\n")).of(Line)
    assert isinstance(line, Line)
    assert line.pace.mode is PathMode.FREE
    assert line.pace.tolerance_u == pytest.approx(tolerance)


def test_a_path_tolerance_ends_with_exact_stops_and_with_the_program() -> None:
    done = ngc("G64 P.01\nG61 G1 F10 X1\nG64 P.02\nM2")
    (line,) = done.of(Line)
    assert isinstance(line, Line)
    assert line.pace.tolerance_u == 0.0
    assert done.interpreter.modal.tolerance == 0.0
    assert wrong("G64 P-.01") == ["E222"]


def test_subroutines_have_parameters_and_names_of_their_own() -> None:
    text = "#1=9\n#<a>=1\nO1 sub\n#1=5\n#<a>=2\nO1 endsub\nO1 call\nG1 F10 X#1 Y#<a>"
    assert ngc(text).moves == ["L X9 Y1"]


def test_parameters_of_a_run_do_not_touch_the_store() -> None:
    done = ngc("#150=7\n#905=3\nG1 F10 X#150 Y#905")
    assert done.moves == ["L X7 Y3"]
    assert done.cells.read(150) == 0
    assert not done.machine.parameters


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G65 P1", "E203"), ("G27 X1", "E203"), ("G70", "E203"), ("G76 X1", "E203"),
        ("G95", "E203"), ("M12", "E205"), ("M595", "E205"), ("IF 1 THEN GOTO 5", "E104"),
        ("X(1)", "E105"), ("O1 sub\nX", "E105"), ("O1 jump", "E108"), ("O1 while", "E108"),
        ("G80\nX1", "E206"), ("G30 P2 X1", "E206"), ("G4 F1", "E222"), ("G93 G1 X1", "E222"),
        ("G2 F10 X2 I1.1 J0", "E230"), ("O9 call", "E220"), ("G10 L2 P10 X1", "E241"),
        ("#5999=1", "E212"), ("#6001=1", "E211"), ("X#<none>", "E211"),
        ("O1 sub\nO1 endsub\nO1 sub", "E221"),
        ("O1 while [1]\nX1\nM2", ""), ("F10 O1 do", "E104"),
    ],
)  # fmt: skip
def test_what_the_dialect_does_not_know_is_an_error(text: str, code: str) -> None:
    assert wrong(text) == ([code] if code else [])


def test_inverse_time_gives_the_feed_by_the_length() -> None:
    (line,) = ngc("G93 G1 X3 Y4 F2").of(Line)
    assert isinstance(line, Line)
    assert line.pace.feed_upm == 10
    (arc,) = ngc("G93 G2 X2 I1 J0 F2").of(Arc)
    assert isinstance(arc, Arc)
    assert arc.pace.feed_upm == pytest.approx(2 * math.pi)


def test_probing_reports_in_program_coordinates() -> None:
    text = "G10 L2 P1 X1\nG38.2 X5 F10\nG1 Y#5061 Z#5070"
    done = ngc(text, machine=Bench(trip=(3.0, 0, 0, 0, 0, 0, 0, 0)))
    assert done.moves == ["P X6", "L X3 Y2 Z1"]
    assert errors("F10 G38.2 X5", dialect="rs274ngc") == ["A36"]
    (probe,) = ngc("F10 G38.5 X5").of(Probe)
    assert isinstance(probe, Probe)
    assert probe.is_away


def test_m5_acts_before_the_motion_and_m30_ends() -> None:
    story = ngc("S100 M3\nG1 F10 X1 M5\nM30\nX5").story
    assert story == ["M3 S100", "M5 S100", "L X1", "end"]


def test_switches_are_outputs_and_inputs() -> None:
    assert ngc("M64 P3\nM63 P3\nM66 P2 L3").story[:3] == ["out 35 1", "out 35 0", "wait 2 1"]
    assert ngc("M66 P2 L3\nM66 P2 L4", {251_002: 1.0}).story[:2] == ["wait 2 0", "wait 2 1"]


def test_peck_cycles_use_the_fixed_clearance() -> None:
    done = ngc("G0 Z1\nG83 X0 Y0 R.1 Z-.5 Q.3 F10")
    assert [end[2] for end in done.ends] == [1, 0.1, -0.2, 0.1, -0.19, -0.5, 1]


def test_m_codes_of_the_user_are_files(tmp_path: Path) -> None:
    (tmp_path / "M123.TXT").write_text("G1 F10 X[#1*2]\nM99\n")
    done = ngc("M123 X4\nY1", folders=Folders(customs=tmp_path))
    assert done.moves == ["L X8", "L X8 Y1"]


def test_the_same_text_means_what_its_dialect_says() -> None:
    text = "F10 G2 X2 Y0 I1 J0"
    (here,) = run(text).of(Arc)
    (there,) = ngc(text).of(Arc)
    assert isinstance(here, Arc)
    assert isinstance(there, Arc)
    assert here.centre == there.centre == (1, 0)
    moves = ngc("F10 G1 X1\nG2 X3 I1 J0").moves
    assert moves == ["L X1", "A X3 about 2,0 -180"]
    assert run("F10 G1 X1\nG2 X3 I1 J1", {SPIRALS: 1}).moves == ["L X1", "A X3 about 1,1 -297"]


def test_length_and_radius_are_those_of_the_tool_in_the_spindle() -> None:
    cells = {235: 3.0, 2003: 1.5, 1003: 0.25}
    assert ngc("G43\nG0 Z1", cells).moves == ["R Z2.5"]
    assert ngc("G41 G1 X0 Y1 F10\nX2\nG40 X3", cells).ends[:2] == [(0, 1.25, 0), (2, 1.25, 0)]


def test_the_feed_of_inverse_time_belongs_to_its_block() -> None:
    entries = ngc("F10 G1 X1\nG93 X3 F2\nG94 X4\nX5 F20").entries
    feeds = [each.pace.feed_upm for each in entries if isinstance(each, Line)]
    assert feeds == [10, 4, 10, 20]


def feed_warnings(text: str, is_metric: bool = False, **more: object) -> list[str]:
    """The warnings of F beside a change of the unit; the store is in inches or millimetres."""
    done = ngc(text, {250_001: float(is_metric)}, **more)
    return [str(each) for each in done.interpreter.warnings if each.code == "W221"]


@pytest.mark.parametrize("has_batches", [False, True])
def test_f_in_a_block_that_changes_the_unit_is_named_as_it_is_read(has_batches: bool) -> None:
    options = Options(has_batches=has_batches)
    title = "W221 F in a block that changes the unit: "
    advice = "(give F in a block of its own)"
    assert feed_warnings("G21 G1 F3000 X10\nG1 X20\nM2", options=options) == [
        f"PROGRAM:1:8: {title}F3000 is read in inches/min, as before G21: 76200 mm/min {advice}"
    ]
    assert feed_warnings("G21 G1 F3000 X10\nG20 F254 X1\nM2", True, options=options) == [
        f"PROGRAM:2:5: {title}F254 is read in mm/min, as before G20: 10 inches/min {advice}"
    ]
    assert feed_warnings("#1=300\nG21 G1 F[#1*10] X10\nM2", options=options) == [
        f"PROGRAM:2:8: {title}F3000 is read in inches/min, as before G21: 76200 mm/min {advice}"
    ]


@pytest.mark.parametrize("has_batches", [False, True])
@pytest.mark.parametrize(
    "text",
    [
        "G20 G1 F100 X1\nM2",  # the unit of the store
        "G21\nF3000\nG1 X10\nM2",
        "G21\nG21 G1 F3000 X10\nM2",
        "F100\nG21 G1 X10\nM2",
        "G93\nG21 G1 X10 F3\nM2",
        "G21 G93 G1 X10 F3\nM2",
    ],
)
def test_f_beside_a_unit_that_stays_or_in_inverse_time_is_no_doubt(
    text: str, has_batches: bool
) -> None:
    assert feed_warnings(text, options=Options(has_batches=has_batches)) == []


def test_acromill_reads_f_in_the_unit_of_its_own_block() -> None:
    done = run("G21 G1 F254 X25.4", {250_001: 0.0})
    assert [move.pace.feed_upm for move in done.of(Line) if isinstance(move, Line)] == [10.0]
    assert [each for each in done.interpreter.warnings if each.code == "W221"] == []
