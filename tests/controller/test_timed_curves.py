"""Uniform NURBs in time mode, packet by packet: counter, overrides, feed hold, and starvation."""

from itertools import pairwise

import pytest
from tests.controller.test_binary_moves import Sender

from openacr.map.rows import masters
from openacr.protocol.bits import SetBit
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0, Code1, Code3

KNOT_S = 0.005
IN_MOTION, IN_FEEDHOLD, FEED_HOLD = 516, 519, 520
LOCKED = int(Code0.OVERRIDE_LOCKOUT)
COUNTED = int(Code0.COUNTER)
FOV = masters.feedrate_override[0]
TIME_FACTOR = masters.nurb_time_factor[0]
COUNTER = masters.move_counter[0]
SPEED = 40  # pulses from one control point to the next: 8000/s


def point(
    at: int, x: int, code0: int = LOCKED, acc: float | None = None, weight: float = 1.0
) -> Move:
    """A control point of slave 0."""
    return Move.of(
        {0: x},
        acc=acc,
        code0=code0,
        code1=int(Code1.NURB),
        code3=int(Code3.CURVE),
        scaling=(float(at), weight),
    )


def end(at: int, code0: int = LOCKED) -> Move:
    return Move.of(
        {}, code0=code0, code1=int(Code1.NURB), code3=int(Code3.CURVE), scaling=(-float(at), 0.0)
    )


class Curve(Sender):
    """A curve along X that begins at rest: 40 pulses per knot from its sixth point on."""

    def __init__(
        self,
        *lines: str,
        code0: int = LOCKED,
        acc: float | None = None,
        weights: tuple[float, ...] = (1.0,),
    ) -> None:
        super().__init__("MBUF OFF", "DIM MBUF(100)", "MBUF ON", f"P{TIME_FACTOR}={KNOT_S}", *lines)
        self.weights = weights
        self.code0, self.knot, self.place = code0, 0, 0
        self.acc = acc
        for step in (0, 0, 0, 1, 4, 10, 20, 30, 36, 39):
            self.send(step)

    def send(self, step: int) -> "Curve":
        """Send the next control point."""
        self.place += step
        weight = self.weights[self.knot % len(self.weights)]
        self.host.send(point(self.knot, self.place, self.code0, self.acc, weight).encode())
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
    curve = Curve(code0=LOCKED | code0).run(20).finish()
    curve.rest()
    assert curve.knot == 40  # of order 4: the first six packets complete no piece
    assert curve.card.p[COUNTER] == counted


def test_the_counter_shows_which_piece_runs() -> None:
    curve = Curve(code0=LOCKED | COUNTED).run(40)
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
    curve = Curve(code0=code0).run(20).finish()
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


@pytest.mark.parametrize(("known", "at_rest_s"), [(80, 0.13), (40, 0.13)])
def test_with_a_jerk_a_feed_hold_keeps_dec_and_jrk(known: int, at_rest_s: float) -> None:
    curve = Curve("JRK 2000", acc=100.0).run(known)
    curve.course(100)
    curve.host.send(SetBit(FEED_HOLD).encode())
    found = speeds(curve.course(400), curve.period_s)
    ramps = [(b - a) / curve.period_s for a, b in pairwise(found)]
    jerks = [(b - a) / curve.period_s for a, b in pairwise(ramps)]
    begin = next(k for k, ramp in enumerate(ramps) if ramp < -1e-3)
    assert found[begin] == pytest.approx(8000.0)
    assert -100_000.0 * 0.995 <= min(ramps) < -85_000.0
    assert max(map(abs, jerks)) <= 2_000_000.0 * 0.996
    rest = next(k for k in range(begin, len(found)) if found[k] == 0.0)
    assert (rest - begin) * curve.period_s == pytest.approx(at_rest_s, rel=0.06)
    assert curve.card.bit[IN_FEEDHOLD]


def test_a_feed_hold_that_has_too_few_points_ramps_as_a_move_does() -> None:
    curve = Curve("JRK 2000", acc=100.0).run(14)
    curve.course(60)
    curve.host.send(SetBit(FEED_HOLD).encode())
    found = speeds(curve.course(130), curve.period_s)
    ramps = [(b - a) / curve.period_s for a, b in pairwise(found)]
    steady = [ramp for ramp in ramps if ramp == pytest.approx(-100_000.0, rel=1e-3)]
    assert len(steady) > 10
    assert 0.0 < found[-1] < 7500.0


def test_curves_with_weights_hold_as_moves_do() -> None:
    curve = Curve("JRK 2000", acc=100.0, weights=(1.0, 2.0)).run(80)
    curve.course(150)
    curve.host.send(SetBit(FEED_HOLD).encode())
    found = speeds(curve.course(400), curve.period_s)
    ramps = [(b - a) / curve.period_s for a, b in pairwise(found)]
    jerks = [(b - a) / curve.period_s for a, b in pairwise(ramps)]
    assert found[-1] == 0.0
    assert max(map(abs, jerks)) > 1e8


def test_the_end_of_a_curve_is_not_hurried_by_a_feed_hold() -> None:
    curve = Curve("JRK 2000", acc=100.0).run(20).finish()
    curve.course(280)  # its last points slow it down already
    curve.host.send(SetBit(FEED_HOLD).encode())
    curve.course(200)
    assert curve.at[0] == pytest.approx(1080.0)


def test_a_hold_after_a_cycle_start_is_sought_again() -> None:
    curve = Curve("JRK 2000", acc=100.0).run(85)
    for _ in range(2):
        curve.course(60)
        curve.host.send(SetBit(FEED_HOLD).encode())
        curve.course(420)
        assert curve.card.bit[IN_FEEDHOLD]
        curve.host.send(SetBit(FEED_HOLD + 1).encode())
        curve.course(100)
        assert not curve.card.bit[IN_FEEDHOLD]
