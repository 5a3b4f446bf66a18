"""Hidden rows of the objects beside the profilers."""

from openacr.map.hidden.block import HiddenBlock

OBJECTS = 8
CHANNELS = 8

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
    ),
    ranges={
        "leader": (0, 16),
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

FAST_STATUS = HiddenBlock(
    prefix="FSB",
    family="fast_status",
    count=10,
    doubles=("phase_ms",),  # since the last copy; entry 0 counts for all
    ints=(
        "code",  # as loaded when the cycle was started
        "index",
        "type",
        ("words", 8),  # LONG, or FP32 through the other view
    ),
    ranges={
        "phase_ms": (0, 1e6),
        "code": (0, 255),
        "index": (0, 255),
    },
)

SAMPLER = HiddenBlock(
    prefix="SA",
    family="sampler",
    count=1,
    doubles=("timer_ms",),
    ints=(
        "armed_old",
        "trigger",  # flag + 1, 0 none
        "trigger_clear",  # the flag is waited for clear
        ("source", CHANNELS),  # parameter, 0 none
        ("kind", CHANNELS),  # of the array: 1 LA, 2 SA, 3 DA
        ("program", CHANNELS),
        ("array", CHANNELS),
    ),
    ranges={
        "timer_ms": (-1e6, 1e6),
        "trigger": (0, 17664),
        "source": (0, 40960),
        "kind": (0, 3),
        "program": (0, 15),
        "array": (0, 1 << 20),
    },
)

OBJECT_STATE = HiddenBlock(
    prefix="OB",
    family="objects",
    count=1,
    ints=(
        "live",  # ratchets, limiters or output objects are in use
        "locked",  # axes that are locked to another
    ),
)
