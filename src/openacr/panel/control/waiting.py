"""Orders that wait for the control thread: what stops comes first."""

from collections import deque
from threading import Condition
from typing import Generic, TypeVar

T = TypeVar("T")


class Waiting(Generic[T]):
    """Two queues that any thread fills and one thread empties."""

    def __init__(self) -> None:
        self._ready = Condition()
        self._urgent: deque[T] = deque()
        self._others: deque[T] = deque()

    def __len__(self) -> int:
        return len(self._urgent) + len(self._others)

    @property
    def is_urgent(self) -> bool:
        """Whether an urgent item waits."""
        return bool(self._urgent)

    def put(self, item: T, *, is_urgent: bool = False) -> None:
        """Add an item; an urgent one is taken before all that are not."""
        with self._ready:
            (self._urgent if is_urgent else self._others).append(item)
            self._ready.notify()

    def take(self, timeout_s: float = 0.0) -> T | None:
        """The next item, for which it waits up to `timeout_s`; None without one."""
        with self._ready:
            if timeout_s and not len(self):
                self._ready.wait(timeout_s)
            for queue in (self._urgent, self._others):
                if queue:
                    return queue.popleft()
        return None
