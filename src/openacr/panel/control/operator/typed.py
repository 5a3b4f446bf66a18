"""MDI of the panel: blocks wait in a queue and run one after the other."""

from collections import deque
from collections.abc import Iterable
from typing import Any

from openacr.cnc.interpreter.mdi import Mdi
from openacr.errors import OpenacrError, UserError
from openacr.mill.card import alarms
from openacr.mill.config.dialects import dialect_of
from openacr.panel.control.machine.link import Link

MOST_TEXT = 1000  # blocks that were executed and are shown
REFUSALS = frozenset({alarms.NOT_HOMED, alarms.TARGET_BEYOND, alarms.PROGRAM_ERROR})


class Typed:
    """The MDI of one machine."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._mdi: Mdi | None = None
        self._queue: deque[str] = deque()
        self._is_shown = True
        self._kept: tuple[str, int] | None = None  # what runs, and the count of alarms before it
        self.text: list[str] = []  # what was executed, as the operator may edit it
        self.is_buffer_on = True  # whether what is executed becomes part of the text

    def forget(self) -> None:
        """Forget the modal state and what waits: the session is another one."""
        self._mdi = self._kept = None
        self._queue.clear()

    def put(self, blocks: Iterable[str], *, dialect: str = "", is_shown: bool = True) -> None:
        """Run blocks one after the other; all are checked, then the first one is started at once.

        A block that cannot be read is refused with its line and column (BlockError).
        `is_shown`: they become part of the text of MDI, if its buffer is on.
        """
        session = self._link.machine
        if self._mdi is None or self._is_other_program():
            self._mdi = session.mdi(dialect or dialect_of(None, session.cells))
        if self._queue:
            raise UserError("blocks of MDI wait: stop them first")
        first, *rest = blocks
        for number, block in enumerate((first, *rest), 1):
            self._mdi.check(block, number)
        self._is_shown = is_shown
        self._start(first)
        self._queue.extend(rest)

    def _is_other_program(self) -> bool:
        """Whether a program has run since: the modal state begins anew."""
        return not self._link.machine.runner.options.is_mdi

    def _start(self, block: str) -> None:
        session = self._link.machine
        if self._mdi is None:
            return
        session.start_block(self._mdi, block)
        if self._is_shown and self.is_buffer_on:
            self.text.append(block)
            del self.text[:-MOST_TEXT]
            self._kept = block, session.runner.alarms.raised

    def poll(self) -> None:
        """Start the next block when the one before it has ended; an error drops the rest."""
        if not self._queue and self._kept is None:
            return
        runner = self._link.machine.runner
        if runner.is_busy:
            return
        self._take_back(runner.alarms)
        if not self._queue:
            return
        if runner.alarms.bars_start or runner.was_aborted:
            self._queue.clear()
            return
        try:
            self._start(self._queue.popleft())
        except OpenacrError:
            self._queue.clear()
            raise

    def _take_back(self, raised: alarms.Alarms) -> None:
        """Take the last block out of the text if an alarm has refused it."""
        if self._kept is None:
            return
        (block, before), self._kept = self._kept, None
        is_refused = any(alarm.kind in REFUSALS for alarm in raised.since(before))
        if is_refused and self.text[-1:] == [block]:
            self.text.pop()

    def drop(self) -> None:
        """Drop the blocks that wait: the operator has stopped."""
        self._queue.clear()

    def data(self) -> dict[str, Any]:
        """What was typed, and what waits."""
        session = self._link.session
        is_running = (
            session is not None and session.runner.options.is_mdi and session.runner.is_busy
        )
        return {
            "buffer": list(self.text),
            "on": self.is_buffer_on,
            "running": is_running,
            "queue": list(self._queue),
        }
