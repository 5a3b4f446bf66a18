"""The terminal of the card on a screen: a stream of its own, beside that of the session."""

from contextlib import suppress

from openacr.client.links import Link, SerialLink, link_to
from openacr.errors import UserError
from openacr.panel.control.installation import Installation
from openacr.protocol.events import ControlKey

KEYS = {
    "esc": b"\x1b",
    "ctrl-c": b"\x03",
    "ctrl-x": bytes((ControlKey.CTRL_X,)),
    "ctrl-y": bytes((ControlKey.CTRL_Y,)),
    "ctrl-z": bytes((ControlKey.CTRL_Z,)),
}
QUERY = "?"  # lines that only read


class Terminal:
    """One terminal of the card; every client that has opened it sees what it prints."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self._link: Link | None = None
        self.clients: set[int] = set()

    def open(self, client: int) -> None:
        """Connect, for this client as well; UserError where the card has one line only."""
        if self._link is None:
            link = link_to(self._installation.target)
            if isinstance(link, SerialLink):
                raise UserError("a card on a serial port has no second connection for a terminal")
            link.open()
            self._link = link
        self.clients.add(client)

    def close(self, client: int) -> None:
        """Disconnect a client; the last one ends the connection."""
        self.clients.discard(client)
        if not self.clients:
            self.end()

    def end(self) -> None:
        """End the connection."""
        link, self._link = self._link, None
        if link is not None:
            with suppress(Exception):
                link.close()

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
        """What the card has printed since."""
        if self._link is None:
            return ""
        return self._link.read(0.0).decode("latin-1")

    def _connected(self) -> Link:
        if self._link is None:
            raise UserError("the terminal is not open")
        return self._link
