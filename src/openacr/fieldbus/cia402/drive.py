"""A drive as its master leads it: what is asked of it, and the control word that follows.

Nothing is ever enabled by itself. `ON` is refused in every state but "switch on disabled" and those
on the path up from it; a drive that leaves operation by itself (fault, quick stop, power) stays off
until `OFF` and `ON` are asked anew.
"""

from enum import Enum

from openacr.fieldbus.cia402.states import (
    DISABLE_VOLTAGE,
    ENABLE_OPERATION,
    FAULT_RESET,
    QUICK_STOP,
    SHUTDOWN,
    SWITCH_ON,
    State,
    state_of,
)

RESET_CYCLES = 10  # the edge that resets a fault is low and high that long: drives look seldom


class Order(Enum):
    """What is asked of a drive."""

    OFF = "off"
    ON = "on"
    QUICK_STOP = "quick stop"


# The next control word on the path to operation, by state.
_UP = {
    State.DISABLED: SHUTDOWN,
    State.READY: SWITCH_ON,
    State.SWITCHED_ON: ENABLE_OPERATION,
    State.OPERATING: ENABLE_OPERATION,
}


class Drive:
    """One drive: feed it status words, ask it for an order, send what it gives."""

    def __init__(self) -> None:
        self.order = Order.OFF
        self.state: State | None = None
        self._resets = 0
        self._was_operating = False

    @property
    def is_operating(self) -> bool:
        """Whether the drive follows its target."""
        return self.state is State.OPERATING

    @property
    def has_fault(self) -> bool:
        """Whether the drive reports a fault, or reacts to one."""
        return self.state in (State.FAULT, State.REACTING)

    def ask(self, order: Order) -> None:
        """Ask for an order from the next control word on."""
        if order is not self.order:
            self._was_operating = False
        self.order = order

    def reset(self) -> None:
        """Reset a fault; the drive is off afterwards."""
        self.ask(Order.OFF)
        self._resets = 2 * RESET_CYCLES

    def next_word(self, status_word: int) -> int:
        """The control word that follows on a status word."""
        self.state = state_of(status_word)
        if self._fell():
            self.ask(Order.OFF)
        if self._resets:
            self._resets -= 1
            is_high = self._resets < RESET_CYCLES and self.state is State.FAULT
            return FAULT_RESET if is_high else DISABLE_VOLTAGE
        if self.order is Order.ON:
            return _UP.get(self.state, DISABLE_VOLTAGE) if self.state else DISABLE_VOLTAGE
        if self.order is Order.QUICK_STOP and self.state in (State.OPERATING, State.QUICK_STOP):
            return QUICK_STOP
        return DISABLE_VOLTAGE

    def _fell(self) -> bool:
        """Whether a drive that is to be on is not on its path to operation, or has left it."""
        if self.order is not Order.ON:
            return False
        if self.state is State.OPERATING:
            self._was_operating = True
            return False
        return self._was_operating or self.state not in _UP
