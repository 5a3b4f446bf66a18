"""Compensation that begins with an arc, as LinuxCNC has it."""

import math

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.cnc.compensation.tools import EXACT, FEED
from tests.cnc.programs import errors, run

from openacr.cnc.canonical import Arc, Plane, Source
from openacr.cnc.compensation import Compensator, Side
from openacr.cnc.compensation.entry import entry_arc
from openacr.cnc.geometry.elements import Element

ANGLES = st.floats(-math.pi, math.pi)
LENGTHS = st.floats(0.1, 10.0)


def ngc(text: str) -> list[str]:
    done = run(text.replace("|", "\n"), dialect="rs274ngc")
    assert done.error is None, done.error
    return done.moves


@given(
    start_angle=ANGLES, turn=st.sampled_from([-1.0, 1.0]), sweep=st.floats(0.2, 6.0),
    radius=LENGTHS, tool=st.floats(0.01, 3.0), is_left=st.booleans(),
)  # fmt: skip
@example(start_angle=-math.pi / 2, turn=1.0, sweep=math.pi / 2, radius=1.0, tool=0.25, is_left=True)
def test_the_tool_leaves_where_it_is_and_arrives_beside_the_end_on_a_tangent(
    start_angle: float, turn: float, sweep: float, radius: float, tool: float, is_left: bool
) -> None:
    cx, cy = 0.3, -0.7
    end_angle = start_angle + turn * sweep
    points = [
        (cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in (start_angle, end_angle)
    ]
    element = Element(
        Source("P", 1, ""),
        Plane.XY,
        (*points[0], 1.0),
        (*points[1], 2.0),
        FEED,
        (cx, cy),
        turn * sweep,
    )
    away = tool if is_left else -tool
    contour = entry_arc(element, away, points[0])
    tangent = (-turn * math.sin(end_angle), turn * math.cos(end_angle))
    arrival = (points[1][0] - away * tangent[1], points[1][1] + away * tangent[0])
    chord = math.dist(points[0], points[1])
    assume(abs(chord - tool) > 1e-6)
    if contour is None:  # too near, or the end is not reached from this side
        to_left = turn * away
        path = (arrival[0] - points[0][0], arrival[1] - points[0][1])
        inward = (cx - points[1][0]) / radius, (cy - points[1][1]) / radius
        height = -(path[0] * inward[0] + path[1] * inward[1])
        reach = math.hypot(*path)
        assert chord <= tool or height <= 1e-9 or reach * reach / (2.0 * height) <= -to_left + 1e-9
        return
    assert contour.centre is not None
    assert chord > tool
    c = contour.centre
    tool_radius = math.dist(c, points[0])
    assert math.dist(c, arrival) == pytest.approx(tool_radius, rel=1e-6)
    assert math.dist(c, points[1]) == pytest.approx(math.dist(c, contour.start[:2]), rel=1e-6)
    # The end of the contour is that of the program, and so is the tangent there.
    assert contour.end == element.end
    radial = (points[1][0] - c[0], points[1][1] - c[1])
    assert abs(radial[0] * tangent[0] + radial[1] * tangent[1]) <= 1e-6 * math.hypot(*radial)
    assert math.copysign(1.0, contour.sweep_rad) == turn
    # The tool is beside the start of the contour, on the same radius.
    begin = (contour.start[0] - c[0], contour.start[1] - c[1])
    along = (points[0][0] - c[0], points[0][1] - c[1])
    assert abs(begin[0] * along[1] - begin[1] * along[0]) <= 1e-6 * tool_radius * math.hypot(*begin)
    assert tool_radius - math.hypot(*begin) == pytest.approx(-turn * away, abs=1e-6 * tool_radius)
    turned = math.atan2(arrival[1] - c[1], arrival[0] - c[0]) - math.atan2(along[1], along[0])
    assert math.cos(turned - contour.sweep_rad) == pytest.approx(1.0, abs=1e-9)
    assert 0.0 <= abs(contour.sweep_rad) <= 2.0 * math.pi
    assert contour.start[2] == 1.0


def test_a_quarter_circle_leads_to_a_line() -> None:
    # (0, 0) to (1, 1) about (0, 1), tool left: it arrives at (.75, 1) on an arc about x = -7/24.
    moves = ngc("G41.1 D.5 F10|G3 X1 Y1 I0 J1|G1 Y3|G40 X0")
    angle = math.degrees(math.atan2(1.0, 7 / 24))
    assert moves == [f"A X0.75 Y1 about -0.291667,1 {round(angle)}", "L X0.75 Y3", "L Y3"]
    right = ngc("G42.1 D.5 F10|G3 X1 Y1 I0 J1|G1 Y3|G40 X2")
    assert right[0].startswith("A X1.25 Y1 about 0.225,1 ")
    assert right[1:] == ["L X1.25 Y3", "L X2 Y3"]


def test_the_code_may_stand_in_the_block_of_the_arc() -> None:
    apart = ngc("G41.1 D.5 F10|G3 X1 Y1 I0 J1|G1 Y3|G40 X0")
    assert ngc("F10 G41.1 D.5 G3 X1 Y1 I0 J1|G1 Y3|G40 X0") == apart


def test_an_outer_corner_after_the_arc_is_rounded_and_an_inner_one_is_cut_short() -> None:
    outer = ngc("G41.1 D.5 F10|G3 X1 Y1 I0 J1|G1 X3|G40 Y0")
    assert outer[0].startswith("A X0.75 Y1 about -0.291667,1 ")
    assert outer[1:3] == ["A X1 Y1.25 about 1,1 -90", "L X3 Y1.25"]
    inner = ngc("G42.1 D.5 F10|G3 X1 Y1 I0 J1|G1 X3|G40 Y2")
    # The tool's arc about (.225, 1), radius 1.025, meets the line y = .75.
    x = 0.225 + math.sqrt(1.025**2 - 0.25**2)
    assert inner[0].startswith(f"A X{round(x, 6):g} Y0.75 about 0.225,1 ")
    assert inner[1] == "L X3 Y0.75"


def test_height_changes_over_the_arc_and_the_plane_may_be_another() -> None:
    (arc, *_) = run("G18 G41.1 D.5 F10\nG2 X1 Z1 Y.5 I1 K0\nG1 X3\nG40 Z3", dialect="rs274ngc").of(
        Arc
    )
    assert isinstance(arc, Arc)
    assert arc.end[1] == 0.5


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G41.1 D3 F10|G3 X1 Y1 I0 J1", "E313"),  # nearer than the radius
        ("G42.1 D3 F10|G3 X1 Y1 I0 J1", "E313"),
        ("G41.1 D2 F10|G3 X1 Y1 I0 J1", "E313"),  # it would have to arrive sideways
        ("G41.1 D3.8 F10|G3 X1 Y1 I0 J1", "E313"),
        ("G41.1 D.5 F10|G1 X1|X2|G40 G3 X3 Y1 I0 J1", "E313"),  # and not as lead-out
        ("G41.1 D.5 F10|G1 X1|X2|G40|G3 X3 Y1 I1 J0", "E313"),
        ("G41.1 D.5 F10|G1 X1|X2|G42.1 D.5 G3 X3 Y1 I0 J1", "E313"),
    ],
)
def test_arcs_that_cannot_be_lead_ins_are_refused(text: str, code: str) -> None:
    assert errors(text.replace("|", "\n"), dialect="rs274ngc") == [code]


def test_a_tool_that_does_not_come_in_is_named() -> None:
    error = run("G41.1 D3 F10\nG3 X1 Y1 I0 J1", dialect="rs274ngc").error
    assert error is not None
    assert str(error) == "PROGRAM:2:1: E313 the tool, radius 1.5, cannot lead in along this arc"


def test_the_lead_in_begins_where_the_tool_is_after_a_chain_without_a_lead_out() -> None:
    rules = replace(EXACT, has_entry_arcs=True)
    found: list[str] = []
    compensator: Compensator[str] = Compensator(rules, lambda code, *_: found.append(code))
    source = Source("P", 1, "")
    compensator.switch(Side.LEFT, 0.25)
    rest = (0.0,) * 6
    line = Element(source, Plane.XY, (0.0, 0.0, *rest), (1.0, 0.0, *rest), FEED)
    compensator.add(line)
    compensator.switch(None)  # the tool rests at (1, .25)
    compensator.switch(Side.LEFT, 0.25)
    ends = (1.0, 0.0, *rest), (2.0, 1.0, *rest)
    arc = Element(source, Plane.XY, *ends, FEED, (1.0, 1.0), math.pi / 2)
    (first,) = [*compensator.add(arc), *compensator.flush()]
    assert isinstance(first, Element)
    assert first.start == pytest.approx((1.0, 0.25, *rest), abs=1e-12)
    assert first.end == pytest.approx((1.75, 1.0, *rest), abs=1e-12)
    assert first.is_compensated
    assert not found
