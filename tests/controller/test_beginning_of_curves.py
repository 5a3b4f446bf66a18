"""NURBs in time that begin a fraction of a pulse from their axes, as after a feed hold."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from tests.controller.test_binary_moves import Sender
from tests.controller.test_timed_curves import KNOT_S, TIME_FACTOR

from openacr.map.rows import masters
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

pytestmark = pytest.mark.evidence("oracle", "B-splines of scipy")

Reals = NDArray[np.float64]
START_TIME = masters.nurb_start_time[0]
COUNTER = masters.move_counter[0]
SCALES = np.array([1000.0, 50.0])  # pulses per unit of X and Y
CODE0 = int(Code0.OVERRIDE_LOCKOUT | Code0.COUNTER)
PLACES = (0, 0, 0, 0, 10, 20, 40, 50, 60, 60, 60)


class Beside(Sender):
    """X and Y at rest between pulses."""

    def __init__(self, x_cnt: float, y_cnt: float, *lines: str) -> None:
        super().__init__(
            "MBUF OFF", "DIM MBUF(100)", "MBUF ON", "PPU Y50", f"P{TIME_FACTOR}={KNOT_S}", *lines
        )
        self.begin_cnt = np.array([x_cnt, y_cnt])
        x_u, y_u = (self.begin_cnt / SCALES).tolist()
        self.host.send(Move.of({0: x_u, 1: y_u}).encode())
        self.rest()
        assert self.at[:2] == pytest.approx((x_cnt, y_cnt), abs=1e-4)  # of a float
        self.begin_cnt = np.array(self.at[:2])

    def curve(self, acc: float, x_cnt: int = 0) -> Reals:
        """Where X and Y are commanded to along a curve that begins at whole pulses, by ticks."""
        for knot, place in enumerate(PLACES):
            self.point({0: x_cnt + place, 1: 0}, float(knot), 1.0, acc if knot == 0 else None)
        self.point({}, -float(len(PLACES)), 0.0)
        found = [self.at[:2]]
        for _ in range(400):
            self.card.advance(1)
            found.append(self.at[:2])
        return np.array(found)

    def point(
        self, targets: dict[int, int], knot: float, weight: float, acc: float | None = None
    ) -> None:
        packet = Move.of(
            targets, acc=acc, code0=CODE0, code1=int(Code1.NURB), code3=int(Code3.CURVE),
            scaling=(knot, weight),
        )  # fmt: skip
        self.host.send(packet.encode())


def spline(points: Reals, period_s: float, times_s: NDArray[np.floating[Any]]) -> Reals:
    """The uniform cubic B-spline of control points, from its third knot on."""
    knots = np.arange(-3.0, len(points) + 1.0) * period_s
    found: Reals = BSpline(knots, points, 3)(times_s)
    return found


@pytest.mark.parametrize(
    ("x_cnt", "y_cnt", "jerk", "acc", "period_s"),
    [
        (0.5, 0.25, 2000.0, 1000.0, (2 * 0.005 / 2000.0) ** (1 / 3)),  # Y is 0.005 from 0
        (-0.9, 0.001, 50.0, 1000.0, (2 * 0.0009 / 50.0) ** (1 / 3)),
        (0.1, -0.5, 1e6, 25.0, (0.01 / 25.0) ** (1 / 2)),  # DEC is what bounds it
    ],
)
def test_the_axes_go_to_the_first_point_within_dec_and_jrk(
    x_cnt: float, y_cnt: float, jerk: float, acc: float, period_s: float
) -> None:
    card = Beside(x_cnt, y_cnt, f"JRK {jerk}")
    places = card.curve(acc)
    tick_s = card.card.period_s
    begin = int(np.flatnonzero((places != places[0]).any(axis=1))[0]) - 1
    times_s = np.arange(len(places) - begin, dtype=np.float64) * tick_s
    lead_s = 3 * period_s
    led = times_s < lead_s
    step = np.array([card.begin_cnt] * 3 + [[0.0, 0.0]] * 3)
    expected = spline(step, period_s, times_s[led])
    assert places[begin:][led] == pytest.approx(expected, abs=1e-6)
    points = np.array([[place, 0.0] for place in PLACES], dtype=np.float64)
    whole_s = (len(PLACES) - 3) * KNOT_S
    run = np.clip(times_s[~led] - lead_s, 0.0, whole_s - 1e-12)
    assert places[begin:][~led] == pytest.approx(spline(points, KNOT_S, run), abs=1e-5)
    bounds = {2: acc, 3: jerk}
    lead = places[begin : begin + int(led.sum())] / SCALES
    rates = [np.abs(np.diff(lead, k, axis=0)).max() / tick_s**k for k in bounds]
    assert all(rate <= most * (1 + 1e-6) for rate, most in zip(rates, bounds.values(), strict=True))
    shares = [rate / most for rate, most in zip(rates, bounds.values(), strict=True)]
    assert max(shares) > 0.9  # one of them is reached, but for ticks beside the knots


def test_the_pieces_before_the_first_point_count_as_none() -> None:
    counters = []
    for x_cnt in (0.0, 0.5):
        card = Beside(x_cnt, 0.0, "JRK 2000")
        card.curve(100.0)
        counters.append(card.card.p[COUNTER])
    assert counters == [len(PLACES) - 6 + 1] * 2  # and the end


def test_the_start_time_of_a_curve_is_that_of_the_pieces_before_its_first_point() -> None:
    start_s = 0.02
    card = Beside(0.5, 0.0, "JRK 2000", f"P{START_TIME}={start_s}")
    places = card.curve(100.0)
    moving = np.flatnonzero((np.diff(places, axis=0) != 0.0).any(axis=1))
    lead_s = 3 * (2 * 0.0005 / 2000.0) ** (1 / 3)
    whole_s = lead_s + (len(PLACES) - 3) * KNOT_S + start_s / 2  # at half the rate on average
    tick_s = card.card.period_s
    assert (moving[-1] + 1 - moving[0]) * tick_s == pytest.approx(whole_s, abs=3 * tick_s)


@pytest.mark.parametrize(("x_cnt", "line"), [(0.5, "JRK 0"), (1.5, "JRK 2000")])
def test_without_jrk_and_from_farther_off_a_move_leads_to_the_first_point(
    x_cnt: float, line: str
) -> None:
    card = Beside(x_cnt, 0.0, line)
    places = card.curve(100.0)
    begin = int(np.flatnonzero((places != places[0]).any(axis=1))[0]) - 1
    reached = int(np.flatnonzero(np.abs(places[:, 0]) < 1e-6)[0])
    jerk = float(line.split()[1])
    distance_u, tick_s = x_cnt / SCALES[0], card.card.period_s
    closed_s = (6 * distance_u / jerk) ** (1 / 3) if jerk else (2 * distance_u / 100.0) ** 0.5
    assert (reached - begin) * tick_s == pytest.approx(closed_s, abs=1.1 * tick_s)  # STP is 0
    assert card.at[:2] == (60.0, 0.0)
