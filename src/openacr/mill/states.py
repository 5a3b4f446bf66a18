"""What a machine may be doing, and how a program is run."""

from dataclasses import dataclass, field
from enum import IntEnum

from openacr.errors import UserError


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


@dataclass(slots=True)
class Status:
    """What a machine is doing now, and how its program is run."""

    state: State = State.IDLE
    reason: str = ""  # what a WAIT or HOLD is for
    options: Options = field(default_factory=Options)
    is_homing: bool = False
    holds_later: bool = False  # a feed hold was requested that waits for a tap to be out
    has_operator: bool = True  # somebody answers and starts again

    @property
    def is_under_way(self) -> bool:
        """Whether a program or a homing goes on by itself."""
        return self.state in (State.RUN, State.WAIT)

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to be ended."""
        return self.state in (State.IDLE, State.ALARM)

    def require(self, state: State, what: str) -> None:
        """Refuse what is for one state alone."""
        if self.state is not state:
            raise UserError(f"cannot {what}: the state is {self.state.name}, not {state.name}")

    def end(self, state: State) -> None:
        """Nothing is waited for any more."""
        self.state, self.reason = state, ""
        self.is_homing = self.holds_later = False
