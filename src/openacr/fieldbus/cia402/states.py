"""The states of a CiA 402 drive by its status word, and the control words that change them.

A state is recognised by the status word under a mask. A control word asks for a target; which
transition follows depends on the state. Bit 4 of the status word (voltage on the supply) takes no
part.
"""

from enum import Enum
from typing import NamedTuple


class State(Enum):
    """The states of the profile."""

    NOT_READY = "not ready to switch on"
    DISABLED = "switch on disabled"
    READY = "ready to switch on"
    SWITCHED_ON = "switched on"
    OPERATING = "operation enabled"
    QUICK_STOP = "quick stop active"
    REACTING = "fault reaction active"
    FAULT = "fault"


class _Pattern(NamedTuple):
    mask: int
    value: int
    state: State


_WITHOUT_QUICK_STOP = 0x4F
_WITH_QUICK_STOP = 0x6F
PATTERNS = (
    _Pattern(_WITHOUT_QUICK_STOP, 0x00, State.NOT_READY),
    _Pattern(_WITHOUT_QUICK_STOP, 0x40, State.DISABLED),
    _Pattern(_WITH_QUICK_STOP, 0x21, State.READY),
    _Pattern(_WITH_QUICK_STOP, 0x23, State.SWITCHED_ON),
    _Pattern(_WITH_QUICK_STOP, 0x27, State.OPERATING),
    _Pattern(_WITH_QUICK_STOP, 0x07, State.QUICK_STOP),
    _Pattern(_WITHOUT_QUICK_STOP, 0x0F, State.REACTING),
    _Pattern(_WITHOUT_QUICK_STOP, 0x08, State.FAULT),
)

# Control words.
DISABLE_VOLTAGE = 0x0000
QUICK_STOP = 0x0002
SHUTDOWN = 0x0006
SWITCH_ON = 0x0007  # in operation it disables the operation
ENABLE_OPERATION = 0x000F
FAULT_RESET = 0x0080  # acts on the edge


def state_of(status_word: int) -> State | None:
    """The state a status word shows; None for a pattern that the profile does not have."""
    for pattern in PATTERNS:
        if status_word & pattern.mask == pattern.value:
            return pattern.state
    return None
