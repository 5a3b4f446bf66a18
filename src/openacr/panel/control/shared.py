"""What the parts of a station share: the machine as it is now, and the way to the screens."""

from collections.abc import Callable
from typing import Any

from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.panel.control.history import STILL
from openacr.panel.control.installation import Installation
from openacr.panel.control.jobs import Jobs
from openacr.panel.control.people import People
from openacr.panel.control.place import Rows
from openacr.panel.control.reading import Reading
from openacr.panel.control.scope import Scope
from openacr.panel.control.snapshot import Ticks
from openacr.panel.control.tuning import Tuning

Tell = Callable[[dict[str, Any]], None]
MEASURED = "an axis is measured (servo tuning): wait until it rests, or STOP"
FIRST_REST = "wait until it rests, or STOP, then go back"


class Shared:
    """One machine, its session where it can be reached, and who is at its screens."""

    def __init__(self, installation: Installation, tell: Tell) -> None:
        self.installation = installation
        self.tell = tell
        self.people = People()
        self.jobs = Jobs()
        self.scope = Scope()
        self.ticks = Ticks()
        self.tuning = Tuning(installation, self.jobs, lambda event: self.tell(event))
        self.session: MillSession | None = None
        self.lost = "the machine is being opened"  # why there is no session
        self.mode = "auto"
        self._reading: Reading | None = None

    @property
    def link(self) -> MillSession:
        """The session of the card, set up by AcroMill or not.

        UserError where the card cannot be reached or is still.
        """
        if self.session is None:
            raise UserError(self.lost)
        history = self.installation.history
        if history is not None and history.is_still:
            raise UserError(STILL)
        return self.session

    @property
    def machine(self) -> MillSession:
        """The session of the machine; UserError where there is none or AcroMill is not set up."""
        session = self.link
        if not session.is_set_up:
            raise UserError(self.installation.lacks)
        return session

    @property
    def is_moved(self) -> bool:
        """Whether the panel moves the machine: a program, a key, servo tuning.

        UserError where the card cannot be reached.
        """
        if self.session is None:
            raise UserError(self.lost)
        return self.session.runner.is_busy or self.tuning.is_moving

    def require_unmeasured(self) -> None:
        """UserError while servo tuning moves an axis: its conversation with the card is timed."""
        if self.tuning.is_moving:
            raise UserError(MEASURED)

    def require_unmoved(self) -> None:
        """UserError while the panel moves the machine, with what to do first."""
        self.require_unmeasured()
        if self.session is not None and self.is_moved:
            state = self.session.runner.state.name
            raise UserError(f"the panel moves the machine (state {state}): {FIRST_REST}")

    @property
    def read(self) -> Rows:
        """What reads parameters; of a card in this process without time or bytes. UserError."""
        history = self.installation.history
        return self.link.machine.read_rows if history is None else history.read_rows

    @property
    def reading(self) -> Reading:
        """The reader of the machine; UserError where the card cannot be reached."""
        if self._reading is None:
            raise UserError(self.lost)
        return self._reading
