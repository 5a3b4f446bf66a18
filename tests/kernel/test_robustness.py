"""Whatever users write into parameters and flags, the servo interrupt survives it.

Every public parameter and flag word of the objects the kernel reads takes values of all
kinds while the core runs; afterwards a card whose settings are put right works again, and
both builds have the same bits.
"""

import math
import random

import pytest
from tests.kernel.rig import PLANT, TICK, Rig, T
from tests.search import examples

from openacr import compiled
from openacr.errors import CardError
from openacr.kernel.tick_cy import tick
from openacr.map import numbers as at
from openacr.map.image import KINDS
from openacr.map.rows import axes
from openacr.map.words import af4
from openacr.motion.jog import jog
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target
from openacr.plant.physics.step_cy import plant_step

WORLD = """
[[axis]]
number = 0
counts_per_rev = 4000
marker = 0.1
drive = { mode = "ideal", revs_per_s_per_volt = 25.0, lag_s = 0.001 }
home = { between = [5.0, 6.0] }

[[axis]]
number = 1
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5 }
drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 20.0, fault_input = 20 }
"""
LONGS = (0, 1, -1, 2, 31, 255, 4096, -(2**31), 2**31 - 1, 0x7FC00000, 123456789)
REALS: tuple[float, ...] = (0.0, -0.0, 1.0, -1.0, 1e-45, 1e-3, 1e9, -1e9, 3.4e38, -3.4e38)
REALS += (math.nan, math.inf, -math.inf)
FIRST_OBJECT, LAST = 4096, 40959


def writable() -> list[tuple[int, bool]]:
    """Every public parameter with whether it is LONG."""
    found = []
    for first, length, kind, stride, count in KINDS:
        for start in range(first, first + stride * count, stride):
            found += [(p, kind == at.KIND_LONG) for p in range(start, start + length)]
    return [(p, long) for p, long in found if FIRST_OBJECT <= p <= LAST]


PARAMETERS = writable()


def busy_card(pure: bool = False) -> Rig:
    """Three axes with a move, a jog and homing under way."""
    rig = Rig(3, world=WORLD, pure=pure)
    rig.depth(4)
    for axis in range(3):
        rig.jog(axis, vel=1000, acc=1e4, dec=1e4, jrk=1e6)
    rig.master(vel=2000, acc=1e4, dec=1e4, stp=1e4, jrk=1e6)
    return rig


def command(rig: Rig, random_: random.Random) -> None:
    """Some command; refusals are fine."""
    axis, value = random_.randrange(3), random_.choice((*REALS, 100.0, -2500.0))
    what = random_.randrange(7)
    try:
        if what == 0:
            moves.issue(rig.card, 0, [Target(axis, value, random_.random() < 0.5)])
        elif what == 1:
            jog.absolute(rig.card, axis, value)
        elif what == 2:
            jog.continuous(rig.card, axis, random_.choice((1, -1)))
        elif what == 3:
            jog.home(rig.card, axis, random_.choice((1, -1)))
        elif what == 4:
            moves.seek(rig.card, 0, axis, 300.0, random_.randrange(16))
        elif what == 5:
            random_.choice((moves.hold, moves.release, moves.halt))(rig.card, 0)
        else:
            for word in range(3):
                rig.I[af4.word[word]] &= ~af4.KILL_ALL_MOTION_REQUEST
            rig.bit(522, False)
    except (CardError, OverflowError):
        pass


def scribble(rig: Rig, random_: random.Random) -> None:
    """Write one parameter as a host would."""
    near = [p for p in PARAMETERS if 12288 <= p[0] < 13056 or p[0] < 4700 or 8192 <= p[0] < 8448]
    number, long = random_.choice(near if random_.random() < 0.7 else PARAMETERS)
    if long:
        rig.I[number] = random_.choice(LONGS)
    else:
        rig.S[number] = random_.choice(REALS)


def torment(seed: int, rounds: int, pure: bool = False) -> Rig:
    random_ = random.Random(seed)
    rig = busy_card(pure)
    for _ in range(rounds):
        if random_.random() < 0.5 and moves.has_room(rig.card, 0):
            command(rig, random_)
        for _ in range(random_.randrange(3)):
            scribble(rig, random_)
        rig.ticks(random_.randrange(1, 12))
    return rig


@pytest.mark.search
@pytest.mark.parametrize("seed", range(examples(60)))
def test_no_value_of_any_parameter_stops_the_servo_interrupt(seed: int) -> None:
    rig = torment(seed, 300)
    put_right(rig)
    rig.move(1000.0)
    rig.record(limit=200_000)
    assert rig.real("position_cnt") == 1000.0
    jog.absolute(rig.card, 0, 500.0)
    rig.record(limit=200_000, while_=792)
    assert rig.real("jog_cnt") == 500.0
    for axis in range(3):
        for row in range(axes.REALS_SIZE):
            value = rig.F[axes.reals[axis] + row]
            assert math.isfinite(value), (axis, row, value)


def put_right(rig: Rig) -> None:
    """What an operator does: stop, clear kills, restore settings, reset positions."""
    fresh = busy_card()
    moves.release(rig.card, 0)
    for axis in range(3):
        rig.I[af4.word[axis]] = af4.KILL_ALL_MOTION_REQUEST
        rig.S[axes.ppu[axis]] = 1.0
        rig.F[axes.hldec_ups2[axis]] = 0.0
    rig.ticks(3)
    rig.I[4096:4800] = fresh.I[4096:4800]
    for start, end in ((8192, 8448), (12288, 13056)):
        rig.I[start:end] = fresh.I[start:end]
    rig.ticks(3)
    for axis in range(3):
        rig.I[af4.word[axis]] = 0
        for row in (axes.current_position, axes.jog_offset, axes.gear_offset):
            rig.I[row[axis]] = 1
            rig.ticks()
            rig.I[row[axis]] = 0
            rig.ticks()
    rig.bit(522, False)
    rig.ticks()


@pytest.mark.skipif(not compiled.is_compiled, reason="needs both builds")
@pytest.mark.parametrize("seed", range(100, 106))
def test_both_builds_agree_on_nonsense(seed: int) -> None:
    assert TICK is not tick
    assert PLANT is not plant_step
    fast, slow = torment(seed, 60), torment(seed, 60, pure=True)
    assert fast.card.clock.tick == slow.card.clock.tick
    assert fast.memory.snapshot() == slow.memory.snapshot()
    assert fast.card.clock.tick * T > 0.1
