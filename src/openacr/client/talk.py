"""The conversation with one card: connect, align, request, time out, reconnect.

Every operation is a generator that yields the effects to be performed outside - open the link,
send bytes, wait for bytes, pause - and is resumed with the result. A blocking and an asyncio
shell drive the same generators (`card`, `async_card`); tests can drive them without either.
"""

from collections.abc import Callable, Iterable

from openacr.channels import BinaryMode, EchoMode, StreamKind
from openacr.client.effects import Close, Op, Open, Pause, Receive, Send
from openacr.client.errors import (
    ConnectionLostError,
    GarbledError,
    NoReplyError,
    RefusedError,
    message_of,
)
from openacr.client.options import Options, Patience
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
from openacr.protocol.escape import encode_packet
from openacr.protocol.events import NEED_DATA
from openacr.protocol.packets import Packet

QUIET_S = 0.15
FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.1, 2.0
RETRIES = 10  # of a connection that stays broken, at least
LONGEST_REPLY_BYTES = 1 << 22  # longer than a listing of the entire memory of a card


class Talk:
    """The conversation with one card over a link that is called `name` in messages.

    `now_s` is the clock that time-outs use.
    """

    def __init__(
        self, name: str, kind: StreamKind, options: Options, now_s: Callable[[], float]
    ) -> None:
        self.name = name
        self.kind = kind
        self.options = options
        self.now_s = now_s
        self.session = Session(options.echo)
        self.connections = 0  # made so far
        self._home = SYS  # the level to return to
        self._is_open = False
        self._was_open = False
        self._is_aligned = False

    @property
    def level(self) -> Level:
        """The level of the stream, also while it is being reconnected."""
        return self._home

    @property
    def is_listening(self) -> bool:
        """Whether a program is being followed."""
        return self.session.is_listening

    @property
    def uses_packets(self) -> bool:
        """Whether parameters are read with packets; not where XON/XOFF would corrupt them."""
        is_clean = self.kind is not StreamKind.SERIAL or self.session.mode.prefixes
        return self.options.uses_packets and is_clean

    def set_echo(self, echo: EchoMode) -> None:
        """Use another ECHO mode from the next request on."""
        if echo != self.session.echo:
            self.session.echo, self._is_aligned = echo, False

    # --- requests ---------------------------------------------------------------------

    def exchange(self, request: Request, wait_s: float | None = None) -> Op[Answer]:
        """Send a request and return its answer; a query is repeated if the connection breaks."""
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
        self._is_aligned = False  # until the answer has arrived
        yield Send(self.session.begin(request))
        silence_s = wait_s or self.options.timeout_s
        patience = Patience(silence_s, self.now_s(), self.options.deadline_s)
        answer = yield from self._answer(request, patience)
        if answer.is_garbled:
            raise GarbledError(self.name, str(request), answer.raw)
        self._is_aligned = True
        if not was_listening:
            self._home = self.session.level
        return answer

    def _answer(self, request: Request, patience: Patience) -> Op[Answer]:
        if isinstance(request, Follow):
            return Answer()
        event = self.session.next_event()
        while not isinstance(event, Answer):
            if event is NEED_DATA:
                event = yield from self._more(request, patience)
            else:  # text of a followed program, while waiting for an answer
                event = self.session.next_event()
        return event

    def _more(self, request: Request, patience: Patience) -> Op[Event]:
        """Wait for bytes; only for a moment when the answer may be complete."""
        if self.session.may_be_done:
            data = yield Receive(QUIET_S)
            if not data and isinstance(event := self.session.end_of_data(), Answer):
                return event
        else:
            data = b""
        left_s = patience.left_s(self.now_s(), self.session.received_bytes)
        if not data and (left_s is None or left_s > 0):
            data = yield Receive(left_s)
        if not data or (left_s is not None and left_s <= 0):
            self._give_up(request, patience)
        return self._take(data or b"", request)

    def _take(self, data: bytes, request: object) -> Event:
        """Interpret received bytes; GarbledError when a reply does not end."""
        self.session.receive_data(data)
        if self.session.received_bytes > LONGEST_REPLY_BYTES:
            received = self.session.received
            self.session.forget()
            raise GarbledError(self.name, str(request), received)
        return self.session.next_event()

    def _give_up(self, request: Request, patience: Patience) -> None:
        received, is_fitting = self.session.received, self.session.is_fitting
        self.session.forget()
        if not is_fitting:
            raise GarbledError(self.name, str(request), received)
        waited_s = self.now_s() - patience.begin_s if received else patience.silence_s
        raise NoReplyError(self.name, str(request), waited_s or 0, is_begun=bool(received))

    # --- following a program ----------------------------------------------------------

    def hear(self, wait_s: float | None) -> Op[str | None]:
        """The next text of the followed program, empty if none in time; None: it has ended."""
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
        event = self.session.next_event()
        end_s = None if wait_s is None else self.now_s() + wait_s
        while event is NEED_DATA:
            left_s = None if end_s is None else end_s - self.now_s()
            if self.session.received_bytes:
                left_s = QUIET_S if left_s is None else min(QUIET_S, left_s)
            data = (yield Receive(left_s)) if left_s is None or left_s > 0 else b""
            if not data:
                return self.session.end_of_data()
            event = self._take(data, "the program that is followed")
        return event

    # --- connection -------------------------------------------------------------------

    def _be_ready(self) -> Op[None]:
        """Connect and reach a known state, if not already there."""
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
        """Open the link; retry if it has been open before."""
        end_s = self.now_s() + (self.options.reconnect_s if self._was_open else 0.0)
        pause_s = FIRST_PAUSE_S
        longest_s = min(LONGEST_PAUSE_S, self.options.reconnect_s / RETRIES)
        while True:
            try:
                yield Open()
            except ConnectionLostError:
                if self.now_s() >= end_s:
                    raise
                yield Pause(pause_s)
                pause_s = min(2 * pause_s, longest_s)
            else:
                self._is_open = self._was_open = True
                self.connections += 1
                return

    def _align(self) -> Op[None]:
        self.session.forget()
        yield from self._once(Align(), None)
        if self.kind is StreamKind.SERIAL and self.options.uses_packets:
            yield from self._ask_mode()

    def _ask_mode(self) -> Op[None]:
        """Ask for the packet MODE of a serial line; the power-up value if not reported."""
        answer = yield from self._once(Line("MODE", is_query=True), None)
        known = len(answer.lines) == 1 and answer.lines[0] in ("0", "1", "2", "3")
        self.session.mode = BinaryMode(int(answer.lines[0])) if known else self.kind.startup_mode

    def _drop(self) -> Op[None]:
        """Close a connection that has become unusable."""
        self.session.forget()
        self._is_open = self._is_aligned = False
        yield Close()

    def close(self) -> Op[None]:
        """End the connection; motion and programs continue."""
        if self._is_open:
            yield from self._drop()
        self._was_open = False

    # --- lines, levels and packets -------------------------------------------------------

    def command(
        self, line: str, *, at: Level | None = None, wait_s: float | None = None
    ) -> Op[tuple[str, ...]]:
        """Send a line, at a level if given, and return the output lines; RefusedError."""
        if at is not None:
            yield from self.go(at)
        answer = yield from self.exchange(Line(line), wait_s)
        return checked(line, answer.lines)

    def query(self, line: str, *, at: Level | None = None) -> Op[tuple[str, ...]]:
        """Like `command`, for a line that only reports something."""
        if at is not None:
            yield from self.go(at)
        answer = yield from self.exchange(Line(line, is_query=True))
        return checked(line, answer.lines)

    def order(self, line: str, *, at: Level | None = None) -> Op[None]:
        """Like `command`, for a line that prints nothing unless it is refused."""
        lines = yield from self.command(line, at=at)
        if lines:
            raise RefusedError(line, lines[-1])

    def go(self, level: Level) -> Op[None]:
        """Change to a level."""
        if self.level != level or not self._is_open:
            yield from self.order(str(level))

    def send(self, request: Press) -> Op[None]:
        """Send a request the card does not answer."""
        yield from self.exchange(request)

    def tell(self, packets: Iterable[Packet]) -> Op[None]:
        """Send packets the card does not answer, all in one write."""
        try:
            yield from self._be_ready()
            mode = self.session.mode
            yield Send(b"".join(encode_packet(packet.encode(), mode) for packet in packets))
        except ConnectionLostError:
            yield from self._drop()
            raise

    def leave(self) -> Op[None]:
        """Stop following a program; it keeps running."""
        if self.is_listening:
            yield from self.exchange(Leave())


def checked(line: str, lines: tuple[str, ...]) -> tuple[str, ...]:
    """The output of a line, unless it is one of the card's error texts."""
    if lines and message_of(lines[-1]) is not None:
        raise RefusedError(line, lines[-1])
    return lines
