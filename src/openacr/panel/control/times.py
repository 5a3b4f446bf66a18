"""The time of the card as the screens command it: still, fast or slow, back, in branches.

The panel is one of the hosts of its card, and what it knows of a run is no part of the card.
Before a moment of the history is shown it leaves the card, as at its end; it comes back where the
operator lets the machine be operated from there, and finds the card as after a power cut of a host.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from openacr.debugger.calls import is_running
from openacr.debugger.card_course import CardCourse
from openacr.engine.watches import Watch, Watched
from openacr.errors import UserError
from openacr.map.rows import masters
from openacr.map.words import mf1
from openacr.mill.card.watchdog import FEED_HOLD_REQUEST, FLAGS_PER_MASTER
from openacr.mill.config.settings import Settings
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.machine.history import AWAY, STILL, History, moment_data, timeline_data
from openacr.panel.control.machine.link import Link
from openacr.panel.control.machine.pace import OwnTime, Paced
from openacr.panel.control.machine.place import read_place
from openacr.panel.control.machine.snapshot import Light, Snapshot
from openacr.timeline import Kind

SLOWEST, FASTEST = 0.01, 100.0
LONGEST_S = 10.0  # of card time that a step may take
LONGEST_HOLD_S, HOLD_STEP_S = 10.0, 0.01  # of moves that the panel had under way
NOT_HERE = "the time of this card is its own: only that of a virtual card in the panel can be moved"


@dataclass(frozen=True, slots=True)
class Around:
    """What a station does around a change of the time of its card."""

    release: Callable[[str], None]  # end held keys, with a sentence why
    leave: Callable[[], None]  # close the session of the machine
    enter: Callable[[], None]  # open it again
    moved: Callable[[], None]  # the card is at another moment: all values are reported again


class Times:
    """What moves the time of one card."""

    def __init__(self, link: Link, interlocks: Interlocks, around: Around) -> None:
        self._link, self._interlocks, self._around = link, interlocks, around
        self._settings: Settings | None = None
        self.speed = 1.0

    # --- what others ask --------------------------------------------------------------

    @property
    def history(self) -> History:
        """The history; UserError for a card that is not in this process."""
        history = self._link.installation.history
        if history is None:
            raise UserError(NOT_HERE)
        return history

    @property
    def settings(self) -> Settings | None:
        """The parameters of the machine that AcroMill has set up, or had when the card was left.

        UserError where the card cannot be reached.
        """
        session = self._link.session
        if session is None and not self._link.is_away:
            raise UserError(self._link.lost)
        found = self._settings if session is None else session.runner.settings
        return None if self._link.installation.lacks else found

    def timeline(self) -> dict[str, Any]:
        """The branches and bookmarks of the history, for the screens."""
        history = self._link.installation.history
        if history is None:
            return {"why": NOT_HERE}
        return {"why": "", **timeline_data(history, self.speed)}

    def moment(self) -> dict[str, Any]:
        """Where the card is in its history, for the screens."""
        history = self._link.installation.history
        return {} if history is None else moment_data(history)

    # --- running ----------------------------------------------------------------------

    def pause(self) -> None:
        """Let no more time pass; held keys end. UserError while an axis is measured."""
        history = self.history
        self._interlocks.require_unmeasured()
        if self._link.session is None and not history.is_away:
            raise UserError(self._link.lost)
        self._around.release(STILL)
        history.is_still = True

    def run(self, speed: float, now_s: float) -> None:
        """Let time pass, `speed` times as fast as real; infinite: as fast as it goes. UserError."""
        history = self.history
        if not (SLOWEST <= speed <= FASTEST or speed == math.inf):
            raise UserError(f"speed {speed:g}: {SLOWEST:g} to {FASTEST:g}, or as fast as it goes")
        self.speed = speed
        history.is_still = False
        self._pace.let(speed, now_s)

    def halt(self, now_s: float) -> bool:
        """A stop was received: the machine comes to rest in real time; a moment becomes still.

        True where nothing else has to be stopped.
        """
        history = self._link.installation.history
        if history is None:
            return False
        if history.is_away or self._link.session is None:
            history.is_still = history.is_away = True
            self._link.lost = AWAY
            return True
        if history.is_still or self.speed != 1.0:
            self.run(1.0, now_s)
        return False

    def wake(self, now_s: float) -> None:
        """Let time pass in real time where the panel has to bring its machine to rest."""
        if self._link.is_still and self._link.session is not None:
            self.run(1.0, now_s)

    @property
    def _pace(self) -> Paced:
        pace = self._link.installation.pace
        if isinstance(pace, OwnTime):
            raise UserError(NOT_HERE)
        return pace

    # --- moments ----------------------------------------------------------------------

    def seek(self, tick: int) -> None:
        """Go to a tick of the present branch; UserError for one that it does not have."""
        history = self.history
        first, last = history.timeline.branch.first.tick, history.last_tk
        if not first <= tick <= last:
            raise UserError(f"tick {tick} is not known: from {first} to {last} are")
        self._go_away()
        history.timeline.seek(tick)
        self._around.moved()

    def switch(self, number: int, tick: int | None = None) -> None:
        """Change to another branch, to a tick of it or its end; UserError for an unknown one."""
        timeline = self.history.timeline
        branch = timeline.branches.named(number)
        if tick is not None and not branch.first.tick <= tick <= branch.last.tick:
            raise UserError(
                f"tick {tick} is not known on branch {number}: from {branch.first.tick} to"
                f" {branch.last.tick} are"
            )
        self._go_away()
        timeline.switch(number)
        if tick is not None:
            timeline.seek(tick)
        self._around.moved()

    def branch(self) -> int:
        """Begin another branch at the present moment; its number. UserError at the end of one."""
        timeline = self.history.timeline
        if not timeline.is_past:
            raise UserError("nothing follows here: go back to a moment first")
        timeline.fork()
        return timeline.branch.number

    def write(self, number: int, value: float, *, is_flag: bool) -> None:
        """Set a parameter or flag at a moment of the history; it begins another branch there."""
        card = self.history.card
        if is_flag:
            card.bit[number] = bool(value)
        else:
            card.p[number] = value

    def step(self, what: str, number: int) -> None:
        """Go on by one tick, one line of a program or one move of a master; or a tick back."""
        history = self.history
        if what == "tick" and not history.is_away:
            self.pause()
            step_tick(history)
            return
        self._go_away()
        if what == "tick":
            step_tick(history)
        elif what == "back":
            step_back(history)
        elif what == "line":
            step_line(history, number)
        else:
            step_move(history, number)
        self._around.moved()

    def operate(self, now_s: float) -> None:
        """Operate the machine from the present moment on: what follows there is another branch."""
        history = self.history
        if not history.is_away:
            return
        history.timeline.advance()  # a tick that has begun is completed
        history.is_still = history.is_away = False
        self._end_watchdog()
        for stream in history.card.streams.numbers:
            history.card.close_stream(stream)
        self.run(1.0, now_s)
        self._around.enter()

    def _end_watchdog(self) -> None:
        """End the watchdog of the panel: it would report a host that was lost.

        Moves that the panel had under way are held before, as the watchdog would hold them.
        """
        history = self.history
        running = [each for each in history.unmarked if is_running(history.card, each)]
        if self._settings is None or not running:
            return
        if read_place(self._settings, history.read_rows).is_moving:
            self._hold(self._settings.master)
        for program in running:
            history.card.send(f"SYS\rHALT PROG{program}\r")

    def _hold(self, master: int) -> None:
        """Bring a master to rest on its path by a feed hold, within LONGEST_HOLD_S."""
        history = self.history
        history.card.bit[FEED_HOLD_REQUEST + FLAGS_PER_MASTER * master] = True
        for _ in range(round(LONGEST_HOLD_S / HOLD_STEP_S)):
            history.advance(round(HOLD_STEP_S / history.period_s))
            word = history.card.memory.I[mf1.word[master]]
            if word & mf1.IN_FEEDHOLD or not word & mf1.IN_MOTION:
                return

    def _go_away(self) -> None:
        """Leave the card, and let its time be still; UserError while the panel moves it."""
        history, session = self.history, self._link.session
        if history.is_away:
            history.is_still = True
            return
        self._interlocks.require_unmoved()
        if session is not None:
            self.pause()
        self._settings = None if session is None else session.runner.settings
        try:
            self._around.leave()
        finally:
            history.is_still = True
        history.is_away = True
        self._link.lost = AWAY

    # --- what is shown ----------------------------------------------------------------

    def snapshot(self, number: int, tick_ms: float, now_s: float) -> Snapshot:
        """The machine at a moment of the history: its positions, nothing of a run."""
        settings = self._settings or Settings(self._link.installation.store)
        place = read_place(settings, self.history.read_rows)
        none = (math.nan,) * len(place.commanded)
        return Snapshot(
            number=number,
            tick_ms=tick_ms,
            read_s=now_s,
            lights=Light.BARRED | (Light.MOVING if place.is_moving else 0),
            jogging=place.moving,
            speed_upm=place.speed_upm,
            work=place.commanded,
            commanded=place.commanded,
            actual=place.actual,
            following=place.following,
            to_go=none,
            following_end=none,
        )

    def follow(self, path: str, line: int) -> None:
        """Note the block that the part program is at, where there is a history."""
        history = self._link.installation.history
        if history is not None:
            history.follow(path, line)

    def note_alarms(self, active: list[dict[str, Any]], so_far: list[dict[str, Any]]) -> None:
        """Note that the alarms of the panel are others now, where there is a history."""
        history = self._link.installation.history
        if history is not None:
            history.note_alarms(active, so_far)

    def watch_own(self) -> None:
        """The session is open: its own programs end without a bookmark."""
        history, session = self._link.installation.history, self._link.session
        if history is not None and session is not None:
            history.unmarked = frozenset({session.runner.settings.watchdog_program})

    def mark(self, kind: Kind, text: str) -> None:
        """Set a bookmark at the present tick, where there is a history."""
        history = self._link.installation.history
        if history is not None:
            history.mark(kind, text)


def step_tick(history: History) -> None:
    """Complete the present tick, or let one pass."""
    if history.timeline.advance(0 if history.card.within else 1):
        history.attend()


def step_back(history: History) -> None:
    """Go back to the end of the tick before."""
    history.timeline.seek(history.lived_tk - 1)


def step_line(history: History, program: int) -> None:
    """Go on to the next line of a program; UserError if it does not run or does not reach one."""
    debugger = CardCourse(history.card, timeline=history.timeline)
    debugger.begin_step(program, into=True)
    try:
        stop = debugger.run(_limit_tk(history))
    finally:
        history.arm()
    if stop is None:
        raise UserError(f"PROG{program} waits: it has reached no line in {LONGEST_S:g} s")


def step_move(history: History, master: int) -> None:
    """Go on until a move of a master begins or ends; UserError if none does."""
    moves = masters.head[master]
    history.card.watch(
        [
            Watch(Watched.WORD, moves),
            Watch(Watched.WORD, mf1.word[master], mf1.IN_MOTION),
        ]
    )
    try:
        has_stopped = history.timeline.advance(_limit_tk(history))
    finally:
        history.arm()
    if not has_stopped:
        raise UserError(f"no move of MASTER{master} has begun or ended in {LONGEST_S:g} s")


def _limit_tk(history: History) -> int:
    return round(LONGEST_S / history.period_s)
