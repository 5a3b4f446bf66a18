"""When files are checked, and what clients are sent of it.

A check runs in a thread, some time after the last change; questions are answered meanwhile. A
change during a check begins another one after it.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from openacr.editing.document import Document
    from openacr.editing.engine import Engine
    from openacr.editing.symbols import Finding

AFTER_S = 0.1  # without a change
logger = logging.getLogger(__name__)
Publish = Callable[["Path", "Document | None", "list[Finding]"], None]


class Checks:
    """The subjects to check: files, or folders of projects."""

    def __init__(self, engine: Callable[[], Engine], publish: Publish) -> None:
        self.found: dict[Path, list[Finding]] = {}  # of each file, as published last
        self._engine = engine
        self._publish = publish
        self._waiting: dict[Path, asyncio.TimerHandle] = {}
        self._running: set[Path] = set()
        self._again: set[Path] = set()
        self._files: dict[Path, set[Path]] = {}  # files with findings, by subject
        self._tasks: set[asyncio.Task[None]] = set()

    def ask(self, subject: Path, after_s: float = AFTER_S) -> None:
        """Check a subject soon."""
        if subject in self._waiting:
            self._waiting[subject].cancel()
        loop = asyncio.get_running_loop()
        self._waiting[subject] = loop.call_later(after_s, self._begin, subject)

    def _begin(self, subject: Path) -> None:
        self._waiting.pop(subject, None)
        if subject in self._running:
            self._again.add(subject)
            return
        self._running.add(subject)
        task = asyncio.get_running_loop().create_task(self._run(subject))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _run(self, subject: Path) -> None:
        try:
            documents = self._engine().copies()
            found = await asyncio.to_thread(self._engine().findings, subject, documents)
            self._send(subject, found, documents)
        except Exception:  # one check that fails must not end the others
            logger.exception("the check of %s failed", subject)
        finally:
            self._running.discard(subject)
            if subject in self._again:
                self._again.discard(subject)
                self.ask(subject, 0.0)

    def _send(
        self, subject: Path, found: dict[Path, list[Finding]], documents: dict[Path, Document]
    ) -> None:
        gone = self._files.get(subject, set()) - set(found)
        self._files[subject] = set(found)
        for path in gone:
            found[path] = []
        for path, findings in found.items():
            self.found[path] = findings
            self._publish(path, documents.get(path), findings)

    def drop(self, path: Path) -> None:
        """Forget what was found in a file that is closed."""
        if self.found.pop(path, None):
            self._publish(path, None, [])
