"""What a tool cannot reach is found, named, and with Gouge Stop off left out."""

from math import pi, tan

import pytest
from tests.cnc.compensation.tools import EXACT, Path, compensate

from openacr.cnc.compensation import Rules, Side

ADJUSTING = Rules(EXACT.epsilon, EXACT.sweep_epsilon, EXACT.root_epsilon, gouge_stop=False)


def pocket(width: float) -> Path:
    """The inside of a rectangle of length 1, clockwise, entered in a long side."""
    path = Path(0.5, 0.2).to(0.5, width).to(1, width).to(1, 0).to(0, 0).to(0, width)
    return path.to(0.5, width).to(0.5, 0.2)


@pytest.mark.req("MILL-COMP-09", "MILL-COMP-27")
def test_a_pocket_narrower_than_the_tool_is_refused_on_both_short_sides() -> None:
    trace = compensate(pocket(0.4).elements, 0.25, Side.RIGHT)
    gouges = [finding for finding in trace.findings if finding[0] == "E322"]
    assert [line for _, _, line in gouges] == [3, 5]
    assert gouges[0][1] == ("gouge: line 3 cannot be reached with radius 0.25 (largest radius 0.2)")


def test_a_tool_that_fits_is_not_refused() -> None:
    assert compensate(pocket(0.4).elements, 0.19, Side.RIGHT).findings == []


def test_the_largest_radius_of_a_step_is_found() -> None:
    # Two inside corners of 45 degrees, 1 apart: the tool reaches the step up to 1 / (2 tan 22.5).
    path = Path(-5, 5).to(-5, 0).to(0, 0).to(0.5**0.5, 0.5**0.5).to(0.5**0.5, 6).to(0, 6)
    largest = 0.5 / tan(pi / 8)
    assert compensate(path.elements, largest * 0.999).findings == []
    trace = compensate(path.elements, largest * 1.001)
    assert trace.codes == ["E322"]
    assert f"(largest radius {largest:.5g})" in trace.findings[0][1]


def test_an_inside_arc_not_larger_than_the_tool_is_refused() -> None:
    path = Path(0, 2).to(0, 0).to(1, 0).arc(1.2, 0.2, 1, 0.2, 1).to(1.2, 2).to(0, 2)
    trace = compensate(path.elements, 0.25)
    assert trace.findings == [
        ("E320", "arc of radius 0.2 is not larger than the tool radius 0.25", 3)
    ]
    assert trace.ends[1:3] == [(0.95, 0.25), (0.95, 2)]


def test_with_gouge_stop_off_a_small_arc_is_left_out() -> None:
    path = Path(0, 2).to(0, 0).to(1, 0).arc(1.2, 0.2, 1, 0.2, 1).to(1.2, 2).to(0, 2)
    trace = compensate(path.elements, 0.25, rules=ADJUSTING)
    assert trace.codes == ["W320"]
    assert trace.ends[1:3] == [(0.95, 0.25), (0.95, 2)]


def test_with_gouge_stop_off_what_cannot_be_reached_is_left_out() -> None:
    # A chamfer of 0.1 in an inside corner, too small for the tool.
    path = Path(0, 2).to(0, 0).to(1, 0).to(1.1, 0.1).to(1.1, 2).to(0, 2)
    trace = compensate(path.elements, 0.5, rules=ADJUSTING)
    assert trace.codes == ["W322"]
    assert "line 3" in trace.findings[0][1]
    assert trace.ends == [(0, 0.5), (0.6, 0.5), (0.6, 2), (0, 2)]


def test_with_gouge_stop_off_several_elements_in_a_row_are_left_out() -> None:
    # A fillet of radius 0.1 in four chords.
    path = Path(0, 2).to(0, 0).to(1, 0).to(1.04, 0.01).to(1.07, 0.03).to(1.09, 0.06)
    path.to(1.1, 0.1).to(1.1, 2).to(0, 2)
    trace = compensate(path.elements, 0.5, rules=ADJUSTING)
    assert set(trace.codes) == {"W322"}
    assert trace.ends == [(0, 0.5), (0.6, 0.5), (0.6, 2), (0, 2)]


def test_more_than_five_left_out_in_a_row_are_refused() -> None:
    path = Path(0, 2).to(0, 0).to(1, 0)
    for k in range(1, 9):
        path.to(1 + 0.1 * (k / 9), 0.1 * (k / 9) ** 2)
    path.to(1.1, 2).to(0, 2)
    trace = compensate(path.elements, 0.5, rules=ADJUSTING)
    assert "E322" in trace.codes


def test_what_waited_for_an_element_left_out_waits_for_the_one_before() -> None:
    path = Path(0, 2).to(0, 0).to(1, 0).to(1.1, 0.1).to(1.1, 0.1, 3).to(1.1, 2).to(0, 2)
    trace = compensate(path.elements, 0.5, rules=ADJUSTING)
    assert trace.ends[1:4] == [(0.6, 0.5), (0.6, 0.5), (0.6, 2)]
    assert trace.elements[2].end[2] == 3
