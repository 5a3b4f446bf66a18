"""Hidden rows of the servo tick as a whole."""

from openacr.map.hidden.block import HiddenBlock

KERNEL = HiddenBlock(
    prefix="KR",
    family="kernel",
    count=1,
    doubles=("millisecond_phase",),
    ints=(
        "inputs_old",
        "slow_ticks",
        "fast_group",  # group of limit flags refreshed last (kernel/status/fast_flags_cy.py)
        "axes",
        "masters",
        "adc_mode",
        "adc_channels",
        "moves_waiting",
        "linked_encoders",  # how many are locked to another, have a destination, or wrap
        "filtered_encoders",  # how many have a LIMIT
        "kinematics",  # mask of the masters with INVK ON
        "synced",  # some masters are synchronised
        "sync_manual",  # SYNC MDI
        "sync_killed",  # a kill on a member has been seen
        "missing_encoders",  # bit masks: what CONFIG leaves out
        "missing_dacs",
        "missing_steppers",
        "missing_adcs",
        # What may be left out of the present tick (engine/alone_cy.py); 0 between calls.
        "untouched",  # nothing else has written since the tick before, and no trigger is armed
        "unread",  # nothing will read what this tick shows
        "shows_due",  # some axes have put off what they show
    ),
    ranges={
        "millisecond_phase": (-10, 10),
        "axes": (1, 16),
        "masters": (1, 16),
        "adc_channels": (0, 16),
        "slow_ticks": (1, 1 << 24),
        "fast_group": (0, 255),
        "moves_waiting": (0, 0xFFFF),
        "untouched": (0, 0),
        "unread": (0, 0),
        "shows_due": (0, 0),
        "kinematics": (0, 0xFFFF),
    },
)
