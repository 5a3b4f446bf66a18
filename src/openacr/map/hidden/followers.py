"""Hidden rows of what follows a source or a setpoint: gears, cams, offsets, objects."""

from openacr.map.hidden.block import HiddenBlock

FILTER_WINDOW = 128
SEGMENTS = 64
SMOOTHING = 64
OBJECTS = 8

GEAR = HiddenBlock(
    prefix="GR",
    family="gears",
    count=16,
    doubles=(
        "ppu",  # source pulses per source unit
        "ratio",
        "acc_rps",  # ratio units per second
        "dec_rps",
        "max_u",
        "min_u",
        "ratio_now",
        "slip_cnt",
        "slip_shown_cnt",
    ),
)

FILTER = HiddenBlock(
    prefix="FL",
    family="filters",
    count=16,
    doubles=(("window_cnt", FILTER_WINDOW), "sum_cnt", "carry_cnt"),
    ints=("on", "size", "index", "out"),
    ranges={
        "size": (0, FILTER_WINDOW),
        "index": (0, FILTER_WINDOW - 1),
        "out": (-1, 40959),
    },
)

HAND_WHEEL = HiddenBlock(
    prefix="HW",
    family="hand_wheels",
    count=16,
    doubles=("ppu", "ratio", "vel_ups", "acc_ups2"),
    ints=("on",),
)

# A table of segments: 0-15 the cams, 16-31 the ballscrews of the axes.
TABLE = HiddenBlock(
    prefix="TB",
    family="tables",
    count=32,
    doubles=(
        ("length_cnt", SEGMENTS),
        "scale",
        "offset_u",
        "flz_cnt",
        "shift_cnt",
        "total_cnt",  # found by the last look-up: length of the table
        "first_cnt",  # its first and last value
        "last_cnt",
        "shown_cnt",  # what the table last put out; another value has been written
    ),
    ints=(
        "segments",
        "running",
        "header",  # of its last array while nothing is written (kernel.untouched), else 0
        ("program", SEGMENTS),  # owner of the array
        ("array", SEGMENTS),  # its number + 1, 0 not given
    ),
    ranges={
        "segments": (0, SEGMENTS),
        "header": (0, 0),
        "program": (0, 15),
        "array": (0, 1 << 20),
    },
)

CAM = HiddenBlock(
    prefix="CA",
    family="cams",
    count=16,
    doubles=(
        "index_cnt",  # source pulses since the cam was switched on
        "cycle",  # whole tables below the index
        "base_cnt",  # so that nothing jumps when the cam is switched on
        "pon_cnt",
        "poff_cnt",
        "sum_cnt",
        ("window_cnt", SMOOTHING),
    ),
    ints=("pon", "poff", "window_index", "window_count", "window_size"),
    ranges={
        "window_index": (0, SMOOTHING - 1),
        "window_count": (0, SMOOTHING),
        "window_size": (0, SMOOTHING),
    },
)

# What an axis uses beyond moves and jogs.
FOLLOWER = HiddenBlock(
    prefix="FO",
    family="followers",
    count=16,
    doubles=(
        "jog_debt_s",  # time the source of the jog has run back
        "backlash_wanted_cnt",
        "backlash_step_cnt",  # per second
        "backlash_old_cnt",  # primary setpoint of the last tick
        "lock_old_cnt",  # primary setpoint of the leader in the last tick
        "lock_v",  # coupling voltage of a locked pair
    ),
    ints=(
        "live",  # sources are followed
        "leader",  # axis it is locked to + 1
        "taps",  # that have a source, while nothing is written (kernel.untouched), else 0
    ),
    ranges={
        "leader": (0, 16),
        "taps": (0, 0),
    },
)

RATCHET = HiddenBlock(
    prefix="RT",
    family="ratchets",
    count=OBJECTS,
    doubles=("output_cnt", "backlog_cnt"),
    ints=("mode",),
)

LIMITER = HiddenBlock(
    prefix="LT",
    family="limiters",
    count=OBJECTS,
    doubles=("output_cnt", "backlog_cnt", "freq_hz", "mult"),
)

LIMIT_SWITCH = HiddenBlock(
    prefix="PS",
    family="limit_switches",
    count=OBJECTS,
    doubles=("base_cnt", "ratio", "flz_cnt", "rotary"),
    ints=("program", "array", "destination", "mask"),
    ranges={
        "program": (0, 15),
        "array": (0, 1 << 20),
        "destination": (0, 40959),
    },
)

OUTPUT_OBJECT = HiddenBlock(
    prefix="OO",
    family="output_objects",
    count=OBJECTS,
    doubles=("from_cnt", "to_cnt", "start_cnt", "pitch_cnt", "width_cnt"),
    ints=("on", "bit", "windows"),
    ranges={
        "bit": (0, 17663),
        "windows": (0, 1 << 30),
    },
)
