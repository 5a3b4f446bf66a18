"""Uniform NURBs in time mode, packet by packet: counter, overrides, feed hold, and starvation."""

from itertools import pairwise

import pytest
from tests.controller.test_binary_moves import Sender

from openacr.map import numbers as n
from openacr.protocol.bits import SetBit
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

KNOT_S = 0.005
IN_MOTION, IN_FEEDHOLD, FEED_HOLD = 516, 519, 520
LOCKED = int(Code0.OVERRIDE_LOCKOUT)
COUNTED = int(Code0.COUNTER)
FOV = n.MA_BASE + n.MA_FEEDRATE_OVERRIDE
TIME_FACTOR = n.MA_BASE + n.MA_NURB_TIME_FACTOR
COUNTER = n.MA_BASE + n.MA_MOVE_COUNTER
SPEED = 40  # pulses from one control point to the next: 8000/s


def point(at: int, x: int, code0: int = LOCKED, acc: float | None = None) -> Move:
    """A control point of slave 0."""
    return Move.of(
        {0: x},
        acc=acc,
        code0=code0,
        code1=int(Code1.NURB),
        code3=int(Code3.CURVE),
        scaling=(float(at), 1.0),
    )


def end(at: int, code0: int = LOCKED) -> Move:
    return Move.of(
        {}, code0=code0, code1=int(Code1.NURB), code3=int(Code3.CURVE), scaling=(-float(at), 0.0)
    )


class Curve(Sender):
    """A curve along X that begins at rest: 40 pulses per knot from its sixth point on."""

    def __init__(self, code0: int = LOCKED, acc: float | None = None) -> None:
        super().__init__("MBUF OFF", "DIM MBUF(100)", "MBUF ON", f"P{TIME_FACTOR}={KNOT_S}")
        self.code0, self.knot, self.place = code0, 0, 0
        self.acc = acc
        for step in (0, 0, 0, 1, 4, 10, 20, 30, 36, 39):
            self.send(step)

    def send(self, step: int) -> "Curve":
        """Send the next control point."""
        self.place += step
        self.host.send(point(self.knot, self.place, self.code0, self.acc).encode())
        self.knot += 1
        return self

    def run(self, count: int) -> "Curve":
        """Send control points at constant speed."""
        for _ in range(count):
            self.send(SPEED)
        return self

    def finish(self) -> "Curve":
        """Slow down and end the curve."""
        for step in (39, 36, 30, 20, 10, 4, 1, 0, 0, 0):
            self.send(step)
        self.host.send(end(self.knot, self.code0).encode())
        return self

    def course(self, ticks: int) -> list[float]:
        """Where X is commanded to, tick by tick."""
        found = []
        for _ in range(ticks):
            self.card.advance(1)
            found.append(self.at[0])
        return found

    @property
    def period_s(self) -> float:
        return self.card.period_s


def speeds(places: list[float], period_s: float) -> list[float]:
    """Pulses per second, tick by tick."""
    return [(b - a) / period_s for a, b in pairwise(places)]


def ticks_of(curve: Curve) -> int:
    """How long a whole curve takes."""
    begin = curve.card.tick
    curve.rest()
    return curve.card.tick - begin


@pytest.mark.parametrize(("code0", "counted"), [(COUNTED, 35), (0, 0)])
def test_packets_that_complete_a_piece_are_counted_and_so_is_the_end(
    code0: int, counted: int
) -> None:
    curve = Curve(LOCKED | code0).run(20).finish()
    curve.rest()
    assert curve.knot == 40  # of order 4: the first six packets complete no piece
    assert curve.card.p[COUNTER] == counted


def test_the_counter_shows_which_piece_runs() -> None:
    curve = Curve(LOCKED | COUNTED).run(40)
    ticks_per_knot = round(KNOT_S / curve.period_s)
    curve.course(10 * ticks_per_knot + 1)
    assert curve.card.p[COUNTER] == 11


def test_a_curve_of_time_takes_one_knot_per_time_factor() -> None:
    curve = Curve().run(20).finish()
    assert ticks_of(curve) == round(37 * KNOT_S / curve.period_s)
    assert curve.at == (1080, 0, 0)


@pytest.mark.parametrize(("code0", "factor"), [(LOCKED, 1), (0, 2)])
def test_the_override_scales_the_time_of_a_curve_unless_its_packets_lock_it(
    code0: int, factor: int
) -> None:
    curve = Curve(code0).run(20).finish()
    curve.card.p[FOV] = 0.5
    assert ticks_of(curve) == factor * round(37 * KNOT_S / curve.period_s)


def test_a_feed_hold_slows_the_time_of_a_curve_with_the_ramp_of_its_packets() -> None:
    curve = Curve(acc=100.0).run(80)
    curve.course(150)
    curve.host.send(SetBit(FEED_HOLD).encode())
    found = speeds(curve.course(600), curve.period_s)
    ramps = [(b - a) / curve.period_s for a, b in pairwise(found)]
    assert found[0] == pytest.approx(8000.0)
    assert min(ramps) == pytest.approx(-100_000.0, rel=1e-3)  # 1000 pulses per unit
    assert found[-1] == 0.0
    assert curve.card.bit[IN_FEEDHOLD]


def test_a_curve_without_further_points_stops_at_once_and_goes_on_with_a_ramp() -> None:
    curve = Curve(acc=100.0).run(20)
    found = speeds(curve.course(600), curve.period_s)
    moving = [speed for speed in found if speed > 0.0]
    assert moving[-2] == pytest.approx(8000.0)  # nothing slows it down: the last known point
    assert found[-1] == 0.0
    assert curve.at[0] == pytest.approx(780.0)
    assert curve.card.bit[IN_MOTION]
    curve.run(60)
    again = speeds(curve.course(150), curve.period_s)
    ramps = [(b - a) / curve.period_s for a, b in pairwise(again)]
    assert max(ramps) == pytest.approx(100_000.0, rel=1e-3)
    assert max(again) > 6000.0
