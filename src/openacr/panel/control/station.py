"""Everything the control thread owns: the machine, its operators, what they hold.

`step` does what is due at a time that the caller gives: no clock is read here, so that tests
drive it by hand.
"""

import logging
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

from openacr.client import ConnectionLostError
from openacr.errors import OpenacrError
from openacr.mill.card.alarms import CONTROL_FAILED, AlarmError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.run.lifecycle import State
from openacr.panel.control.buttons import Buttons
from openacr.panel.control.facts import Facts
from openacr.panel.control.failures import Failures
from openacr.panel.control.hand_motion import HandMotion
from openacr.panel.control.installation import Installation
from openacr.panel.control.later import LATER
from openacr.panel.control.on_card import OnCard
from openacr.panel.control.orders import Order, failure
from openacr.panel.control.pace import Sampler
from openacr.panel.control.part import Part
from openacr.panel.control.people import Person
from openacr.panel.control.presses import End
from openacr.panel.control.reading import Reading
from openacr.panel.control.scope import Samples
from openacr.panel.control.settled import is_of_session
from openacr.panel.control.shared import Shared, Tell
from openacr.panel.control.snapshot import Snapshot
from openacr.panel.control.terminal import Terminal
from openacr.panel.control.typed import Typed
from openacr.panel.control.watches import Watches
from openacr.panel.roles import Role
from openacr.sysvar.tabs import CELLS

log = logging.getLogger(__name__)
SNAPSHOT_S = 0.04
RETRY_S = 2.0  # between two attempts to reach a card
KEEP = "jog.keep"  # comes many times a second
LINES_KEPT = 200  # of the print window

OF_A_RUN = range(CELLS.tool_selected, CELLS.cycle_direction + 1)  # written as a program runs
MOST_CELLS = 2000  # numbers of changed cells in one event
SERVER = Person(0, Role.SERVICE, "", "server")
Carry = Callable[["Station", Order, float], object]


class Station(Shared):
    """One machine and the people at its screens."""

    def __init__(
        self, installation: Installation, carry_out: Carry, tell: Tell = lambda _event: None
    ) -> None:
        super().__init__(installation, tell)
        self.sampled: Callable[[Samples], None] = lambda _samples: None
        self.on_snapshot: Callable[[], None] = lambda: None  # a new snapshot is there
        self.on_link: Callable[[str], None] = lambda _why: None  # lost, or found again ("")
        self.on_end: Callable[[], None] = lambda: None  # EXIT: the program is to end
        self.hand_motion = HandMotion(self)
        self.typed = Typed(self)
        self.part = Part(self)
        self.terminal = Terminal(installation)
        self.on_card = OnCard(installation, lambda event: self.tell(event))
        self.buttons = Buttons()
        self.watches = Watches()
        self.said: deque[dict[str, Any]] = deque(maxlen=LINES_KEPT)
        self.snapshot = Snapshot(number=0, tick_ms=0.0, read_s=0.0)
        self._kept: dict[int, float] = {}  # settings of motion that are stored at rest
        self._link = ""  # as `on_link` was called last
        self.now_s = 0.0  # of the present step or order
        self.stopped_s = 0.0  # when the last stop was received
        self.must_renew = False  # settings were stored that count from the next session
        self._facts = Facts(self, self.part, self.typed)
        self._failures = Failures(self, partial(self.hand_motion.presses.end_all, End.ALARM))
        self._carry_out = carry_out
        self._retry_s = 0.0
        self._poll_at = self._snapshot_at = 0.0
        self._tick_ms = self._tick_base_ms = 0.0
        self._alarms = 0

    # --- the session ------------------------------------------------------------------

    def open(self, now_s: float) -> None:
        """Open the session of the machine; without it the screens say why."""
        self.must_renew = False  # before the settings are read: what is stored then counts
        try:
            self.session = self.installation.open(self.say)
        except (OpenacrError, *LINK_ERRORS) as error:
            self._note_link(_why(error))
            self._retry_s = now_s + RETRY_S
            self._facts.tell()
            return
        self._note_link("")
        self._reading = Reading(self.session)
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
        session, self.session, self._reading = self.session, None, None
        self.typed.forget()
        self.terminal.end()
        self.on_card.end()
        self.scope.stop()
        if session is not None:
            with suppress(*LINK_ERRORS):
                session.close()

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
        if self.session is None:
            if now_s >= self._retry_s:
                self.open(now_s)
            return
        if self.session.runner.is_out_of_reach:
            self._lose("the card does not answer", now_s)
            return
        try:
            clock = self.installation.pace.advance(self.session.card, now_s, self._sampler())
            if clock >= self._poll_at:
                self._poll_at = clock + self.session.poll_in_s
                self._poll(now_s)
            if clock >= self._snapshot_at:
                self._snapshot_at = clock + SNAPSHOT_S
                self._sample(now_s)
            self.on_card.step(now_s)
        except LINK_ERRORS as lost:
            log.info("%s", lost)
        if self.session is not None and self._rests:
            self._store_kept()
            if self.must_renew:
                self.renew(now_s)

    def _poll(self, now_s: float) -> None:
        session = self.machine
        try:
            session.poll()
            self._guarded(self.typed.poll)
            self._guarded(self.part.poll)
            self._print()
        except AlarmError as error:  # another program has taken the machine
            self._lose(str(error), now_s)
            return
        self._tick_ms = self._tick_base_ms + 1000.0 * session.machine.now_s
        if len(session.runner.alarms.history) != self._alarms:
            self._alarms = len(session.runner.alarms.history)
            self._guarded(lambda: self.hand_motion.presses.end_all(End.ALARM, self._last_alarm()))
        self._failures.forget()

    def _last_alarm(self) -> str:
        history = self.machine.runner.alarms.history
        return history[-1].text if history else ""

    def _sampler(self) -> Sampler | None:
        """What the scope does at each of its samples; None while it is off."""
        capture = self.scope.capture
        if capture is None or capture.is_over or self.session is None:
            return None
        controller, session, parameters = (
            self.installation.controller,
            self.session,
            capture.parameters,
        )
        if controller is None:
            return capture.period_s, lambda: self.scope.add(session.machine.read_rows(parameters))
        view = controller.p
        return capture.period_s, lambda: self.scope.add([float(view[p]) for p in parameters])

    def _print(self) -> None:
        """What the terminal of the card has printed."""
        text = self.terminal.poll() if self.terminal.clients else ""
        if text:
            for client in self.terminal.clients:
                self.tell({"event": "term", "text": text, "to": client})

    def _sample(self, now_s: float) -> None:
        number, left_s = self.snapshot.number + 1, self.part.left_s()
        snapshot = self.reading.snapshot(number, self._tick_ms, now_s, left_s, self.part.line)
        self.ticks.note(snapshot.tick_ms, now_s)
        self.snapshot = snapshot
        self.on_snapshot()
        if (samples := self.scope.take()) is not None:
            self.sampled(samples)
        self._facts.tell()
        if self.session is not None:
            self.watches.look(self.session, now_s)
            self.on_card.look(self.session, now_s)

    @property
    def _rests(self) -> bool:
        session = self.machine
        return not session.runner.is_busy and session.runner.state is State.IDLE

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
            self._failures.note(cause, self.now_s)
        finally:
            if is_new:
                self.say(CONTROL_FAILED.text.format(cause))
            self._facts.tell()

    # --- settings ---------------------------------------------------------------------

    def note_stored(self, cells: frozenset[int]) -> None:
        """Cells were stored: the session of the machine is opened again where they count."""
        if any(map(is_of_session, cells)):
            self.must_renew = True
        shown = sorted(n for n in cells if n not in OF_A_RUN)
        if shown:
            self.tell({"event": "changed", "what": "forms", "cells": shown[:MOST_CELLS]})

    def store_at_rest(self, cell: int, value: float) -> None:
        """Store a setting of motion: now, or once the machine rests."""
        self._kept[cell] = value
        if self._rests:
            self._store_kept()

    def _store_kept(self) -> None:
        kept, self._kept = self._kept, {}
        for cell, value in kept.items():
            self._guarded(partial(self.installation.store.write, cell, value))

    def load_sample(self) -> None:
        """Load the sample part, where the machine has one."""
        name = self.installation.sample
        if name:
            file = self.installation.programs / name
            order = Order(SERVER, "program.load")
            self.part.load(file, name, order, kind="file", dialect="")

    # --- orders -----------------------------------------------------------------------

    def order(self, order: Order, now_s: float) -> None:
        """Carry an order out and answer it."""
        self.now_s = now_s
        try:
            result = self._carry_out(self, order, now_s)
        except Exception as error:
            if not isinstance(error, (OpenacrError, ConnectionLostError)):
                log.exception("%s has failed", order.name)
            order.answer({"ok": False, "error": failure(error)})
            return
        if result is not LATER:
            order.answer({"ok": True, "result": result})
        if order.name != KEEP:
            self._facts.tell()

    # --- what is said -----------------------------------------------------------------

    def say(self, text: str) -> None:
        """A line of the machine or of a program, for the print window."""
        event = {"text": text, "at_s": round(self._tick_ms / 1000.0, 3)}
        self.said.append(event)
        self.tell({"event": "say", **event})

    def join(self, person: Person) -> None:
        """A browser has connected: it gets all facts."""
        self.people.join(person)
        to = person.client
        for event in self._facts.all():
            control = {"you": self.people.holder == to} if event["event"] == "control" else {}
            self.tell({**event, **control, "to": to})
        self.tell({"event": "says", "lines": list(self.said), "to": to})

    def leave(self, client: int) -> None:
        """A browser has gone: what it held stops."""
        self._guarded(lambda: self.hand_motion.presses.end_all(End.LINK, client=client))
        self.hand_motion.presses.forget(client)
        self.watches.forget(client)
        self.on_card.forget(client)
        self.terminal.close(client)
        self._guarded(lambda: self.buttons.drop(self.session, client))
        self.people.leave(client)
        self._facts.tell()


def _why(error: Exception) -> str:
    if isinstance(error, LINK_ERRORS):
        return f"NO CARD FOUND ({error})"
    return str(error)
