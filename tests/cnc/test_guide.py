"""The listings of the guide, as printed: each is read, and does what the text beside it says.

Known slips of the print are noted where a listing stands otherwise than it is meant.
"""

import math

import pytest
from tests.cnc.programs import CYCLES, Bench, errors, made, run

from openacr.cnc.canonical import Dwell
from openacr.cnc.interpreter.mdi import Mdi

Z2 = (0.0, 0.0, 2.0)


def test_the_square_of_the_sample_session_with_its_printed_minus_signs() -> None:
    done = run("F100 G91 \nG1X1  \nG1Y1  \nG1X\u22121 \n\nG1Y\u2212\u22121 \n")
    assert done.moves == ["L X1", "L X1 Y1", "L Y1", "L 0"]
    assert "W102" in done.codes


def test_the_mdi_command_of_the_manual_menu() -> None:
    mdi = Mdi(made("M2").interpreter)
    moves = [entry for entry in mdi.execute("G1 F50 X5.6 Y3.5") if hasattr(entry, "end")]
    assert [move.end[:2] for move in moves] == [(5.6, 3.5)]


def test_the_transfer_of_a_parameter_to_the_controller() -> None:
    done = run("P3=55555 \n T P3 \n")
    assert done.story == ["P3=55555", "end"]


@pytest.mark.parametrize(
    ("text", "trip", "moves"),
    [
        ("G31 G91 X100 \nY50 ", None, ["P X100", "L X100 Y50"]),
        ("G 31 G91 X100 \nY50 ", 40.0, ["P X100", "L X40 Y50"]),
        ("G31 G90 X200 \nX300 Y100 ", None, ["P X200", "L X300 Y100"]),
        ("G31 G90 X200 \nX300 Y100 ", 40.0, ["P X200", "L X300 Y100"]),
    ],
)
def test_skips(text: str, trip: float | None, moves: list[str]) -> None:
    machine = Bench(trip=(trip, 0, 0, 0, 0, 0, 0, 0) if trip else None)
    done = run("F100\n" + text, machine=machine)
    assert done.moves == moves
    assert done.p(101) == (trip or 0.0)


@pytest.mark.parametrize("trip", [None, 0.75])
def test_the_rectangle_around_a_probed_edge(trip: float | None) -> None:
    text = "N100 F100 G1 X0Y0 \n\nN110 G31 X1 \nN120 Y1  \nN130 X0 \nN140 Y0 \n"
    done = run(text, machine=Bench(trip=(trip, 0, 0, 0, 0, 0, 0, 0) if trip else None))
    x = f"X{trip or 1:g}"
    assert done.moves == ["P X1", f"L {x} Y1", "L Y1", "L 0"]
    assert done.p(101) == (trip or 0.0)


@pytest.mark.parametrize("words", ["G30 P(1+1) X1 Y1", "G30 P 2 X1 Y1", "G30 X1 Y1"])
def test_the_second_reference_point(words: str) -> None:
    assert run(words, {290: 5.0, 291: 6.0}).moves == ["R X1 Y1", "R X5 Y6"]


def test_reference_points_before_and_after_a_tool_change() -> None:
    done = run("G28 X1 Y1\nM6\nG29 X2 Y2\n", {280: 5.0, 281: 6.0})
    assert done.moves == ["R X1 Y1", "R X5 Y6", "R X1 Y1", "R X2 Y2"]


def test_the_local_system_is_cancelled_by_zeros() -> None:
    done = run("G54\nG52 X1 Y1 Z1\nG0 X1\nG52 X0Y0Z0\nX1", {910: 0.0})
    assert done.moves == ["R X2", "R X1"]


def test_the_macro_gets_fourteen_values_twice() -> None:
    call = "G65 P1000 L2 X1 Y2 Z3 A4 B5 C6 D7 E8 F9 G10 H11 I12 J13 K14  "
    body = "".join(f"P{150 + n}=P{150 + n}*100+#{n}\n" for n in range(1, 15))
    done = run(f"{call}\nM2\nN1000\n{body}RET\n")
    assert [done.p(150 + n) for n in range(1, 15)] == [n * 100 + n for n in range(1, 15)]


def test_a_modal_macro_follows_every_move() -> None:
    done = run("G91 F10\nG66 P1000 Z3\nX1\nX1\nG67\nX1\nM2\nN1000 Z#3\nZ-#3\nRET")
    assert done.moves == ["L X1", "L X1 Z3", "L X1", "L X2", "L X2 Z3", "L X2", "L X3"]


@pytest.mark.parametrize(
    ("words", "turned"),
    [
        ("G17 G68 X0 Y0 R90", "L Y1"),
        # The lines of G18 and G19 are exchanged in print: G18 is the plane of Z and X.
        ("G18 G68 X0 Z0 R90", "L Z-1"),
        ("G19 G68 Y0 Z0 R90", "L X1"),
    ],
)
def test_rotations(words: str, turned: str) -> None:
    assert run(f"{words}\nG1 F10 X1\n").moves == [turned]


CYCLE_FORMATS = [
    ("G90 G73 X1 Y1 Z-1 R.1 Q.3 F10", 10),
    ("G90 G74 X1 Y1 Z-1 R.1  F10", 5),
    ("G90 G76 X1 Y1 Z-1 R.1 Q.2 F10", 6),
    ("G90 G81 X1 Y1 Z-1 R.1  F10", 4),
    ("G90 G82 X1 Y1 Z-1 R.1 P2 F10", 4),
    ("G90 G83 X1 Y1 Z-1 R.1 Q.3 F10", 13),
    ("G90 G84 X1 Y1 Z-1 R.1 P2 F10", 5),
    ("G90 G85 X1 Y1 Z-1 R.1  F10", 5),
    ("G90 G86 X1 Y1 Z-1 R.1  F10", 4),
    ("G90 G89 X1 Y1 Z-1 R.1P2  F10", 4),
]


@pytest.mark.parametrize(("words", "move_cnt"), CYCLE_FORMATS)
def test_the_formats_of_the_cycles(words: str, move_cnt: int) -> None:
    done = run(f"{words}\nG80 X0{CYCLES}", start=Z2)
    assert done.error is None
    assert len(done.moves) == move_cnt + 1
    assert bool(done.of(Dwell)) == ("P2" in words)
    assert min(z for *_, z in done.ends) == -1


def test_a_cycle_cannot_be_used_without_its_file() -> None:
    assert errors("G90 G81 X1 Y1 Z-1 R.1 F10\nM2") == ["E251"]
    assert errors("$I CYCLES.TXT\nG90 G81 X1 Y1 Z-1 R.1 F10\nM2") == ["E262"]
    assert errors(f"N70001 G90 G81 X1 Y1 Z-1 R.1 F10{CYCLES}") == ["E263"]


@pytest.mark.parametrize(("f", "centre"), [(0, "1,0"), (1, "1,2"), (2, "0,1")])
def test_the_circle_in_three_readings(f: int, centre: str) -> None:
    done = run(f"G200 F{f}\nF10\nX1 Y1 \nG2 X1 Y1 I0 J1 \n")
    assert done.moves == ["L X1 Y1", f"A X1 Y1 about {centre} -360"]


def test_the_loop_with_a_counter() -> None:
    text = "G91 \n F100 \n P5=0 \n N100 \n P5=P5+1 \n X1 \n Y1 \n IF P5<5 THEN GOTO 100 \n M2 \n"
    done = run(text)
    assert len(done.moves) == 10
    assert done.moves[-1] == "L X5 Y5"


def test_the_same_shape_without_the_loop() -> None:
    done = run("G91 \nF100 \nP5=0 \nN100 \nP5=5 \n \n \n \nX1 \nY1 \nM2 \n")
    assert done.moves == ["L X1", "L X1 Y1"]
    assert done.machine.parameters[5] == 5


@pytest.mark.parametrize(
    ("condition", "cells", "bits", "jumps"),
    [
        ("If P1=5 THEN GOTO 100", {1: 5.0}, set(), True),
        ("If P1=5 THEN GOTO 100", {1: 4.0}, set(), False),
        ("If #1 = 1 THEN GOTO 100", {1: 0.0}, {1}, True),
        ("If #1 = 1 THEN GOTO 100", {1: 1.0}, set(), False),
    ],
)
def test_the_conditional_branches(
    condition: str, cells: dict[int, float], bits: set[int], jumps: bool
) -> None:
    done = run(f"F10\n{condition}\nX1\nN100 Y1\nM2", cells, machine=Bench(bits=bits))
    assert done.moves == (["L Y1"] if jumps else ["L X1", "L X1 Y1"])


def test_the_axes_with_expressions() -> None:
    done = run("F10\nX(#1+#3) Y(P4+P6) \n", {1: 1.5, 3: 2.0, 4: 0.25, 6: 0.5})
    assert done.moves == ["L X3.5 Y0.75"]


def test_the_assignment_with_a_function() -> None:
    done = run("P40 = 1.555*Sin(45) + P6/P10 \n", {6: 6.0, 10: 2.0})
    assert done.machine.parameters[40] == pytest.approx(1.555 * math.sin(math.pi / 4) + 3)
    assert "W220" in done.codes  # P34 to P99 are reserved, and the guide uses one


def test_a_return_without_a_call_is_an_error() -> None:
    assert errors("RET") == ["E261"]
    calls = "".join(f"N{n} GOSUB {n + 1}\nRET\n" for n in range(1, 10)) + "N10 RET\n"
    assert errors(f"GOSUB 1\nM2\n{calls}") == []
    calls = "".join(f"N{n} GOSUB {n + 1}\nRET\n" for n in range(1, 11)) + "N11 RET\n"
    assert errors(f"GOSUB 1\nM2\n{calls}") == ["E260"]
