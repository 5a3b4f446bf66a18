"""Hidden rows of the card as a whole."""

from openacr.map.hidden.block import HiddenBlock

SYSTEM = HiddenBlock(
    prefix="SYS",
    family="system",
    count=1,
    doubles=(
        "period_s",  # servo period: one tick
        "time_s",  # simulated time since power-up
    ),
    ints=(
        "p_count",  # user variables P0.. reserved by DIM P
        "slow_phase",  # ticks since the last slow flag scan
        "tick_low",  # ticks since power-up: low 32 bits
        "tick_high",
        "random_seed_low",  # state of RND: low 32 bits
        "random_seed_high",
    ),
    ranges={
        "period_s": (1e-5, 0.1),
        "time_s": (0, 1e12),
        "p_count": (0, 4096),
        "slow_phase": (0, 1 << 24),
    },
)
