"""G codes: what each one does to the path."""

import pytest
from tests.cnc.programs import errors, run

from openacr.cnc.canonical import Arc, Line, PathMode, Rapid


def placed(**axes: float) -> str:
    """Axis words as moves show them."""
    return " ".join(f"{axis}{axes[axis]:g}" for axis in "XYZ" if axis in axes)


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


def test_a_path_mode_acts_on_the_moves_after_it() -> None:
    lines = run("F10 G1 X1\nG61\nX2\nG63\nX3\nG64\nX4").of(Line)
    modes = [PathMode.FREE, PathMode.EXACT, PathMode.LOCKED, PathMode.FREE]
    assert [line.pace.mode for line in lines if isinstance(line, Line)] == modes


# --- work systems, offsets ----------------------------------------------------------------


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


@pytest.mark.req("MILL-G53")
@pytest.mark.parametrize(
    ("chosen", "there"), [("G68 X0 Y0 R90", "R Y2"), ("G51 X0 Y0 Z0 P3", "R X6")]
)
def test_machine_coordinates_are_neither_rotated_nor_scaled(chosen: str, there: str) -> None:
    done = run(f"{chosen}\nG53 G0 X1\nF10 G2 X1 Y0 I0 J0\nG54 G0 X2 Y0")
    assert done.moves == ["R X1", "A X1 about 0,0 -360", there]


@pytest.mark.parametrize(("code", "offset"), [("G43", 1.51), ("G44", -1.51)])
def test_positions_after_g49_are_without_the_length(code: str, offset: float) -> None:
    done = run(f"G0 {code} H1 Z0\nG49 Z0\nZ1", {2001: 1.5, 3001: 0.01}, start=(0, 0, 2))
    assert done.moves == [f"R Z{offset:g}", "R 0", "R Z1"]


def test_a_change_of_the_unit_keeps_the_speed() -> None:
    lines = [each for each in run("G1 X1 F10\nG21\nX50.8").of(Line) if isinstance(each, Line)]
    assert [(each.end[0], each.pace.feed_upm) for each in lines] == [(1, 10), (2, 10)]


# --- reference points ---------------------------------------------------------------------


def test_reference_moves_do_not_go_with_scaling() -> None:
    assert errors("G51 X0 P2\nG28 X1") == ["E242"]
    assert errors("G41 D1\nG28 X1") == ["E312"]


# --- codes that do not exist or do not go together ------------------------------------------


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
