"""Links opened beside the control thread, and conversations with a card that a stop breaks off.

A host that does not answer takes seconds; a stop waits for nothing.
"""

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress

from openacr.client import Card, ConnectionLostError, Options
from openacr.client.links import CONNECT_S, Host, Link, ProcessLink, link_to
from openacr.errors import OpenacrError

SLICE_S = 0.01  # between two looks whether a stop waits
GRACE_S = 0.3  # for the end of a conversation that was broken off


class StopWaitsError(OpenacrError):
    """A conversation was broken off: a stop waits for the control thread."""

    def __init__(self) -> None:
        super().__init__("a stop was pressed meanwhile")


class HastyLink:
    """A link whose waits end as soon as a stop waits; used while a card is opened and set up.

    The first wait that is broken off raises StopWaitsError; what follows has GRACE_S to leave the
    card in order. After `settle` it is the link alone.
    """

    def __init__(self, link: Link, is_awaited: Callable[[], bool], limit_s: float) -> None:
        """`limit_s`: longest time that connecting may take."""
        self.name, self.kind = link.name, link.kind
        self._link = link
        self._is_awaited = is_awaited
        self._is_settled = False
        self._limit_s = limit_s
        self._end_s: float | None = None  # of the grace

    def settle(self) -> None:
        """No stop breaks anything off from now on."""
        self._is_settled = True

    def _look(self) -> None:
        if self._is_settled:
            return
        if self._end_s is None and self._is_awaited():
            self._end_s = time.monotonic() + GRACE_S
            raise StopWaitsError
        if self._end_s is not None and time.monotonic() > self._end_s:
            raise ConnectionLostError(f"{self.name}: broken off")

    def open(self) -> None:
        """Connect, within the limit; ConnectionLostError, StopWaitsError."""
        opening, end_s = opened(self._link), time.monotonic() + self._limit_s
        try:
            while not opening.done():
                self._look()
                if time.monotonic() > end_s:
                    raise ConnectionLostError(
                        f"cannot connect to {self.name}: no answer in {self._limit_s:g} s"
                    )
                time.sleep(SLICE_S)
        except BaseException:
            close(self._link, opening)
            raise
        opening.result()

    def read(self, timeout_s: float | None) -> bytes:
        """What has arrived, as of the link; StopWaitsError."""
        if self._is_settled:
            return self._link.read(timeout_s)
        end_s = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            self._look()
            left_s = SLICE_S if end_s is None else min(SLICE_S, end_s - time.monotonic())
            if (data := self._link.read(max(0.0, left_s))) or left_s <= 0.0:
                return data

    def write(self, data: bytes) -> None:
        """Send everything."""
        self._look()
        self._link.write(data)

    def pause(self, seconds: float) -> None:
        """Let time pass; StopWaitsError."""
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0.0:
            self._look()
            self._link.pause(min(SLICE_S, left_s))

    def now_s(self) -> float:
        """The clock of the link."""
        return self._link.now_s()

    def close(self) -> None:
        """Disconnect."""
        self._link.close()


def connected(
    target: str | Host,
    options: Options,
    is_awaited: Callable[[], bool] = lambda: False,
    limit_s: float = CONNECT_S,
) -> tuple[Card, Callable[[], None]]:
    """Connect to a card, broken off by a stop until the returned function is called.

    A card in this process answers at once: nothing is broken off. StopWaitsError, a link error.
    """
    found = link_to(target)
    hasty = None if isinstance(found, ProcessLink) else HastyLink(found, is_awaited, limit_s)
    link = hasty or found
    card = Card(link, options)
    try:
        card.connect()
    except BaseException:
        link.close()  # a card that answers nothing keeps no socket open
        raise
    return card, hasty.settle if hasty is not None else lambda: None


def opened(link: Link) -> "Future[None]":
    """Open a link, in a thread of its own unless the card is in this process; done at its end."""
    future: Future[None] = Future()

    def run() -> None:
        try:
            link.open()
        except Exception as error:
            future.set_exception(error)
        else:
            future.set_result(None)

    if isinstance(link, ProcessLink):
        run()
    else:
        threading.Thread(target=run, name="card", daemon=True).start()
    return future


def close(link: Link, opening: "Future[None] | None" = None) -> None:
    """Close a link; one that is still being opened is closed as soon as it is open."""

    def end() -> None:
        with suppress(Exception):
            link.close()

    if opening is None:
        end()
    else:
        opening.add_done_callback(lambda _done: end())
