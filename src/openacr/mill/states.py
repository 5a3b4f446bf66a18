"""What a machine may be doing, and how a program is run."""

from dataclasses import dataclass
from enum import IntEnum


class State(IntEnum):
    """What the machine is doing; the values are those of P244."""

    IDLE = 0
    RUN = 1
    PAUSED = 2
    WAIT = 3
    HOLD = 4
    ALARM = 5


@dataclass(frozen=True, slots=True)
class Options:
    """How a program is run."""

    is_dry: bool = False
    is_single: bool = False
    stops_optionally: bool = False
    is_repeated: bool = True  # where the store says Repeat Forever
    is_mdi: bool = False  # blocks typed one by one: what is on stays on behind them
