"""The session of the card: opened, lost, tried again; what asks for it is refused without one."""

from collections.abc import Callable

from openacr.errors import OpenacrError, UserError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.machine.history import STILL
from openacr.panel.control.machine.installation import Installation, Say
from openacr.panel.control.machine.opening import StopWaitsError
from openacr.panel.control.machine.place import Rows
from openacr.panel.control.machine.reading import Reading

RETRY_S = 2.0  # between two attempts to reach a card
BROKEN_OFF = "a stop came first: the card is opened when it is over"


class Link:
    """One machine, and its session where its card can be reached; else `lost` says why not."""

    def __init__(self, installation: Installation) -> None:
        self.installation = installation
        self.session: MillSession | None = None
        self.lost = "the machine is being opened"  # why there is no session
        self.tick_ms = 0.0  # card time of the last poll, counted on from session to session
        self.retry_s = 0.0  # when the card is tried again
        self.is_ending = False  # the panel ends: no card is opened any more
        self.is_awaited: Callable[[], bool] = lambda: False  # a stop or the end waits
        self.on_change: Callable[[str], None] = lambda _why: None  # lost, or found again ("")
        self._reported = ""  # as `on_change` was called last
        self._base_ms = 0.0  # card time before this session
        self._reading: Reading | None = None

    # --- what others ask --------------------------------------------------------------

    @property
    def required(self) -> MillSession:
        """The session of the card, set up by AcroMill or not.

        UserError where the card cannot be reached or is still.
        """
        if self.session is None:
            raise UserError(self.lost)
        if self.is_still:
            raise UserError(STILL)
        return self.session

    @property
    def machine(self) -> MillSession:
        """The session of the machine; UserError where there is none or AcroMill is not set up."""
        session = self.required
        if not session.is_set_up:
            raise UserError(self.installation.lacks)
        return session

    @property
    def is_still(self) -> bool:
        """Whether no time passes on the card."""
        history = self.installation.history
        return history is not None and history.is_still

    @property
    def is_away(self) -> bool:
        """Whether the panel has left the card to show moments of its history."""
        history = self.installation.history
        return history is not None and history.is_away

    @property
    def read(self) -> Rows:
        """What reads parameters; of a card in this process without time or bytes. UserError."""
        history = self.installation.history
        return self.required.machine.read_rows if history is None else history.read_rows

    @property
    def reading(self) -> Reading:
        """The reader of the machine; UserError where the card cannot be reached."""
        if self._reading is None:
            raise UserError(self.lost)
        return self._reading

    # --- its course -------------------------------------------------------------------

    def open(self, say: Say, now_s: float) -> None:
        """Open the session of the machine, set up or bare; without it `lost` says why.

        A stop that waits breaks it off: it is tried again once the stop is over.
        """
        try:
            self.session = self.installation.open(say, self.is_awaited)
        except StopWaitsError:
            self.installation.is_agreed = self.installation.is_virtual
            self.wait(now_s)
            if not self.is_ending:
                self._note(BROKEN_OFF)
            return
        except (OpenacrError, *LINK_ERRORS) as error:
            self.lose(reason(error), now_s)
            self.installation.pace.begin(now_s)
            return
        self._note("")
        self._reading = Reading(self.session, self.read)
        self._base_ms = self.tick_ms
        self.installation.pace.begin(now_s)

    def drop(self) -> MillSession | None:
        """Part from the session, which the caller closes."""
        session, self.session, self._reading = self.session, None, None
        return session

    def lose(self, why: str, now_s: float) -> None:
        """Note why there is no session, and when another one is tried."""
        self._note(why)
        self.wait(now_s)

    def wait(self, now_s: float) -> None:
        """Try again in RETRY_S, not before."""
        self.retry_s = now_s + RETRY_S

    def note_poll(self) -> None:
        """The session was polled: note the time of its card."""
        self.tick_ms = self._base_ms + 1000.0 * self.required.machine.now_s

    def _note(self, why: str) -> None:
        """Why there is no session; a change is reported."""
        before, self._reported = self._reported, why
        self.lost = why
        if why != before:
            self.on_change(why)


def reason(error: Exception) -> str:
    """Why a card cannot be reached, as the screens say it."""
    if isinstance(error, LINK_ERRORS):
        return f"NO CARD FOUND ({error})"
    return str(error)
