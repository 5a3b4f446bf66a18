"""Orders that wait for the control thread: what stops comes first, each sender has a bound."""

from collections import Counter, deque
from collections.abc import Hashable
from threading import Condition
from typing import Generic, TypeVar

T = TypeVar("T")


class Waiting(Generic[T]):
    """Two queues that any thread fills and one thread empties."""

    def __init__(self) -> None:
        self._ready = Condition()
        self._urgent: deque[tuple[T, Hashable]] = deque()
        self._others: deque[tuple[T, Hashable]] = deque()
        self._counts: Counter[Hashable] = Counter()  # what waits of each sender

    def __len__(self) -> int:
        return len(self._urgent) + len(self._others)

    @property
    def is_urgent(self) -> bool:
        """Whether an urgent item waits."""
        return bool(self._urgent)

    def put(
        self, item: T, *, is_urgent: bool = False, sender: Hashable = None, most: int | None = None
    ) -> bool:
        """Add an item; an urgent one is taken before all that are not.

        False, and nothing is added, where `most` of the sender wait already.
        """
        with self._ready:
            if most is not None and self._counts[sender] >= most:
                return False
            self._counts[sender] += 1
            (self._urgent if is_urgent else self._others).append((item, sender))
            self._ready.notify()
            return True

    def take(self, timeout_s: float = 0.0) -> T | None:
        """The next item, for which it waits up to `timeout_s`; None without one."""
        with self._ready:
            if timeout_s and not len(self):
                self._ready.wait(timeout_s)
            for queue in (self._urgent, self._others):
                if queue:
                    item, sender = queue.popleft()
                    self._counts[sender] -= 1
                    if not self._counts[sender]:
                        del self._counts[sender]
                    return item
        return None
