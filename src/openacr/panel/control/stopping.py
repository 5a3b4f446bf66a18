"""STOP at the screens: an act on the card, and what it has held.

It needs no session: a card that was just found, is being set up or refuses its set-up is stopped
over a connection of its own.
"""

from contextlib import suppress
from typing import Any

from openacr.client import Card, Options
from openacr.client.program_states import PROGRAMS
from openacr.client.standstill import EVERY_S, Standstill, cut_all
from openacr.errors import OpenacrError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.card.stopping import watching
from openacr.mill.config.settings import Settings
from openacr.panel.control.engineer.tuning import Tuning
from openacr.panel.control.machine.link import Link
from openacr.panel.control.machine.opening import connected

HELD_S = 0.5  # between two looks at what is held
BARE_S = 1.0  # longest wait for a card without a session


class Stopping:
    """The last STOP: it goes on until its watch is over and nothing is held by it."""

    def __init__(self, link: Link, tuning: Tuning) -> None:
        self._link, self._tuning = link, tuning
        self._stop: Standstill | None = None
        self._bare: Card | None = None  # where the session has not given the card
        self._is_watched = False
        self._left: set[int] = set()  # axes that moved at the end of the watch
        self._is_held = False
        self._due_s = 0.0
        self._again: bool | None = None  # the stop after a measurement has ended; its `ends`

    # --- the act ----------------------------------------------------------------------

    def stop(self, now_s: float, *, ends: bool) -> list[str]:
        """Stop the card and watch it; what was found to move. A link error: it was not reached."""
        history = self._link.installation.history
        if history is not None and history.is_still:
            return []  # no time passes on the card
        card = self._card()
        settings = Settings(self._link.installation.store)
        session = self._link.session
        is_ours = session is not None and session.runner.is_busy
        measured = self._tuning.moved_axis  # its program ends it, and prints the record
        self._again = None if measured is None else ends
        former, was_held = self._stop, self.holds
        self._stop = Standstill(
            card,
            ends=ends,
            spared=PROGRAMS if measured is not None else {settings.watchdog_program},
            of_host={settings.master} if is_ours else (),
            beside=() if measured is None else (measured,),
        )
        if former is not None and was_held and not ends:  # RESUME goes on with both
            self._stop.masters |= former.masters
            self._stop.programs |= former.programs
            self._stop.axes |= former.axes
        self._stop.look()
        if measured is None:  # asked by a line, which may take its time: after the act
            self._stop.spare(watching(card, settings))
            self._stop.look()
        self._is_watched, self._left, self._is_held = False, set(), False
        self._due_s = now_s + EVERY_S
        return self._stop.found

    def kill(self) -> None:
        """Kill all motion and switch all drives off, over any connection (Ctrl-Z)."""
        cut_all(self._card())

    def _card(self) -> Card:
        session = self._link.session
        if session is not None:
            return session.card
        if self._bare is None:
            options = Options(timeout_s=BARE_S, reconnect_s=0.0)
            self._bare, _ = connected(self._link.installation.target, options, limit_s=BARE_S)
        return self._bare

    # --- its course -------------------------------------------------------------------

    def step(self, now_s: float) -> None:
        """Look again where it is time; never waits longer than the card takes to answer."""
        if self._again is not None and self._tuning.moved_axis is None:
            self.stop(now_s, ends=self._again)
        stop = self._stop
        if stop is None or now_s < self._due_s:
            return
        try:
            stop.card = self._card()
            if not self._is_watched:
                self._due_s = now_s + EVERY_S
                stop.look()
                self._is_watched = stop.is_over
                self._left = set(stop.moving)
                return
            self._due_s = now_s + HELD_S
            self._is_held = stop.still_held()
            self._left &= set(stop.moving)
        except (OpenacrError, *LINK_ERRORS):
            self.end()
            raise
        if not self._is_held and not self._left:
            self.end()

    def allow_motion(self) -> None:
        """Motion is commanded at a screen after the stop: the watch would end it again."""
        stop, self._again = self._stop, None
        if stop is not None and not self._is_watched:
            stop.card = self._card()
            stop.let_begin()
            self._is_watched, self._is_held = True, bool(stop.masters or stop.programs)

    @property
    def is_watching(self) -> bool:
        """Whether motion that begins now is stopped as well."""
        return self._stop is not None and not self._is_watched

    @property
    def holds(self) -> bool:
        """Whether something waits for RESUME."""
        stop = self._stop
        if stop is None or stop.ends:
            return False
        return self._is_held or bool(not self._is_watched and (stop.masters or stop.programs))

    def resume(self) -> None:
        """Go on with the moves and programs of the card that STOP has held."""
        if self._stop is not None:
            self._stop.card = self._card()
            self._stop.resume()
        self.end()

    def leave(self) -> None:
        """Close the connection of its own: a serial line has only one."""
        bare, self._bare = self._bare, None
        if bare is not None:
            with suppress(*LINK_ERRORS):
                bare.close()

    def end(self) -> None:
        """Forget the last stop; what it holds stays held."""
        self._stop = None
        self.leave()

    def data(self) -> dict[str, Any]:
        """What was stopped, whether RESUME goes on with it, and what moves in spite of it."""
        stop = self._stop
        if stop is None:
            return {"found": [], "holds": False, "moving": [], "next": ""}
        left = sorted(self._left) if self._is_watched else []
        return {
            "found": stop.found,
            "holds": self.holds,
            "moving": [self._link.installation.axis_name(axis) for axis in left],
            "next": "stop.estop" if stop.ends else "stop.all",
        }
