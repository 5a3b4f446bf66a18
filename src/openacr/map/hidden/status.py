"""Hidden rows of what the card watches and shows: fast status, samples, objects in use."""

from openacr.map.hidden.block import HiddenBlock

CHANNELS = 8

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
