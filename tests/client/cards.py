"""Cards and links for tests of the client."""

from collections.abc import Callable
from pathlib import Path

from openacr.client import Card, ConnectionLostError, Level, Options
from openacr.client.links import ProcessLink
from openacr.controller import Controller
from openacr.project import Place, find_project

EXAMPLES = Path(__file__).parents[2] / "examples"
AXIS = (
    "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "DRIVE ON X",
    "ACC 1000 DEC 1000 STP 1000 VEL 100",
)  # fmt: skip


class WrappedLink(ProcessLink):
    """A card in this process on a line that is not perfect."""

    def __init__(self, card: Controller) -> None:
        super().__init__(card)
        self.alters: Callable[[bytes], bytes] = lambda data: data
        self.chunk = 1 << 16
        self.breaks_at: list[str] = []  # in this order, before "write" or "read"
        self.opened = self.writes = 0
        self.is_reachable = True
        self._waiting = b""

    def open(self) -> None:
        if not self.is_reachable:
            raise ConnectionLostError("cannot connect")
        self.opened += 1
        self._waiting = b""
        super().open()

    def write(self, data: bytes) -> None:
        self._break("write")
        self.writes += 1
        super().write(data)

    def read(self, timeout_s: float | None) -> bytes:
        self._break("read")
        if not self._waiting:
            self._waiting = self.alters(super().read(timeout_s))
        data, self._waiting = self._waiting[: self.chunk], self._waiting[self.chunk :]
        return data

    def _break(self, where: str) -> None:
        if self.breaks_at[:1] == [where]:
            self.breaks_at.pop(0)
            self.close()
            raise ConnectionLostError("the line broke")


def wrapped(options: Options | None = None) -> tuple[Card, WrappedLink]:
    """A connected card and the line to it."""
    link = WrappedLink(Controller())
    card = Card(link, options)
    card.connect()
    return card, link


def with_axis(card: Card) -> Card:
    """A card whose program 0 moves X."""
    for line in AXIS:
        card.command(line)
    card.pause(0.05)
    return card


def load_example(card: Card, name: str) -> list[Level]:
    """Download all files of an example; the levels that have text now."""
    entered: list[Level] = []
    for source in find_project(EXAMPLES / name).sources:
        levels = {Place.PROGRAM: Level.program, Place.PLC: Level.plc}
        level = levels[source.place](source.number) if source.place in levels else Level()
        entered += card.download(source.text, path=str(source.path), to=level).entered
    return entered
