"""The state machine of a drive (CiA 402, IEC 61800-7-201): control word to state to status word."""

from enum import IntEnum


class DriveState(IntEnum):
    """States, with the bits of the status word that show them."""

    NOT_READY = 0x0000
    DISABLED = 0x0040
    READY = 0x0021
    SWITCHED_ON = 0x0023
    ENABLED = 0x0027
    QUICK_STOP = 0x0007
    REACTION = 0x000F
    FAULT = 0x0008


SWITCH_ON, VOLTAGE, NO_QUICK_STOP, ENABLE, RESET, HALT = 0x01, 0x02, 0x04, 0x08, 0x80, 0x100


class Wish(IntEnum):
    """What a control word asks for."""

    DISABLE_VOLTAGE = 0
    QUICK_STOP = 1
    SHUTDOWN = 2
    SWITCH_ON = 3
    ENABLE = 4


def wish_of(control: int) -> Wish:
    """What a control word asks for, but for resets."""
    if not control & VOLTAGE:
        return Wish.DISABLE_VOLTAGE
    if not control & NO_QUICK_STOP:
        return Wish.QUICK_STOP
    if not control & SWITCH_ON:
        return Wish.SHUTDOWN
    return Wish.ENABLE if control & ENABLE else Wish.SWITCH_ON


_S, _W = DriveState, Wish
# From each state, where a wish leads: one transition a period. (QUICK_STOP: see `leaves`.)
TRANSITIONS = {
    (_S.DISABLED, _W.SHUTDOWN): _S.READY,
    (_S.READY, _W.DISABLE_VOLTAGE): _S.DISABLED,
    (_S.READY, _W.QUICK_STOP): _S.DISABLED,
    (_S.READY, _W.SWITCH_ON): _S.SWITCHED_ON,
    (_S.READY, _W.ENABLE): _S.SWITCHED_ON,
    (_S.SWITCHED_ON, _W.DISABLE_VOLTAGE): _S.DISABLED,
    (_S.SWITCHED_ON, _W.QUICK_STOP): _S.DISABLED,
    (_S.SWITCHED_ON, _W.SHUTDOWN): _S.READY,
    (_S.SWITCHED_ON, _W.ENABLE): _S.ENABLED,
    (_S.ENABLED, _W.DISABLE_VOLTAGE): _S.DISABLED,
    (_S.ENABLED, _W.QUICK_STOP): _S.QUICK_STOP,
    (_S.ENABLED, _W.SHUTDOWN): _S.READY,
    (_S.ENABLED, _W.SWITCH_ON): _S.SWITCHED_ON,
    (_S.QUICK_STOP, _W.DISABLE_VOLTAGE): _S.DISABLED,
}
POWERED = (_S.ENABLED, _S.QUICK_STOP, _S.REACTION)


class Profile:
    """The state of a drive and the transitions that control words cause."""

    def __init__(self) -> None:
        self.state = DriveState.NOT_READY
        self._had_reset = False

    def start(self) -> None:
        """The drive has tested itself: automatic transitions 0 and 1."""
        if self.state is DriveState.NOT_READY:
            self.state = DriveState.DISABLED

    def obey(self, control: int, can_reset: bool, can_resume: bool) -> None:
        """Do at most one transition.

        `can_reset`: the cause of a fault is gone. `can_resume`: after a quick stop the drive
        remains in its state, and may be enabled again (transition 16).
        """
        resets = bool(control & RESET) and not self._had_reset
        self._had_reset = bool(control & RESET)
        if self.state is DriveState.FAULT:
            if resets and can_reset:
                self.state = DriveState.DISABLED
            return
        wish = wish_of(control)
        if self.state is DriveState.QUICK_STOP and wish is Wish.ENABLE and can_resume:
            self.state = DriveState.ENABLED
            return
        self.state = TRANSITIONS.get((self.state, wish), self.state)
