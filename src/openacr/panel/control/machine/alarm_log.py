"""Which alarms were active, and had been, on each branch of the history of a card."""

from bisect import bisect_right
from typing import Any, NamedTuple

MOST = 2000  # changes of a branch; of more, the older half is forgotten
Data = dict[str, Any]


class Alarmed(NamedTuple):
    """The alarms from a tick on, as the screens get them: those that are active, all so far."""

    tick: int
    active: list[Data]
    history: list[Data]


def _tick(alarmed: Alarmed) -> int:
    return alarmed.tick


class AlarmLog:
    """The alarms of all branches, as the panel has noted them at its polls."""

    def __init__(self) -> None:
        self._of: dict[int, list[Alarmed]] = {}

    def note(self, branch: int, alarmed: Alarmed) -> None:
        """The alarms are others now."""
        known = self._of.setdefault(branch, [])
        known.append(alarmed)
        if len(known) > MOST:
            del known[: MOST // 2]

    def at(self, branch: int, tick: int) -> Data:
        """The alarms at a tick; none before the first that is known."""
        known = self._of.get(branch, [])
        place = bisect_right(known, tick, key=_tick)
        found = known[place - 1] if place else Alarmed(tick, [], [])
        return {"active": found.active, "history": found.history}

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before."""
        self._of[branch] = [each for each in self._of.get(parent, []) if each.tick <= tick]

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._of.pop(branch, None)
