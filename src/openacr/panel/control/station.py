"""Everything the control thread owns: the machine, the people at its screens, and their parts.

`step` does what is due at a time that the caller gives: no clock is read here, so that tests
drive it by hand.
"""

import logging
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial

from openacr.client import ConnectionLostError
from openacr.errors import OpenacrError
from openacr.mill.card.alarms import CONTROL_FAILED, Alarm, AlarmError
from openacr.mill.card.driver import LINK_ERRORS
from openacr.panel.control.engineer.captures import Captures
from openacr.panel.control.engineer.drives import Drives
from openacr.panel.control.engineer.gain_sets import GainSets
from openacr.panel.control.engineer.on_card import OnCard
from openacr.panel.control.engineer.records import Records
from openacr.panel.control.engineer.scope import Samples
from openacr.panel.control.engineer.sources import Sources
from openacr.panel.control.engineer.terminal import Terminals
from openacr.panel.control.engineer.tuning import Tuning
from openacr.panel.control.engineer.watches import Watches
from openacr.panel.control.engineer.world import WorldPane
from openacr.panel.control.facts import Facts, MachineFacts, alarm_data
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.jobs import Jobs
from openacr.panel.control.machine.about import machine_data
from openacr.panel.control.machine.failures import Failures
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.lamp import Lamp
from openacr.panel.control.machine.link import Link, reason
from openacr.panel.control.machine.snapshot import Snapshot, Ticks
from openacr.panel.control.operator.buttons import Buttons
from openacr.panel.control.operator.card_jogs import CardJogs
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.orders import LATER, Order, failure
from openacr.panel.control.operator.part import Part
from openacr.panel.control.operator.people import People, Person
from openacr.panel.control.operator.presses import End
from openacr.panel.control.operator.typed import Typed
from openacr.panel.control.screens import Screens
from openacr.panel.control.settings import StoredSettings
from openacr.panel.control.stopping import Stopping
from openacr.panel.control.times import Around, Times
from openacr.panel.roles import Role
from openacr.timeline import Kind

log = logging.getLogger(__name__)
SNAPSHOT_S = 0.04
KEEP = "jog.keep"  # comes many times a second
SERVER = Person(0, Role.SERVICE, "", "server")
Carry = Callable[["Station", Order, float], object]


class Station:
    """One machine and the people at its screens."""

    def __init__(self, installation: Installation, carry_out: Carry) -> None:
        self._carry_out = carry_out
        self.on_snapshot: Callable[[], None] = lambda: None  # a new snapshot is there
        self.on_samples: Callable[[int | None, Samples], None] = lambda _to, _samples: None
        self.on_end: Callable[[], None] = lambda: None  # EXIT: the program is to end
        self.installation = installation
        self.link = Link(installation)
        self.screens = Screens(self.link)
        self.people = People()
        self.jobs = Jobs()
        self.ticks = Ticks()
        self.gain_sets = GainSets()
        self.tuning = Tuning(installation, self.jobs, self.screens.tell, self.gain_sets)
        self.card_jogs = CardJogs(self.link, self.screens.say)
        self.interlocks = Interlocks(self.link, self.tuning, self.card_jogs)
        self.settings = StoredSettings(self.link, self.interlocks, self.screens)
        self.hand_motion = HandMotion(self.link, self.ticks, self.card_jogs, self.screens.tell)
        self.stopping = Stopping(self.link, self.tuning)
        self.lamp = Lamp(self.link)
        self.typed = Typed(self.link)
        self.part = Part(self.link, self.jobs)
        self.terminals = Terminals(installation)
        self.on_card = OnCard(installation, self.screens.tell)
        self.drives = Drives(self.link)
        self.world = WorldPane(installation)
        sources = Sources(self.link)
        self.captures = Captures(self.link, sources, self.people, self.screens.say)
        path = installation.store.path
        folder = None if path is None else path.parent
        self.records = Records(sources, self.people, self.screens.say, folder)
        self.buttons = Buttons()
        self.watches = Watches()
        end_all = self.hand_motion.presses.end_all
        around = Around(
            release=partial(end_all, End.STOP),
            leave=self.close,
            enter=lambda: self.open(self.now_s),
            moved=self._moved,
        )
        self.times = Times(self.link, self.interlocks, around)
        self.facts = self._facts()
        if installation.history is not None:
            installation.history.on_note = self.screens.say
            installation.history.breakpoints.on_note = self.screens.say
        self._failures = Failures(self.link, partial(end_all, End.ALARM))
        self.snapshot = Snapshot(number=0, tick_ms=0.0, read_s=0.0)
        self.now_s = 0.0  # of the present step or order
        self.stopped_s = 0.0  # when the last stop was received
        self._poll_at = self._snapshot_at = 0.0  # on the clock of the pace
        self._shown_at = 0.0  # while time is still
        self._texts: int | None = None  # of the programs at the moment that is shown
        self._alarms = 0
        self._noted_alarms: tuple[int, list[Alarm]] = (0, [])

    def _facts(self) -> Facts:
        of_machine = MachineFacts(self.link, self.part, self.people)
        makers = {
            "machine": lambda: machine_data(self.installation),
            "state": of_machine.state,
            "stopped": self.stopping.data,
            "lamp": self.lamp.data,
            "program": self.part.data,
            "modals": of_machine.modals,
            "alarms": of_machine.alarms,
            "messages": of_machine.messages,
            "control": self.people.data,
            "overrides": of_machine.overrides,
            "mdi": self.typed.data,
            "home": of_machine.home,
            "timeline": self.times.timeline,
            "moment": self.times.moment,
            "breakpoints": self.on_card.breakpoints,
            "record": self.records.data,
            "forced": self.world.forced,
        }
        own = {"scope": self.captures.data}
        return Facts(makers, own, lambda: self.people.clients, self.screens.tell)

    # --- the session of the machine ---------------------------------------------------

    def open(self, now_s: float) -> None:
        """Open the session of the machine, set up or bare; without it the screens say why."""
        self.settings.must_renew = False  # before they are read: what is stored then counts
        self.stopping.leave()
        self.link.open(self.screens.say, now_s)
        if self.link.session is None:
            self.facts.tell()
            return
        if self.link.session.is_set_up:
            self.stopping.end()
        self.times.watch_own()
        self._poll_at = self._snapshot_at = 0.0
        self._alarms = 0
        self._noted_alarms = -1, []

    def close(self) -> None:
        """Close the session: axes that move are brought to rest by the caller before."""
        self.times.wake(self.now_s)  # it takes some ticks
        self._texts = None
        session = self.link.drop()
        self.typed.forget()
        self.card_jogs.end()
        self.terminals.end()
        self.on_card.end()
        self.drives.end()
        self.stopping.end()
        self.lamp.end()
        self.captures.stop()
        self.records.end()
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
        self.link.required.hand_over()
        self.typed.forget()
        self.installation.is_agreed, self.installation.lacks = False, why
        self.screens.say(f"{why}: SET UP gives the axes back to AcroMill")

    def renew(self, now_s: float) -> None:
        """Open the session again, with the settings as they are stored now."""
        self.hand_motion.presses.end_all(End.MODE, "the machine is set up again")
        self.close()
        self.link.lost = "the machine is being set up"
        self.open(now_s)

    def lose(self, why: str, now_s: float) -> None:
        """The card is out of reach: the session ends, and another one is tried."""
        self.screens.guarded(lambda: self.hand_motion.presses.end_all(End.LINK, why))
        self.close()
        self.link.lose(why, now_s)
        self.facts.tell()

    # --- one step ---------------------------------------------------------------------

    def step(self, now_s: float) -> None:
        """Do what is due: keys, time of the card, a poll, a snapshot."""
        self.now_s = now_s
        self.screens.guarded(lambda: self.hand_motion.expire(now_s))
        self.jobs.poll()
        self.part.rehearse_on()
        if self.link.is_away or (self.link.is_still and self.link.session is not None):
            self._stand(now_s)
        elif self.link.session is None:
            self._try_again(now_s)
        elif self.link.session.runner.is_out_of_reach:
            self.lose("the card does not answer", now_s)
        else:
            self._operate(now_s)

    def _stand(self, now_s: float) -> None:
        """Show the card while it is not operated: its time is still, or it is in the past."""
        if self.link.is_away:
            self.installation.pace.advance(self.times.history, now_s)
        self._print()
        if now_s >= self._shown_at:
            self._shown_at = now_s + SNAPSHOT_S
            number = self.snapshot.number + 1
            if self.link.is_away:
                self._show(self.times.snapshot(number, self.link.tick_ms, now_s), now_s)
            else:
                self._show(replace(self.snapshot, number=number, read_s=now_s), now_s)

    def _try_again(self, now_s: float) -> None:
        """Open the session where it is time; a stop has to be over."""
        if self.installation.history is not None:  # a card lives without its host
            self.installation.pace.advance(self.installation.history, now_s)
        self.screens.guarded(lambda: self.stopping.step(now_s))
        self.facts.tell()
        is_due = now_s >= self.link.retry_s
        if is_due and not self.stopping.is_watching and not self.link.is_ending:
            self.open(now_s)

    def _operate(self, now_s: float) -> None:
        session = self.link.required
        try:
            clock = self.installation.pace.advance(session.card, now_s)
            self.captures.step(session, now_s)
            self.records.step(session, now_s)
            if clock >= self._poll_at:
                self._poll_at = clock + session.poll_in_s
                self._poll(now_s)
            if clock >= self._snapshot_at:
                self._snapshot_at = clock + SNAPSHOT_S * self.installation.pace.speed
                self._sample(now_s)
            self.screens.guarded(self.hand_motion.step)
            self.on_card.step(now_s)
            self.drives.step(now_s)
            self.tuning.step(now_s)
            self.screens.guarded(lambda: self.stopping.step(now_s))
        except LINK_ERRORS as lost:
            log.info("%s", lost)
        if self.installation.waits_for_rest and now_s >= self.link.retry_s:
            self.link.wait(now_s)
            self.screens.guarded(self._set_up_at_rest)
        if self.interlocks.rests:
            self.settings.store_kept()
            if self.settings.must_renew:
                self.renew(now_s)

    def _set_up_at_rest(self) -> None:
        """Set a card up that moved when it was opened; a stop has to be over, and nothing held."""
        session = self.link.session
        if session is None or self.stopping.is_watching or self.stopping.holds:
            return
        if self.installation.rests(session):
            self.renew(self.now_s)

    def _poll(self, now_s: float) -> None:
        session, was_under_way = self.link.required, self.part.executing.is_under_way
        try:
            session.poll()
            self.screens.guarded(self.typed.poll)
            if was_under_way and not self.part.executing.is_under_way:
                self.times.mark(Kind.END, f"{self.part.name} has ended")
            self.screens.guarded(self.part.poll)
            self.times.follow(self.part.path, self.part.line)
            self._print()
        except AlarmError as error:  # another program has taken the machine
            self.lose(str(error), now_s)
            return
        except LINK_ERRORS as error:
            if not session.is_set_up:  # else the runner counts what is lost
                self.lose(reason(error), now_s)
                return
            raise
        self.link.note_poll()
        alarms = session.runner.alarms
        if (alarms.raised, alarms.active) != self._noted_alarms:
            self._noted_alarms = alarms.raised, alarms.active
            self.times.note_alarms(
                [alarm_data(each) for each in alarms.active],
                [alarm_data(each) for each in alarms.history],
            )
        if alarms.raised != self._alarms:
            self._alarms = alarms.raised
            last = alarms.history[-1].text if alarms.history else ""
            self.times.mark(Kind.ALARM, last)
            self.screens.guarded(lambda: self.hand_motion.presses.end_all(End.ALARM, last))
        self._failures.forget()

    def fail(self, cause: str, *, is_new: bool) -> None:
        """A step has failed: what moves ends; a cause that is not the last one again is said."""
        try:
            self.times.wake(self.now_s)
            self._failures.note(cause, self.now_s)
        finally:
            if is_new:
                self.screens.say(CONTROL_FAILED.text.format(cause))
            self.facts.tell()

    # --- what is shown ----------------------------------------------------------------

    def _moved(self) -> None:
        """The card is at another moment: all values are reported again."""
        self._shown_at = 0.0
        self.captures.stop()
        self.records.end()
        self.watches.renew()
        self.installation.pace.begin(self.now_s)
        texts = self.times.history.texts()
        if texts != self._texts:
            self._texts = texts
            self.on_card.programs.texts_changed("")

    def _print(self) -> None:
        """What the card has printed on its terminals."""
        for number, client, text in self.terminals.printed():
            self.screens.tell({"event": "term", "terminal": number, "text": text, "to": client})

    def _sample(self, now_s: float) -> None:
        number, tick_ms = self.snapshot.number + 1, self.link.tick_ms
        left_s, line = self.part.left_s(), self.part.line
        self._show(self.link.reading.snapshot(number, tick_ms, now_s, left_s, line), now_s)

    def _show(self, snapshot: Snapshot, now_s: float) -> None:
        self.ticks.note(snapshot.tick_ms, now_s)
        self.snapshot = snapshot
        self.on_snapshot()
        for to, samples in self.captures.samples():
            self.on_samples(to, samples)
        self.records.collect()
        self.facts.tell()
        if self.link.session is not None or self.link.is_away:
            self.watches.look(self.link.read, now_s, is_past=self.link.is_away)
            self.on_card.look(self.link.read, now_s)
            self.lamp.look(now_s)
        self.world.look(now_s)

    # --- orders and people ------------------------------------------------------------

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
            self.facts.tell()

    def load_sample(self) -> None:
        """Load the sample part, where the machine has one."""
        name = self.installation.sample
        if name:
            file = self.installation.programs / name
            order = Order(SERVER, "program.load")
            self.part.load(file, name, order, kind="file", dialect="")

    def join(self, person: Person) -> None:
        """A browser has connected: it gets all facts."""
        self.people.join(person)
        to = person.client
        for event in self.facts.all():
            control = {"you": self.people.holder == to} if event["event"] == "control" else {}
            self.screens.tell({**event, **control, "to": to})
        self.screens.tell({"event": "says", "lines": list(self.screens.said), "to": to})

    def leave(self, client: int) -> None:
        """A browser has gone: what it held stops."""
        guarded, session = self.screens.guarded, self.link.session
        guarded(lambda: self.hand_motion.presses.end_all(End.LINK, client=client))
        self.hand_motion.presses.forget(client)
        self.watches.forget(client)
        self.on_card.forget(client)
        self.world.watchers.forget(client)
        guarded(lambda: self.tuning.leave(client, session))
        self.terminals.leave(client)
        guarded(lambda: self.buttons.drop(session, client))
        self.people.leave(client)
        self.facts.tell()
