"""What programs of a card print, and their errors: LISTEN, on a connection for each."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, Full, Queue

from openacr.client import Card, ClientError
from openacr.client.errors import message_of
from openacr.debugger.real_cards.link import OPTIONS
from openacr.errors import UserError

BEGIN_S = 10.0
END_S = 5.0
MOST_HEARD = 1000  # texts that wait for the editor; then the card is not read
TURN_S = 0.1
_ERROR = re.compile(r"Error in PROG\d+ line \d+: .*")


@dataclass(frozen=True, slots=True)
class Heard:
    """Text that a program has printed; `error`: the run-time error at the end of it."""

    program: int
    text: str
    error: str = ""


class Follower:
    """Follows one program in a thread until it is closed or the connection is lost."""

    def __init__(self, host: str, program: int, heard: Queue[Heard]) -> None:
        """ClientError if the card has no connection left."""
        self._program, self._heard = program, heard
        self._card = Card.open(host, OPTIONS)
        self._line = ""
        self._is_begun, self._is_ended = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._follow, daemon=True)
        self._thread.start()
        if not self._is_begun.wait(BEGIN_S):
            self.close()
            raise UserError(f"LISTEN of PROG{program}: the card does not answer")

    def _follow(self) -> None:
        try:
            for text in self._card.listen(self._program):
                self._is_begun.set()
                if self._is_ended.is_set():
                    break
                if text:
                    self._take(text)
        except ClientError as failure:
            if not self._is_ended.is_set():
                self._report(Heard(self._program, f"LISTEN has ended: {failure}\n"))

    def _take(self, text: str) -> None:
        """Report a text, and each error that its lines contain."""
        self._report(Heard(self._program, text))
        *lines, self._line = (self._line + text).split("\n")
        for line in lines:
            if is_error(line):
                self._report(Heard(self._program, "", line))

    def _report(self, heard: Heard) -> None:
        """Hand something on, as soon as there is room for it."""
        while not self._is_ended.is_set():
            with suppress(Full):
                self._heard.put(heard, timeout=TURN_S)
                return

    def close(self) -> None:
        """Stop listening; the program keeps running."""
        self._is_ended.set()
        self._thread.join(END_S)
        if not self._thread.is_alive():  # otherwise the lost connection ends with the process
            self._card.close()


def is_error(line: str) -> bool:
    """Whether a printed line is the message of an error that ends a program."""
    return _ERROR.fullmatch(line) is not None or message_of(line) is not None


class Followers:
    """The programs that are followed."""

    def __init__(self, host: str) -> None:
        self._host = host
        self._heard: Queue[Heard] = Queue(MOST_HEARD)
        self._followers: list[Follower] = []

    def follow(self, program: int) -> None:
        """Follow one more; ClientError if the card has no connection left."""
        self._followers.append(Follower(self._host, program, self._heard))

    def heard(self) -> Iterator[Heard]:
        """What was printed since."""
        while True:
            try:
                yield self._heard.get_nowait()
            except Empty:
                return

    def close(self) -> None:
        """Follow none any more."""
        for follower in self._followers:
            follower.close()
        self._followers.clear()
