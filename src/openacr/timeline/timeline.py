"""The timeline of a card: go back to any moment, and on from there.

The state of a card depends on its inputs and their ticks alone. A timeline notes the inputs
and keeps the whole state every few simulated seconds; any other moment is reached by living
through the time since the latest keyframe again. An input at a moment in the past begins
another branch; the branch that was left remains as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path

from openacr.controller.controller import Controller
from openacr.controller.player import Player
from openacr.errors import UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.timeline.branch import Branch, Branches
from openacr.timeline.course import Course
from openacr.timeline.keyframe import Base, Keyframe
from openacr.timeline.moment import Moment, moments

KEYFRAME_EVERY_S = 2.0
MOST_BYTES = 1 << 28
_ALL_PROGRAMS = 0xFFFF


class Timeline:
    """The past and the branches of a card; `card` is the card at the present moment.

    Time goes on by `advance`; everything else is done with the card itself, and what it is given
    from outside comes to `note`. Connections are part of the state: at a moment before a host has
    connected, its stream does not exist.
    """

    def __init__(
        self,
        card: Controller,
        *,
        keyframe_every_s: float = KEYFRAME_EVERY_S,
        most_bytes: int = MOST_BYTES,
    ) -> None:
        if card.recorder is not None:
            raise UserError("the card writes a journal already: a timeline needs one without")
        self.card = card
        self._player = Player(card)
        self._every_tk = max(1, round(keyframe_every_s / card.period_s))
        self._most_bytes = most_bytes
        self._base = Base(card.snapshot())
        first = Keyframe(self._base, card, 0)
        self.branches = Branches([Branch(0, Moment(card.lived_tk), [first])])
        self.branch = self.branches[0]  # the present one
        self._entered = 0  # inputs up to now
        self.next_tk = card.lived_tk + self._every_tk  # when a keyframe may be due
        self.on_fork: Callable[[Branch, Branch], None] = lambda _before, _branch: None
        card.recorder = self

    # the present moment

    @property
    def now(self) -> Moment:
        """The present moment."""
        return Moment(self.card.lived_tk, self.card.within)

    @property
    def is_past(self) -> bool:
        """Whether the present branch goes on after the present moment."""
        return self._knows_inputs or self.now.order < self.branch.last.order

    @property
    def size_bytes(self) -> int:
        """What keyframes and inputs take, roughly."""
        return self.branches.size_bytes

    # forward

    def advance(self, ticks: int = 0) -> bool:
        """Advance by a number of ticks, or until an event ends it, and return whether one has.

        From a moment in the past, the inputs that followed come again at their moments.
        """
        end_tk = self.card.lived_tk + ticks
        if self._knows_inputs and self._repeat(end_tk):
            return True
        self.card.advance(end_tk - self.card.lived_tk)
        self._reach()
        return self.card.was_ended

    @property
    def _knows_inputs(self) -> bool:
        """Whether inputs follow on the present branch."""
        return self._entered - self.branch.forgotten < len(self.branch.entries)

    def _repeat(self, end_tk: int) -> bool:
        """Advance to the last known input up to a tick; True if an event ends it before."""
        branch = self.branch
        for moment, place in moments(branch.entries, self._entered - branch.forgotten):
            if moment.tick > end_tk:
                break
            if self._advance_to(moment):
                return True
            if branch.entries[place].what is not Entered.WITHIN:
                with self._without_notes():
                    self._player.apply(branch.entries[place])
            self._entered += 1
        return False

    def _advance_to(self, moment: Moment) -> bool:
        """Advance to a moment of inputs; True if an event ends it, there or before."""
        if self.now == moment:
            return False
        if moment.within:
            return self._advance_within(moment)
        self.card.advance(moment.tick - self.card.lived_tk)
        self._reach()
        return self.card.was_ended

    def _advance_within(self, moment: Moment) -> bool:
        """The same into a tick, with the lines that the caller wants announced."""
        card = self.card
        programs, ask = card.announced
        is_there = wanted = False

        def either(program: int, line: int) -> bool:
            nonlocal is_there, wanted
            present = Moment(card.lived_tk, card.next_statement)
            is_there = present.order >= moment.order
            wanted = ask is not None and bool(programs >> program & 1) and ask(program, line)
            return is_there or wanted

        card.announce_lines(_ALL_PROGRAMS, either)
        try:
            card.advance(moment.tick - card.lived_tk)
        finally:
            card.announce_lines(programs, ask)
        self._reach()
        return wanted if is_there else card.was_ended

    def _reach(self) -> None:
        tick, last = self.card.lived_tk, self.branch.last  # at every step of the clock
        if tick > last.tick or (tick == last.tick and self.now.order > last.order):
            self.branch.last = self.now

    def foresee(self, entries: Sequence[JournalEntry], last_tk: int) -> None:
        """Let inputs of a journal come at their moments, up to a tick; from here they are known.

        UserError unless the present is the first moment of an empty history.
        """
        if self.branch.entries or self.now != self.branch.first:
            raise UserError("a timeline takes a journal at its beginning only")
        for entry in entries:
            if not entry.is_digest:
                self.branch.note(entry)
        self.branch.last = Moment(last_tk)

    # back

    def seek(self, moment: Moment | int) -> None:
        """Go to any moment of the present branch; UserError for one that it does not have.

        What programs print meanwhile is not heard, and what waits to be sent is dropped.
        """
        self._reach()
        moment = _moment(moment)
        self.branch.require(moment)
        with self.card.undisturbed():
            self._return_to(self.branch.keyframe(moment), unless_before=moment)
            self._live_to(moment)
        self.card.streams.discard_output()

    def _return_to(self, keyframe: Keyframe, *, unless_before: Moment) -> None:
        """Take over a keyframe, unless the present is between it and the moment."""
        if Moment(keyframe.tick).order <= self.now.order <= unless_before.order:
            return
        self._take_over(keyframe)

    def _take_over(self, keyframe: Keyframe) -> None:
        self.card.take_over(keyframe.snapshot)
        self._entered = keyframe.entered
        self.next_tk = keyframe.tick + self._every_tk

    def _live_to(self, moment: Moment) -> None:
        branch = self.branch
        place = self._entered - branch.forgotten
        due = takewhile(lambda each: each[0].order <= moment.order, moments(branch.entries, place))
        for _, place in due:
            self._player.play(branch.entries[place])
            self._entered += 1
        self._player.advance_within(moment.tick, moment.within)

    def seek_stop(self, counts: Callable[[], bool] = lambda: True) -> bool:
        """Go back to the last moment at which an event would have ended `advance`.

        Events are those of the watches, the poll and the announced lines that are set now, if
        `counts` says so there. If there is none, the card is at its first moment and the answer
        is False.
        """
        end = self.now
        for keyframe in reversed(self.branch.keyframes):
            if Moment(keyframe.tick).order >= end.order:
                continue
            found = self._last_stop(keyframe, end, counts)
            if found is not None:
                self.seek(found)
                return True
            end = Moment(keyframe.tick)
        self.seek(self.branch.first)
        return False

    def _last_stop(
        self, keyframe: Keyframe, end: Moment, counts: Callable[[], bool]
    ) -> Moment | None:
        self.seek(keyframe.tick)
        found = None
        while self.now.order < end.order:
            ended = self.advance(end.tick - self.card.lived_tk)
            if ended and self.now.order < end.order and counts():
                found = self.now
        return found

    # branches

    def switch(self, number: int) -> None:
        """Go to the last moment of another branch; UserError for one that does not exist."""
        branch = self.branches.named(number)
        self._reach()
        self.branch = branch
        with self.card.undisturbed():
            keyframe = self.branch.keyframe(self.branch.last)
            self._take_over(keyframe)
            self._live_to(self.branch.last)
        self.card.streams.discard_output()

    def drop(self, number: int) -> None:
        """Forget a branch; UserError for the present one and for one that does not exist."""
        branch = self.branches.named(number)
        if branch is self.branch:
            raise UserError(f"branch {number} is the present one: change to another one first")
        self.branches.remove(branch)

    def course(
        self, number: int, first: Moment | int | None = None, last: Moment | int | None = None
    ) -> Course:
        """A branch as plain data, from the latest keyframe before one moment up to another.

        Without moments, all of it; UserError for a branch or a moment that does not exist.
        """
        self._reach()
        branch = self.branches.named(number)
        first = branch.first if first is None else _moment(first)
        last = branch.last if last is None else _moment(last)
        for moment in (first, last):
            branch.require(moment)
        return Course.of(self.card, branch, first, last)

    def save(self, path: Path, *, seen: Callable[[float], None] = lambda part: None) -> None:
        """Write the present branch as a journal; `seen` gets the part that is done, 0 to 1."""
        self.course(self.branch.number).save(path, seen=seen)

    # what the card reports (openacr.controller.inputs.JournalFile)

    def note(self, entry: JournalEntry) -> None:
        """Note an input at the present moment; in the past it begins another branch."""
        now = self.now
        if self._knows_inputs or now.order < self.branch.last.order:
            self.fork()
        self.branch.note(entry)
        self._entered += 1
        self.branch.last = now

    def fork(self) -> None:
        """Begin another branch at the present moment: what followed stays on the one before."""
        self._reach()
        before = self.branch
        self.branch = self.branches.fork(before, self.now, self._entered)
        self.on_fork(before, self.branch)

    def flush(self) -> None:
        """Do nothing: inputs are kept in memory."""

    def mark(self) -> None:
        """Take a keyframe, unless one of time that is lived through again is near enough."""
        tick = self.card.lived_tk
        self.next_tk = self.branch.keyframe(self.now).tick + self._every_tk
        if tick < self.next_tk:
            return
        self.next_tk = tick + self._every_tk
        self.branch.put(Keyframe(self._base, self.card, self._entered))
        self.branches.shorten(self._most_bytes)

    def close(self) -> None:
        """Do nothing: a timeline ends with its process, unless it is saved."""

    @contextmanager
    def _without_notes(self) -> Iterator[None]:
        file, self.card.recorder = self.card.recorder, None
        try:
            yield
        finally:
            self.card.recorder = file


def _moment(place: Moment | int) -> Moment:
    """A moment; of a tick, its end."""
    return Moment(place) if isinstance(place, int) else place
