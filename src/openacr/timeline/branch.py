"""One course of events of a card: its inputs and, here and there, its whole state."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field

from openacr.errors import UserError
from openacr.journal.entries import JournalEntry
from openacr.timeline.keyframe import Keyframe
from openacr.timeline.moment import Moment

ENTRY_BYTES = 200  # of an input in memory, without its text


def _tick(entry: JournalEntry) -> int:
    return entry.tick


@dataclass
class Branch:
    """A course of events. A branch shares the past before its fork with its parent."""

    number: int
    last: Moment
    keyframes: list[Keyframe]
    entries: list[JournalEntry] = field(default_factory=list)
    forgotten: int = 0  # inputs before the first one of `entries`
    parent: int | None = None
    fork: Moment | None = None
    shared: int = 0  # inputs before the fork
    _text_bytes: int = 0  # of the inputs after it

    @property
    def first(self) -> Moment:
        """The earliest moment that can be returned to."""
        return Moment(self.keyframes[0].tick)

    def require(self, moment: Moment) -> None:
        """UserError for a moment that is not on it."""
        if not self.first.order <= moment.order <= self.last.order:
            raise UserError(
                f"tick {moment.tick} is not on branch {self.number}, which goes from"
                f" {self.first.tick} to {self.last.tick}"
            )

    def forked(self, number: int, at: Moment, entered: int) -> Branch:
        """Another course of events from a moment on, before which `entered` inputs came."""
        return Branch(
            number,
            at,
            self.keyframes[: self._following(at)],
            self.entries[: entered - self.forgotten],
            self.forgotten,
            self.number,
            at,
            entered,
        )

    def note(self, entry: JournalEntry) -> None:
        """Append an input."""
        self.entries.append(entry)
        self._text_bytes += len(entry.text)

    def between(self, first_tk: int, last_tk: int) -> list[JournalEntry]:
        """The inputs from one tick to another, with both."""
        begin = bisect_left(self.entries, first_tk, key=_tick)
        return self.entries[begin : bisect_right(self.entries, last_tk, key=_tick)]

    @property
    def inputs_bytes(self) -> int:
        """What its inputs since the fork take in memory, roughly."""
        own = self.forgotten + len(self.entries) - max(self.shared, self.forgotten)
        return ENTRY_BYTES * own + self._text_bytes

    def keyframe(self, at: Moment) -> Keyframe:
        """The latest keyframe that is not after a moment."""
        return self.keyframes[self._following(at) - 1]

    def _following(self, at: Moment) -> int:
        """Place of the first keyframe after a moment; at least 1."""
        ended_tk = at.tick - 1 if at.within else at.tick
        return max(1, bisect_right(self.keyframes, ended_tk, key=lambda each: each.tick))

    def put(self, keyframe: Keyframe) -> None:
        """Insert a keyframe."""
        self.keyframes.insert(self._following(Moment(keyframe.tick)), keyframe)

    def thin(self) -> bool:
        """Drop every second keyframe of the older half; False if there are too few."""
        middle = len(self.keyframes) // 2
        before = len(self.keyframes)
        del self.keyframes[1:middle:2]
        return len(self.keyframes) < before

    def forget_first(self) -> bool:
        """Let the history begin at the second keyframe; False if there is none."""
        if len(self.keyframes) < 2:
            return False
        del self.keyframes[0]
        dropped = self.keyframes[0].entered - self.forgotten
        own = max(0, self.shared - self.forgotten)
        self._text_bytes -= sum(len(each.text) for each in self.entries[own:dropped])
        del self.entries[:dropped]
        self.forgotten += dropped
        return True


class Branches(list[Branch]):
    """All branches of a history; numbers are not given again."""

    _made = 1

    def named(self, number: int) -> Branch:
        """A branch by its number; UserError for one that does not exist."""
        for branch in self:
            if branch.number == number:
                return branch
        known = ", ".join(str(each.number) for each in self)
        raise UserError(f"there is no branch {number}; known: {known}")

    def fork(self, parent: Branch, at: Moment, entered: int) -> Branch:
        """Add a branch that leaves its parent at a moment, before which `entered` inputs came."""
        branch = parent.forked(self._made, at, entered)
        self._made += 1
        self.append(branch)
        return branch

    @property
    def size_bytes(self) -> int:
        """What keyframes and inputs take in memory, roughly; what is shared counts once."""
        kept = {id(each): each for branch in self for each in branch.keyframes}
        frames = sum(each.size_bytes for each in kept.values())
        return frames + sum(branch.inputs_bytes for branch in self)

    def shorten(self, most_bytes: int) -> None:
        """Thin the keyframes, then forget the beginning, until no more bytes are taken."""
        while self.size_bytes > most_bytes:
            shorter = [branch.thin() for branch in self]
            if not any(shorter):
                shorter = [branch.forget_first() for branch in self]
            if not any(shorter):
                break
