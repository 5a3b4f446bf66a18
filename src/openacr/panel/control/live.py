"""The session of a machine and its steps: polls, looks, what follows from them.

`step` does what is due at a time that the caller gives: no clock is read here, so that tests
drive it by hand.
"""

import logging
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

from openacr.errors import OpenacrError
from openacr.mill.card.alarms import CONTROL_FAILED, AlarmError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.run.lifecycle import State
from openacr.panel.control.buttons import Buttons
from openacr.panel.control.captures import Captures
from openacr.panel.control.facts import Facts
from openacr.panel.control.failures import Failures
from openacr.panel.control.hand_motion import HandMotion
from openacr.panel.control.installation import Installation
from openacr.panel.control.lamp import Lamp
from openacr.panel.control.on_card import OnCard
from openacr.panel.control.opening import StopWaitsError
from openacr.panel.control.part import Part
from openacr.panel.control.presses import End
from openacr.panel.control.reading import Reading
from openacr.panel.control.scope import Samples
from openacr.panel.control.shared import Shared, Tell
from openacr.panel.control.snapshot import Snapshot
from openacr.panel.control.stopping import Stopping
from openacr.panel.control.terminal import Terminals
from openacr.panel.control.times import Around, Times
from openacr.panel.control.typed import Typed
from openacr.panel.control.watches import Watches
from openacr.panel.control.world import WorldPane
from openacr.timeline import Kind

log = logging.getLogger(__name__)
SNAPSHOT_S = 0.04
RETRY_S = 2.0  # between two attempts to reach a card
BROKEN_OFF = "a stop came first: the card is opened when it is over"
LINES_KEPT = 200  # of the print window


class Live(Shared):
    """One machine while it is watched: its session, found again when it was lost, and its parts."""

    def __init__(self, installation: Installation, tell: Tell) -> None:
        super().__init__(installation, tell)
        self.sampled: Callable[[Samples], None] = lambda _samples: None
        self.on_snapshot: Callable[[], None] = lambda: None  # a new snapshot is there
        self.on_link: Callable[[str], None] = lambda _why: None  # lost, or found again ("")
        self.on_end: Callable[[], None] = lambda: None  # EXIT: the program is to end
        self.is_awaited: Callable[[], bool] = lambda: False  # a stop or the end waits
        self.hand_motion = HandMotion(self)
        self.stopping = Stopping(self)
        self.lamp = Lamp(self)
        self.typed = Typed(self)
        self.part = Part(self)
        self.terminals = Terminals(installation)
        self.on_card = OnCard(installation, lambda event: self.tell(event))
        self.world = WorldPane(installation)
        self.captures = Captures(self, self.say)
        self.buttons = Buttons()
        self.watches = Watches()
        self.said: deque[dict[str, Any]] = deque(maxlen=LINES_KEPT)
        self.snapshot = Snapshot(number=0, tick_ms=0.0, read_s=0.0)
        self._kept: dict[int, float] = {}  # settings of motion that are stored at rest
        self._link = ""  # as `on_link` was called last
        self.is_ending = False  # the panel ends: no card is opened any more
        self.now_s = 0.0  # of the present step or order
        self.stopped_s = 0.0  # when the last stop was received
        self.must_renew = False  # settings were stored that count from the next session
        self.times = Times(
            self,
            Around(
                release=partial(self.hand_motion.presses.end_all, End.STOP),
                leave=self.close,
                enter=lambda: self.open(self.now_s),
                moved=self._moved,
            ),
        )
        self._facts = Facts(self, self.part, self.typed, self.times, (self.stopping, self.lamp))
        self._failures = Failures(self, partial(self.hand_motion.presses.end_all, End.ALARM))
        self._retry_s = 0.0
        self._poll_at = self._snapshot_at = 0.0  # on the clock of the pace
        self._shown_at = 0.0  # while time is still
        self._tick_ms = self._tick_base_ms = 0.0
        self._alarms = 0

    @property
    def facts(self) -> Mapping[str, dict[str, Any]]:
        """The facts by name, as they were reported last; any thread may read them."""
        return self._facts.reported

    # --- the session ------------------------------------------------------------------

    def open(self, now_s: float) -> None:
        """Open the session of the machine, set up or bare; without it the screens say why.

        A stop that waits breaks it off: it is tried again once the stop is over.
        """
        self.must_renew = False  # before the settings are read: what is stored then counts
        self.stopping.leave()
        try:
            self.session = self.installation.open(self.say, self.is_awaited)
        except StopWaitsError:
            self.installation.is_agreed = self.installation.is_virtual
            self._retry_s = now_s + RETRY_S
            if not self.is_ending:
                self._note_link(BROKEN_OFF)
                self._facts.tell()
            return
        except (OpenacrError, *LINK_ERRORS) as error:
            self._note_link(_why(error))
            self._retry_s = now_s + RETRY_S
            self.installation.pace.begin(now_s)
            self._facts.tell()
            return
        self._note_link("")
        if self.session.is_set_up:
            self.stopping.end()
        self.times.watch_own()
        self._reading = Reading(self.session, self.read)
        self._poll_at = self._snapshot_at = 0.0
        self._tick_base_ms = self._tick_ms
        self._alarms = 0
        self.installation.pace.begin(now_s)

    def _note_link(self, why: str) -> None:
        """Why there is no session; a change is reported."""
        before, self._link = self._link, why
        self.lost = why
        if why != before:
            self.on_link(why)

    def close(self) -> None:
        """Close the session: axes that move are brought to rest by the caller before."""
        self.times.wake(self.now_s)  # it takes some ticks
        session, self.session, self._reading = self.session, None, None
        self.typed.forget()
        self.terminals.end()
        self.on_card.end()
        self.stopping.end()
        self.lamp.end()
        self.captures.stop()
        self.tuning.end()
        if session is not None:
            with suppress(*LINK_ERRORS):
                session.close()

    def set_up(self, now_s: float) -> None:
        """AcroMill may set the card up, and does."""
        self.installation.is_agreed = True
        self.renew(now_s)

    def hand_over(self, why: str) -> None:
        """AcroMill leaves its axes to a program of the card, at rest, until `set_up`."""
        self.hand_motion.presses.end_all(End.MODE, why)
        self.link.hand_over()
        self.typed.forget()
        self.installation.is_agreed, self.installation.lacks = False, why
        self.say(f"{why}: SET UP gives the axes back to AcroMill")

    def renew(self, now_s: float) -> None:
        """Open the session again, with the settings as they are stored now."""
        self.hand_motion.presses.end_all(End.MODE, "the machine is set up again")
        self.close()
        self.lost = "the machine is being set up"
        self.open(now_s)

    # --- one step ---------------------------------------------------------------------

    def step(self, now_s: float) -> None:
        """Do what is due: keys, time of the card, a poll, a snapshot."""
        self.now_s = now_s
        self._guarded(lambda: self.hand_motion.expire(now_s))
        self.jobs.poll()
        self.part.rehearse_on(self.is_awaited)
        if self.times.is_away or (self.times.is_still and self.session is not None):
            self._stand(now_s)
            return
        if self.session is None:
            if self.installation.history is not None:  # a card lives without its host
                self.installation.pace.advance(self.installation.history, now_s)
            self._guarded(lambda: self.stopping.step(now_s))
            self._facts.tell()
            if now_s >= self._retry_s and not self.stopping.is_watching and not self.is_ending:
                self.open(now_s)
            return
        if self.session.runner.is_out_of_reach:
            self._lose("the card does not answer", now_s)
            return
        try:
            clock = self.installation.pace.advance(self.session.card, now_s)
            self.captures.step(self.session, now_s)
            if clock >= self._poll_at:
                self._poll_at = clock + self.session.poll_in_s
                self._poll(now_s)
            if clock >= self._snapshot_at:
                self._snapshot_at = clock + SNAPSHOT_S * self.installation.pace.speed
                self._sample(now_s)
            self.on_card.step(now_s)
            self.tuning.step(now_s)
            self._guarded(lambda: self.stopping.step(now_s))
        except LINK_ERRORS as lost:
            log.info("%s", lost)
        if self.installation.waits_for_rest and now_s >= self._retry_s:
            self._retry_s = now_s + RETRY_S
            self._guarded(self._set_up_at_rest)
        if self._rests:
            self._store_kept()
            if self.must_renew:
                self.renew(now_s)

    def _set_up_at_rest(self) -> None:
        """Set a card up that moved when it was opened; a stop has to be over, and nothing held."""
        session = self.session
        if session is None or self.stopping.is_watching or self.stopping.holds:
            return
        if self.installation.rests(session):
            self.renew(self.now_s)

    def _stand(self, now_s: float) -> None:
        """Show the card while it is not operated: its time is still, or it is in the past."""
        history = self.times.history
        if self.times.is_away:
            self.installation.pace.advance(history, now_s)
        self._print()
        if now_s >= self._shown_at:
            self._shown_at = now_s + SNAPSHOT_S
            number = self.snapshot.number + 1
            if self.times.is_away:
                self._show(self.times.snapshot(number, self._tick_ms, now_s), now_s)
            else:
                self._show(replace(self.snapshot, number=number, read_s=now_s), now_s)

    def _moved(self) -> None:
        """The card is at another moment: all values are reported again."""
        self._shown_at = 0.0
        self.captures.stop()
        self.watches.renew()
        self.installation.pace.begin(self.now_s)

    def _poll(self, now_s: float) -> None:
        session, was_under_way = self.link, self.part.executing.is_under_way
        try:
            session.poll()
            self._guarded(self.typed.poll)
            if was_under_way and not self.part.executing.is_under_way:
                self.times.mark(Kind.END, f"{self.part.name} has ended")
            self._guarded(self.part.poll)
            self._print()
        except AlarmError as error:  # another program has taken the machine
            self._lose(str(error), now_s)
            return
        except LINK_ERRORS as error:
            if not session.is_set_up:  # else the runner counts what is lost
                self._lose(_why(error), now_s)
                return
            raise
        self._tick_ms = self._tick_base_ms + 1000.0 * session.machine.now_s
        if session.runner.alarms.raised != self._alarms:
            self._alarms = session.runner.alarms.raised
            self.times.mark(Kind.ALARM, self._last_alarm())
            self._guarded(lambda: self.hand_motion.presses.end_all(End.ALARM, self._last_alarm()))
        self._failures.forget()

    def _last_alarm(self) -> str:
        history = self.link.runner.alarms.history
        return history[-1].text if history else ""

    def _print(self) -> None:
        """What the card has printed on its terminals."""
        for number, client, text in self.terminals.printed():
            self.tell({"event": "term", "terminal": number, "text": text, "to": client})

    def _sample(self, now_s: float) -> None:
        number, left_s = self.snapshot.number + 1, self.part.left_s()
        self._show(
            self.reading.snapshot(number, self._tick_ms, now_s, left_s, self.part.line), now_s
        )

    def _show(self, snapshot: Snapshot, now_s: float) -> None:
        self.ticks.note(snapshot.tick_ms, now_s)
        self.snapshot = snapshot
        self.on_snapshot()
        for samples in self.captures.samples():
            self.sampled(samples)
        self._facts.tell()
        if self.session is not None or self.times.is_away:
            self.watches.look(self.read, now_s, is_past=self.times.is_away)
            self.on_card.look(self.read, now_s)
            self.lamp.look(now_s)
        self.world.look(now_s)

    @property
    def _rests(self) -> bool:
        if self.session is None:
            return False
        return not self.is_moved and self.session.runner.state is State.IDLE

    def _lose(self, why: str, now_s: float) -> None:
        """The card is out of reach: the session ends, and another one is tried."""
        self._guarded(lambda: self.hand_motion.presses.end_all(End.LINK, why))
        self.close()
        self._note_link(why)
        self._retry_s = now_s + RETRY_S
        self._facts.tell()

    def _guarded(self, do: Callable[[], object]) -> None:
        """Do something whose failure must not end the thread: it is said."""
        try:
            do()
        except (OpenacrError, *LINK_ERRORS) as error:
            self.say(str(error))

    def fail(self, cause: str, *, is_new: bool) -> None:
        """A step has failed: what moves ends; a cause that is not the last one again is said."""
        try:
            self.times.wake(self.now_s)
            self._failures.note(cause, self.now_s)
        finally:
            if is_new:
                self.say(CONTROL_FAILED.text.format(cause))
            self._facts.tell()

    # --- what is kept and said ---------------------------------------------------------

    def _store_kept(self) -> None:
        kept, self._kept = self._kept, {}
        for cell, value in kept.items():
            self._guarded(partial(self.installation.store.write, cell, value))

    def say(self, text: str) -> None:
        """A line of the machine or of a program, for the print window."""
        is_homing = self.session is not None and self.session.runner.state is State.HOMING
        event = {"text": text, "at_s": round(self._tick_ms / 1000.0, 3), "homing": is_homing}
        self.said.append(event)
        self.tell({"event": "say", **event})


def _why(error: Exception) -> str:
    if isinstance(error, LINK_ERRORS):
        return f"NO CARD FOUND ({error})"
    return str(error)
