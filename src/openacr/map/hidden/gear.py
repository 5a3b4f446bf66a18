"""Hidden rows of what follows a source directly: gears, filters, hand wheels."""

from openacr.map.hidden.block import HiddenBlock

FILTER_WINDOW = 128

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
