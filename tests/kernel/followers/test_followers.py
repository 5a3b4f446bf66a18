"""Gears, cams, tables and objects under random settings: both builds alike, always finite."""

import math
import random

import pytest

from openacr.compiled import is_compiled, pick
from openacr.kernel.sources.source_cy import USES
from openacr.kernel.tick_cy import tick
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.motion.card import Card

AXES = 3
ENCODER = at.ENC_BASE + 10 * at.ENC_STRIDE  # follows no axis
HEAP = at.HEAP_BYTE_BASE // 4
VALUES = (0.0, 1.0, -1.0, 0.5, 3.0, -20.0, 1e9, -1e9, 3e38)


def points(memory: Memory, random_: random.Random) -> None:
    """An array LA0 of program 0 with five points."""
    row = at.STI_BASE
    memory.I[row + at.STI_LA_BASE] = HEAP
    memory.I[row + at.STI_LA_COUNT] = 1
    memory.I[HEAP] = HEAP + 2
    memory.I[HEAP + 2] = 5
    for place in range(5):
        memory.I[HEAP + 3 + place] = random_.randint(-50, 50)


def configure(memory: Memory, random_: random.Random) -> None:
    """Everything in use."""
    points(memory, random_)
    memory.I[at.OBI_BASE + at.OBI_LIVE] = 1
    for axis in range(AXES):
        memory.I[at.FOI_BASE + axis * at.FOI_STRIDE + at.FOI_LIVE] = 1
        memory.I[at.HWI_BASE + axis * at.HWI_STRIDE + at.HWI_ON] = 1
        memory.I[at.FLI_BASE + axis * at.FLI_STRIDE + at.FLI_ON] = 1
        for table in (axis, 16 + axis):
            row = at.TBI_BASE + table * at.TBI_STRIDE
            memory.I[row + at.TBI_SEGMENTS] = 1
            memory.I[row + at.TBI_ARRAY] = 1
            memory.F[at.TBF_BASE + table * at.TBF_STRIDE + at.TBF_LENGTH_CNT] = 100.0
        memory.I[at.AF1_WORD + axis] |= (
            at.AF1_GEAR_ACTIVATE | at.AF1_CAM_ACTIVATE | at.AF1_BALLSCREW_ACTIVATE
        )
    for number in range(8):
        memory.I[at.PSI_BASE + number * at.PSI_STRIDE + at.PSI_ARRAY] = 1
        memory.I[at.OOI_BASE + number * at.OOI_STRIDE + at.OOI_ON] = 1
    memory.I[at.SAI_BASE + at.SAI_SOURCE] = ENCODER + 1
    memory.I[at.SAI_BASE + at.SAI_KIND] = 1


def disturb(memory: Memory, random_: random.Random) -> None:
    """Change a setting, a source, a flag word or an address of an array to anything."""
    axis, what = random_.randrange(AXES), random_.randrange(8)
    number = random_.choice((-1, 0, 1, 7, 15, 99, 2**31 - 1, -(2**31), HEAP, HEAP + 2))
    if what == 0:
        tap = random_.choice((axis * USES + random_.randrange(USES), random_.randrange(96, 128)))
        memory.I[at.SRI_BASE + tap * at.SRI_STRIDE + at.SRI_KIND] = random_.randrange(11)
        memory.I[at.SRI_BASE + tap * at.SRI_STRIDE + at.SRI_INDEX] = random_.choice(
            (number, ENCODER, random_.randrange(40960))
        )
    elif what == 1:
        row = at.GRF_BASE + axis * at.GRF_STRIDE + random_.randrange(at.GRF_RATIO_NOW)
        memory.F[row] = random_.choice(VALUES)
    elif what == 2:
        row = random_.choice((at.AF1_WORD, at.AF2_WORD, at.AF4_WORD)) + axis
        memory.I[row] ^= 1 << random_.randrange(31)
    elif what == 3:
        memory.I[random_.choice((HEAP, HEAP + 2, at.STI_BASE + at.STI_LA_BASE))] = number
    elif what == 4:
        points(memory, random_)
    elif what == 5:
        trigger = at.TGI_BASE + (axis * 3 + random_.randrange(3)) * at.TGI_STRIDE
        memory.I[trigger + at.TGI_KIND] = random_.randrange(6)
        memory.I[trigger + at.TGI_MODE] = random_.randrange(16)
        memory.I[trigger + at.TGI_PARAMETER] = random_.choice((number, ENCODER))
    elif what == 6:
        memory.I[at.W_MISC_OUTPUTS] ^= 1 << random_.randrange(31)
    else:
        memory.S[at.AX_BASE + axis * at.AX_STRIDE + at.AX_BACKLASH_SETTING] = random_.choice(VALUES)


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
        for row in range(at.AXF_STRIDE):
            value = memory.F[at.AXF_BASE + axis * at.AXF_STRIDE + row]
            assert math.isfinite(value), (axis, row)
        parts = memory.F[at.AXF_BASE + axis * at.AXF_STRIDE :][: at.AXF_BALLSCREW_CNT]
        psp = memory.F[at.AXF_BASE + axis * at.AXF_STRIDE + at.AXF_PSP_CNT]
        assert psp == pytest.approx(math.fsum(parts), rel=1e-9, abs=1e-6)
