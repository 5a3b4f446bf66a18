"""Hidden rows of cams and ballscrew tables."""

from openacr.map.hidden.block import HiddenBlock

SEGMENTS = 64
SMOOTHING = 64

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
        ("program", SEGMENTS),  # owner of the array
        ("array", SEGMENTS),  # its number + 1, 0 not given
    ),
    ranges={
        "segments": (0, SEGMENTS),
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
