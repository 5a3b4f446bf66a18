"""A card with hosts on its streams, byte by byte; `|` in texts stands for CR LF."""

from collections.abc import Iterable

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.plant.describe.schema import World

X_AND_Y = (
    "PROG0",
    "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS0 "X"',
    'ATTACH SLAVE1 AXIS1 "Y"',
    "PPU X1000 Y1000",
    "ACC 1000 DEC 1000 STP 1000 VEL 100",
    "JOG VEL X50 Y50 JOG ACC X500 Y500 JOG DEC X500 Y500",
    "DRIVE ON X Y",
)


class Host:
    """One connection to a card."""

    def __init__(self, card: Controller, kind: StreamKind = StreamKind.TERMINAL) -> None:
        self.card = card
        self.stream = card.open_stream(kind)

    def send(self, data: str | bytes) -> str:
        """Send in one piece; what the card has to say at once."""
        self.card.receive(self.stream, _bytes(data))
        return self.heard()

    def send_apart(self, data: str | bytes, sizes: Iterable[int]) -> str:
        """Send in pieces of these sizes, the last one for the rest."""
        rest, heard = _bytes(data), ""
        for size in sizes:
            heard += self.send(rest[:size])
            rest = rest[size:]
        return heard + self.send(rest)

    def type(self, *lines: str) -> str:
        """Send lines with CR; the answer without the echo of the first line."""
        return "".join(self.send(line + "\r").removeprefix(line + "|") for line in lines)

    def ask(self, query: str) -> str:
        """The value a query gives; everything around it must be as hosts expect."""
        answer = self.send(query + "\r")
        head, middle, prompt = answer.partition("|")
        assert (head, middle) == (query, "|"), answer
        value, end, prompt = prompt.rpartition("|")
        assert end == "|", answer
        assert prompt.endswith(">"), answer
        return value

    def asks(self, *queries: str) -> list[str]:
        return [self.ask(query) for query in queries]

    def writes(self) -> list[str]:
        """What waits to be sent, one item per write."""
        found = []
        while data := self.card.take_output(self.stream):
            found.append(data.decode("latin-1").replace("\r\n", "|"))
        return found

    def heard(self) -> str:
        return "".join(self.writes())

    def after(self, ticks: int) -> str:
        """What is heard while time passes."""
        self.card.advance(ticks)
        return self.heard()

    def raw(self, data: bytes) -> bytes:
        """The reply to a packet, in bytes; it must be one write."""
        self.card.receive(self.stream, data)
        reply = self.card.take_output(self.stream)
        assert not self.card.take_output(self.stream)
        return reply

    def close(self) -> None:
        self.card.close_stream(self.stream)


def _bytes(data: str | bytes) -> bytes:
    return data.replace("|", "\r\n").encode("latin-1") if isinstance(data, str) else data


def connected(*lines: str, model: str = "ACR9000", world: World | None = None) -> Host:
    """A host of a new card, after some lines."""
    host = Host(Controller(model, world=world))
    for line in lines:
        answer = host.type(line)
        notice = "CONFIG acts after ESAVE and REBOOT|"
        assert answer.removeprefix(notice).count("|") == 0, answer
    return host


def at_axes(world: World | None = None) -> Host:
    """At P00 with axes X and Y, drives on."""
    host = connected(*X_AND_Y, world=world)
    host.card.advance(100)
    return host


def store(host: Host, *lines: str) -> None:
    """Store program text at the level of the host, as a download does."""
    answer = host.type("PROGRAM", *lines, "ENDP")
    assert answer == "P00>" * (len(lines) + 2), answer
