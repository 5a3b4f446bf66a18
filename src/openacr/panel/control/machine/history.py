"""A card in this process with its history, as the links of the panel see it.

Links let time pass by `advance`. While time is still they get what the card has printed, and
wait in vain for anything that takes a tick.
"""

import math
from collections.abc import Callable
from typing import Any

from openacr.channels import StreamKind
from openacr.client import Level
from openacr.client.stored import Room
from openacr.controller import Controller
from openacr.debugger.breakpoints import MASTERS, kill_watch, running_watch
from openacr.debugger.calls import PROGRAMS, is_running, name_of
from openacr.errors import UserError
from openacr.panel.control.machine.alarm_log import Alarmed, AlarmLog
from openacr.panel.control.machine.blocks import Block, Blocks
from openacr.panel.control.machine.breakpoints import Breakpoints
from openacr.panel.control.machine.lanes import Lanes
from openacr.panel.control.machine.traffic import Sent
from openacr.timeline import Bookmark, Bookmarks, Branch, Course, Kind, Timeline

MOST_BYTES = 1 << 27  # of memory, for an hour of a machine that is used and some branches
MOST_BRANCHES = 16
OWN = PROGRAMS + MASTERS  # watches of the history; those of breakpoints follow
COARSE_S = 0.5  # of moments as the screens get them while time passes
AWAY = "the card is at a moment of its history without the panel: OPERATE of the timeline goes on"
STILL = "the time of the card is still: RUN of the timeline lets it go on"


class History:
    """The time of a card: it notes what happens, with a bookmark at every error and end."""

    def __init__(self, card: Controller, *, most_bytes: int = MOST_BYTES) -> None:
        self.card = card
        self.timeline = Timeline(card, most_bytes=most_bytes)
        self.timeline.on_fork = self._forked
        self.most_bytes = most_bytes
        self.bookmarks = Bookmarks()
        self.lanes = Lanes(card)
        self.sent = Sent()
        card.streams.on_put = self._note_sent
        self._is_given_input = False
        self.blocks = Blocks()
        self.alarms = AlarmLog()
        self.names = {0: "first"}
        self.is_still = False
        self.is_away = False  # from its links: none is opened
        self.on_note: Callable[[str], None] = lambda _text: None  # a change begins a branch
        self.unmarked: frozenset[int] = frozenset()  # programs of the panel, whose ends count not
        self.own_streams: frozenset[int] = frozenset()  # that the panel has opened
        self._size = (-1, 0)  # tick, bytes
        self.breakpoints = Breakpoints(card, lambda: not (self.is_away or self.timeline.is_past))
        self.breakpoints.on_watches = self.arm
        self.arm()

    # --- the card as links see it -----------------------------------------------------

    @property
    def period_s(self) -> float:
        """Seconds of card time per tick."""
        return self.card.period_s

    @property
    def lived_tk(self) -> int:
        """Ticks since the card was created."""
        return self.card.lived_tk

    @property
    def last_tk(self) -> int:
        """The end of what is known of the present branch."""
        return max(self.timeline.branch.last.tick, self.lived_tk)

    def size_bytes(self, tick: int) -> int:
        """What the history takes in memory, counted again when this tick is another one."""
        if self._size[0] != tick:
            self._size = (
                tick,
                sum(each.size_bytes for each in (self.timeline, self.lanes, self.sent)),
            )
        return self._size[1]

    def open_stream(self, kind: StreamKind) -> int:
        """Open a stream for a new connection; UserError at a moment of the history."""
        if self.is_away:
            raise UserError(AWAY)
        stream = self.card.open_stream(kind)
        self.own_streams |= {stream}
        return stream

    def close_stream(self, stream: int) -> None:
        """Close the stream of an ended connection."""
        self.card.close_stream(stream)

    def receive(self, stream: int, data: bytes) -> None:
        """Process bytes that arrived together."""
        self._is_given_input = True
        try:
            self.card.receive(stream, data)
        finally:
            self._is_given_input = False

    def _note_sent(self, stream: int, data: bytes, is_packet: bool) -> None:
        """The card has written to a host: kept, unless it is of time that is known already."""
        timeline = self.timeline
        if self._is_given_input or timeline.now.order > timeline.branch.last.order:
            self.sent.note(timeline.branch.number, self.lived_tk, stream, data, is_packet)

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""
        return self.card.accepts_input(stream)

    def take_output(self, stream: int) -> bytes:
        """Return the bytes of the next write, empty when there is nothing to send."""
        return self.card.take_output(stream)

    def advance(self, ticks: int) -> None:
        """Let card time pass, unless it is still."""
        end_tk = self.lived_tk + (0 if self.is_still else ticks)
        while self.lived_tk < end_tk:
            if self.timeline.advance(end_tk - self.lived_tk):
                self.attend()
        self.lanes.look(self.timeline.branch.number)

    def pause(self, seconds: float) -> None:
        """Let card time pass [s]; at the end of what has happened it becomes still."""
        left_tk = self.timeline.branch.last.tick - self.lived_tk
        ticks = max(1, round(seconds / self.period_s))
        ends = self.timeline.is_past and left_tk <= ticks
        self.advance(left_tk if ends else ticks)
        if ends:
            self.timeline.advance()  # the last tick, where it has begun
            self.is_still = True

    def read_rows(self, parameters: list[int]) -> list[float]:
        """Several parameters, without time or bytes; CardError for one that does not exist."""
        return [float(self.card.p[parameter]) for parameter in parameters]

    def moment(self) -> Course:
        """The card as it is at this moment, of which copies can be made."""
        return self.timeline.course(self.timeline.branch.number, *[self.timeline.now] * 2)

    @property
    def aliases(self) -> dict[str, str]:
        """The aliases of the card, with what they stand for."""
        written = self.card.system.aliases.nodes.written
        return {name: each.text for name, each in written.items()}

    def texts(self) -> int:
        """A number that is another one where the programs and PLCs have other texts."""
        programs, owners = self.card.system.programs, self.card.system.owners()
        return hash(tuple((k, at.number, at.text) for k in owners for at in programs.lines(k)))

    def rooms(self) -> dict[Level, Room]:
        """The memory of every program and PLC that has some."""
        storage = self.card.system.storage
        return {
            Level.program(n) if n < PROGRAMS else Level.plc(n - PROGRAMS): Room(size, free)
            for n in self.card.system.owners()
            for size, free in [(storage.size(n), storage.free_program(n))]
            if size
        }

    # --- bookmarks --------------------------------------------------------------------

    def mark(self, kind: Kind, text: str) -> None:
        """Set a bookmark at the present tick."""
        self.bookmarks.add(self.timeline.branch.number, Bookmark(self.lived_tk, kind, text))

    def follow(self, path: str, line: int) -> None:
        """Note the block that the part program of the panel is at; line 0: none runs."""
        self.blocks.note(self.timeline.branch.number, Block(self.lived_tk, path, line))

    def note_alarms(self, active: list[dict[str, Any]], so_far: list[dict[str, Any]]) -> None:
        """Note that the alarms of the panel are others now."""
        self.alarms.note(self.timeline.branch.number, Alarmed(self.lived_tk, active, so_far))

    def arm(self) -> None:
        """Have every tick seen in which a program ends or motion is killed, and breakpoints."""
        watches = [running_watch(program) for program in range(PROGRAMS)]
        watches += [kill_watch(master) for master in range(MASTERS)]
        self.card.watch(watches + self.breakpoints.watches())
        self.breakpoints.arm()

    def attend(self) -> None:
        """An event has ended `advance`: hold a program at its breakpoint, set bookmarks."""
        self.breakpoints.attend()
        fired = self.card.take_fired()
        self.breakpoints.fired([place - OWN for place in fired if place >= OWN])
        for place in fired:
            if place < PROGRAMS:
                self._mark_end(place)
            elif place < OWN and self._is_killed(place - PROGRAMS):
                self.mark(Kind.ALARM, f"the motion of MASTER{place - PROGRAMS} is killed")

    def _mark_end(self, program: int) -> None:
        if program in self.unmarked or is_running(self.card, program):
            return
        failure = self.card.executor.threads.failures.get(program)
        if failure is None:
            self.mark(Kind.END, f"{name_of(program)} has ended")
        else:
            self.mark(Kind.ERROR, f"{name_of(program)}: {failure}")

    def _is_killed(self, master: int) -> bool:
        watch = kill_watch(master)
        return bool(self.card.memory.I[watch.row] & watch.mask)

    # --- branches ---------------------------------------------------------------------

    def _forked(self, parent: Branch, branch: Branch) -> None:
        """Another branch has begun: it shares bookmarks; of too many, the oldest is forgotten."""
        self.bookmarks.fork(parent.number, branch.number, self.lived_tk)
        ended_tk = self.lived_tk - bool(self.card.within)  # what a tick has begun may be another
        self.lanes.fork(parent.number, branch.number, ended_tk)
        self.blocks.fork(parent.number, branch.number, ended_tk)
        self.sent.fork(parent.number, branch.number, ended_tk)
        self.alarms.fork(parent.number, branch.number, ended_tk)
        self.names[branch.number] = f"branch {branch.number}"
        if self.is_away:
            at_s = self.timeline.now.tick * self.period_s
            kept = self.names[parent.number]
            self.on_note(f"branch {branch.number} begins at {at_s:.4g} s: {kept} keeps the rest")
        if len(self.timeline.branches) > MOST_BRANCHES:
            others = (each for each in self.timeline.branches if each not in (parent, branch))
            self.forget(next(others).number)

    def forget(self, number: int) -> None:
        """Forget a branch with its bookmarks; UserError for the present one."""
        self.timeline.drop(number)
        self.bookmarks.forget(number)
        self.lanes.forget(number)
        self.blocks.forget(number)
        self.sent.forget(number)
        self.alarms.forget(number)
        self.names.pop(number, None)


def timeline_data(history: History, speed: float) -> dict[str, Any]:
    """The branches and bookmarks; what changes with every tick is in `moment_data`."""
    present = history.timeline.branch
    return {
        "period_s": history.period_s,
        "still": history.is_still,
        "away": history.is_away,
        "speed": None if speed == math.inf else speed,
        "branch": present.number,
        "most_bytes": history.most_bytes,
        "branches": [
            {
                "number": each.number,
                "name": history.names[each.number],
                "parent": each.parent,
                "fork": each.fork.tick if each.fork else None,
                "first": each.first.tick,
                "last": None if each is present else each.last.tick,
            }
            for each in history.timeline.branches
        ],
        "bookmarks": [
            {"tick": each.tick, "kind": each.kind.value, "text": each.text}
            for each in history.bookmarks.of(present.number)
            if each.tick >= present.first.tick
        ],
    }


def moment_data(history: History) -> dict[str, Any]:
    """Where the card is in its history: exactly while time is still, else every half second."""
    coarse_tk = 1 if history.is_still else max(1, round(COARSE_S / history.period_s))
    now, last_tk = history.timeline.now, history.last_tk // coarse_tk * coarse_tk
    number = history.timeline.branch.number
    block = history.blocks.at(number, now.tick) if history.is_away else None
    return {
        "tick": now.tick // coarse_tk * coarse_tk,
        "within": now.within if history.is_still else 0,
        "last": last_tk,
        "bytes": history.size_bytes(last_tk),
        "alarms": history.alarms.shown(number, now.tick) if history.is_away else None,
        "block": None if block is None else {"path": block.path, "line": block.line},
    }
