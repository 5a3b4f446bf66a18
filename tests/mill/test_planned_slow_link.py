"""A host of a planned path that is late by drawn times, on a line with drawn delays, and killed.

Nothing arrives at a copy of the card from a drawn tick on: within a batch of points, before the
first number, in a hold, after an override. It has to come to rest within the limits, and so has the
card of the host that lives, wherever its watchdog holds it.
"""

import random
from dataclasses import dataclass

import numpy as np
import pytest
from tests.mill.planned import Point, Reals, highest
from tests.mill.slow_card import SlowCard, alone
from tests.mill.test_planned_link_overrides import turn
from tests.mill.test_planned_lost_host import PATHS, PULSES, ROUNDING, Host
from tests.search import IS_WHOLE, sparse

from openacr.cnc.occupied import HOLD_AT, RAN_SHORT
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.sysvar.tabs import SPEEDS

LIVES_S, REST_S = 2.5, 1.5
KILLS = 12 if IS_WHOLE else 5
SHORT = 500  # bytes: no batch of points
INHIBIT = 540


@dataclass(frozen=True)
class Limits:
    """Of a machine: mm/s, mm/s2, mm/s3."""

    speed: float = 100.0
    accel: float = 1000.0
    jerk: float = 20_000.0

    @property
    def cells(self) -> dict[int, float]:
        return {
            SPEEDS.path_jerk: self.jerk,
            SPEEDS.master_feed_acc_dec: self.accel,
            SPEEDS.master_rapid_acc_dec: self.accel,
            SPEEDS.max_machine_speed: 60.0 * self.speed,
        }

    def require(self, places: Reals, period_s: float, about: str) -> None:
        """No limit is exceeded in any tick; the hold adds nothing to them."""
        speed, accel, jerk = highest(places / PULSES, period_s)
        assert speed <= self.speed * 1.001, about
        assert accel <= self.accel * 1.001, about
        assert jerk <= self.jerk * (1.0 + ROUNDING), about


FAST_AND_SOFT = Limits(speed=60.0, jerk=5_000.0)
HARD = Limits(speed=150.0, accel=2000.0, jerk=80_000.0)


def late_host(
    points: list[Point], limits: Limits, seed: int, line_s: float
) -> tuple[Host, SlowCard, random.Random]:
    """A host whose program has just been started, and its card."""
    chance = random.Random(seed)
    slow = SlowCard(Controller(), chance)
    host = Host(points, 60.0 * limits.speed, slow, limits.cells)  # type: ignore[arg-type]
    slow.longest_tk = round(line_s / slow.card.period_s)
    return host, slow, chance


def press(host: Host, chance: random.Random) -> None:
    """Turn the override or press a key, now and then."""
    runner = host.session.runner
    what = chance.randrange(12)
    try:
        if what == 0:
            turn(host, chance.choice([30.0, 70.0, 100.0, 120.0]))
        elif what == 1:
            runner.stop()
        elif runner.state is State.PAUSED and what < 6:
            runner.resume()
    except UserError:
        pass  # not in this state


CASES = [
    ("square", Limits(), 0.0, 0.03),
    ("square", Limits(), 0.01, 0.05),
    ("wave", Limits(), 0.004, 0.15),
    ("corners", Limits(), 0.05, 0.2),
    ("wave", FAST_AND_SOFT, 0.01, 0.1),
    ("corners", HARD, 0.01, 0.1),
    ("square", HARD, 0.002, 0.3),
]


@pytest.mark.parametrize("seed", sparse(range(2)))
@pytest.mark.parametrize(("kind", "limits", "line_s", "late_s"), CASES)
def test_a_card_rests_within_the_limits_whenever_its_host_is_killed(
    kind: str, limits: Limits, line_s: float, late_s: float, seed: int
) -> None:
    host, slow, chance = late_host(PATHS[kind], limits, seed, line_s)
    begin = slow.card.lived_tk
    ticks = range(begin + 20, begin + round(LIVES_S / slow.card.period_s))
    slow.leaves = sorted(chance.sample(ticks, KILLS))
    while slow.leaves:
        slow.advance(seconds=chance.uniform(0.002, late_s))
        host.session.poll()
        press(host, chance)
    period_s, places = slow.card.period_s, slow.places
    limits.require(places, period_s, "the card of the host that lives")
    copy = Controller()
    for at, left in slow.copies:
        rest = alone(copy, left, REST_S)
        whole = np.concatenate([places[max(at - 4, 0) : at], rest])
        limits.require(whole, period_s, f"killed at tick {at}")
        assert (rest[-1] == rest[-2]).all(), at


def test_a_late_host_ends_its_program_although_the_card_has_held() -> None:
    host, slow, chance = late_host(PATHS["square"], Limits(), 1, 0.005)
    for _ in range(400):
        slow.advance(seconds=chance.choice([0.02, 0.02, 0.02, 0.3]))
        host.session.poll()
        if host.session.runner.state is State.IDLE:
            break
    assert host.session.runner.state is State.IDLE
    assert set(host.said) == {
        "the card had too little of the path and rests on it; it goes on from there"
    }
    assert (slow.places[-1] == 0.0).all()
    assert (slow.card.p[HOLD_AT], slow.card.bit[RAN_SHORT]) == (0, False)
    Limits().require(slow.places, slow.card.period_s, "to its end")


@pytest.mark.parametrize("kept", [1, 200, 700, 1500, 2600])
def test_a_curve_whose_first_points_arrive_in_part_does_not_begin(kept: int) -> None:
    host, slow, _ = late_host(PATHS["square"], Limits(), 0, 0.0)
    batches: list[bytes] = []

    def receive(stream: int, data: bytes) -> None:
        if len(data) > SHORT or batches:
            batches.append(data)
            data = data[:kept] if len(batches) == 1 else b""
        slow.card.receive(stream, data)

    slow.receive = receive  # type: ignore[method-assign]
    while not batches:
        slow.advance(seconds=0.02)
        host.session.poll()
    assert len(batches[0]) > 2600
    rest = alone(Controller(), slow.card.snapshot(), REST_S)
    assert (rest == 0.0).all()


def test_what_a_host_left_that_was_lost_before_its_curve_began_does_not_bar_the_next_one() -> None:
    card = Controller()
    card.send("SYS\rDIM P(100)\r")
    for flag in (INHIBIT, RAN_SHORT):
        card.bit[flag] = True
    card.p[HOLD_AT] = 1
    host = Host(PATHS["square"], card=card)
    assert not card.bit[INHIBIT]  # the first move may be none of a curve
    host.finish()
    assert host.session.runner.state is State.IDLE
    assert host.said == []
    Limits().require(host.places * PULSES, card.period_s, "to its end")
    assert (host.places[-1] == 0.0).all()
    assert float(np.ptp(host.places[:, 0])) == pytest.approx(30.0, abs=0.05)
