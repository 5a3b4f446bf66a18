"""Work systems that are rotated about Z: `G10 L2 P R`."""

import math

import pytest
from tests.cnc.programs import Bench, Run, errors, run

from openacr.cnc.canonical import Arc, Polyline
from openacr.sysvar.tabs import CELLS

HALF = math.sqrt(3) / 2


def ngc(text: str, cells: dict[int, float] | None = None, **more: object) -> Run:
    return run(text.replace("|", "\n"), cells, dialect="rs274ngc", **more)  # type: ignore[arg-type]


def fault(text: str, dialect: str = "rs274ngc") -> str:
    error = run(text.replace("|", "\n"), dialect=dialect).error
    assert error is not None
    return str(error)


def test_the_angle_is_kept_in_the_store_beside_the_offsets() -> None:
    done = ngc("G10 L2 P1 R30|G10 L2 P8 X1 R-45|G10 L2 P9 R12.5")
    assert [done.cells.read(cell) for cell in CELLS.work_rotations] == [30, 0, 0, 0, 0, 0, 0, -45]
    assert done.cells.read(848) == 12.5
    assert CELLS.work_rotations == tuple(range(918, 989, 10))


@pytest.mark.parametrize(
    "text", ["G21 G10 L2 P1 X25.4 R30|G0 X25.4 Y0", "G10 L2 P1 X1 R30|G0 X1 Y0"]
)
def test_degrees_are_degrees_in_any_unit(text: str) -> None:
    assert ngc(text).ends[-1] == pytest.approx((1 + HALF, 0.5, 0))


@pytest.mark.parametrize(
    ("degrees", "end"),
    [(90, (-1, 2)), (-90, (1, -2)), (180, (-2, -1)), (360, (2, 1)), (450, (-1, 2))],
)
def test_right_angles_have_no_rounding_errors(degrees: float, end: tuple[float, float]) -> None:
    assert ngc(f"G10 L2 P1 R{degrees}|G0 X2 Y1").ends == [(*end, 0)]


def test_programs_of_both_dialects_run_in_the_system_as_it_is() -> None:
    rotated = {CELLS.work_rotations[0]: 90.0}
    assert run("G0 X2 Y1", rotated).moves == ["R X-1 Y2"]
    assert run("G53 G0 X2 Y1\nG54 X2 Y1", rotated).moves == ["R X2 Y1", "R X-1 Y2"]
    assert run("G10 L2 P1 R90\nG0 X2 Y1").moves == ["R X-1 Y2"]
    assert run("G10 L2 P1 R60\nG91 G10 L2 P1 R30\nG90 G0 X2 Y1").moves == ["R X-1 Y2"]


def test_rotation_and_scale_of_the_program_come_first() -> None:
    rotated = {CELLS.work_rotations[0]: 90.0, CELLS.work_systems[0][0]: 5.0}
    assert run("G68 X1 Y0 R90\nG0 X2 Y0", rotated).moves == ["R X4 Y1"]  # 1,1 after G68
    assert run("G51 X0 Y0 Z0 P2\nG0 X1 Y2", rotated).moves == ["R X1 Y2"]  # 2,4 after G51
    assert run("G54 G52 X1\nG0 X1 Y0", rotated).moves == ["R X5 Y2"]
    assert run("G0 X2\nG92 X0 Y0\nG0 X1", rotated).moves == ["R Y2", "R Y3"]


def test_long_runs_of_plain_lines_are_rotated_too() -> None:
    lines = "|".join(f"X{n} Y1" for n in range(40))
    done = ngc(f"G10 L2 P1 R90|G1 F10|{lines}")
    assert done.ends == [(-1, n, 0) for n in range(40)]
    assert not done.of(Polyline)


def test_compensation_lies_beside_the_turned_contour() -> None:
    straight = ngc("G41 D1 F10 G1 X1|X2|Y2|G40 X0", {1001: 0.25})
    turned = ngc("G10 L2 P1 R90|G41 D1 F10 G1 X1|X2|Y2|G40 X0", {1001: 0.25})
    assert turned.ends == [(-y, x, z) for x, y, z in straight.ends]


def test_probing_reports_in_the_rotated_system() -> None:
    trip = (0.0, 3.0, 0.0, 0, 0, 0, 0, 0)
    done = ngc("G10 L2 P1 R90|F10 G38.2 X5|G1 Y#5061", machine=Bench(trip=trip))
    assert done.moves == ["P Y5", "L X-3 Y3"]


def test_what_would_leave_its_plane_is_refused() -> None:
    out = "the plane is turned out of itself"
    arc = "E244 scale factor zero or unequal in an arc plane"
    assert fault("G10 L2 P1 R30|F10 G18|G2 X2 I1 K0") == f"PROGRAM:3:1: {arc}: {out}"
    assert fault("G10 L2 P1 R30|F10 G19|G81 X1 Y1 R2") == f"PROGRAM:3:1: {arc}: {out}"
    beside = "E311 plane, scale or rotation change with compensation"
    text = "G10 L2 P1 R30|F10 G18 G41.1 D.1|G1 X1"
    assert fault(text) == f"PROGRAM:3:1: {beside}: {out}"
    assert fault(f"{text} Z1") == f"PROGRAM:3:1: {beside}: {out}"
    assert ngc("G10 L2 P1 R30|F10 G18|G2 X2 I1 K0", {}).error is not None
    assert ngc("G10 L2 P1 R30|G10 L2 P1 R0|F10 G18|G2 X2 I1 K0").moves == ["A X2 about 0,1 -180"]


@pytest.mark.parametrize(
    ("dialect", "text", "found"),
    [
        ("rs274ngc", "G10 L20 P1 X0 R10",
         "PROGRAM:1:15: E241 G10 word or number out of range: R (R turns a work system with L2)"),
        ("acromill", "G10 L20 P1 X0 R10",
         "PROGRAM:1:15: E241 G10 word or number out of range: R (R turns a work system with L2)"),
        ("acromill", "G10 L14 P1 X0 R10",
         "PROGRAM:1:15: E241 G10 word or number out of range: R (R turns a work system with L2)"),
        ("acromill", "G10 L2 P1",
         "PROGRAM:1:5: E241 G10 word or number out of range: axis words missing"),
        ("rs274ngc", "G10 L2 P-1 R1", "PROGRAM:1:8: E241 G10 word or number out of range"),
        ("rs274ngc", "G10 L2 R1",
         "PROGRAM:1:5: E241 G10 word or number out of range (L 1, 2, 10, 11 or 20 with P)"),
    ],
)  # fmt: skip
def test_r_is_an_angle_of_l2_alone(dialect: str, text: str, found: str) -> None:
    assert fault(text, dialect) == found


def test_a_reading_of_one_axis_keeps_that_of_the_other() -> None:
    cells = {CELLS.work_rotations[0]: 30.0, CELLS.work_systems[0][1]: 2.0}
    for dialect in ("acromill", "rs274ngc"):
        done = run("G0 X1 Y3\nG10 L20 P1 X0\nG0 X0 Y3", cells, dialect=dialect)
        assert len(done.moves) == 1  # it is there
        done = run("G0 X1 Y3\nG10 L20 P1 Z5", cells, dialect=dialect)
        assert done.cells.read(CELLS.work_systems[0][0]) == 0.0
        assert done.cells.read(CELLS.work_systems[0][1]) == 2.0


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("F10 G2 X2 I1 P0", "PROGRAM:1:14: E222 value out of range: P0 (P 1 to 9999)"),
        ("F10 G2 X2 I1 P-1", "PROGRAM:1:14: E222 value out of range: P-1 (P 1 to 9999)"),
        ("F10 G2 X2 I1 P1.5", "PROGRAM:1:14: E204 integer expected: P"),
        ("F10 G2 X2 I1 P10000", "PROGRAM:1:14: E222 value out of range: P10000 (P 1 to 9999)"),
        ("F10 G2 X2 I1|G4 P2 X4 P3", "E202"),
        ("G1 F10 X1 P2", "E206"),
    ],
)
def test_turns_are_a_whole_number(text: str, found: str) -> None:
    for dialect in ("acromill", "rs274ngc"):
        if found.startswith("PROGRAM"):
            words = text if dialect == "rs274ngc" else text.replace("I1", "I1 J0")
            places = found.replace(":14:", ":17:") if dialect == "acromill" else found
            assert fault(words, dialect) == places
        else:
            assert errors(text.replace("|", "\n"), dialect=dialect) == [found]


def test_turns_of_a_spiral_share_its_growth() -> None:
    arcs = [arc for arc in run("F10 G2 X2 Y0 I.9 J0 P3 Z6").of(Arc) if isinstance(arc, Arc)]
    sweeps = [math.degrees(arc.sweep_rad) for arc in arcs]
    assert sweeps == pytest.approx([-360, -360, -180])
    assert [arc.start_radius for arc in arcs] == pytest.approx([0.9, 0.98, 1.06])
    assert [arc.end_radius for arc in arcs] == pytest.approx([0.98, 1.06, 1.1])
    assert [arc.end[:3] for arc in arcs] == [
        pytest.approx((0.9 - 0.98, 0, 2.4)), pytest.approx((0.9 - 1.06, 0, 4.8)), (2, 0, 6),
    ]  # fmt: skip


def test_the_time_of_g93_is_that_of_all_turns() -> None:
    arcs = [arc for arc in ngc("G93 G2 X0 Y0 I1 P3 F2").of(Arc) if isinstance(arc, Arc)]
    assert [arc.pace.feed_upm for arc in arcs] == [pytest.approx(2 * 3 * 2 * math.pi)] * 3
    assert [arc.end[:2] for arc in arcs] == [(0, 0)] * 3


def test_compensated_turns_lie_beside_the_circle() -> None:
    done = ngc("F10 G41.1 D.5 G1 X1|G3 X1 Y0 I0 J1 P2 Z-1|G40 G1 X2", {})
    radii = [arc.start_radius for arc in done.of(Arc) if isinstance(arc, Arc)]
    assert radii == pytest.approx([0.75, 0.75])


def test_full_turns_are_counted_exactly() -> None:
    for turns in range(1, 100):
        arcs = ngc(f"F10 G3 X0 Y0 I1 P{turns} Z1").of(Arc)
        assert len(arcs) == turns
        assert sum(arc.sweep_rad for arc in arcs if isinstance(arc, Arc)) == pytest.approx(
            turns * 2 * math.pi
        )
