"""The state of a bus as lines of JSON, for the process that has started the card."""

import asyncio
import json
import os
import signal
import sys
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from openacr.fieldbus.machine.report import BusReport

REPORT_S = 0.25
MOST_TYPED = 4096


class Reported(Protocol):
    """What has a bus."""

    def report(self) -> "BusReport":
        """The state of the bus."""

    def reset_counters(self) -> None:
        """Let its counters begin at 0."""


class Reporting:
    """Lines on standard output, and orders that are heard on standard input, until `end`."""

    def __init__(self, reported: Reported) -> None:
        """Begin, in the running loop of asyncio."""
        self._reported = reported
        self._loop = asyncio.get_running_loop()
        self._task = self._loop.create_task(self._report())
        self._loop.add_reader(sys.stdin.fileno(), self._hear)

    def end(self) -> None:
        """Report no more."""
        self._task.cancel()

    async def _report(self) -> None:
        while True:
            print(f"bus {json.dumps(self._reported.report())}", flush=True)
            await asyncio.sleep(REPORT_S)

    def _hear(self) -> None:
        """A line of the process that started the card; without one the card ends as by Ctrl-C."""
        words = os.read(sys.stdin.fileno(), MOST_TYPED)
        if b"reset" in words:
            self._reported.reset_counters()
        if not words:
            self._loop.remove_reader(sys.stdin.fileno())
            os.kill(os.getpid(), signal.SIGTERM)
