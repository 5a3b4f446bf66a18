"""Work with a bus that is done a part at a time, between ticks.

Bringing a bus up asks its devices some hundred frames and waits for their states. It is written as
a course of calls, so it runs in a thread of its own, but never at the same time as the card: it
goes on in `advance` only, which returns when a share of time is used up or the work waits. With a
link whose time is given, the same calls give the same frames.
"""

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Generic, TypeVar

from openacr.fieldbus.ethercat.master.port import BusError, Link

T = TypeVar("T")


class _Ended(BaseException):
    """The work is given up; nothing in it is to catch this."""


class InParts(Generic[T]):
    """`work` with a link; it is a link itself, which hands frames on while there is time."""

    def __init__(self, link: Link, work: Callable[[Link], T]) -> None:
        self.name = link.name
        self._link, self._work = link, work
        self._until_s = 0.0
        self._go, self._rest = threading.Semaphore(0), threading.Semaphore(0)
        self._is_ended = False
        self._result: T | None = None
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._run, name=f"bus {link.name}", daemon=True)
        self._thread.start()

    def advance(self, share_s: float) -> bool:
        """Go on for at most `share_s` and a frame; whether the work is done."""
        if self._thread.is_alive():
            self._until_s = self._link.now_s() + share_s
            self._go.release()
            self._rest.acquire()
        return self._result is not None or self._error is not None

    def result(self) -> T:
        """What the work gives once it is done; its error is raised."""
        self._thread.join()
        if self._error is not None:
            raise self._error
        if self._result is None:
            raise BusError(f"the bus {self.name}: bringing it up was given up")
        return self._result

    def end(self) -> None:
        """Give the work up."""
        self._is_ended = True
        self._go.release()
        self._thread.join()

    def _run(self) -> None:
        with suppress(_Ended):
            try:
                self._go_on()
                self._result = self._work(self)
            except Exception as error:  # raised again by `result`
                self._error = error
        self._rest.release()

    def _pass_on(self) -> None:
        """Let the card run until the next part."""
        self._rest.release()
        self._go_on()

    def _go_on(self) -> None:
        self._go.acquire()
        if self._is_ended:
            raise _Ended

    # --- as a link, in the thread of the work -----------------------------------------------

    def exchange(self, frame: bytes) -> bytes | None:
        """Send a frame, in a later part if the share of this one is used up."""
        if self._link.now_s() >= self._until_s:
            self._pass_on()
        return self._link.exchange(frame)

    def now_s(self) -> float:
        """The time of the link."""
        return self._link.now_s()

    def pause(self, seconds: float) -> None:
        """Wait for a later part."""
        end_s = self._link.now_s() + seconds
        while self._link.now_s() < end_s:
            self._pass_on()
