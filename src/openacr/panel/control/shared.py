"""What the parts of a station share: the machine as it is now, and the way to the screens."""

from collections.abc import Callable
from typing import Any

from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.panel.control.installation import Installation
from openacr.panel.control.jobs import Jobs
from openacr.panel.control.people import People
from openacr.panel.control.reading import Reading
from openacr.panel.control.scope import Scope
from openacr.panel.control.snapshot import Ticks

Tell = Callable[[dict[str, Any]], None]


class Shared:
    """One machine, its session where it can be reached, and who is at its screens."""

    def __init__(self, installation: Installation, tell: Tell) -> None:
        self.installation = installation
        self.tell = tell
        self.people = People()
        self.jobs = Jobs()
        self.scope = Scope()
        self.ticks = Ticks()
        self.session: MillSession | None = None
        self.lost = "the machine is being opened"  # why there is no session
        self.mode = "auto"
        self._reading: Reading | None = None

    @property
    def machine(self) -> MillSession:
        """The session of the machine; UserError where the card cannot be reached."""
        if self.session is None:
            raise UserError(self.lost)
        return self.session

    @property
    def reading(self) -> Reading:
        """The reader of the machine; UserError where the card cannot be reached."""
        if self._reading is None:
            raise UserError(self.lost)
        return self._reading
