"""When files are checked, and what clients are sent of it.

A check runs some time after the last change, of short texts in a thread, of others in a process
(`apart.py`); questions are answered meanwhile. A change during a check begins another one after it.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Sequence
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from openacr.errors import UserError
from openacr.language_server.found import NOTHING, Found, found_by

if TYPE_CHECKING:
    from openacr.editing.document import Document
    from openacr.editing.engine import Engine
    from openacr.editing.symbols import Finding
    from openacr.language_server.apart import Apart

AFTER_S = 0.1  # without a change
LONG_LINES = 2000  # of the open texts of a subject; their check takes a process
LONG_S = 0.1  # CPU time of a check in a thread; the next one takes a process
logger = logging.getLogger(__name__)


class Asking(Protocol):
    """Whose files are checked."""

    machine: tuple[Path | None, str | None]  # store and dialect

    @property
    def engine(self) -> Engine:
        """What knows the texts."""

    def publish(self, path: Path, document: Document | None, found: Found) -> None:
        """Send what was found in a file."""

    def warn(self, text: str) -> None:
        """Say what the user has to know."""


class Checks:
    """The subjects to check: files, or folders of projects."""

    def __init__(self, server: Asking) -> None:
        self._server = server
        self._found: dict[Path, Found] = {}  # of each file, as published last
        self._long: set[Path] = set()  # subjects whose check took long in a thread
        self._refused: set[Path] = set()  # subjects that were not checked, as the user knows
        self._waiting: dict[Path, asyncio.TimerHandle] = {}
        self._running: set[Path] = set()
        self._again: set[Path] = set()
        self._files: dict[Path, set[Path]] = {}  # files with findings, by subject
        self._tasks: set[asyncio.Task[None]] = set()

    @cached_property
    def _apart(self) -> Apart:
        from openacr.language_server.apart import Apart

        return Apart(*self._server.machine)

    def shown(self, path: Path) -> Sequence[Finding]:
        """What the client was sent of a file."""
        found = self._found.get(path)
        return found.shown if found is not None else ()

    def end(self) -> None:
        """End the process of long checks, if one was started."""
        if "_apart" in self.__dict__:
            self._apart.end()

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
            await self.check(subject)
        except Exception:  # one check that fails must not end the others
            logger.exception("the check of %s failed", subject)
        finally:
            self._running.discard(subject)
            if subject in self._again:
                self._again.discard(subject)
                self.ask(subject, 0.0)

    async def check(self, subject: Path) -> None:
        """Check a subject and send what is found, or why it is not checked."""
        try:
            documents = self._server.engine.copies()
            self._send(subject, await self._found_in(subject, documents), documents)
            self._refused.discard(subject)
        except UserError as error:
            logger.warning("%s is not checked: %s", subject, error)
            if subject not in self._refused:
                self._server.warn(f"{subject.name} is not checked until its next change: {error}")
            self._refused.add(subject)

    def is_long(self, subject: Path, documents: dict[Path, Document]) -> bool:
        """Whether the check of a subject is expected to take long."""
        near = (each for path, each in documents.items() if subject in (path, path.parent))
        return subject in self._long or sum(len(each.lines) for each in near) > LONG_LINES

    async def _found_in(self, subject: Path, documents: dict[Path, Document]) -> dict[Path, Found]:
        if self.is_long(subject, documents):
            try:
                await asyncio.to_thread(import_module, "openacr.language_server.apart")
                return await self._apart.found(subject, documents)
            except (OSError, ImportError):  # no process can be started here
                logger.exception("%s is checked beside the answers", subject)
        return await asyncio.to_thread(self._checked_here, subject, documents)

    def _checked_here(self, subject: Path, documents: dict[Path, Document]) -> dict[Path, Found]:
        began_s = time.thread_time()
        found = found_by(self._server.engine, subject, documents)
        if time.thread_time() - began_s > LONG_S:
            self._long.add(subject)
        return found

    def _send(
        self, subject: Path, found: dict[Path, Found], documents: dict[Path, Document]
    ) -> None:
        gone = self._files.get(subject, set()) - set(found)
        self._files[subject] = set(found)
        for path, each in (found | dict.fromkeys(gone, NOTHING)).items():
            self._found[path] = each
            self._server.publish(path, documents.get(path), each)

    def drop(self, path: Path) -> None:
        """Forget what was found in a file that is closed."""
        if self.shown(path):
            self._server.publish(path, None, NOTHING)
        self._found.pop(path, None)
