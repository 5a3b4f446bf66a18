"""Predicted times on a machine with a jerk limit: closed forms, and runs on the virtual card."""

import math
from pathlib import Path

import numpy as np
import pytest
from tests.mill.planned import follow, motion_s
from tests.mill.prediction import predicted
from tests.mill.shop import Shop, at, end, line, rapid, src
from tests.mill.test_path_motion import motion
from tests.search import sparse

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.checking import opened, surveyed
from openacr.mill.plan.pictures.quantities import Quantity
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, CONTROL, SPEEDS

ROOT = Path(__file__).parents[2]
PROGRAMS = {
    "parts": "knife_letter macro_grid",
    "tests/data/field": (
        "estlcam_style freecad_style fusion_style guide_style lead_in_arc_style lead_in_left_style"
        " mastercam_style owords_style pcb_drill_style"
    ),
    "tests/data/dialects": (
        "carbide_arcs carbide_lines estlcam_arcs fusion_grbl guide_cycle guide_loop lines_only"
    ),
    "tests/data/ngc": (
        "cubic_spline cycle_g73 cycle_g83 cycles_in_other_planes nurbs reference_points"
        " zero_offsets arcs_in_a_rotated_system"
    ),
}
FILES = [f"{folder}/{name}" for folder, names in PROGRAMS.items() for name in names.split()]
PERIOD_S = 0.0005
SPEED, RAMP, JERK = 10.0, 100.0, 2000.0


def jerk_shop(**cells: float) -> Shop:
    """Feed 10 units/s at most, 100 units/s2, 2000 units/s3."""
    own = {f"P{SPEEDS.path_jerk}": JERK, f"P{SPEEDS.max_machine_speed}": 60.0 * SPEED}
    return Shop(**own | cells)


def time_of(*entries: c.Entry, **cells: float) -> float:
    return predicted(entries, Settings(jerk_shop(**cells).store), at()).time_s


def test_a_move_without_a_tolerance_takes_the_s_curves_of_its_ramps() -> None:
    # L/v for the length, v/a and a/J for both ramps together
    assert time_of(line(1, at(5)), end()) == pytest.approx(0.5 + 0.1 + 0.05)
    # rapids as well
    assert time_of(rapid(1, at(5)), end()) == pytest.approx(0.5 + 0.1 + 0.05)
    # a quarter of the length in each of four parts of the same jerk: L = 2 J t^3
    assert time_of(line(1, at(0.01)), end()) == pytest.approx(4 * (0.01 / 2 / JERK) ** (1 / 3))


def test_every_stop_takes_its_ramps_with_jerk() -> None:
    moves = [line(n, at(5 * n), mode=c.PathMode.EXACT) for n in (1, 2)]
    rest = c.Dwell(c.Source("", 3, ""), 0.3)
    assert time_of(*moves, rest, line(4, at(5)), end()) == pytest.approx(3 * 0.65 + 0.3)


def test_moves_in_line_are_one_ramp_with_jerk() -> None:
    # up once for all; the last move ends within its own length, from 10 units/s to rest
    pieces = [line(n, at(n), mode=c.PathMode.FREE) for n in range(1, 6)]
    assert time_of(*pieces, end()) == pytest.approx(time_of(line(1, at(5)), end()))


def test_the_jerk_of_the_weakest_axis_of_a_move_counts() -> None:
    weak = {f"P{AXIS.max_axis_jerk[1]}": JERK / 4}
    assert time_of(line(1, at(5)), end(), **weak) == pytest.approx(0.65)
    # a ramp of 10 units/s at 500 units/s3 has no part at 100 units/s2: 2 sqrt(v/J) each
    assert time_of(line(1, at(0, 5)), end(), **weak) == pytest.approx(0.5 + 2 * (10 / 500) ** 0.5)


def test_a_picture_shows_the_acceleration_rise_and_fall_with_the_jerk() -> None:
    found, time_s = motion([line(1, at(5)), end()], Quantity.ACCELERATION, jerk_shop())
    assert time_s == pytest.approx(0.65)
    rise = JERK * (np.arange(16) + 0.5) / 16 * (RAMP / JERK)
    assert found.values[:16] == pytest.approx(rise)
    assert found.values[16:32] == pytest.approx(RAMP)
    assert found.values[32:48] == pytest.approx(rise[::-1])
    assert found.values[48] == pytest.approx(0.0, abs=1e-9)
    places = np.cumsum(np.linalg.norm(np.diff(found.points, axis=0), axis=1))
    assert places[15] == pytest.approx(JERK * (RAMP / JERK) ** 3 / 6)
    assert found.points[-1].tolist() == pytest.approx([5, 0, 0])


@pytest.mark.parametrize("feeds", [(400.0, 400.0), (400.0, 390.0), (400.0, 100.0)])
@pytest.mark.parametrize("count", [10, 50, 500])
def test_pieces_of_a_ramp_pass_speed_and_acceleration_on(
    feeds: tuple[float, float], count: int
) -> None:
    pieces = [line(n, at(n / count), feed=feeds[n % 2]) for n in range(1, count + 1)]
    shop = jerk_shop()
    places = follow(shop, *pieces, end())
    period_s = shop.controller.period_s
    expected = time_of(*pieces, end())
    assert motion_s(places, period_s) == pytest.approx(expected, abs=1.1 * period_s)


@pytest.mark.parametrize("pulses", [10_000.0, 787.0])
@pytest.mark.parametrize("sweep", [math.pi / 2, -math.pi, -1.9 * math.pi, 2 * math.pi])
def test_arcs_are_as_long_as_between_whole_pulses(pulses: float, sweep: float) -> None:
    start = math.radians(17.0)
    x, y = -math.cos(start), -math.sin(start)
    finish = at(x + math.cos(start + sweep), y + math.sin(start + sweep))
    turn = c.Arc(src(1), finish, c.Plane.XY, (x, y), sweep, 1.0, 1.0, c.Pace(300.0))
    scale = {f"P{AXIS.pulses_per_unit[axis]}": pulses for axis in range(3)}
    shop = jerk_shop(**scale)
    late_s = motion_s(follow(shop, turn, end()), PERIOD_S) - time_of(turn, end(), **scale)
    assert 0.0 < late_s < PERIOD_S


def test_a_move_within_a_pulse_takes_no_time() -> None:
    assert time_of(line(1, at(4e-5)), end()) == 0.0
    assert time_of(line(1, at(6e-5)), end()) == pytest.approx(4 * (1e-4 / 2 / JERK) ** (1 / 3))


def machine() -> Store:
    """A metric machine of fine pulses, on which the points of programs are whole pulses."""
    cells = Store()
    cells.write(CONTROL.default_units, 1.0)
    for axis in range(3):
        cells.write(AXIS.home_required[axis], 0.0)
        cells.write(AXIS.pulses_per_unit[axis], 20_000.0)
    cells.write(SPEEDS.path_jerk, 20_000.0)
    cells.write(SPEEDS.master_feed_acc_dec, 800.0)
    cells.write(SPEEDS.master_rapid_acc_dec, 1500.0)
    cells.write(SPEEDS.max_machine_speed, 12_000.0)
    return cells


@pytest.mark.parametrize("file", sparse(FILES, 4))
def test_programs_take_the_predicted_time_with_jerk_to_one_period_for_each_run_of_moves(
    file: str,
) -> None:
    cells = machine()
    path = next(ROOT.glob(f"{file}.n*c"))
    program, choice = opened(path, cells)
    survey, prediction = surveyed(program, cells, choice.name)
    assert not survey.errors and not prediction.planned
    session = MillSession.virtual(cells, lambda _text: None)
    card = session.virtual_card
    assert card is not None
    card.record(1)
    session.start(program, Start(dialect=choice.name, is_repeated=False))
    parts = [np.zeros((1, 3))]
    while session.runner.is_busy:
        session.step()
        session.carry_on()
        axes = card.take_trace().axes
        parts.append(np.column_stack([axes[k].commanded_u for k in range(3)]))
    session.close()
    is_moving = (np.diff(np.concatenate(parts), axis=0) != 0.0).any(axis=1)
    runs = np.count_nonzero(np.diff(is_moving.astype(int)) == 1) + int(is_moving[0])
    late = np.count_nonzero(is_moving) - (prediction.feed_s + prediction.rapid_s) / card.period_s
    assert 0.0 < late < runs + 0.02  # each run of moves ends within a period
