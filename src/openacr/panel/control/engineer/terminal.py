"""Terminals of the card on screens: each a stream of its own, beside that of the session."""

from collections.abc import Iterator
from concurrent.futures import Future

from openacr.client import ConnectionLostError
from openacr.client.links import Link, SerialLink, link_to
from openacr.errors import UserError
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.opening import close, opened
from openacr.protocol.events import ControlKey

KEYS = {
    "esc": b"\x1b",
    "ctrl-c": b"\x03",
    "ctrl-x": bytes((ControlKey.CTRL_X,)),
    "ctrl-y": bytes((ControlKey.CTRL_Y,)),
    "ctrl-z": bytes((ControlKey.CTRL_Z,)),
}
QUERY = "?"  # lines that only read
TERMINALS = 4  # of one panel, however many streams the card has


LOST = "\r\n(the connection is lost: open the terminal again)\r\n"


class Terminal:
    """One terminal of the card; every client that has opened it sees what it prints."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self._link: Link | None = None
        self._opening: Future[None] | None = None
        self.clients: set[int] = set()

    def open(self, client: int) -> "Future[None]":
        """Connect, for this client as well: done once it is; UserError on a serial port."""
        if self._opening is None or self._has_failed:
            self.end()
            link = link_to(self._installation.target)
            if isinstance(link, SerialLink):
                raise UserError("a card on a serial port has no second connection for a terminal")
            self._link, self._opening = link, opened(link)
        self.clients.add(client)
        return self._opening

    def close(self, client: int) -> None:
        """Disconnect a client; the last one ends the connection."""
        self.clients.discard(client)
        if not self.clients:
            self.end()

    def end(self) -> None:
        """End the connection."""
        link, opening = self._link, self._opening
        self._link = self._opening = None
        if link is not None:
            close(link, opening)

    @property
    def _is_open(self) -> bool:
        opening = self._opening
        return opening is not None and opening.done() and not opening.exception()

    @property
    def _has_failed(self) -> bool:
        return self._opening is not None and self._opening.done() and not self._is_open

    def line(self, text: str, *, is_busy: bool) -> None:
        """Type a line; while the machine moves only those that ask."""
        if is_busy and not text.lstrip().startswith(QUERY):
            raise UserError("the machine moves: only lines that begin with ? are sent")
        if not text.isprintable():
            raise UserError("a line has printable characters only")
        self._connected().write(text.encode("latin-1", "replace") + b"\r")

    def key(self, name: str) -> None:
        """Press a control key."""
        self._connected().write(KEYS[name])

    def poll(self) -> str:
        """What the card has printed since; a connection that has broken ends."""
        if self._link is None or not self._is_open:
            return ""
        try:
            return self._link.read(0.0).decode("latin-1")
        except ConnectionLostError:
            self.end()
            return LOST

    def _connected(self) -> Link:
        if self._link is None or not self._is_open:
            raise UserError("the terminal is not open")
        return self._link


class Terminals:
    """The terminals of one card by number; every client may have each of them open."""

    def __init__(self, installation: Installation) -> None:
        self._all = [Terminal(installation) for _ in range(TERMINALS)]

    def __getitem__(self, number: int) -> Terminal:
        return self._all[number]

    def printed(self) -> Iterator[tuple[int, int, str]]:
        """What the card has printed since: terminal, client, text."""
        for number, terminal in enumerate(self._all):
            if terminal.clients and (text := terminal.poll()):
                for client in terminal.clients:
                    yield number, client, text

    def leave(self, client: int) -> None:
        """A client has gone: what only it had open ends."""
        for terminal in self._all:
            terminal.close(client)

    def end(self) -> None:
        """End all connections."""
        for terminal in self._all:
            terminal.end()
