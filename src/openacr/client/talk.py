"""The conversation with one card: connect, align, ask, time out, connect again.

Everything here is a generator that yields what is to be done outside - open the link, send
bytes, wait for bytes, pause - and is resumed with the result. A blocking and an asyncio
shell drive the same generators (`card`, `async_card`); tests can drive them with neither.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from openacr.client.effects import Close, Op, Open, Pause, Receive, Send
from openacr.client.errors import (
    ConnectionLostError,
    GarbledError,
    NoReplyError,
    RefusedError,
    message_of,
)
from openacr.client.requests import (
    SYS,
    Align,
    Answer,
    Follow,
    Heard,
    Leave,
    Level,
    Line,
    Press,
    Request,
)
from openacr.client.session import Event, Session
from openacr.errors import UserError
from openacr.protocol.escape import BinaryMode, encode_packet
from openacr.protocol.events import NEED_DATA
from openacr.protocol.packets import Packet
from openacr.protocol.stream import EchoMode, StreamKind

QUIET_S = 0.15
FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.1, 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How to talk to a card.

    `timeout_s`: longest silence while a reply is awaited (None: any). `reconnect_s`: how long
    to try again after a lost connection (0: not at all). `uses_packets`: read parameters with
    binary packets, exact and up to eight at once; otherwise by text.
    """

    timeout_s: float | None = 5.0
    reconnect_s: float = 10.0
    echo: EchoMode = EchoMode.CHARACTERS
    uses_packets: bool = True


class Talk:
    """One card at the other end of a link that is called `name` in messages."""

    def __init__(self, name: str, kind: StreamKind, options: Options) -> None:
        self.name = name
        self.kind = kind
        self.options = options
        self.session = Session(options.echo)
        self._home = SYS  # the level to come back to
        self._is_open = False
        self._was_open = False
        self._is_aligned = False

    @property
    def level(self) -> Level:
        """The level of the stream, also while it is being connected again."""
        return self._home

    @property
    def is_listening(self) -> bool:
        """A program is being followed."""
        return self.session.is_listening

    @property
    def uses_packets(self) -> bool:
        """Parameters are read with packets; not where XON and XOFF would be taken out of them."""
        is_clean = self.kind is not StreamKind.SERIAL or self.session.mode.prefixes
        return self.options.uses_packets and is_clean

    def set_echo(self, echo: EchoMode) -> None:
        """Work in another ECHO mode from the next request on."""
        if echo != self.session.echo:
            self.session.echo, self._is_aligned = echo, False

    # --- requests ---------------------------------------------------------------------

    def exchange(self, request: Request, wait_s: float | None = None) -> Op[Answer]:
        """The answer to a request; a query is sent again if the connection breaks."""
        try:
            yield from self._be_ready()
            return (yield from self._once(request, wait_s))
        except ConnectionLostError:
            yield from self._drop()
            if not request.is_query or self.options.reconnect_s <= 0:
                raise
        yield from self._be_ready()
        return (yield from self._once(request, wait_s))

    def _once(self, request: Request, wait_s: float | None) -> Op[Answer]:
        if self.is_listening and isinstance(request, Line | Follow):
            raise UserError(f"{request}: a program is being followed; end that first")
        was_listening = self.is_listening
        self._is_aligned = False  # until the answer is there, whatever happens
        yield Send(self.session.begin(request))
        answer = yield from self._answer(request, wait_s or self.options.timeout_s)
        if answer.is_garbled:
            raise GarbledError(self.name, str(request), answer.raw)
        self._is_aligned = True
        if not was_listening:
            self._home = self.session.level
        return answer

    def _answer(self, request: Request, wait_s: float | None) -> Op[Answer]:
        if isinstance(request, Follow):
            return Answer()
        event = self.session.next_event()
        while not isinstance(event, Answer):
            if event is NEED_DATA:
                event = yield from self._more(request, wait_s)
            else:  # text of a followed program, while something else is awaited
                event = self.session.next_event()
        return event

    def _more(self, request: Request, wait_s: float | None) -> Op[Event]:
        """Wait for bytes; only for a moment when what is there could be all."""
        if self.session.may_be_done:
            data = yield Receive(QUIET_S)
            if not data and isinstance(event := self.session.end_of_data(), Answer):
                return event
        else:
            data = b""
        data = data or (yield Receive(wait_s))
        if not data:
            self._give_up(request, wait_s or 0)
        self.session.receive_data(data or b"")
        return self.session.next_event()

    def _give_up(self, request: Request, wait_s: float) -> None:
        received, is_fitting = self.session.received, self.session.is_fitting
        self.session.forget()
        if not is_fitting:
            raise GarbledError(self.name, str(request), received)
        raise NoReplyError(self.name, str(request), wait_s)

    # --- following a program ----------------------------------------------------------

    def hear(self, wait_s: float | None) -> Op[str | None]:
        """The next text of the followed program, empty if none came in time; None: it ended."""
        if not self.is_listening:
            return None
        try:
            event = yield from self._next_heard(wait_s)
        except ConnectionLostError:
            yield from self._drop()
            raise
        if isinstance(event, Answer):
            self._home, self._is_aligned = self.session.level, True
            return None
        return event.text if isinstance(event, Heard) else ""

    def _next_heard(self, wait_s: float | None) -> Op[Event]:
        while (event := self.session.next_event()) is NEED_DATA:
            data = yield Receive(QUIET_S if self.session.received else wait_s)
            if not data:
                return self.session.end_of_data()
            self.session.receive_data(data)
        return event

    # --- connection -------------------------------------------------------------------

    def _be_ready(self) -> Op[None]:
        """Connect and come to a known state, if that is not so already."""
        if not self._is_open:
            yield from self._connect()
        if not self._is_aligned:
            home = self._home
            try:
                yield from self._align()
            except (NoReplyError, GarbledError):
                yield from self._drop()
                raise
            if home != SYS:
                yield from self._once(Line(str(home)), None)

    def _connect(self) -> Op[None]:
        """Open the link; once it has been open before, keep trying."""
        patience_s = self.options.reconnect_s if self._was_open else 0.0
        pause_s = FIRST_PAUSE_S
        while True:
            try:
                yield Open()
            except ConnectionLostError:
                if patience_s <= 0:
                    raise
                yield Pause(pause_s)
                patience_s -= pause_s
                pause_s = min(2 * pause_s, LONGEST_PAUSE_S)
            else:
                self._is_open = self._was_open = True
                return

    def _align(self) -> Op[None]:
        self.session.forget()
        yield from self._once(Align(), None)
        if self.kind is StreamKind.SERIAL and self.options.uses_packets:
            yield from self._ask_mode()

    def _ask_mode(self) -> Op[None]:
        """How packets travel on a serial line; the power-up value if the card does not say."""
        answer = yield from self._once(Line("MODE", is_query=True), None)
        known = len(answer.lines) == 1 and answer.lines[0] in ("0", "1", "2", "3")
        self.session.mode = BinaryMode(int(answer.lines[0])) if known else self.kind.startup_mode

    def _drop(self) -> Op[None]:
        """The connection is of no use any more."""
        self.session.forget()
        self._is_open = self._is_aligned = False
        yield Close()

    def close(self) -> Op[None]:
        """End the connection; motion and programs go on."""
        if self._is_open:
            yield from self._drop()
        self._was_open = False

    # --- what everything above is made of ---------------------------------------------

    def command(
        self, line: str, *, at: Level | None = None, wait_s: float | None = None
    ) -> Op[tuple[str, ...]]:
        """Send a line, at a certain level if need be; the output lines. RefusedError."""
        if at is not None:
            yield from self.go(at)
        answer = yield from self.exchange(Line(line), wait_s)
        return checked(line, answer.lines)

    def query(self, line: str, *, at: Level | None = None) -> Op[tuple[str, ...]]:
        """As `command`, for a line that only reports something."""
        if at is not None:
            yield from self.go(at)
        answer = yield from self.exchange(Line(line, is_query=True))
        return checked(line, answer.lines)

    def order(self, line: str, *, at: Level | None = None) -> Op[None]:
        """As `command`, for a line that says nothing unless it is refused."""
        lines = yield from self.command(line, at=at)
        if lines:
            raise RefusedError(line, lines[-1])

    def go(self, level: Level) -> Op[None]:
        """Come to a level."""
        if self.level != level or not self._is_open:
            yield from self.order(str(level))

    def send(self, request: Press) -> Op[None]:
        """Send something the card does not answer."""
        yield from self.exchange(request)

    def tell(self, packets: Iterable[Packet]) -> Op[None]:
        """Send packets the card does not answer, in one write."""
        try:
            yield from self._be_ready()
            mode = self.session.mode
            yield Send(b"".join(encode_packet(packet.encode(), mode) for packet in packets))
        except ConnectionLostError:
            yield from self._drop()
            raise

    def leave(self) -> Op[None]:
        """End following a program; it runs on."""
        if self.is_listening:
            yield from self.exchange(Leave())


def checked(line: str, lines: tuple[str, ...]) -> tuple[str, ...]:
    """The output of a line, unless it is one of the card's error texts."""
    if lines and message_of(lines[-1]) is not None:
        raise RefusedError(line, lines[-1])
    return lines
