"""The way to the screens: events, and the lines of the print window."""

from collections import deque
from collections.abc import Callable
from typing import Any

from openacr.errors import OpenacrError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.run.lifecycle import State
from openacr.panel.control.machine.link import Link

LINES_KEPT = 200  # of the print window


class Screens:
    """All screens of one machine."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self.send: Callable[[dict[str, Any]], None] = lambda _event: None  # to the browsers
        self.said: deque[dict[str, Any]] = deque(maxlen=LINES_KEPT)

    def tell(self, event: dict[str, Any]) -> None:
        """Send an event to all screens, or to the client that it names (`to`)."""
        self.send(event)

    def say(self, text: str) -> None:
        """A line of the machine or of a program, for the print window."""
        session = self._link.session
        is_homing = session is not None and session.runner.state is State.HOMING
        at_s = round(self._link.tick_ms / 1000.0, 3)
        event = {"text": text, "at_s": at_s, "homing": is_homing}
        self.said.append(event)
        self.tell({"event": "say", **event})

    def guarded(self, do: Callable[[], object]) -> None:
        """Do something whose failure must not end the control thread: it is said."""
        try:
            do()
        except (OpenacrError, *LINK_ERRORS) as error:
            self.say(str(error))
