"""Canonical moves as bytes, against packets worked out by hand."""

import math
from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mill.shop import PULSES, at, line, rapid, src

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.plan.moves.planning import CornerRules, Planner
from openacr.protocol.move import Move
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS


def encoder(**cells: float) -> Encoder:
    store = Store()
    for name, value in cells.items():
        store.write(int(name.removeprefix("P")), value)
    return Encoder(Settings(store))


def planned(entries: Iterable[c.Line | c.Arc | c.Rapid], **cells: float) -> list[Move]:
    coder = encoder(**cells)
    planner: Planner[Job] = Planner(CornerRules())
    begin = at()
    for entry in entries:
        planner.add(coder.job(entry, begin))
        begin = entry.end
    packets = (coder.packet(job) for job in planner.release(100, is_complete=True))
    return [packet for packet in packets if packet is not None]


def test_the_last_move_of_a_program_is_the_printed_packet() -> None:
    (move,) = planned([line(1, at(1), feed=60.0)])
    assert move.encode() == bytes.fromhex("04 B9 00 01 00 0000803F 0000C842 10270000")


def test_an_arc_followed_by_a_tangent_line_is_the_printed_packet() -> None:
    arc = c.Arc(src(1), at(1, 1), c.Plane.XY, (0.0, 1.0), math.pi / 2, 1.0, 1.0, c.Pace(60.0))
    first, _ = planned([arc, line(2, at(1, 2), feed=60.0)])
    ramp = "71FDC742"  # sqrt(100^2 - (1^2/1)^2): what the turn leaves of Master Feed ACC
    assert first.encode() == bytes.fromhex(
        f"04 B8 30 03 00 0000803F {ramp} 10270000 10270000 00000000 10270000"
    )


def test_a_square_without_corner_rule_stops_only_at_its_end() -> None:
    ends = [at(1, 0), at(1, 1), at(0, 1), at(0, 0)]
    packets = planned([line(n, end, feed=100.0) for n, end in enumerate(ends)])
    assert [packet.codes[0] & 0x05 for packet in packets] == [0, 0, 0, 1]


def test_a_slower_move_is_reached_at_its_own_speed() -> None:
    first, _ = planned([line(1, at(10), feed=120.0), line(2, at(20), feed=60.0)])
    assert first.codes[0] & 0x05 == 0x04
    assert first.fvel == pytest.approx(1.0)


def test_rapids_have_their_own_mode_speed_and_ramp() -> None:
    (move,) = planned([rapid(1, at(1))], P650_011=90.0, P650_007=50.0)
    assert move.codes[0] & 0x05 == 0x05
    assert (move.vel, move.acc) == (1.5, 50.0)


@pytest.mark.parametrize("mode", list(c.PathMode))
def test_the_override_is_locked_under_g63_only(mode: c.PathMode) -> None:
    (move,) = planned([line(1, at(1), mode=mode)])
    assert bool(move.codes[0] & 0x02) is (mode is c.PathMode.LOCKED)


@pytest.mark.parametrize(
    ("plane", "code", "slaves"),
    [(c.Plane.XY, 0x30, (0, 1)), (c.Plane.YZ, 0x70, (1, 2)), (c.Plane.ZX, 0xB0, (0, 2))],
)
def test_the_plane_of_an_arc_is_in_its_header(
    plane: c.Plane, code: int, slaves: tuple[int, int]
) -> None:
    start, end = [0.0] * 8, [0.0] * 8
    end[plane.first] = end[plane.second] = 1.0
    centre = (0.0, 1.0)
    arc = c.Arc(src(1), tuple(end), plane, centre, math.pi / 2, 1.0, 1.0, c.Pace(60.0))
    move = encoder().packet(encoder().job(arc, tuple(start)))
    assert move is not None
    assert move.codes[1] == code
    assert tuple(slave for slave, _ in move.targets) == slaves
    assert move.centers == (0, 10000)


def test_only_axes_that_move_are_sent_and_nothing_at_all_when_none_does() -> None:
    coder = encoder()
    job = coder.job(line(1, at(1, 0, 0.00003)), at(1, 0, 0))
    assert coder.packet(job) is None
    moved = coder.packet(coder.job(line(1, at(1, 2)), at(1, 0)))
    assert moved is not None
    assert dict(moved.targets) == {1: 20000}


@pytest.mark.parametrize(
    ("position", "pulses"), [(0.00005, 1), (-0.00005, -1), (0.00004, 0), (1.23456, 12346)]
)
def test_positions_are_rounded_half_away_from_zero(position: float, pulses: int) -> None:
    assert encoder().pulses(at(position))[0] == pulses


def test_a_position_beyond_32_bits_is_refused() -> None:
    coder = encoder()
    inside, beyond = at((2**31 - 1) / PULSES), at(2**31 / PULSES)
    assert coder.beyond_pulses(coder.job(line(1, inside), at())) is None
    refusal = coder.beyond_pulses(coder.job(line(1, beyond), at()))
    assert refusal == "axis X at 214748 inch"


def test_an_arc_is_slowed_to_what_the_machine_gives_across() -> None:
    coder = encoder(P650_008=100.0, P650_000=60000.0)
    arc = c.Arc(src(1), at(0), c.Plane.XY, (0.01, 0.0), math.pi, 0.01, 0.01, c.Pace(6000.0))
    job = coder.job(arc, at(0.02))
    assert job.feed_ups == pytest.approx(math.sqrt(math.sqrt(0.75) * 100.0 * 0.01), rel=1e-14)
    assert job.ramp_ups2 == pytest.approx(50.0, rel=1e-14)  # half of it changes the speed


def test_rotary_axes_alone_move_at_degrees_per_minute() -> None:
    store = Store()
    store.write(100_001, 4)
    store.write(650_000, 60000.0)
    job = Encoder(Settings(store)).job(
        c.Line(src(1), (0.0, 0.0, 0.0, 90.0, 0, 0, 0, 0), c.Pace(600.0)), at()
    )
    assert job.length_u == 90.0
    assert job.feed_ups == pytest.approx(10.0)
    assert job.start is None


ARC_PATHS = st.lists(
    st.tuples(*[st.sampled_from((0.0, 0.00004, 0.25, -1.5, 3.33333))] * 4), min_size=1, max_size=6
)


@given(ARC_PATHS, st.floats(1.0, 9000.0), st.booleans())
@settings(deadline=None, max_examples=60)
def test_a_polyline_is_planned_and_sent_like_its_lines_one_by_one(
    paths: list[tuple[float, ...]], feed: float, is_limited: bool
) -> None:
    cells = {"P100_001": 4.0, "P650_000": 6000.0, "P650_010": 720.0}
    if is_limited:
        cells |= {f"P{AXIS.max_axis_speed[0]}": 120.0, f"P{AXIS.max_axis_acceleration[1]}": 7.0}
        cells |= {f"P{AXIS.tolerance_radius[3]}": 4.0, f"P{AXIS.max_axis_jerk[3]}": 300.0}
        cells |= {"P650_015": 1000.0, f"P{AXIS.max_axis_jerk[0]}": 700.0}
    coder = encoder(**cells)
    begin, ends, point = at(1.0, -2.0), [], np.array(at(1.0, -2.0))
    for path in paths:
        point = point + np.array([*path, 0.0, 0.0, 0.0, 0.0])
        ends.append(tuple(point.tolist()))
    pace = c.Pace(feed)
    many = c.Polyline(src(1), np.array(ends), np.arange(1, len(ends) + 1), pace)
    singly, here = [], begin
    for number, end in enumerate(ends, start=1):
        singly.append(coder.job(c.Line(src(number), end, pace), here))
        here = end
    assert list(coder.jobs(many, begin)) == singly
    for one, other in zip(coder.jobs(many, begin), singly, strict=True):
        assert coder.packet(one) == coder.packet(other)
