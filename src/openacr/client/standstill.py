"""STOP as one act on a card: everything that moves comes to rest.

Nothing here knows who commands the motion. A look reads masters, axes and programs of the card;
what is found to move is stopped, and again at the next look if a host or a PLC begins anew.
Requests go as packets, which no program and no prompt can delay:

    master in motion       feed hold: it ramps down on its path; `ends`: its moves are dropped,
                           and those that follow killed; then such moves do not begin, and
                           where its host has sent some, all are killed: the kill stays
    running program        PAUSE before its next statement; `ends`: HALT
    jog                    its request ends, then JOG OFF: it ramps down with JOG DEC
    gear, cam              disengaged; a gear ramps down with GEAR DEC
    hand wheel, filter     an axis that moves in spite of all that: HDW OFF, FLT OFF

PLCs are the logic of the machine and go on. An axis moves while its setpoint changes from one
look to the next.
"""

from collections.abc import Collection, Iterator
from contextlib import suppress

from msgspec import Struct

from openacr.client.card import Card
from openacr.client.errors import RefusedError
from openacr.client.program_states import PROGRAMS
from openacr.map.rows import axes
from openacr.map.words import af1, af4, mf1, pf, plf
from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.packets import Packet

WATCH_S = 1.0  # motion that begins again within this time is stopped, too
KILLED_S = 0.5 * WATCH_S  # of it dropped masters stay killed: time for a host to see the kill
EVERY_S = 0.05  # between two looks
FLAG_WORD_BASE, BITS_PER_WORD = 4096, 32
MASTERS, AXES = range(len(mf1.word)), range(len(af1.word))
ROWS = (*mf1.word, *pf.word, *af1.word, *axes.primary_setpoint)
MOVES = mf1.IN_MOTION | mf1.MOVE_BUFFERED
HOLDS = mf1.FEEDHOLDING | mf1.IN_FEEDHOLD | mf1.FEEDHOLD_REQUEST
DROPS = mf1.STOP_ALL_MOVES_REQUEST | mf1.KILL_ALL_MOVES_REQUEST
KNOWN = af1.JOG_ACTIVE | af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE
FOLLOWERS = ("HDW OFF", "FLT OFF")
REQUESTS = (mf1.STOP_ALL_MOVES_REQUEST, mf1.FEEDHOLD_REQUEST, mf1.KILL_ALL_MOVES_REQUEST)


def _flag(word: int, mask: int) -> int:
    """The number of one flag of a word."""
    return (word - FLAG_WORD_BASE) * BITS_PER_WORD + (mask & 0xFFFFFFFF).bit_length() - 1


def _freed(master: int) -> Iterator[Packet]:
    """A master takes moves again."""
    return (ClearBit(_flag(mf1.word[master], request)) for request in REQUESTS)


def cut_all(card: Card) -> None:
    """Kill all motion, end all programs and switch all drives off, moving or not (Ctrl-Z).

    PLCs, which end with it, run again: they are the logic of the machine, such as its brakes. All
    motion is killed before the card is asked which ones run: the answer may be long in coming.
    """
    card.tell(*(SetBit(_flag(word, af4.KILL_ALL_MOTION_REQUEST)) for word in af4.word))
    plcs: list[int] = []
    try:
        flags = card.read_many(plf.word)
        plcs = [n for n, word in enumerate(flags) if int(word) & plf.PLC_RUNNING]
    finally:  # also where the card answers no more: it may still hear
        card.kill_all(disable=True)
    for n in plcs:
        with suppress(RefusedError):  # it has gone on
            card.command(f"RUN PLC{n}", program=0)


class _Seen(Struct, frozen=True):
    """What one look has read."""

    masters: list[int]
    programs: list[int]
    axes: list[int]
    setpoints: list[float]


class Standstill:
    """One STOP of a card: `look` until it `is_over`, then `resume` or forget it.

    `ends`: programs are halted and moves are dropped instead of being held. `spared`: programs
    that watch over the card and go on. `of_host`: masters whose own host knows of this stop:
    they are held as well, but it is the host that goes on with them and clears what bars them.
    `beside`: axes that are left alone, since a spared program brings them to rest.
    """

    def __init__(
        self,
        card: Card,
        *,
        ends: bool = False,
        spared: Collection[int] = (),
        of_host: Collection[int] = (),
        beside: Collection[int] = (),
    ) -> None:
        self.card = card
        self.ends = ends
        self._spared = frozenset(spared)
        self._of_host = frozenset(of_host)
        self._axes = [n for n in AXES if n not in beside]
        self._began_s = card.now_s()
        self._before: list[float] | None = None  # setpoints of the last look
        self._jogged: set[int] = set()  # axes whose jogs were ended before
        self._idle: set[int] = set()  # axes that nothing known moved at the last look
        self._dropped: set[int] = set()  # masters whose moves this stop has killed
        self._held: set[int] = set()  # those whose next moves are taken again, and do not begin
        self.barred: set[int] = set()  # those whose host has sent more: no moves begin any more
        self.masters: set[int] = set()
        self.programs: set[int] = set()
        self.axes: set[int] = set()
        self.moving: tuple[int, ...] = ()

    def spare(self, programs: Collection[int]) -> None:
        """Let these programs go on, and no others: the next look pauses what was spared before."""
        self._spared = frozenset(programs)

    # --- looking ----------------------------------------------------------------------

    def look(self) -> None:
        """Read what moves and stop it; a link error where the card does not answer."""
        seen = self._read()
        packets = [*self._of_programs(seen), *self._of_masters(seen), *self._of_axes(seen)]
        if packets:
            self.card.tell(*packets)
        self._note_moving(seen)
        self._end_jogs(seen)

    def watch(self) -> None:
        """Look for WATCH_S, and let that time pass."""
        self.look()
        while not self.is_over:
            self.card.pause(EVERY_S)
            self.look()

    @property
    def is_over(self) -> bool:
        """Whether the time in which new motion is stopped is over, and all moves may begin."""
        return self._elapsed_s >= WATCH_S and not self._held

    @property
    def _elapsed_s(self) -> float:
        return self.card.now_s() - self._began_s

    @property
    def found(self) -> list[str]:
        """What was stopped, in the words of the card."""
        verb = "halted" if self.ends else "paused"
        return [
            *(f"PROG{n} {verb}" for n in sorted(self.programs)),
            *(f"MASTER{n} {self._done(n)}" for n in sorted(self.masters)),
            *(f"AXIS{n} stopped" for n in sorted(self.axes)),
        ]

    def _done(self, master: int) -> str:
        if master in self.barred:
            return "stopped and barred (its host sent more moves)"
        return "stopped" if self.ends else "held"

    def _read(self) -> _Seen:
        values = iter(self.card.read_many(ROWS))
        masters, programs, flags = (
            [int(next(values)) for _ in part] for part in (MASTERS, PROGRAMS, AXES)
        )
        return _Seen(masters, programs, flags, [float(next(values)) for _ in AXES])

    def _note_moving(self, seen: _Seen) -> None:
        before, self._before = self._before, seen.setpoints
        if before is None:
            return
        pairs = zip(before, seen.setpoints, strict=True)
        changed = {n for n, (old, new) in enumerate(pairs) if old != new}
        self.moving = tuple(n for n in self._axes if n in changed)

    # --- stopping ---------------------------------------------------------------------

    def _of_programs(self, seen: _Seen) -> Iterator[Packet]:
        """PAUSE or HALT; first, so that nothing that was stopped is commanded again."""
        wanted = pf.HALT_REQUEST_FLAG if self.ends else pf.PAUSE_CONTROL
        for n, word in enumerate(seen.programs):
            if word & pf.PROGRAM_RUNNING and not word & wanted and n not in self._spared:
                self.programs.add(n)
                yield SetBit(_flag(pf.word[n], wanted))

    def _of_masters(self, seen: _Seen) -> Iterator[Packet]:
        for n, word in enumerate(seen.masters):
            if n in self._held:
                yield from self._of_held(n, word)
            elif n in self._dropped and not word & MOVES:
                yield from self._of_dropped(n, word)
            elif self.ends and n not in self._of_host:
                if word & MOVES and not word & DROPS:
                    self.masters.add(n)
                    self._dropped.add(n)
                    yield SetBit(_flag(mf1.word[n], mf1.STOP_ALL_MOVES_REQUEST))
            elif word & MOVES and not word & (HOLDS | DROPS):
                self.masters |= {n} - self._of_host
                yield SetBit(_flag(mf1.word[n], mf1.FEEDHOLD_REQUEST))

    def _of_dropped(self, n: int, word: int) -> Iterator[Packet]:
        """A master at rest, its moves killed: later it takes moves again, which do not begin.

        A host that has not seen the kill continues from where its path would be by now: its moves
        would cut across from where the axes rest.
        """
        if self._elapsed_s < KILLED_S:
            return
        self._dropped.discard(n)
        if not word & mf1.START_MOVE_INHIBIT:  # else it is another's, who lets moves begin
            self._held.add(n)
            yield SetBit(_flag(mf1.word[n], mf1.START_MOVE_INHIBIT))
        yield from _freed(n)

    def _of_held(self, n: int, word: int) -> Iterator[Packet]:
        """A master whose host may have sent moves since the kill: then it is killed for good."""
        if word & MOVES and not word & DROPS:
            self.barred.add(n)
            waits = word & mf1.START_MOVE_INHIBIT  # else its host has let them begin: a ramp
            request = mf1.KILL_ALL_MOVES_REQUEST if waits else mf1.STOP_ALL_MOVES_REQUEST
            yield SetBit(_flag(mf1.word[n], request))
        if self._elapsed_s >= WATCH_S:
            self._held.discard(n)
            yield ClearBit(_flag(mf1.word[n], mf1.START_MOVE_INHIBIT))

    def let_begin(self) -> None:
        """Instead of the rest of the watch: moves may begin where masters rest and are not barred.

        A link error where the card does not answer.
        """
        if self._held | self._dropped:
            masters = self._read().masters
            resting = (n for n in self._dropped if not masters[n] & MOVES)
            inhibits = (_flag(mf1.word[n], mf1.START_MOVE_INHIBIT) for n in self._held)
            self.card.tell(*(p for n in resting for p in _freed(n)), *map(ClearBit, inhibits))

    def _of_axes(self, seen: _Seen) -> Iterator[Packet]:
        requests = (af1.JOG_FORWARD, af1.JOG_REVERSE, af1.GEAR_ACTIVATE, af1.CAM_ACTIVATE)
        for n in self._axes:
            for request in requests:
                if seen.axes[n] & request:
                    self.axes.add(n)
                    yield ClearBit(_flag(af1.word[n], request))

    def _end_jogs(self, seen: _Seen) -> None:
        """End what has no flag of its own: jogs to a position, homing, hand wheel, filter."""
        for n in self._axes:
            word = seen.axes[n]
            if word & af1.JOG_ACTIVE and not word & af1.JOG_STOPPING:
                # A hand wheel moves its axis as a jog does, and goes on with the next pulse.
                words = ("JOG OFF", *FOLLOWERS) if n in self._jogged else ("JOG OFF",)
                self._type(n, *words)
                self._jogged.add(n)
        is_path = any(word & MOVES for word in seen.masters)
        idle = [] if is_path else [n for n in AXES if not seen.axes[n] & KNOWN]
        for n in self._idle & set(idle) & set(self.moving):
            self._type(n, *FOLLOWERS)
        self._idle = set(idle)

    def _type(self, axis: int, *commands: str) -> None:
        self.axes.add(axis)
        for command in commands:
            try:
                self.card.command(f"AXIS{axis} {command}", program=0)
            except RefusedError:
                continue  # the next look shows whether the axis still moves

    # --- going on ---------------------------------------------------------------------

    def still_held(self) -> bool:
        """Whether something that this stop has held still waits for `resume`."""
        seen = self._read()
        self._note_moving(seen)
        self.programs = {n for n in self.programs if seen.programs[n] & pf.PAUSE_CONTROL}
        self.masters = {n for n in self.masters if seen.masters[n] & HOLDS}
        return not self.ends and bool(self.programs or self.masters)

    def resume(self) -> None:
        """Go on with the moves and programs that were held; jogs, gears and cams stay off."""
        for n in sorted(self.masters):
            self.card.tell(
                ClearBit(_flag(mf1.word[n], mf1.FEEDHOLD_REQUEST)),
                SetBit(_flag(mf1.word[n], mf1.CYCLE_START_REQUEST)),
            )
        for n in sorted(self.programs):
            self.card.tell(ClearBit(_flag(pf.word[n], pf.PAUSE_CONTROL)))
        self.masters, self.programs = set(), set()
