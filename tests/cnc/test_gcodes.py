"""G codes: what each one does to the path."""

from itertools import permutations

import pytest
from tests.cnc.programs import CYCLES, Bench, Run, errors, run

from openacr.cnc.canonical import Arc, Check, Confirm, Dwell, Line, PathMode, Rapid


def paces(done: Run) -> list[tuple[PathMode, bool, bool]]:
    return [
        (e.pace.mode, e.pace.is_locked, e.pace.is_confirmed)
        for e in done.entries
        if isinstance(e, Line | Arc)
    ]


# --- G0 to G3 ---------------------------------------------------------------------------


@pytest.mark.req("MILL-G0-MODAL", "MILL-G1", "MILL-G2", "MILL-G3")
def test_motion_codes_hold_until_another() -> None:
    assert run("F10 G0 X1\nX2\nG1 X3\nX4\nG0 Y1").moves == [
        "R X1", "R X2", "L X3", "L X4", "R X4 Y1",
    ]  # fmt: skip
    for arc, angle in (("G2", -180), ("G3", 180)):
        assert run(f"F10 G0 X2\n{arc} X0 I1 J0\nX2 I1 J0\nG0 Y1\nX3").moves == [
            "R X2", f"A 0 about 1,0 {angle}", f"A X2 about 1,0 {angle}", "R X2 Y1", "R X3 Y1",
        ]  # fmt: skip


@pytest.mark.req("MILL-G42")
@pytest.mark.parametrize(
    ("cancel", "rest"), [("G40", ["L X3"]), ("G41", ["L X2 Y0.25", "L X3 Y0.25"])]
)
def test_g42_holds_until_g40_or_g41(cancel: str, rest: list[str]) -> None:
    text = (
        f"G42 D1 F10 G1 X0 Y0\nX1\nX2\n{cancel} X3\nG40 X3 Y0"
        if cancel == "G41"
        else ("G42 D1 F10 G1 X0 Y0\nX1\nX2\nG40 X2 Y0\nX3")
    )
    done = run(text, {1001: 0.2, 1501: 0.05}, start=(0, -1, 0))
    assert done.moves == ["L Y-0.25", "L X1 Y-0.25", "L X2 Y-0.25", *rest]


@pytest.mark.req("MILL-G1-MULTIAXIS")
def test_a_line_moves_any_axes_together() -> None:
    done = run("G1 F10 X1 Y2 Z3 A4 B5 C6 U7 V8", axes=8)
    assert done.moves == ["L X1 Y2 Z3 A4 B5 C6 U7 V8"]
    assert run("G1 F10 Y2 V1", axes=8).moves == ["L Y2 V1"]


def test_the_feed_of_each_line_is_its_own() -> None:
    lines = run("G1 F10 X1\nX2 F20\nX3").of(Line)
    assert [e.pace.feed_upm for e in lines if isinstance(e, Line)] == [10, 20, 20]


@pytest.mark.req("MILL-G2", "MILL-G3")
@pytest.mark.parametrize("code", ["G2", "G3"])
def test_the_feed_of_each_arc_is_its_own(code: str) -> None:
    text = f"F30 G1 X1\n{code} X2 I1.5 J0\nF20 X3 I2.5 J0\nX4 I3.5 J0"
    arcs = run(text).of(Arc)
    assert [e.pace.feed_upm for e in arcs if isinstance(e, Arc)] == [30, 20, 20]


ARCS = [
    # plane, centre words, end words, start, centre, end
    ("G17", "I1 J0", "X2 Y0", "X2 about 1,0"),
    ("G18", "I1 K0", "X2 Z0", "X2 about 0,1"),
    ("G19", "J1 K0", "Y2 Z0", "Y2 about 1,0"),
]


@pytest.mark.req("MILL-G2", "MILL-G2-G17", "MILL-G2-G18", "MILL-G2-G19")
@pytest.mark.parametrize(("plane", "centre", "end", "shown"), ARCS)
def test_g2_turns_clockwise_in_each_plane(plane: str, centre: str, end: str, shown: str) -> None:
    assert run(f"{plane} G2 F10 {end} {centre}").moves == [f"A {shown} -180"]


@pytest.mark.req("MILL-G3", "MILL-G3-G17", "MILL-G3-G18", "MILL-G3-G19")
@pytest.mark.parametrize(("plane", "centre", "end", "shown"), ARCS)
def test_g3_turns_counter_clockwise(plane: str, centre: str, end: str, shown: str) -> None:
    assert run(f"{plane} G3 F10 {end} {centre}").moves == [f"A {shown} 180"]


@pytest.mark.req("MILL-G17", "MILL-G18", "MILL-G19")
@pytest.mark.parametrize(
    ("code", "axes", "centre"), [(17, "XYZ", "I1 J0"), (18, "ZXY", "K1 I0"), (19, "YZX", "J1 K0")]
)
def test_a_plane_holds_for_arcs_compensation_rotation_and_cycles(
    code: int, axes: str, centre: str
) -> None:
    u, v, w = list(axes)
    blocks = {
        f"G2 F10 {u}2 {centre}": f"A {u}2 about 1,0 -180",
        f"G3 F10 {u}2 {centre}": f"A {u}2 about 1,0 180",
        f"G41 D1 G1 F10 {u}1\n{u}2\nG40 {v}1": f"L {placed(**{u: 2, v: 0.25})}",
        f"G68 R90\nG1 F10 {u}1": f"L {v}1",
        f"G81 {u}1 {v}2 {w}-1 R0 F10": f"L {placed(**{u: 1, v: 2, w: -1})}",
    }
    for other in {17, 18, 19} - {code}:
        for words, shown in blocks.items():
            done = run(f"G{other}\nG{code}\n{words}{CYCLES}", {1001: 0.25})
            assert shown in done.moves, (words, done.moves)
            done = run(f"G{code}\nG{other}\nG0 X0\nG{code}\n{words}{CYCLES}", {1001: 0.25})
            assert shown in done.moves


def placed(**axes: float) -> str:
    """Axis words as moves show them."""
    return " ".join(f"{axis}{axes[axis]:g}" for axis in "XYZ" if axis in axes)


@pytest.mark.req("MILL-G2-HELIX", "MILL-G3-HELIX")
@pytest.mark.parametrize("code", [2, 3])
def test_other_axes_follow_an_arc(code: int) -> None:
    done = run(f"G{code} F10 X2 Z3 A4 I1", axes=4)
    assert done.moves[0].startswith("A X2 Z3 A4 about 1,0")


@pytest.mark.req("MILL-G2-FULL", "MILL-G3-FULL")
@pytest.mark.parametrize(("code", "sweep"), [(2, -360), (3, 360)])
def test_an_arc_to_its_start_is_a_full_circle(code: int, sweep: int) -> None:
    assert run(f"G{code} F10 I1 J0").moves == [f"A 0 about 1,0 {sweep}"]
    assert run(f"F10 X1 Y1\nG{code} X1 Y1 I1 J2").moves[-1] == f"A X1 Y1 about 1,2 {sweep}"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G2 X1", "E231"),
        ("G2 X1 K1", "E234"),
        ("G18 G2 X1 J1", "E234"),
        ("G200 F1\nG2 X1 I0 J0", "E232"),
        ("G2 X3 R1", "E233"),
        ("G2 R1", "E231"),
        ("G2 X1 R1 I1", "E231"),
        ("G1 X1 I1", "E206"),
        ("G51 X0 Y0 Z0 I2 J1\nG2 X2 I1 J0", "E244"),
    ],
)
def test_arcs_that_cannot_be(text: str, code: str) -> None:
    assert errors(text) == [code]


def test_radii_choose_the_short_or_the_long_arc() -> None:
    assert run("F10 G2 X1 Y1 R1").moves == ["A X1 Y1 about 1,0 -90"]
    assert run("F10 G2 X1 Y1 R-1").moves == ["A X1 Y1 about 0,1 -270"]
    assert run("F10 G3 X1 Y1 R1").moves == ["A X1 Y1 about 0,1 90"]
    assert run("F10 G3 X2.001 R1").of(Arc)  # too long by less than epsilon


# --- G4, G9, G61 to G64 -----------------------------------------------------------------


@pytest.mark.req("MILL-G4", "MILL-G4-FMODAL", "MILL-WORD-F")
def test_a_dwell_takes_f_for_itself() -> None:
    done = run("G1 F10 X1\nG4 F2.5\nX2")
    assert [e.seconds for e in done.of(Dwell) if isinstance(e, Dwell)] == [2.5]
    assert [e.pace.feed_upm for e in done.of(Line) if isinstance(e, Line)] == [10, 10]
    for seconds in ("0.1", "999.9"):
        assert run(f"G4 F{seconds}").of(Dwell)
    for bad in ("0.09", "1000", "-1"):
        assert errors(f"G4 F{bad}") == ["E240"]
    assert errors("G4") == ["E240"]
    assert errors("G4 F1 X1") == ["E206"]
    assert errors("P200=0\nG4 F(P200)") == ["E240"]


@pytest.mark.req("MILL-G9-ONESHOT")
def test_g9_confirms_one_block() -> None:
    assert paces(run("F10 G9 X1\nX2")) == [
        (PathMode.FREE, False, True),
        (PathMode.FREE, False, False),
    ]


@pytest.mark.parametrize(
    ("code", "pace"),
    [
        (61, (PathMode.EXACT, False, True)),
        (62, (PathMode.CORNER, False, False)),
        (63, (PathMode.LOCKED, True, False)),
        (64, (PathMode.FREE, False, False)),
    ],
)
def test_path_modes_hold_until_another(code: int, pace: tuple[PathMode, bool, bool]) -> None:
    other = 61 if code != 61 else 62
    done = run(f"F10 G{other} X1\nG{code}\nX2\nG3 X3 I2.5 J0")
    assert paces(done)[1:] == [pace, pace]


@pytest.mark.req("MILL-G64-COMPAT")
def test_with_compatibility_g64_slows_at_corners() -> None:
    assert paces(run("F10 G64 X1", {700_000: 1}))[0][0] is PathMode.CORNER
    assert paces(run("F10 X1", {700_000: 1}))[0][0] is PathMode.CORNER


# --- units, distances, planes -------------------------------------------------------------


@pytest.mark.parametrize(
    ("code", "x"),
    [
        pytest.param("G20", 1, marks=pytest.mark.req("MILL-G20")),
        pytest.param("G70", 1, marks=pytest.mark.req("MILL-G70")),
        pytest.param("G21", 1 / 25.4, marks=pytest.mark.req("MILL-G21")),
        pytest.param("G71", 1 / 25.4, marks=pytest.mark.req("MILL-G71")),
    ],
)
def test_units(code: str, x: float) -> None:
    done = run(f"{code} F10 G1 X1 Y-2 A90", axes=4)
    (line,) = done.of(Line)
    assert isinstance(line, Line)
    assert line.end[:2] == (x, -2 * x)
    assert line.end[3] == 90  # degrees have no unit
    assert line.pace.feed_upm == pytest.approx(10 * x)


@pytest.mark.req("MILL-G90", "MILL-G91", "MILL-G90-MIX")
def test_positions_and_distances() -> None:
    done = run("F10 X1\nG91 X1\nY1\nG90 X1\n")
    assert done.moves == ["L X1", "L X2", "L X2 Y1", "L X1 Y1"]
    assert done.codes.count("W212") == 1


@pytest.mark.req("MILL-G200-INDEP")
@pytest.mark.parametrize("distance", ["G90", "G91"])
def test_centres_do_not_depend_on_the_distance_mode(distance: str) -> None:
    text = f"G0 X1 Y1 F10\n{distance} G200 F2 G2 I1 J2"
    assert run(text).moves[-1] == "A X1 Y1 about 1,2 -360"


@pytest.mark.req("MILL-G200-F0", "MILL-G200-F1", "MILL-G200-F2", "MILL-WORD-I", "MILL-WORD-J")
@pytest.mark.req("MILL-WORD-K")
@pytest.mark.parametrize(("f", "centre"), [(0, (-1, -0.5)), (1, (1, 0.5)), (2, (2, 1.5))])
@pytest.mark.parametrize(
    ("plane", "axes", "words"), [(17, "XY", "IJ"), (18, "ZX", "KI"), (19, "YZ", "JK")]
)
def test_each_reading_counts_for_both_centres_of_every_plane_in_g90_and_g91(
    f: int, centre: tuple[float, float], plane: int, axes: str, words: str
) -> None:
    """From 1,1 about 2,1.5 to 3,1."""
    (u, v), (i, j) = list(axes), list(words)
    about = f"{i}{centre[0]:g} {j}{centre[1]:g}"
    third = next(letter for letter in "XYZ" if letter not in axes)
    begin = f"G{plane} G0 {u}1 {v}1 {third}7\nF10\nG200 F{f}\n"
    for distance, end in (("G90", f"{u}3 {v}1"), ("G91", f"{u}2 {v}0")):
        shown = run(f"{begin}{distance} G2 {end} {about}").moves[-1]
        assert shown == f"A {placed(**{u: 3, v: 1, third: 7})} about 2,1.5 -233", distance


@pytest.mark.req("MILL-G200-SAMECIRCLE", "MILL-G200-F0", "MILL-G200-F1", "MILL-G200-F2")
@pytest.mark.parametrize("words", ["G200 F0 I0 J-1", "G200 F1 I0 J1", "G200 F2 I1 J2"])
def test_the_same_circle_in_three_readings(words: str) -> None:
    assert run(f"G0 X1 Y1\nF10\nG2 {words}").moves[-1] == ("A X1 Y1 about 1,2 -360")


@pytest.mark.req("MILL-G200-DEFAULT")
@pytest.mark.parametrize(("setting", "centre"), [(0, "0,0"), (1, "2,2"), (2, "1,1")])
def test_the_reading_at_the_start_is_a_setting(setting: int, centre: str) -> None:
    done = run("G0 X1 Y1\nG2 F10 X1 Y1 I1 J1", {250_003: setting})
    if setting == 2:
        assert done.error is not None
        assert done.error.code == "E232"
    else:
        assert done.moves[-1] == f"A X1 Y1 about {centre} -360"


# --- work systems, offsets ----------------------------------------------------------------


@pytest.mark.req("MILL-G54", "MILL-G55", "MILL-G56", "MILL-G57", "MILL-G58", "MILL-G59")
@pytest.mark.parametrize("first", range(54, 60))
@pytest.mark.parametrize("then", range(54, 60))
def test_a_work_system_acts_until_the_next_one(first: int, then: int) -> None:
    zeros = {910 + 10 * k: float(k + 1) for k in range(6)}
    done = run(f"G{first} G0 X0\nX10\nG{then} X0\nG53 X0\nX10\nG{first} X0", zeros)
    shift, other = (zeros[910 + 10 * (code - 54)] for code in (first, then))
    assert [x for x, *_ in done.ends] == [shift, shift + 10, other, 0, 10, shift]


@pytest.mark.req("MILL-G54", "MILL-G55", "MILL-G56", "MILL-G57", "MILL-G58", "MILL-G59")
@pytest.mark.parametrize(
    ("code", "n"), [*((f"G{53 + n}", n) for n in range(1, 7)), ("G59.1", 7), ("G59.2", 8)]
)
def test_work_systems_shift_the_path(code: str, n: int) -> None:
    cells = {900 + 10 * n: float(n), 901 + 10 * n: -1.0}
    assert run(f"{code} G0 X1 Y1\nX2", cells).moves == [f"R X{n + 1:g}", f"R X{n + 2:g}"]


@pytest.mark.req("MILL-G54", "MILL-G55", "MILL-G56", "MILL-G57", "MILL-G58", "MILL-G59")
@pytest.mark.parametrize(("first", "then"), list(permutations(range(53, 60), 2)))
def test_a_work_system_counts_until_another_is_chosen(first: int, then: int) -> None:
    cells = {900 + 10 * n: float(n) for n in range(1, 7)}
    done = run(f"G{first} G0 X1\nM5\nX2\nG{then} X9\nX10", cells)
    shifts = [first - 53] * 2 + [then - 53] * 2
    assert done.moves == [f"R X{x + d:g}" for x, d in zip((1, 2, 9, 10), shifts, strict=True)]


@pytest.mark.req("MILL-G54-SCREEN", "MILL-G10-L2")
@pytest.mark.parametrize("n", range(1, 7))
def test_g10_writes_what_the_cells_hold(n: int) -> None:
    done = run(f"G10 L2 P{n} X1 Y2 Z3\nG{53 + n}\nG0 X0 Y0 Z0\n")
    assert [done.p(900 + 10 * n + axis) for axis in range(3)] == [1, 2, 3]
    assert done.moves == ["R X1 Y2 Z3"]


@pytest.mark.req("MILL-G10-TOOL", "MILL-G43-SOURCE", "MILL-WORD-L")
@pytest.mark.parametrize(
    ("words", "cell"),
    [("L10 P3", 2003), ("L11 P999", 3999), ("L12 P400", 1400), ("L13 P1", 1501)],
)
def test_g10_writes_lengths_and_radii(words: str, cell: int) -> None:
    assert run(f"G10 {words} R.5").p(cell) == 0.5
    assert run(f"G91 G10 {words} R.5", {cell: 1.0}).p(cell) == 1.5
    assert run(f"G21 G10 {words} R25.4").p(cell) == 1


@pytest.mark.req("MILL-G10-FIXTURE", "MILL-G101-SET", "MILL-G101-G199", "MILL-G100")
@pytest.mark.parametrize("n", [1, 50, 99])
def test_fixtures_shift_all_axes(n: int) -> None:
    text = f"G10 L14 P{n} X1 Y2 Z3\nG{100 + n} G0 X0 Y0 Z0\nG100 X0 Y0 Z0"
    assert run(text).moves == ["R X1 Y2 Z3", "R 0"]
    assert run(f"G10 L10 P{n} R3\nH{n} G0 Z0").moves == ["R Z3"]
    assert run(f"G10 L10 P{n} R3\nG{100 + n} G0 Z0").moves == ["R Z3"]


@pytest.mark.req("MILL-G10-BAD")
@pytest.mark.parametrize(
    "words",
    ["L2 P0 X1", "L2 P7 X1", "L2 X1", "P1 X1", "L2 P1", "L3 P1 X1", "L10 P1000 R1", "L10 P1",
     "L12 P401 R1", "L14 P100 X1", "L20 P9 X1", "L10 P1 R1 X1", "L2.5 P1 X1"],
)  # fmt: skip
def test_a_wrong_g10_writes_nothing(words: str) -> None:
    done = run(f"P200=1\nG10 {words}", {900 + n: 9.0 for n in range(100) if n < 98})
    assert done.error is not None
    assert done.error.code == "E241"
    assert not {n for n in done.cells.written if 1000 < n < 4000 and n not in (1998, 1999)}
    assert done.p(910) == 9


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
def test_g10_l20_teaches_the_present_position(dialect: str) -> None:
    done = run("G0 X5\nG10 L20 P1 X1\nG0 X2", {900: 0.5}, dialect=dialect)
    assert done.moves == ["R X5.5", "R X6.5"]
    assert done.interpreter.position[0] == 2


def test_g10_l20_counts_a_local_shift_of_the_system_it_teaches() -> None:
    text = "G54 G52 X1\nG10 L20 P{} X5\nG0 {} X6"
    assert run(text.format(1, "")).ends == [(1, 0, 0)]
    assert run(text.format(2, "G55")).ends == [(1, 0, 0)]
    assert run(text.format(2, "G55")).p(920) == -5


@pytest.mark.req("MILL-G44", "MILL-G43", "MILL-WORD-H")
def test_lengths_are_added_or_taken_away() -> None:
    cells = {2002: 1.0, 3002: 0.25}
    assert run("G0 G43 H2 Z1", cells).moves == ["R Z2.25"]
    assert run("G0 G44 H2 Z1", cells).moves == ["R Z-0.25"]
    assert run("G0 H2 Z1", cells).moves == ["R Z2.25"]
    assert run("G0 G43 H2 Z1\nH0 Z1", cells).moves == ["R Z2.25", "R Z1"]
    done = run("G43 H2\nP450=P4000 P451=P4001 P452=P237", cells)
    assert [done.p(450 + k) for k in range(3)] == [1, 0.25, 2]


@pytest.mark.req("MILL-G52")
@pytest.mark.parametrize("system", range(54, 60))
def test_a_local_shift_moves_the_zero_of_the_system_that_is_active(system: int) -> None:
    """In every axis by its own amount, not added to the one before."""
    zero = (system, 1, 2)
    done = run(
        f"G10 L2 P{system - 53} X{zero[0]} Y{zero[1]} Z{zero[2]}\nG{system}\n"
        "G52 X.5 Y.25 Z-.75\nG0 X0 Y0 Z0\nG52 X.125 Z1\nX1 Y1 Z1"
    )
    assert done.ends == [(system + 0.5, 1.25, 1.25), (system + 1.125, 2.25, 4.0)]
    assert [done.p(910 + 10 * (system - 54) + axis) for axis in range(3)] == list(zero)


@pytest.mark.req("MILL-G52-CANCEL", "MILL-G52")
def test_a_local_shift_is_cancelled_by_zero_and_by_another_system() -> None:
    text = "G54 G0 X0\nG52 X1\nX0\nG52 X0 Y0 Z0\nX0\nG52 X2\nX0\nG55 X0"
    assert run(text).moves == ["R X1", "R 0", "R X2", "R 0"]


@pytest.mark.req("MILL-G53")
def test_machine_coordinates_hold_until_a_work_system() -> None:
    done = run("G53 G0 X1\nX2\nG54 X1", {910: 5.0, 2001: 1.0})
    assert done.moves == ["R X1", "R X2", "R X6"]
    assert errors("G53\nG92 X1") == ["E245"]


@pytest.mark.req("MILL-G53")
@pytest.mark.parametrize(
    ("chosen", "there"), [("G68 X0 Y0 R90", "R Y2"), ("G51 X0 Y0 Z0 P3", "R X6")]
)
def test_machine_coordinates_are_neither_rotated_nor_scaled(chosen: str, there: str) -> None:
    done = run(f"{chosen}\nG53 G0 X1\nF10 G2 X1 Y0 I0 J0\nG54 G0 X2 Y0")
    assert done.moves == ["R X1", "A X1 about 0,0 -360", there]


@pytest.mark.req("MILL-G50")
def test_scaling_ends_with_g50() -> None:
    text = "F10 G51 X0 Y0 Z0 P2\nX1\nG50\nX1"
    assert run(text).moves == ["L X2", "L X1"]
    assert run("F10 G51 X1 P2\nX2").moves == ["L X3"]


@pytest.mark.req("MILL-G69")
@pytest.mark.parametrize(
    ("plane", "axes", "ends"),
    [
        ("G17", "XY", ["L Y1", "L X1"]),
        pytest.param("G18", "ZX", ["L X1", "L Z1"], marks=pytest.mark.req("MILL-G68-G18")),
        pytest.param("G19", "YZ", ["L Z1", "L Y1"], marks=pytest.mark.req("MILL-G68-G19")),
    ],
)
def test_rotation_turns_each_plane(plane: str, axes: str, ends: list[str]) -> None:
    first, second = axes[0], axes[1]
    text = f"F10 {plane} G68 {first}0 {second}0 R90\n{first}1\nG69\n{first}1 {second}0"
    assert run(text).moves == ends
    other = next(letter for letter in "XYZ" if letter not in axes)
    assert errors(f"{plane} G68 {other}1 R5") == ["E234"]


# --- reference points ---------------------------------------------------------------------

REFERENCE = {280: 10.0, 281: 11.0, 282: 12.0, 290: 20.0, 300: 30.0, 310: 40.0}


def test_g27_checks_the_reference_and_goes_on() -> None:
    done = run("G27 X1 Y2", {**REFERENCE, 400_010: 5.0})
    assert done.moves == ["R X10 Y11", "R X1 Y2"]
    (confirm,) = done.of(Confirm)
    assert isinstance(confirm, Confirm)
    assert (confirm.check, confirm.axes) == (Check.REFERENCE_INPUT, (0, 1))
    assert errors("G27 X1") == ["E242"]  # no input


@pytest.mark.req("MILL-G28", "MILL-G28-MEMORY")
def test_g28_goes_through_the_intermediate_point_and_remembers_it() -> None:
    done = run("G28 X1 Y2\nG0 X0 Y0\nG28 Z3", REFERENCE)
    assert done.moves == [
        "R X1 Y2", "R X10 Y11", "R 0", "R X1 Y2 Z3", "R X10 Y11 Z12",
    ]  # fmt: skip
    assert [done.p(320 + axis) for axis in range(3)] == [1, 2, 3]
    assert done.p(328) == 7
    assert done.of(Confirm)[0].check is Check.AT_REFERENCE  # type: ignore[union-attr]


def test_an_offset_makes_the_machine_miss_the_reference() -> None:
    done = run("G43 H1\nG28 Z1", {**REFERENCE, 2001: 0.5})
    assert done.moves == ["R Z1.5", "R Z12.5"]
    (confirm,) = done.of(Confirm)
    assert isinstance(confirm, Confirm)
    assert confirm.point[2] == 12


@pytest.mark.req("MILL-G29", "MILL-G29-NOG28", "MILL-G30-G29")
def test_g29_returns_through_the_intermediate_point() -> None:
    for code in ("G28", "G30"):
        done = run(f"{code} X1\nG29 X5 Y5", REFERENCE)
        assert done.moves[-2:] == ["R X1", "R X5 Y5"]
    assert errors("G29 X1") == ["E242"]
    assert errors("G28") == ["E242"]


@pytest.mark.req("MILL-G30", "MILL-G30-DEFAULTP", "MILL-G30-BADP")
@pytest.mark.parametrize(("words", "x"), [("", 20), ("P2", 20), ("P3", 30), ("P(2+2)", 40)])
def test_g30_goes_to_the_other_reference_points(words: str, x: int) -> None:
    assert run(f"G30 {words} X1", REFERENCE).moves == ["R X1", f"R X{x}"]
    for bad in ("P1", "P5", "P(0)", "P2.5"):
        assert errors(f"G30 {bad} X1")[0] in ("E242", "E204")


@pytest.mark.req("MILL-G30-HOMED")
def test_g30_needs_homed_axes() -> None:
    class NotHomed(Bench):
        def is_homed(self, axis: int) -> bool:
            return axis != 0

    assert errors("G30 X1", machine=NotHomed()) == ["A33"]
    assert errors("G30 Y1", machine=NotHomed()) == []


def test_reference_moves_do_not_go_with_scaling() -> None:
    assert errors("G51 X0 P2\nG28 X1") == ["E242"]
    assert errors("G41 D1\nG28 X1") == ["E312"]


@pytest.mark.req("MILL-TOOL-G28")
def test_a_tool_change_at_the_reference() -> None:
    done = run("T4 G28 X1\nM6\nG29 X2", REFERENCE)
    assert [s for s in done.story if s != "SetCell"] == [
        "R X1", "R X10", "Confirm", "tool 4", "R X1", "R X2", "end",
    ]  # fmt: skip


# --- codes that do not exist or do not go together ------------------------------------------


@pytest.mark.req("MILL-G-UNKNOWN")
@pytest.mark.parametrize("code", ["G5", "G5.1", "G79", "G93", "G201", "G999", "G1.5", "G38.2"])
def test_an_unknown_code_is_named(code: str) -> None:
    from tests.cnc.programs import STORE

    from openacr.cnc.loading.load import load

    (error,) = load(f"X1 F10\n{code} X1", STORE).errors
    assert error.code == "E203"
    assert (error.line, error.column) == (2, 1)
    assert code in error.text


@pytest.mark.req("MILL-G-MULTI")
@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("G17 G90 G1 G64 G54 G40 G49 G80 G98 X1 F10", []),
        ("G17 G18", ["E201"]),
        ("G90 G91", ["E201"]),
        ("G20 G71", ["E201"]),
        ("G41 G42", ["E201"]),
        ("G54 G55", ["E201"]),
        ("G61 G64", ["E201"]),
        ("G43 H1 G101", ["E201"]),
        ("G28 X1 G31", ["E201"]),
        ("G92 X1 G52", ["E201"]),
        ("M3 M8 M12", []),
    ],
)
def test_codes_of_several_groups_may_stand_together(text: str, codes: list[str]) -> None:
    assert errors(text) == codes


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G41 D1\nG18", "E311"),
        ("G41 D1\nG51 X0 P2", "E311"),
        ("G41 D1\nG68 R5", "E311"),
        ("G41 D1\nG53", "E310"),
        ("G41 D1\nG31 X1", "E243"),
        ("G2 G41 D1 X2 I1 J0", "E313"),
        ("G68 X0 Y0", "E206"),
        ("G51 X0", "E206"),
        ("G51 P2 I1", "E206"),
        ("G51 P0", "E244"),
        ("G200 F3", "E222"),
        ("G200", "E222"),
        ("F0 X1", "E222"),
        ("F-5 X1", "E222"),
        ("D401", "E222"),
        ("H1000", "E222"),
        ("T1000", "E222"),
        ("T1.5", "E204"),
        ("W5", "E206"),
        ("A5", "E207"),
        ("M3.5", "E204"),
    ],
)
def test_words_out_of_place(text: str, code: str) -> None:
    assert errors(text) == [code]


def test_a_zero_length_block_gives_no_move() -> None:
    assert run("F10 X1\nX1\nG0 X1").moves == ["L X1"]


def test_rapids_have_no_feed() -> None:
    assert all(not hasattr(entry, "pace") for entry in run("G0 X1").of(Rapid))


@pytest.mark.parametrize(
    ("text", "moves"),
    [
        # about the present position where the block names no centre, axis by axis
        ("G0 X2 Y1\nG68 R90\nX3", ["R X2 Y1", "R X2 Y2"]),
        ("G0 X2 Y1\nG68 X0 R90\nX1", ["R X2 Y1", "R X2 Y2"]),  # from 0, -1 as seen after G68
        ("G0 X2 Y1\nG68 Y0 R90\nX3 Y0", ["R X2 Y1"]),
        ("G0 X2 Y1\nG68 X1 Y3 R180\nX2 Y3", ["R X2 Y1", "R Y3"]),
    ],
)
def test_a_rotation_turns_about_its_centre(text: str, moves: list[str]) -> None:
    assert run(text).moves == moves


def test_the_centre_of_a_rotation_is_in_the_work_system() -> None:
    cells = {910: 10.0, 911: 20.0}
    assert run("G54 G0 X2 Y1\nG68 X1 Y1 R90\nX2 Y1", cells).moves == ["R X12 Y21", "R X11 Y22"]
