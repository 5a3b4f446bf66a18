"""Inserted moves as lines of text."""

import pytest

from openacr.cnc.canonical import Arc, Line, Pace, Plane, Rapid, Source
from openacr.cnc.compensation import listing

SOURCE, PACE = Source("", 3, ""), Pace(10.0)
REST = (0.0,) * 5


def test_an_arc_has_its_end_and_its_centre() -> None:
    arc = Arc(SOURCE, (1.25, 0, -1, *REST), Plane.XY, (1, 0), 1.5708, 0.25, 0.25, PACE, True)
    assert listing(arc, Plane.XY) == "<ins> G3 X1.25 Y0 I1 J0"


@pytest.mark.parametrize(
    ("plane", "text"),
    [
        (Plane.XY, "<ins> G2 X1.1235 Y2 I3 J4"),
        (Plane.ZX, "<ins> G2 X1.1235 Z5 I4 K3"),
        (Plane.YZ, "<ins> G2 Y2 Z5 J3 K4"),
    ],
)
def test_words_are_those_of_the_plane(plane: Plane, text: str) -> None:
    arc = Arc(SOURCE, (1.12346, 2, 5, *REST), plane, (3, 4), -1.0, 1, 1, PACE, True)
    assert listing(arc, plane) == text


def test_straight_moves_are_lines_or_rapids() -> None:
    end = (0.5, -0.00001, 0, *REST)
    assert listing(Line(SOURCE, end, PACE, True), Plane.XY) == "<ins> G1 X0.5 Y0"
    assert listing(Rapid(SOURCE, end, True), Plane.XY) == "<ins> G0 X0.5 Y0"


def test_numbers_are_program_coordinates_in_the_active_unit() -> None:
    arc = Arc(SOURCE, (11.25, 10, 0, *REST), Plane.XY, (11, 10), 1.5708, 0.25, 0.25, PACE, True)
    shift = (10.0, 10.0, 3.0, *REST)
    text = listing(arc, Plane.XY, shift=shift, scale=25.4, is_metric=True)
    assert text == "<ins> G3 X31.75 Y0 I25.4 J0"
