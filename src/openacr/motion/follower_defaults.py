"""What gears, cams, tables and objects are set to at power-up."""

from openacr.kernel.sources.source_cy import (
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
from openacr.map.memory import Memory
from openacr.map.rows import (
    filters,
    gears,
    hand_wheels,
    limit_switches,
    limiters,
    masters,
    output_objects,
    sources,
    tables,
)

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
        memory.F[hand_wheels.ppu[axis]] = 1.0
        memory.F[hand_wheels.ratio[axis]] = 1.0
        memory.I[filters.size[axis]] = FILTER_TICKS
        memory.I[filters.out[axis]] = -1
        set_source(memory, axis * USES + USE_CAM, FROM_CLOCK)
        set_source(memory, axis * USES + USE_JOG, FROM_CLOCK)
        set_source(memory, axis * USES + USE_BALLSCREW, FROM_SELF)
    for master in range(masters.COUNT):
        set_source(memory, TIME_TAPS + master, FROM_CLOCK)
    for number in range(limiters.COUNT):
        memory.F[limiters.mult[number]] = 1.0
        memory.F[limit_switches.ratio[number]] = 1.0
        memory.I[limit_switches.destination[number]] = OUTPUT_WORD
        memory.I[limit_switches.mask[number]] = ALL_BITS
        memory.I[output_objects.bit[number]] = FIRST_OUTPUT + number
        set_source(memory, OUTPUT_TAPS + number, FROM_COUNTER, number)


def set_source(memory: Memory, tap: int, kind: int, index: int = 0) -> None:
    """Connect a tap; the caller lets it count from the present value."""
    memory.I[sources.kind[tap]] = kind
    memory.F[sources.delta[tap]] = 0.0
    memory.I[sources.index[tap]] = index


def set_gear_defaults(memory: Memory, axis: int) -> None:
    """Settings of a gear: ratio 1, source pulses as they are, no ramps, no clamp."""
    for row in (gears.acc_rps, gears.dec_rps, gears.max_u, gears.min_u):
        memory.F[row[axis]] = 0.0
    memory.F[gears.ppu[axis]] = 1.0
    memory.F[gears.ratio[axis]] = 1.0


def set_table_defaults(memory: Memory, table: int) -> None:
    """An empty table: no segments, scale 1, no shifts."""
    for row in (tables.offset_u, tables.flz_cnt, tables.shift_cnt):
        memory.F[row[table]] = 0.0
    memory.F[tables.scale[table]] = 1.0
    memory.I[tables.segments[table]] = 0
    for segment in range(tables.ARRAY_SIZE):
        memory.I[tables.array[table] + segment] = 0
