"""Virtual push buttons: a press sets a flag of the card, as its cells say."""

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
                session.machine.set_flag(flag, not session.card.read_bit(flag))
            return
        if is_pressed:
            self._held[button] = (client, flag)
        else:
            self._held.pop(button, None)
        session.machine.set_flag(flag, is_pressed)

    def drop(self, session: MillSession | None, client: int) -> None:
        """Release what a client holds: it has gone."""
        for button, (holder, flag) in list(self._held.items()):
            if holder == client:
                del self._held[button]
                if session is not None:
                    session.machine.set_flag(flag, False)
