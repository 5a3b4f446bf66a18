"""The programs of the card as the screens know them: states, texts, what they print."""

from collections.abc import Callable
from typing import Any

from openacr.panel.control.aside import Aside
from openacr.panel.control.card_programs import CardPrograms
from openacr.panel.control.installation import Installation
from openacr.panel.control.listening import Listening
from openacr.panel.control.parked import ParkedTexts
from openacr.panel.control.rows import Rows


class OnCard:
    """States by the link of the session; texts and listening by streams of their own."""

    def __init__(self, installation: Installation, tell: Callable[[dict[str, Any]], None]) -> None:
        self.aside = Aside(installation)
        self.programs = CardPrograms(tell)
        self.parked = ParkedTexts()
        self.listening = Listening(installation, tell)

    def step(self, now_s: float) -> None:
        """Carry on with what is under way; never waits."""
        self.aside.step(now_s)
        self.listening.step(now_s)

    def look(self, read: Rows, now_s: float) -> None:
        """Read the states for those who watch them."""
        self.programs.look(read, now_s)

    def forget(self, client: int) -> None:
        """A browser has gone."""
        self.programs.forget(client)
        self.listening.forget(client)

    def end(self) -> None:
        """The session has ended: close the streams."""
        self.aside.end()
        self.listening.end()
