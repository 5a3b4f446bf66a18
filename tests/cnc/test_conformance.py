"""The numbered examples of the reference: program in, machine path out."""

import pytest
from tests.cnc.programs import CYCLES, Bench, errors, run

from openacr.cnc.canonical import Arc, Line, Rapid

Z2 = (0.0, 0.0, 2.0)


def test_1_a_square_in_increments() -> None:
    done = run("F100 G91\nG1X1\nG1Y1\nG1X-1\nG1Y-1")
    assert done.ends == [(1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0)]
    assert all(isinstance(e, Line) and e.pace.feed_upm == 100 for e in done.of(Line))


@pytest.mark.req("MILL-FLOW-LOOPEX", "MILL-FLOW-GOTO")
def test_2_a_loop_with_a_counter() -> None:
    text = "G91\nF100\nP5=0\nN100\nP5=P5+1\nX1\nY1\nIF P5<5 THEN GOTO 100\nM2"
    done = run(text)
    assert len(done.moves) == 10
    assert done.ends[-1] == (5, 5, 0)
    assert done.machine.parameters[5] == 5


@pytest.mark.req("MILL-G200-F0", "MILL-G200-F1", "MILL-G200-F2", "MILL-G2-FULL")
@pytest.mark.parametrize(("f", "centre"), [(2, (0, 1)), (1, (1, 2)), (0, (1, 0))])
def test_3_full_circles_in_three_readings(f: int, centre: tuple[float, float]) -> None:
    done = run(f"G200 F{f}\nF10 X1 Y1\nG2 X1 Y1 I0 J1")
    (arc,) = done.of(Arc)
    assert isinstance(arc, Arc)
    assert arc.centre == centre
    assert arc.sweep_rad == pytest.approx(-6.283185307179586)


def test_4_a_quarter() -> None:
    assert run("F10 G3 X1 Y1 I0 J1").moves == ["A X1 Y1 about 0,1 90"]


@pytest.mark.req("MILL-G2-SPIRAL")
def test_5_a_spiral() -> None:
    (arc,) = run("F10 G2 X2 Y0 I.9 J0 G17").of(Arc)
    assert isinstance(arc, Arc)
    assert arc.start_radius == 0.9
    assert arc.end_radius == pytest.approx(1.1)
    assert arc.sweep_rad == pytest.approx(-3.141592653589793)


def test_6_radii() -> None:
    moves = run("F10 G2 X2 R1\nG2 X0 R-1").moves
    assert moves == ["A X2 about 1,0 -180", "A 0 about 1,0 -180"]


@pytest.mark.req("MILL-G20", "MILL-G21")
def test_7_millimetres() -> None:
    (line,) = run("G21 G1 X25.4 F254").of(Line)
    assert isinstance(line, Line)
    assert line.end[0] == 1.0
    assert line.pace.feed_upm == pytest.approx(10)


def test_8_a_unit_change_keeps_the_speed() -> None:
    lines = run("G1 X1 F10\nG21\nX50.8").of(Line)
    assert [(e.end[0], e.pace.feed_upm) for e in lines if isinstance(e, Line)] == [
        (1, 10),
        (2, 10),
    ]


@pytest.mark.req("MILL-G68-G17")
def test_9_rotation() -> None:
    assert run("G17 G68 X0 Y0 R90\nG1 X1\nY1").ends == [(0, 1, 0), (-1, 1, 0)]


@pytest.mark.req("MILL-G51-P")
def test_10_scale() -> None:
    assert run("G51 X0 Y0 Z0 P2\nG1 X1").moves == ["L X2"]


@pytest.mark.req("MILL-G51-IJK")
def test_11_mirror() -> None:
    assert run("G51 X0 Y0 Z0 I-1 J1 K1\nG2 X1 Y1 I0 J1").moves == ["A X-1 Y1 about 0,1 270"]


@pytest.mark.req("MILL-G43")
def test_12_length() -> None:
    done = run("G0 G43 H1 Z0\nG49\nG91 Z-1", {2001: 1.5, 3001: 0.01}, start=Z2)
    assert done.moves == ["R Z1.51", "R Z0.51"]


@pytest.mark.req("MILL-G49")
@pytest.mark.parametrize(("code", "offset"), [("G43", 1.51), ("G44", -1.51)])
def test_12_positions_after_g49_are_without_the_length(code: str, offset: float) -> None:
    done = run(f"G0 {code} H1 Z0\nG49 Z0\nZ1", {2001: 1.5, 3001: 0.01}, start=Z2)
    assert done.moves == [f"R Z{offset:g}", "R 0", "R Z1"]


@pytest.mark.req("MILL-G10-L2", "MILL-G52", "MILL-G54")
def test_13_work_and_local_shift() -> None:
    assert run("G10 L2 P1 X2\nG54\nG52 X1\nG0 X0\nG54\nX0").moves == ["R X3", "R X2"]


@pytest.mark.req("MILL-G52-ORDER")
def test_14_local_shift_first() -> None:
    assert errors("G52 X1") == ["E245"]


@pytest.mark.req("MILL-G92", "MILL-G92-PARAM")
def test_15_floating_zero() -> None:
    done = run("G0 X2\nG92 X0\nG1 X1")
    assert done.moves == ["R X2", "L X3"]
    assert done.p(801) == 2


@pytest.mark.req("MILL-G81", "MILL-G98")
def test_16_drilling() -> None:
    done = run("G90 G98 G81 X1 Y1 Z-1 R.1 F10" + CYCLES, start=Z2)
    assert done.moves == ["R X1 Y1 Z2", "R X1 Y1 Z0.1", "L X1 Y1 Z-1", "R X1 Y1 Z2"]


@pytest.mark.req("MILL-G99", "MILL-CYC-MODAL")
def test_17_drilling_from_hole_to_hole() -> None:
    done = run("G90 G99 G81 X1 Y1 Z-1 R.1 F10\nX2" + CYCLES, start=Z2)
    assert done.moves[3:] == [
        "R X1 Y1 Z0.1",
        "R X2 Y1 Z0.1",
        "L X2 Y1 Z-1",
        "R X2 Y1 Z0.1",
    ]


@pytest.mark.req("MILL-CYC-L")
def test_18_repeated_holes() -> None:
    done = run("G91 G81 X1 Z-1.1 R-1.9 L3 F10" + CYCLES, start=Z2)
    assert [m for m in done.moves if m.startswith("L")] == ["L X1 Z-1", "L X2 Z-1", "L X3 Z-1"]
    assert "R X1 Z0.1" in done.moves


@pytest.mark.req("MILL-G73", "MILL-G73-PECK", "MILL-G73-RETRACT")
def test_19_chip_breaking() -> None:
    done = run("G90 G73 Z-1 R.1 Q.3 F10" + CYCLES, {250_140: 0.02}, start=Z2)
    z = [round(end[2], 6) for end in done.ends]
    assert z == [0.1, -0.2, -0.18, -0.5, -0.48, -0.8, -0.78, -1, 2]


@pytest.mark.req("MILL-G83", "MILL-G83-D")
def test_20_deep_holes() -> None:
    done = run("G90 G83 Z-1 R.1 Q.3 F10" + CYCLES, {250_141: 0.05}, start=Z2)
    z = [round(end[2], 6) for end in done.ends]
    assert z == [0.1, -0.2, 0.1, -0.15, -0.5, 0.1, -0.45, -0.8, 0.1, -0.75, -1, 2]
    kinds = "".join("R" if isinstance(e, Rapid) else "L" for e in done.of(Rapid | Line))  # type: ignore[arg-type]
    assert kinds == "RLRRLRRLRRLR"


@pytest.mark.req("MILL-G65", "MILL-G65-L", "MILL-G65-ARGS", "MILL-G65-LOCAL")
def test_21_a_macro_with_arguments() -> None:
    sums = "\n".join(f"P{300 + n}=P{300 + n}+#{n}" for n in range(14, 0, -1))
    sums = sums.replace("P3", "P4")
    text = (
        "P1=-1\nG65 P1000 L2 X1 Y2 Z3 A4 B5 C6 D7 E8 F9 G10 H11 I12 J13 K14\nM2\n"
        f"N1000\n{sums}\nRET"
    )
    done = run(text)
    assert [done.p(400 + n) for n in range(1, 15)] == [2.0 * n for n in range(1, 15)]
    assert done.machine.parameters == {1: -1}


@pytest.mark.req("MILL-G31-RECT", "MILL-G31-STORE")
def test_22_probing() -> None:
    text = "N100 F100 G1 X0Y0\nN110 G31 X1\nN120 Y1\nN130 X0\nN140 Y0"
    done = run(text, machine=Bench(trip=(0.75, 0, 0, 0, 0, 0, 0, 0)))
    assert done.moves == ["P X1", "L X0.75 Y1", "L Y1", "L 0"]
    assert done.p(101) == 0.75
    where = (0.75, 0.5, -1.0, 90.0, 10.0, -20.0, 4.0, 0.125)
    done = run("G31 F10 X1\nP200=P101", axes=8, machine=Bench(trip=where))
    assert [done.p(number) for number in range(101, 109)] == list(where)
    assert run(text).moves == ["P X1", "L X1 Y1", "L Y1", "L 0"]


@pytest.mark.req("MILL-MATH-EXAMPLE")
def test_23_an_expression() -> None:
    done = run("P40 = 1.555*Sin(45) + P6/P10", {6: 6, 10: 2})
    assert done.machine.parameters[40] == pytest.approx(4.099551, abs=5e-7)


def test_28_two_codes_of_a_group() -> None:
    done = errors("G1 X1 G0")
    assert done == ["E201"]


@pytest.mark.req("MILL-G-MULTI", "MILL-G30-BADP", "MILL-FLOW-RETERR")
@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G0 G1", "E201"),
        ("X1 X2", "E202"),
        ("G4 F0.05", "E240"),
        ("G30 P5 X1", "E242"),
        ("RET", "E261"),
    ],
)
def test_29_errors(text: str, code: str) -> None:
    assert errors(text) == [code]


@pytest.mark.req("MILL-FLOW-IF-INPUT")
def test_31_the_input_test() -> None:
    text = "If #1 = 1 THEN GOTO 100\nX1\nN100 X2"
    assert run(text, machine=Bench(bits={1})).moves == ["L X2"]
    assert run(text, {1: 1}).moves == ["L X1", "L X2"]
    assert run(text, machine=Bench(bits={0, 2, 129})).moves == ["L X1", "L X2"]
    text = "If #1 = 0 THEN GOTO 100\nX1\nN100 X2"
    assert run(text, {1: 1}).moves == ["L X2"]
    assert run(text, machine=Bench(bits={1})).moves == ["L X1", "L X2"]
    for n in (0, 31):
        text = f"IF #{n}=1 THEN GOTO 100\nX1\nN100 X2"
        assert run(text, machine=Bench(bits={n})).moves == ["L X2"]
    of_the_parameter = "IF P1=1 THEN GOTO 100\nX1\nN100 X2"
    assert run(of_the_parameter, machine=Bench(bits={1})).moves == ["L X1", "L X2"]
    assert run(of_the_parameter, {1: 1}).moves == ["L X2"]


@pytest.mark.req("MILL-G41", "MILL-G40", "MILL-WORD-D")
def test_25_compensation_inside_a_corner() -> None:
    text = "G41 D1 F10 G1 X0 Y0\nX1\nY1\nG40 X0 Y1"
    done = run(text, {1001: 0.25}, start=(0, 1, 0))
    assert done.moves == ["L Y0.25", "L X0.75 Y0.25", "L X0.75 Y1", "L Y1"]


@pytest.mark.req("MILL-G42")
def test_26_compensation_around_a_corner() -> None:
    text = "G42 D1 F10 G1 X0 Y0\nX1\nY1\nG40 X0 Y1"
    done = run(text, {1001: 0.2, 1501: 0.05}, start=(0, -1, 0))
    assert done.moves == [
        "L Y-0.25",
        "L X1 Y-0.25",
        "A X1.25 about 1,0 90",
        "L X1.25 Y1",
        "L Y1",
    ]
    (arc,) = done.of(Arc)
    assert isinstance(arc, Arc)
    assert arc.is_inserted
