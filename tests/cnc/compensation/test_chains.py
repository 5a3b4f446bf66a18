"""Beginning and end of compensation, what waits between elements, and changes on the way."""

from math import cos, pi, radians, sin

import pytest
from msgspec.structs import replace
from tests.cnc.compensation.tools import EXACT, FEED, Path, Trace, compensate, plane_point

from openacr.cnc.canonical import Plane, Source
from openacr.cnc.compensation import Compensator, Rules, Side
from openacr.cnc.geometry.elements import Element


def started(radius: float = 0.25, side: Side = Side.LEFT, rules: Rules = EXACT):  # type: ignore[no-untyped-def]
    trace = Trace()
    compensator: Compensator[str] = Compensator(rules, trace.report)
    trace.out += compensator.switch(side, radius)
    return trace, compensator


def texts(trace: Trace) -> list[object]:
    """Positions of elements and the held texts between them, in order."""
    return [e if isinstance(e, str) else plane_point(e.plane, e.end) for e in trace.out]


@pytest.mark.req("MILL-COMP-12")
def test_the_lead_in_ends_beside_the_start_of_the_contour() -> None:
    trace = compensate(Path(-1, 2).to(0, 0).to(2, 0).to(2, 2).elements, 0.25)
    lead_in = trace.elements[0]
    assert lead_in.start[:2] == (-1, 2)
    assert trace.ends[0] == (0, 0.25)
    assert trace.findings == []


def test_rapid_lead_ins_and_lead_outs_stay_rapid() -> None:
    path = Path(-1, 2).rapid(0, 0).to(2, 0).rapid(2, 2)
    trace = compensate(path.elements, 0.25)
    assert [each.pace for each in trace.elements] == [None, FEED, None]


@pytest.mark.req("MILL-COMP-13")
def test_the_lead_out_goes_straight_from_beside_the_end() -> None:
    trace = compensate(Path(-1, 2).to(0, 0).to(2, 0).to(3, 3).elements, 0.25)
    assert trace.ends[1:] == [(2, 0.25), (3, 3)]


def test_the_tool_rests_beside_the_end_until_something_moves() -> None:
    trace, compensator = started()
    path = Path(-1, 2).to(0, 0).to(2, 0)
    for element in path.elements:
        trace.out += compensator.add(element)
    trace.out += compensator.switch(None)
    assert texts(trace)[-1] == (2, 0.25)
    assert compensator.place == (2, 0.25)
    path.to(2, 0, 5).to(3, 0)
    up, out = path.elements[-2:]
    (lifted,) = compensator.add(up)
    assert isinstance(lifted, Element)
    assert lifted.end[:3] == (2, 0.25, 5)
    (left,) = compensator.add(out)
    assert isinstance(left, Element)
    assert left.start[:3] == (2, 0.25, 5)
    assert left.end[:3] == (3, 0, 5)
    assert compensator.place is None


def test_without_an_element_after_it_the_lead_in_ends_beside_itself() -> None:
    trace = compensate(Path(0, 0).to(2, 0).to(4, 4).elements, 0.25)
    assert trace.ends == [(2, 0.25), (4, 4)]


@pytest.mark.req("MILL-COMP-14")
@pytest.mark.parametrize("is_first", [True, False])
def test_an_arc_is_neither_lead_in_nor_lead_out(is_first: bool) -> None:
    path = Path(0, 0)
    if is_first:
        path.arc(2, 0, 1, 0, 1).to(3, 0).to(4, 4)
    else:
        path.to(1, 0).to(3, 0).arc(5, 0, 4, 0, 1)
    trace = compensate(path.elements, 0.25)
    ((code, _, line),) = trace.findings
    assert (code, line) == ("E313", 1 if is_first else 3)


def test_a_short_lead_in_is_reported() -> None:
    trace = compensate(Path(0, 0.2).to(0, 0).to(2, 0).to(2, 2).elements, 0.25)
    assert trace.findings == [("W311", "lead-in is shorter than the radius 0.25", 1)]


@pytest.mark.parametrize(
    ("turn_deg", "codes"),
    [(0, []), (44.9, []), (-44.9, []), (45.1, ["W311"]), (-45.1, ["W311"]), (180, ["W311"])],
)
def test_a_short_lead_in_that_runs_on_into_an_arc_is_not_one(
    turn_deg: float, codes: list[str]
) -> None:
    """The arc begins at the origin to the right, with its centre above."""
    x, y = 0.2 * cos(radians(turn_deg)), 0.2 * sin(radians(turn_deg))
    path = Path(-x, -y).to(0, 0).arc(1, 1, 0, 1, 1).to(1, 2).to(2, 2)
    found = compensate(path.elements, 0.25).codes
    assert [code for code in found if code == "W311"] == codes


def test_a_short_lead_in_along_a_line_is_reported() -> None:
    assert compensate(Path(-0.2, 0).to(0, 0).to(2, 0).to(2, 2).elements, 0.25).codes == ["W311"]
    assert compensate(Path(-0.25, 0).to(0, 0).to(2, 0).to(2, 2).elements, 0.25).codes == []


def test_a_lead_in_from_the_material_is_reported() -> None:
    trace = compensate(Path(1.5, -0.1).to(0, 0).to(2, 0).to(2, 2).elements, 0.25)
    assert trace.codes == ["W312"]
    assert "line 2" in trace.findings[0][1]


def test_a_lead_in_from_far_beyond_the_contour_is_not() -> None:
    trace = compensate(Path(1.5, -0.3).to(0, 0).to(2, 0).to(2, 2).elements, 0.25)
    assert trace.codes == []


def test_blocks_without_motion_wait_for_the_trimmed_end() -> None:
    trace, compensator = started(side=Side.RIGHT)
    path = Path(0, -1).to(0, 0).to(1, 0).to(1, 0, 3).to(1, 1).to(0, 1)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.hold("M8")
    trace.out += compensator.hold("block end", is_after=True)
    for element in path.elements[2:]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert texts(trace)[1:6] == [(1, -0.25), "M8", (1, -0.25), (1.25, 0), "block end"]
    up, corner = trace.elements[2:4]
    assert (up.start[2], up.end[2]) == (0, 3)
    assert corner.is_inserted
    assert (corner.start[2], corner.end[2]) == (3, 3)


def test_more_than_a_hundred_waiting_blocks_end_the_chain() -> None:
    trace, compensator = started()
    path = Path(0, 1).to(0, 0).to(1, 0)
    for element in path.elements:
        trace.out += compensator.add(element)
    for k in range(101):
        trace.out += compensator.hold(f"M{k}")
    assert texts(trace)[1] == (1, 0.25)
    assert texts(trace)[-1] == "M100"


def test_a_waiting_block_ends_the_chain_and_the_corner_is_rounded_after_it() -> None:
    trace, compensator = started(side=Side.RIGHT)
    path = Path(0, -1).to(0, 0).to(1, 0).to(1, 1).to(0, 1)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.flush()
    assert texts(trace)[-1] == (1, -0.25)
    trace.out.append("M0")
    for element in path.elements[2:]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert texts(trace)[2:4] == ["M0", (1.25, 0)]
    assert trace.inserted[0].sweep_rad == pytest.approx(pi / 2)
    assert trace.findings == []


def test_after_a_waiting_block_an_inside_corner_is_reached_straight() -> None:
    trace, compensator = started()
    path = Path(0, 1).to(0, 0).to(1, 0).to(1, 1).to(0, 1)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.flush()
    for element in path.elements[2:]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert trace.ends[:4] == [(0, 0.25), (1, 0.25), (0.75, 0), (0.75, 0.75)]
    assert trace.inserted[0].centre is None
    assert trace.codes == ["W324"]


def test_another_radius_at_an_outside_corner_is_reached_straight() -> None:
    trace, compensator = started(side=Side.RIGHT)
    path = Path(0, -1).to(0, 0).to(1, 0).to(1, 1).to(0, 1)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.switch(Side.RIGHT, 0.4)
    for element in path.elements[2:]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert trace.ends[1:3] == [(1, -0.25), (1.4, 0)]
    assert trace.inserted[0].centre is None


def test_a_change_of_side_goes_straight_across() -> None:
    trace, compensator = started()
    path = Path(0, 1).to(0, 0).to(1, 0).to(2, 0).to(3, 0)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.switch(Side.RIGHT, 0.25)
    for element in path.elements[2:]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert trace.ends[1:4] == [(1, 0.25), (1, -0.25), (2, -0.25)]
    assert trace.findings == [("W313", "G42 follows G41 without G40", 3)]


def test_a_ramp_reaches_its_level_over_the_trimmed_element() -> None:
    path = Path(0, 1).to(0, 0).to(1, 0, -1).to(1, 1, -2).to(0, 1)
    trace = compensate(path.elements, 0.25)
    ramp = trace.elements[1]
    assert ramp.start[:3] == (0, 0.25, 0)
    assert ramp.end[:3] == (0.75, 0.25, -1)


def test_a_helix_keeps_its_pitch_of_turns() -> None:
    path = Path(0, 0).to(1, 0).arc(1, 0, 0, 0, 1, z=-1).arc(1, 0, 0, 0, 1, z=-2).to(0, 0)
    trace = compensate(path.elements, 0.25)
    for turn, level in zip(trace.elements[1:3], (-1, -2), strict=True):
        assert turn.sweep_rad == pytest.approx(2 * pi)
        assert turn.end[:3] == pytest.approx((0.75, 0, level))
    assert trace.findings == []


@pytest.mark.parametrize("side", list(Side))
def test_a_full_circle_stays_one(side: Side) -> None:
    trace = compensate(Path(3, 0).to(2, 0).arc(2, 0, 0, 0, -1).to(3, 0).elements, 0.25, side)
    circle = trace.elements[1]
    assert circle.sweep_rad == pytest.approx(-2 * pi)
    assert circle.start[:2] == pytest.approx((2.25 if side is Side.LEFT else 1.75, 0))


def test_stop_ends_compensation_without_a_move() -> None:
    trace, compensator = started()
    path = Path(0, 1).to(0, 0).to(1, 0).to(2, 2)
    for element in path.elements[:2]:
        trace.out += compensator.add(element)
    trace.out += compensator.stop()
    assert trace.ends == [(0, 0.25), (1, 0.25)]
    assert not compensator.is_on
    last = path.elements[2]
    assert compensator.add(last) == [last]


def test_moves_shorter_than_a_millionth_only_wait() -> None:
    path = Path(0, 1).to(0, 0).to(1, 0).to(1 + 5e-7, 0, -1).to(1, 1).to(0, 1)
    trace = compensate(path.elements, 0.25)
    assert [each.end[2] for each in trace.elements[1:4]] == [0, -1, -1]
    assert trace.elements[2].start[:2] == trace.elements[2].end[:2] == trace.elements[1].end[:2]
    assert trace.findings == []


def test_a_rapid_corner_keeps_its_distance_in_straight_moves() -> None:
    path = Path(0, -1).rapid(0, 0).rapid(1, 0).rapid(1, 1).rapid(0, 1)
    trace = compensate(path.elements, 0.25, Side.RIGHT)
    assert all(each.pace is None and each.centre is None for each in trace.elements)
    for each in trace.inserted:
        for x, y in (plane_point(Plane.XY, each.start), plane_point(Plane.XY, each.end)):
            assert ((x - 1) ** 2 + y**2) ** 0.5 >= 0.25 - 1e-9


def test_findings_name_the_source_of_the_element() -> None:
    trace = Trace()
    places: list[Source] = []
    compensator: Compensator[str] = Compensator(
        EXACT, lambda code, text, element: places.append(element.source)
    )
    compensator.switch(Side.LEFT, -1.0)
    path = Path(0, 5).to(0, 0)
    trace.out += compensator.add(path.elements[0])
    assert places == [path.elements[0].source]


def test_elements_that_come_out_are_like_any_other() -> None:
    path = Path(-1, 2).to(0, 0).to(2, 0).to(2, 2)
    made = compensate(path.elements, 0.25).elements[1]
    same = Element(
        path.elements[1].source, Plane.XY, made.start, made.end, FEED, is_compensated=True
    )
    assert made == same
    assert hash(made) == hash(same)
    assert replace(made, pace=None).pace is None
    with pytest.raises(AttributeError):
        made.pace = None  # type: ignore[misc]


def test_after_an_arc_that_is_left_out_outside_corners_are_rolled_about_again() -> None:
    rules = Rules(epsilon=1e-6, sweep_epsilon=1e-4, root_epsilon=-12, gouge_stop=False)
    path = Path(-1, 0).to(0, 0).to(2, 0).arc(2.1, 0.1, 2, 0.1, 1).to(2.1, 2).to(4, 2).to(4, 4)
    trace = compensate(path.elements, 0.25, rules=rules)
    (rolled,) = [each for each in trace.inserted if each.centre is not None]
    assert rolled.source.line == 5
    assert plane_point(rolled.plane, rolled.start) == (1.85, 2.0)
    assert plane_point(rolled.plane, rolled.end) == (2.1, 2.25)


def test_a_corner_before_a_rapid_is_rolled_about_at_the_feed_before_it() -> None:
    path = Path(-1, 0).to(0, 0).to(1, 0).rapid(1, -1).to(3, -3)
    (rolled,) = compensate(path.elements, 0.25, has_lead_out=True).inserted
    assert rolled.pace == FEED
    assert rolled.centre == (1.0, 0.0)
    assert plane_point(rolled.plane, rolled.end) == (1.25, 0.0)


def test_an_element_without_a_path_of_the_tool_still_moves_other_axes() -> None:
    path = Path(-1, 0).to(0, 0).to(1, 0).to(1, 0.5, -1).to(0, 0.5).to(-1, 0)
    moved = [each for each in compensate(path.elements, 0.25).elements if each.source.line == 3]
    assert [each.end[:3] for each in moved] == [(0.75, 0.25, -1.0)]
