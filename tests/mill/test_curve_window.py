"""Curves cut out of the setpoints of a plan: where they begin and end, and where moves begin."""

import numpy as np
import pytest
from tests.mill.planned import Reals
from tests.mill.planned_rotary import A, line, table_store, to
from tests.mill.shop import end, src

from openacr.cnc import canonical as c
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_window import REST, CurveRows, CurveWindow
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.phases import Phases
from openacr.trajectory import Setpoints
from openacr.trajectory.override.timescale import Progress

STEPS = np.array([0.001, 0.003, 0.006, 0.009, 0.01, 0.01, 0.009, 0.006, 0.003, 0.001])
RESTING_U = 9.5  # the path at the end


def setpoints(repeated: int) -> Setpoints:
    """A turn of A after some points that repeat the start, at 0.1 of the path per point."""
    turned = np.concatenate([np.zeros(repeated), np.cumsum(STEPS)])
    points = np.zeros((len(turned), A + 1))
    points[:, A] = turned
    paths = np.array([0.1 * k for k in range(len(turned))])
    rest = np.repeat(points[-1:], REST, axis=0)
    lines = np.ones(len(turned), np.int64)
    factors = np.linspace(1.0, 1.5, len(turned))
    return Setpoints(0, PERIOD_S, points, lines, paths, rest, RESTING_U, factors)


def part(found: Setpoints, begin: int, stop: int) -> Setpoints:
    """Some of the setpoints."""
    return Setpoints(
        begin, PERIOD_S, found.points[begin:stop], found.lines[begin:stop],
        found.path_u[begin:stop], found.rest, RESTING_U, found.factors[begin:stop],
    )  # fmt: skip


@pytest.mark.parametrize("repeated", [0, 1, 4])
@pytest.mark.parametrize("cut", [1, 2, 8])
def test_a_curve_begins_with_the_first_point_that_has_moved(repeated: int, cut: int) -> None:
    rows, found = CurveRows(np.zeros(A + 1)), setpoints(repeated)
    pieces = [rows.add(part(found, 0, cut)), rows.add(part(found, cut, len(found.points)))]
    points, paths = (np.concatenate(each) for each in zip(*pieces, strict=True))
    assert points.tolist() == found.points[repeated:].tolist()
    assert paths.tolist() == found.path_u[repeated:].tolist()


def test_a_curve_ends_with_three_equal_points() -> None:
    rows, found = CurveRows(np.zeros(A + 1)), setpoints(2)
    points, _ = rows.add(found)
    tail, paths = rows.tail()
    whole = np.concatenate([points, tail])
    assert (whole[-REST:] == whole[-1]).all()
    assert (whole[-REST - 1] != whole[-1]).any()
    assert paths.tolist() == [RESTING_U] * (REST - 1)


def test_the_path_of_a_window_is_that_of_the_point_it_has_given() -> None:
    window, found = CurveWindow(np.zeros(A + 1), Settings(table_store())), setpoints(2)
    window.append(found)
    window.complete()
    seen: list[tuple[float, float]] = []
    progress = Progress.MOVES
    while progress is Progress.MOVES:
        progress, point = window.next()
        seen.append((float(point[A]), window.path_u))
    moved = list(zip(found.points[2:, A].tolist(), found.path_u[2:].tolist(), strict=True))
    assert seen == [*moved, *[(moved[-1][0], RESTING_U)] * (REST - 1)]


class Passed:
    """Collects the moves that are done, with the lengths of their phases."""

    def __init__(self) -> None:
        self.moves: list[tuple[Job, float]] = []

    def read(self, job: Job) -> None: ...

    def rested(self, seconds: float) -> None: ...

    def curve(self, points: Reals) -> None: ...

    def passed(self, job: Job, phases: Phases) -> None:
        self.moves.append((job, sum(phase.length_u for phase in phases)))


def test_every_curve_of_a_program_counts_its_path_from_its_own_beginning() -> None:
    there: list[c.Entry] = [line(1, 20, 0, 0, 90), c.Dwell(src(2), 0.5)]
    program = [*there, line(3, 40, 0, 0, 180), c.Dwell(src(4), 0.5), line(5, 60, 0, 0, 270), end()]
    passed = Passed()
    predictor = Predictor(Settings(table_store()), to(), reader=passed)
    for entry in program:
        predictor.add(entry)
    predictor.close()
    assert [length for _, length in passed.moves] == pytest.approx([20.0] * 3, abs=1e-9)
    once = Predictor(Settings(table_store()), to())
    once.add(there[0])
    once.close()
    assert predictor.found.lost_s == pytest.approx(3 * once.found.lost_s, abs=1e-9)
    assert predictor.found.time_s == pytest.approx(3 * once.found.time_s + 1.0, abs=1e-9)
