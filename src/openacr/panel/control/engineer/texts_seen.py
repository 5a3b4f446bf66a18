"""Programs that a terminal or another host stores while screens show them: noticed by their memory.

A card in this process is looked at, one over a link is asked (DIM, MEM) on the stream for listings.
Memory of a program that runs changes by its variables and jumps: it counts once it is halted.
"""

from collections.abc import Callable, Mapping
from concurrent.futures import Future

from openacr.client import Level
from openacr.client.stored import Room, rooms
from openacr.errors import UserError
from openacr.panel.control.engineer.conversations import Aside
from openacr.panel.control.machine.installation import Installation

EVERY_S = 2.0  # between two looks
NONE = Room(0, 0)


class TextsSeen:
    """The memory of the programs as it was seen last."""

    def __init__(
        self, installation: Installation, aside: Aside, tell: Callable[[str], None]
    ) -> None:
        self._installation, self._aside, self._tell = installation, aside, tell
        self.known: dict[Level, Room] = {}
        self._due_s = 0.0
        self._asked: Future[dict[Level, Room]] | None = None

    def look(self, now_s: float, halted: Callable[[], set[Level]]) -> None:
        """Look where it is time, and report a program of another size. Never waits."""
        if self._asked is not None and self._asked.done():
            asked, self._asked = self._asked, None
            if not asked.cancelled() and asked.exception() is None:
                self._compare(asked.result(), halted)
        if now_s < self._due_s or self._asked is not None:
            return
        self._due_s = now_s + EVERY_S
        history = self._installation.history
        if history is not None:
            self._compare(history.rooms(), halted)
        elif not self._aside.is_busy:
            try:
                self._asked = self._aside.begin(rooms)
            except UserError:
                return  # a serial port: its texts are not shown

    def forget(self) -> None:
        """The session has ended: what the next one finds is no change."""
        self.known, self._asked, self._due_s = {}, None, 0.0

    def _compare(self, found: Mapping[Level, Room], halted: Callable[[], set[Level]]) -> None:
        known = self.known
        new = {at for at in {*found, *known} if known.get(at, NONE) != found.get(at, NONE)}
        if not new:
            return
        changed = new & halted()
        self.known = known | {at: found.get(at, NONE) for at in changed}
        if known and changed:
            self._tell(str(*changed) if len(changed) == 1 else "")
