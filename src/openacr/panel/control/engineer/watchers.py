"""Clients that watch a state as a whole: each gets it at its own rate, when it has changed."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

S = TypeVar("S")
EARLY_S = 0.005  # a look may come as much too early


@dataclass(slots=True)
class _Watcher(Generic[S]):
    every_s: float
    due_s: float = 0.0
    reported: S | None = None


class Watchers(Generic[S]):
    """The clients that watch one state; without any it is not read."""

    def __init__(self, report: Callable[[int, S], None]) -> None:
        self.report = report  # client, state
        self._watchers: dict[int, _Watcher[S]] = {}

    def watch(self, client: int, hz: float) -> None:
        """Tell a client the state, at once and when it has changed."""
        self._watchers[client] = _Watcher(1.0 / hz)

    def forget(self, client: int) -> None:
        """Tell a client no more."""
        self._watchers.pop(client, None)

    @property
    def are_there(self) -> bool:
        """Whether a client watches."""
        return bool(self._watchers)

    def look(self, read: Callable[[], S], now_s: float) -> None:
        """Read the state for those whose time has come, and tell what has changed."""
        due = {c: each for c, each in self._watchers.items() if now_s >= each.due_s - EARLY_S}
        if not due:
            return
        state = read()
        for client, each in due.items():
            each.due_s = max(each.due_s + each.every_s, now_s)
            if each.reported != state:
                each.reported = state
                self.report(client, state)
