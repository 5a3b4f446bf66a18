"""The programs of the card as the screens know them: states, texts, what they print."""

from collections import OrderedDict
from collections.abc import Callable
from hashlib import blake2b
from typing import Any

from openacr.client import Level
from openacr.client.effects import Op
from openacr.client.program_states import ROWS, program_states
from openacr.client.requests import Follow
from openacr.client.talk import Talk
from openacr.errors import UserError
from openacr.panel.control.engineer.card_programs import CardPrograms, read_states
from openacr.panel.control.engineer.conversations import Aside
from openacr.panel.control.engineer.texts_seen import TextsSeen
from openacr.panel.control.machine.breakpoints import Breakpoints
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.place import Rows

HEAR_S = 0.1  # between two looks at what has been printed
MOST_PARKED = 8
NO_BREAKPOINTS = (
    "a card over a link cannot stop before a line: it has no breakpoints. PAUSE holds a program,"
    " BLOCK and STEP carry it out line by line"
)


class ParkedTexts:
    """Texts that a browser has handed over before the command that sends them to the card.

    They are known by marks made of them. A message of the socket is short, and only the socket
    knows who has control.
    """

    def __init__(self) -> None:
        self._texts: OrderedDict[str, str] = OrderedDict()

    def put(self, text: str) -> str:
        """Keep a text; its mark."""
        mark = blake2b(text.encode(errors="replace"), digest_size=16).hexdigest()
        self._texts[mark] = text
        self._texts.move_to_end(mark)
        while len(self._texts) > MOST_PARKED:
            self._texts.popitem(last=False)
        return mark

    def text(self, mark: str) -> str:
        """The text of a mark; UserError if it is no longer kept."""
        if mark not in self._texts:
            raise UserError("the text is no longer here: send it again")
        return self._texts[mark]


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
        """End the connection; the program continues."""
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


def _halted(read: Rows) -> set[Level]:
    states = program_states(read(list(ROWS)))
    return {state.level for state in states if not state.is_running}


class OnCard:
    """States by the link of the session; texts and listening by streams of their own."""

    def __init__(self, installation: Installation, tell: Callable[[dict[str, Any]], None]) -> None:
        self._installation = installation
        self.aside = Aside(installation)
        self.programs = CardPrograms(tell)
        self.parked = ParkedTexts()
        self.texts_seen = TextsSeen(installation, self.aside, self.programs.texts_changed)
        self.listening = Listening(installation, tell)

    @property
    def stops(self) -> Breakpoints:
        """The breakpoints of a card in this process; UserError for any other card."""
        if self._installation.history is None:
            raise UserError(NO_BREAKPOINTS)
        return self._installation.history.breakpoints

    def breakpoints(self) -> dict[str, Any]:
        """The breakpoints and what they hold, for the screens; else why there are none."""
        if self._installation.history is None:
            return {"why_not": NO_BREAKPOINTS, "breakpoints": [], "held": []}
        return {"why_not": "", **self._installation.history.breakpoints.data()}

    def step(self, now_s: float) -> None:
        """Carry on with what is under way; never waits."""
        self.aside.step(now_s)
        self.listening.step(now_s)

    def look(self, read: Rows, now_s: float) -> None:
        """Read the states for those who watch them."""
        self.programs.watchers.look(lambda: read_states(read), now_s)
        if self.programs.watchers.are_there:
            self.texts_seen.look(now_s, lambda: _halted(read))

    def forget(self, client: int) -> None:
        """A browser has gone."""
        self.programs.watchers.forget(client)
        self.listening.forget(client)

    def end(self) -> None:
        """The session has ended: close the streams."""
        self.aside.end()
        self.texts_seen.forget()
        self.listening.end()
