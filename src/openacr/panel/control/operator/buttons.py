"""Virtual push buttons: a press sets a flag of the card, as its cells say.

An input cannot be written on a card. A button whose bit is an input of the machine therefore acts
as the switch that is wired to it: the input counts as active while the button is pressed.
"""

from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.sysvar.tabs import OFFSETS

COUNT = len(OFFSETS.button_caption)
TOGGLE = 1


class Buttons:
    """The buttons of one machine; one that is held is released with its client."""

    def __init__(self) -> None:
        self._held: dict[int, tuple[int, int]] = {}  # by button: client and flag

    def press(self, session: MillSession, button: int, client: int, *, is_pressed: bool) -> None:
        """Press or release a button."""
        if not 0 <= button < COUNT:
            raise UserError(f"button {button}: buttons are 0 to {COUNT - 1}")
        read = session.cells.read
        flag = int(read(OFFSETS.button_set_bit[button]))
        if flag < 0:
            raise UserError(f"button {button} sets nothing (P{OFFSETS.button_set_bit[button]})")
        if read(OFFSETS.button_mode[button]) == TOGGLE:
            if is_pressed:
                _set(session, flag, on=not _is_set(session, flag))
            return
        if is_pressed:
            self._held[button] = (client, flag)
        else:
            self._held.pop(button, None)
        _set(session, flag, on=is_pressed)

    def drop(self, session: MillSession | None, client: int) -> None:
        """Release what a client holds: it has gone."""
        for button, (holder, flag) in list(self._held.items()):
            if holder == client:
                del self._held[button]
                if session is not None:
                    _set(session, flag, on=False)


def _set(session: MillSession, flag: int, *, on: bool) -> None:
    if session.runner.io.has_input(flag):
        session.runner.io.press(flag, on)
    else:
        session.machine.set_flag(flag, on)


def _is_set(session: MillSession, flag: int) -> bool:
    io = session.runner.io
    return io.is_pressed(flag) if io.has_input(flag) else session.card.read_bit(flag)
