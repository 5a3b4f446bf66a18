"""What the log says of refused connections: the first ones of a minute, then their number."""

import logging
from collections.abc import Callable

log = logging.getLogger(__name__)
LINES = 5
WINDOW_S = 60.0


class Refusals:
    """Keeps a host that connects again and again from filling the log.

    A minute begins with the first refusal after the last one has ended. Its first LINES refusals
    have a line each; how many had none is said with the first refusal of the next minute.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._ends_s = float("-inf")
        self._count = 0

    def note(self, name: str, why: str) -> None:
        """A connection from `name` was refused; `why` completes the sentence."""
        now_s = self._now_s()
        if now_s >= self._ends_s:
            unlisted = self._count - LINES
            if unlisted > 0:
                log.warning("%d more connections were refused", unlisted)
            self._count, self._ends_s = 0, now_s + WINDOW_S
        self._count += 1
        if self._count <= LINES:
            log.warning("%s refused: %s", name, why)
