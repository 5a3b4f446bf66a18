"""Hidden rows of sources: what followers take their pulses from, and what triggers them."""

from openacr.map.hidden.block import HiddenBlock

# One tap per user of a source (kernel/sources/source_cy.py): six per axis, then one for each
# ratchet, limiter, limit switch and output object.
SOURCE = HiddenBlock(
    prefix="SR",
    family="sources",
    count=144,
    doubles=(
        "old",  # value of the last tick
        "delta",  # change of this tick
    ),
    ints=("kind", "index"),
    ranges={
        "kind": (0, 9),
        "index": (0, 40959),
    },
)

# What a gear or cam waits for: three per axis (gear on, gear off, cam on).
TRIGGER = HiddenBlock(
    prefix="TG",
    family="triggers",
    count=48,
    doubles=(
        "setpoint",  # of IHPOS
        "travel_cnt",  # source pulses since the captured edge
        "over_cnt",  # source pulses after the event in its tick
    ),
    ints=(
        "kind",  # 0 not armed
        "parameter",  # of IHPOS
        "mode",  # of the capture
        "copy",  # parameter that receives the captured source position, 0 none
        "register",  # encoder + 1 whose signals are watched, 0 that of the source
        "ticks_left",  # until the timeout, 0 never
    ),
    ranges={
        "kind": (0, 5),
        "parameter": (0, 40959),
        "copy": (0, 40959),
        "register": (0, 24),
    },
)
