"""Checks of long files in a process of their own, so that keys do not share their interpreter.

A process that dies, or does not answer for long, gives its place to another one.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from openacr.errors import UserError
from openacr.language_server.found import Found, found_anew
from openacr.workers import Background

if TYPE_CHECKING:
    from openacr.editing.document import Document

ATTEMPTS = 2  # at a check
ANSWER_S = 20.0  # then the process is taken for frozen; for what it checked twice as long next time
DIED = "the process that looks for findings has ended; it may lack memory"
FROZEN = "the process that looks for findings does not answer"


class Apart:
    """Checks in one process, one after the other; it is started by the first one."""

    def __init__(self, store: Path | None, dialect: str | None) -> None:
        self._machine = store, dialect
        self._process = Background(DIED)
        self._turn = asyncio.Lock()
        self._frozen: Counter[Path] = Counter()  # how often, by subject

    async def found(self, subject: Path, documents: dict[Path, Document]) -> dict[Path, Found]:
        """What is wrong with a subject, by file; UserError where no process has an answer.

        OSError or ImportError on a computer that cannot start one.
        """
        near = {subject, subject.parent}  # a project or a folder; a file sees its neighbours
        texts = {path: each for path, each in documents.items() if near & {path, path.parent}}
        failure = UserError(DIED)
        async with self._turn:
            for _ in range(ATTEMPTS):
                try:
                    async with asyncio.timeout(self.patience_s(subject)):
                        return await self._process.run(found_anew, self._machine, subject, texts)
                except TimeoutError:
                    self._process.close()
                    self._frozen[subject] += 1
                    failure = UserError(FROZEN)
                except UserError as error:
                    failure = error
        raise failure

    def patience_s(self, subject: Path) -> float:
        """How long the check of a subject may take."""
        return float(ANSWER_S * 2 ** self._frozen[subject])

    def end(self) -> None:
        """End the process, whatever it does."""
        self._process.end()
