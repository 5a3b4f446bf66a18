"""Bookmarks of a history: moments worth returning to, with a text, for each branch."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

MOST = 200  # of a branch


class Kind(StrEnum):
    """What a bookmark was set for."""

    ERROR = "error"
    ALARM = "alarm"
    END = "end"
    HAND = "hand"


@dataclass(frozen=True, slots=True)
class Bookmark:
    """A moment of a branch, the end of a tick."""

    tick: int
    kind: Kind
    text: str


class Bookmarks:
    """The bookmarks of all branches, in the order of time."""

    def __init__(self) -> None:
        self._of: dict[int, list[Bookmark]] = {}

    def of(self, branch: int) -> list[Bookmark]:
        """The bookmarks of a branch."""
        return list(self._of.get(branch, ()))

    def add(self, branch: int, bookmark: Bookmark) -> bool:
        """Set a bookmark; False if it is there already.

        Of too many, the oldest that were not set by hand go first.
        """
        present = self._of.setdefault(branch, [])
        if bookmark in present:
            return False
        present.append(bookmark)
        present.sort(key=lambda each: each.tick)
        if len(present) > MOST:
            oldest = (each for each in present if each.kind is not Kind.HAND)
            present.remove(next(oldest, present[0]))
        return True

    def remove(self, branch: int, tick: int) -> None:
        """Remove the bookmarks of a moment."""
        self._of[branch] = [each for each in self.of(branch) if each.tick != tick]

    def fork(self, parent: int, child: int, tick: int) -> None:
        """A branch shares those of its parent up to its fork."""
        self._of[child] = [each for each in self.of(parent) if each.tick <= tick]

    def forget(self, branch: int) -> None:
        """Forget the bookmarks of a branch."""
        self._of.pop(branch, None)
