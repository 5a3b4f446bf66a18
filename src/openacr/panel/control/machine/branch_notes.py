"""What was so from a tick on, as the panel has noted it, on each branch of a history."""

from bisect import bisect_right
from typing import Generic, Protocol, TypeVar


class Noted(Protocol):
    """What is noted, with the tick from which on it is so."""

    @property
    def tick(self) -> int:
        """The tick."""


T = TypeVar("T", bound=Noted)


def _tick(noted: Noted) -> int:
    return noted.tick


class BranchNotes(Generic[T]):
    """The notes of all branches, at most `most` of each: of more, the older half is forgotten."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._of: dict[int, list[T]] = {}

    def last(self, branch: int) -> T | None:
        """What was noted last."""
        known = self._of.get(branch, [])
        return known[-1] if known else None

    def note(self, branch: int, noted: T) -> None:
        """It is so now."""
        known = self._of.setdefault(branch, [])
        known.append(noted)
        if len(known) > self._most:
            del known[: self._most // 2]

    def at(self, branch: int, tick: int) -> T | None:
        """What was so at a tick; None before the first note."""
        known = self._of.get(branch, [])
        place = bisect_right(known, tick, key=_tick)
        return known[place - 1] if place else None

    def between(self, branch: int, first_tk: int, last_tk: int) -> list[T]:
        """The notes of a part of a branch, with the one before it."""
        known = self._of.get(branch, [])
        begin = max(0, bisect_right(known, first_tk, key=_tick) - 1)
        return known[begin : bisect_right(known, last_tk, key=_tick)]

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before."""
        self._of[branch] = [each for each in self._of.get(parent, []) if each.tick <= tick]

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._of.pop(branch, None)
