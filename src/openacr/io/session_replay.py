"""Give a recorded session to a card in this process, and find the first answer that differs.

The card gets the bytes of each host at the times of the recording. Its answers are compared as
streams, connection by connection: when a card answers, and in which pieces, differs from card
to card; what it answers must not.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from openacr.channels import StreamKind
from openacr.errors import NoFreeStreamError, UserError
from openacr.host import CardHost
from openacr.io.recorded_session import Recording
from openacr.journal.entries import Entered, JournalEntry
from openacr.protocol.terminal import XOFF, XON

PATIENCE_S = 1.0  # card time for an answer after the last event of a connection
STEP_S = 0.001
FLOW = bytes((XON, XOFF))
OUTPUT_S = 0.05  # the output of the card is read at least this often, as by a host


@dataclass(frozen=True, slots=True)
class Difference:
    """The first answer that differs, and what the host had sent before it."""

    time_s: float  # of the request in the recording
    connection: int
    sent: bytes
    recorded: bytes
    replayed: bytes


@dataclass(slots=True)
class _Stream:
    """One connection: what was recorded of the card, and what this card has answered."""

    number: int  # of the stream of the card
    kind: StreamKind
    recorded: bytearray = field(default_factory=bytearray)
    replayed: bytearray = field(default_factory=bytearray)
    requests: list[tuple[int, float, bytes]] = field(default_factory=list)  # answers before it

    def compared(self, data: bytes) -> bytes:
        """Bytes of a card without those whose place depends on timing: XON and XOFF."""
        return data.translate(None, FLOW) if self.kind is StreamKind.SERIAL else data

    def difference(self, connection: int) -> Difference | None:
        """Compare what was answered with what was recorded."""
        if self.recorded == self.replayed:
            return None
        pairs = zip(self.recorded, self.replayed, strict=False)
        place = next(
            (place for place, (one, other) in enumerate(pairs) if one != other),
            min(len(self.recorded), len(self.replayed)),
        )
        begin, time_s, sent = max(
            (each for each in self.requests if each[0] <= place), key=lambda each: each[0],
            default=(0, 0.0, b""),
        )  # fmt: skip
        line = self.recorded.rfind(b"\n", begin, place) + 1 or begin
        return Difference(
            time_s, connection, sent, _line(self.recorded, line), _line(self.replayed, line)
        )


def _line(data: bytearray, begin: int) -> bytes:
    end = data.find(b"\n", begin)
    return bytes(data[begin : end + 1 if end >= 0 else None])


class SessionReplay:
    """A card that is given a recorded session."""

    def __init__(self, card: CardHost) -> None:
        self._card = card
        self._streams: dict[int, _Stream] = {}
        self._elapsed_s = 0.0
        self.found: list[Difference] = []

    def run(self, recording: Recording) -> Difference | None:
        """Give the card every event at its time; the first answer that differs."""
        for entry in recording.entries:
            time_s = recording.time_s(entry)
            self._advance_to(time_s)
            self._take(entry, time_s)
        for connection in list(self._streams):
            self._close(connection)
        return min(self.found, key=lambda each: each.time_s, default=None)

    def _take(self, entry: JournalEntry, time_s: float) -> None:
        if entry.what is Entered.OPEN:
            self._streams[entry.number] = self._opened(entry.number, StreamKind(entry.text))
        elif entry.what is Entered.CLOSE:
            self._close(entry.number)
        else:
            stream = self._streams[entry.number]
            if entry.what is Entered.SENT:
                stream.recorded += stream.compared(entry.data)
            else:
                stream.requests.append((len(stream.recorded), time_s, entry.data))
                self._wait(lambda: self._card.accepts_input(stream.number))
                self._card.receive(stream.number, entry.data)
                self._collect()

    def _opened(self, connection: int, kind: StreamKind) -> _Stream:
        try:
            return _Stream(self._card.open_stream(kind), kind)
        except NoFreeStreamError:
            raise UserError(f"connection {connection}: this card has no stream left") from None

    def _close(self, connection: int) -> None:
        """Wait for what the recording has more than this card, compare, and disconnect."""
        stream = self._streams[connection]
        self._wait(lambda: len(stream.replayed) >= len(stream.recorded))
        del stream.replayed[len(stream.recorded) :]  # what the host was no longer there to read
        difference = stream.difference(connection)
        if difference is not None:
            self.found.append(difference)
        self._card.close_stream(stream.number)
        del self._streams[connection]

    def _wait(self, is_done: Callable[[], bool]) -> None:
        """Let card time pass until it is so, for PATIENCE_S at most."""
        for _ in range(round(PATIENCE_S / STEP_S)):
            if is_done():
                return
            self._advance(STEP_S)

    def _advance_to(self, time_s: float) -> None:
        while (left_s := time_s - self._elapsed_s) > 0.5 * self._card.period_s:
            self._advance(min(left_s, OUTPUT_S))

    def _advance(self, seconds: float) -> None:
        ticks = max(1, round(seconds / self._card.period_s))
        self._card.advance(ticks)
        self._elapsed_s += ticks * self._card.period_s
        self._collect()

    def _collect(self) -> None:
        for stream in self._streams.values():
            while data := self._card.take_output(stream.number):
                stream.replayed += stream.compared(data)
