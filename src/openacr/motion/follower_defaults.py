"""What gears, cams, tables and objects are set to at power-up."""

from openacr.kernel.source_cy import (
    FROM_CLOCK,
    FROM_COUNTER,
    FROM_SELF,
    OUTPUT_TAPS,
    TIME_TAPS,
    USE_BALLSCREW,
    USE_CAM,
    USE_JOG,
    USES,
)
from openacr.map import numbers as at
from openacr.map.memory import Memory

AXES = 16
FIRST_OUTPUT = 32
OUTPUT_WORD = 4097
ALL_BITS = -1
FILTER_TICKS = 10


def set_follower_defaults(memory: Memory) -> None:
    """Ratios and scales of 1, time bases of the clock, everything off."""
    for axis in range(AXES):
        set_gear_defaults(memory, axis)
        set_table_defaults(memory, axis)
        set_table_defaults(memory, AXES + axis)
        memory.F[at.HWF_BASE + axis * at.HWF_STRIDE + at.HWF_PPU] = 1.0
        memory.F[at.HWF_BASE + axis * at.HWF_STRIDE + at.HWF_RATIO] = 1.0
        filters = at.FLI_BASE + axis * at.FLI_STRIDE
        memory.I[filters + at.FLI_SIZE] = FILTER_TICKS
        memory.I[filters + at.FLI_OUT] = -1
        set_source(memory, axis * USES + USE_CAM, FROM_CLOCK)
        set_source(memory, axis * USES + USE_JOG, FROM_CLOCK)
        set_source(memory, axis * USES + USE_BALLSCREW, FROM_SELF)
    for master in range(at.MS_COUNT):
        set_source(memory, TIME_TAPS + master, FROM_CLOCK)
    for number in range(at.LT_COUNT):
        memory.F[at.LTF_BASE + number * at.LTF_STRIDE + at.LTF_MULT] = 1.0
        memory.F[at.PSF_BASE + number * at.PSF_STRIDE + at.PSF_RATIO] = 1.0
        switch = at.PSI_BASE + number * at.PSI_STRIDE
        memory.I[switch + at.PSI_DESTINATION] = OUTPUT_WORD
        memory.I[switch + at.PSI_MASK] = ALL_BITS
        memory.I[at.OOI_BASE + number * at.OOI_STRIDE + at.OOI_BIT] = FIRST_OUTPUT + number
        set_source(memory, OUTPUT_TAPS + number, FROM_COUNTER, number)


def set_source(memory: Memory, tap: int, kind: int, index: int = 0) -> None:
    """Connect a tap; the caller lets it count from the present value."""
    row = at.SRI_BASE + tap * at.SRI_STRIDE
    memory.I[row + at.SRI_KIND] = kind
    memory.I[row + at.SRI_INDEX] = index


def set_gear_defaults(memory: Memory, axis: int) -> None:
    """Settings of a gear: ratio 1, source pulses as they are, no ramps, no clamp."""
    row = at.GRF_BASE + axis * at.GRF_STRIDE
    for setting in (at.GRF_ACC_RPS, at.GRF_DEC_RPS, at.GRF_MAX_U, at.GRF_MIN_U):
        memory.F[row + setting] = 0.0
    memory.F[row + at.GRF_PPU] = 1.0
    memory.F[row + at.GRF_RATIO] = 1.0


def set_table_defaults(memory: Memory, table: int) -> None:
    """An empty table: no segments, scale 1, no shifts."""
    row = at.TBF_BASE + table * at.TBF_STRIDE
    for setting in (at.TBF_OFFSET_U, at.TBF_FLZ_CNT, at.TBF_SHIFT_CNT):
        memory.F[row + setting] = 0.0
    memory.F[row + at.TBF_SCALE] = 1.0
    ints = at.TBI_BASE + table * at.TBI_STRIDE
    memory.I[ints + at.TBI_SEGMENTS] = 0
    for segment in range(at.TBI_ARRAY_SIZE):
        memory.I[ints + at.TBI_ARRAY + segment] = 0
