"""Gears, cams, tables and objects under random settings: both builds alike, always finite."""

import math
import random

import pytest

from openacr.compiled import is_compiled, pick
from openacr.kernel.sources.source_cy import USES
from openacr.kernel.tick_cy import tick
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import (
    axes,
    encoders,
    filters,
    followers,
    gears,
    hand_wheels,
    limit_switches,
    objects,
    output_objects,
    sampler,
    sources,
    storage,
    tables,
    triggers,
)
from openacr.map.words import af1, af2, af4
from openacr.motion.card import Card

AXES = 3
ENCODER = encoders.parameters[10]  # follows no axis
HEAP = at.HEAP_BYTE_BASE // 4
VALUES = (0.0, 1.0, -1.0, 0.5, 3.0, -20.0, 1e9, -1e9, 3e38)


def points(memory: Memory, random_: random.Random) -> None:
    """An array LA0 of program 0 with five points."""
    memory.I[storage.la_base[0]] = HEAP
    memory.I[storage.la_count[0]] = 1
    memory.I[HEAP] = HEAP + 2
    memory.I[HEAP + 2] = 5
    for place in range(5):
        memory.I[HEAP + 3 + place] = random_.randint(-50, 50)


def configure(memory: Memory, random_: random.Random) -> None:
    """Everything in use."""
    points(memory, random_)
    memory.I[objects.live] = 1
    for axis in range(AXES):
        memory.I[followers.live[axis]] = 1
        memory.I[hand_wheels.on[axis]] = 1
        memory.I[filters.on[axis]] = 1
        for table in (axis, 16 + axis):
            memory.I[tables.segments[table]] = 1
            memory.I[tables.array[table]] = 1
            memory.F[tables.length_cnt[table]] = 100.0
        memory.I[af1.word[axis]] |= af1.GEAR_ACTIVATE | af1.CAM_ACTIVATE | af1.BALLSCREW_ACTIVATE
    for number in range(8):
        memory.I[limit_switches.array[number]] = 1
        memory.I[output_objects.on[number]] = 1
    memory.I[sampler.source] = ENCODER + 1
    memory.I[sampler.kind] = 1


def disturb(memory: Memory, random_: random.Random) -> None:
    """Change a setting, a source, a flag word or an address of an array to anything."""
    axis, what = random_.randrange(AXES), random_.randrange(8)
    number = random_.choice((-1, 0, 1, 7, 15, 99, 2**31 - 1, -(2**31), HEAP, HEAP + 2))
    if what == 0:
        tap = random_.choice((axis * USES + random_.randrange(USES), random_.randrange(96, 128)))
        memory.I[sources.kind[tap]] = random_.randrange(11)
        memory.I[sources.index[tap]] = random_.choice((number, ENCODER, random_.randrange(40960)))
    elif what == 1:
        row = random_.randrange(gears.reals[axis], gears.ratio_now[axis])
        memory.F[row] = random_.choice(VALUES)
    elif what == 2:
        row = random_.choice((af1.word[0], af2.word[0], af4.word[0])) + axis
        memory.I[row] ^= 1 << random_.randrange(31)
    elif what == 3:
        memory.I[random_.choice((HEAP, HEAP + 2, storage.la_base[0]))] = number
    elif what == 4:
        points(memory, random_)
    elif what == 5:
        trigger = axis * 3 + random_.randrange(3)
        memory.I[triggers.kind[trigger]] = random_.randrange(6)
        memory.I[triggers.mode[trigger]] = random_.randrange(16)
        memory.I[triggers.parameter[trigger]] = random_.choice((number, ENCODER))
    elif what == 6:
        memory.I[at.W_MISC_OUTPUTS] ^= 1 << random_.randrange(31)
    else:
        memory.S[axes.backlash_setting[axis]] = random_.choice(VALUES)


def live(seed: int, *, pure: bool, ticks: int) -> Card:
    card, random_ = Card(), random.Random(seed)
    memory = card.memory
    configure(memory, random_)
    step = tick if pure else pick(tick)
    for _ in range(ticks):
        if random_.random() < 0.3:
            disturb(memory, random_)
        memory.I[ENCODER] = (memory.I[ENCODER] + random_.randint(-90, 100)) & 0xFFFFFFF
        memory.I[at.W_INPUTS] = random_.getrandbits(31)
        step(memory.F, memory.I, memory.S)
    return card


@pytest.mark.skipif(not is_compiled, reason="the compiled core is not available")
@pytest.mark.parametrize("seed", range(8))
def test_both_builds_live_the_same_life(seed: int) -> None:
    fast, plain = live(seed, pure=False, ticks=150), live(seed, pure=True, ticks=150)
    assert fast.memory.digest() == plain.memory.digest()


@pytest.mark.parametrize("seed", range(30))
def test_no_address_or_setting_makes_a_setpoint_infinite(seed: int) -> None:
    memory = live(seed, pure=False, ticks=400).memory
    for axis in range(AXES):
        for row in range(axes.REALS_SIZE):
            value = memory.F[axes.reals[axis] + row]
            assert math.isfinite(value), (axis, row)
        parts = memory.F[axes.reals[axis] : axes.ballscrew_cnt[axis]]
        psp = memory.F[axes.psp_cnt[axis]]
        assert psp == pytest.approx(math.fsum(parts), rel=1e-9, abs=1e-6)
