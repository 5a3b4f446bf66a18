"""LISTEN on a screen: what one program of the card prints, for all who have asked."""

from collections.abc import Callable
from typing import Any

from openacr.client import Level
from openacr.client.effects import Op
from openacr.client.requests import Follow
from openacr.client.talk import Talk
from openacr.errors import UserError
from openacr.panel.control.aside import Aside
from openacr.panel.control.installation import Installation

HEAR_S = 0.1  # between two looks at what has been printed


class Listening:
    """The program that is listened to, on a stream of its own; one at a time."""

    def __init__(self, installation: Installation, tell: Callable[[dict[str, Any]], None]) -> None:
        self._aside = Aside(installation)
        self._tell = tell
        self._clients: set[int] = set()
        self._program: int | None = None

    def begin(self, client: int, program: int) -> None:
        """Listen to a program, for a client; UserError while others listen to another one."""
        others = self._clients - {client}
        if self._program not in (None, program) and others:
            raise UserError(f"PROG{self._program} is listened to on another screen")
        if self._program != program or not self._aside.is_busy:
            self._aside.end()
            self._program = program
            self._aside.begin(lambda talk: self._follow(talk, program))
        self._clients.add(client)

    def forget(self, client: int) -> None:
        """A client listens no more; the last one ends the connection."""
        self._clients.discard(client)
        if not self._clients:
            self.end()

    def end(self) -> None:
        """End the connection; the program goes on."""
        self._aside.end()
        self._program = None

    def step(self, now_s: float) -> None:
        """Take what has been printed."""
        self._aside.step(now_s)

    def _follow(self, talk: Talk, program: int) -> Op[None]:
        yield from talk.go(Level.program(program))
        yield from talk.exchange(Follow("LISTEN"))
        while (text := (yield from talk.hear(HEAR_S))) is not None:
            if text:
                self._say(program, text)
        self._say(program, "")

    def _say(self, program: int, text: str) -> None:
        """Text that was printed; empty at the end."""
        for client in self._clients:
            self._tell({"event": "listen", "program": program, "text": text, "to": client})
