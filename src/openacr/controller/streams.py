"""Command streams: each connects a host's bytes, through a terminal, to a session."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated

from msgspec import Meta, Struct

from openacr.basic.channels.session import Session
from openacr.basic.memory.ranges import Index, ProgramNumber
from openacr.channels import CHANNELS, Attention, BinaryMode, StreamKind
from openacr.controller.packets import PacketHost
from openacr.errors import NoFreeStreamError, StoreError, UserError
from openacr.protocol.events import (
    NEED_DATA,
    Control,
    ControlKey,
    Escape,
    Event,
    LineTooLong,
    Received,
    ReceivedLine,
    Typed,
)
from openacr.protocol.execute import execute
from openacr.protocol.move import Move
from openacr.protocol.terminal import Terminal, TerminalState

CONSOLE = "STREAM1"  # the stream of a caller in this process
LINE_WORK = 150  # to read one line, in the units of a LIST: 2.5 units are a microsecond
CHARACTER_WORK = 30  # added for each of its characters
KEY_WORK = 30  # to act on a control key
PACKET_WORK = 12  # to act on a packet
VALUE_WORK = 8  # added for each value it reads or pokes
WORK_PER_TURN = 5000  # about 2 ms of computing for bytes that arrive together
WORK_PER_TICK = 250  # about 0.1 ms in every tick for lines left over


Credit = Annotated[int, Meta(ge=-(1 << 31), le=WORK_PER_TURN)]


class StreamState(Struct, frozen=True):
    """The state of one connection in a snapshot."""

    terminal: TerminalState
    channel: str | None
    moves_of: ProgramNumber | None
    credit: Credit


class StreamsState(Struct, frozen=True):
    """The state of all connections in a snapshot; `next` is the number of the next one."""

    next: Index
    open: dict[Index, StreamState]


@dataclass(slots=True)
class Stream:
    """One connection: its line discipline and, unless it has carried packets only, its session."""

    terminal: Terminal
    session: Session | None
    moves_of: int | None = None  # the master its latest move packet was for
    credit: int = WORK_PER_TURN  # work its lines may still cause; without any, they wait

    @property
    def is_overdue(self) -> bool:
        """Whether input waits only for its turn."""
        return self.terminal.has_next


class Streams:
    """All connected streams of a card."""

    def __init__(
        self,
        sessions: dict[str, Session],
        host: PacketHost,
        press: Callable[[ControlKey], None],
    ) -> None:
        self._sessions = sessions
        self._host = host
        self.moves = host.moves
        self._press = press
        self._open: dict[int, Stream] = {}
        self._next = 1
        # Output that a stream has got: its number, the bytes, whether they are a packet.
        self.on_put: Callable[[int, bytes, bool], None] = lambda _number, _data, _is_packet: None

    def __contains__(self, number: int) -> bool:
        """Whether a connection is open."""
        return number in self._open

    @property
    def numbers(self) -> list[int]:
        """The streams that are open."""
        return list(self._open)

    def open(self, kind: StreamKind, name: str | None = None) -> int:
        """Open a stream for a new connection; NoFreeStreamError if all are in use."""
        session = None if kind is StreamKind.PACKETS else self._taken(kind, name)
        number, self._next = self._next, self._next + 1
        self._open[number] = Stream(self._terminal(number, kind), session)
        self._settle(self._open[number])
        return number

    def _terminal(self, number: int, kind: StreamKind) -> Terminal:
        terminal = Terminal(kind, timeout_tk=1, short_overrides=self._host.short_overrides)
        terminal.output.on_put = lambda data, is_packet: self.on_put(number, data, is_packet)
        return terminal

    def _taken(self, kind: StreamKind, name: str | None = None) -> Session:
        """A free channel, connected."""
        session = self._free(kind, name)
        session.connect()
        session.mode = kind.startup_mode
        return session

    def _take_text(self, stream: Stream) -> None:
        """Give a connection for packets a channel for its text, which is passed over without."""
        with suppress(NoFreeStreamError):
            stream.session = self._taken(StreamKind.TERMINAL)
            stream.terminal.takes_text = True

    def _free(self, kind: StreamKind, name: str | None) -> Session:
        for candidate in (name,) if name else CHANNELS[kind]:
            session = self._sessions.get(candidate)
            if session is not None and not session.is_connected:
                return session
        raise NoFreeStreamError(f"no {name or kind.value} stream is free")

    def close(self, number: int) -> None:
        """Close the stream of an ended connection; motion and programs continue."""
        stream = self._open.pop(number, None)
        if stream is not None and stream.session is not None:
            stream.session.disconnect()

    def opened(self, number: int) -> Stream:
        """The open stream with this number; UserError if not open."""
        if number not in self._open:
            raise UserError(f"stream {number}: no such stream is open")
        return self._open[number]

    def receive(self, number: int, data: bytes, tick: int) -> None:
        """Process bytes that arrived together at `tick`; UserError if the stream is not open."""
        stream = self.opened(number)
        if not stream.is_overdue:  # a host that floods gets no turn with each of its writes
            stream.credit = WORK_PER_TURN
        if stream.session is None and stream.terminal.begins_text(data):
            self._take_text(stream)
        self._settle(stream)  # a program may have opened or closed the stream meanwhile
        name = stream.session.name if stream.session else ""
        stream.terminal.timeout_tk = self._host.timeout_tk(name)
        stream.terminal.receive_data(data, tick)
        self._pump(stream)
        self.settle()  # what went to another channel: TALK TO, PRINT # of a typed line

    def settle(self) -> None:
        """Pass on the output of sessions, and input lines that were waiting for an answer."""
        for stream in list(self._open.values()):
            if stream.session is not None and (
                stream.session.has_output or stream.terminal.busy != stream.session.busy
            ):
                self._settle(stream)
                self._pump(stream)

    def escape(self, name: str) -> None:
        """Act on the Escape Request of a channel as on ESC typed there."""
        for stream in self._open.values():
            if stream.session is not None and stream.session.name == name:
                event = stream.terminal.escape()
                if event is not None:
                    self._deal(stream, event)
        self.settle()

    @property
    def is_overdue(self) -> bool:
        """Whether lines wait for a turn from `take_turns`."""
        return any(stream.is_overdue for stream in self._open.values())

    def take_turns(self) -> None:
        """Process lines that exceeded the work of one turn; called at the end of a tick."""
        for stream in list(self._open.values()):
            if stream.is_overdue:
                stream.credit = min(stream.credit + WORK_PER_TICK, WORK_PER_TURN)
                self._settle(stream)
                self._pump(stream)
        self.settle()  # what went to another channel

    def accepts_input(self, number: int) -> bool:
        """False while the sender should be held back."""
        stream = self.opened(number)
        if stream.moves_of is not None and self.moves.is_full(stream.moves_of):
            return False
        if stream.session is not None and not stream.session.accepts_input:
            return False
        return stream.terminal.accepts_input

    def is_busy(self, number: int) -> bool:
        """Whether a line of the stream is still being executed."""
        session = self.opened(number).session
        return session is not None and session.busy

    def is_answered(self, number: int) -> bool:
        """Whether every line of the stream is answered, and the program it follows has ended."""
        stream = self.opened(number)
        follows = stream.session is not None and stream.session.until_end
        return not (self.is_busy(number) or stream.is_overdue or follows)

    def session(self, number: int) -> Session | None:
        """The session of a stream."""
        return self.opened(number).session

    def number_of(self, name: str) -> int | None:
        """The stream whose session has this name."""
        opened = self._open.items()
        return next((n for n, each in opened if each.session and each.session.name == name), None)

    def take_output(self, number: int) -> bytes:
        """Return the bytes of the next write."""
        stream = self._open.get(number)
        return stream.terminal.data_to_send() if stream else b""

    def discard_output(self) -> None:
        """Drop everything that waits to be sent."""
        for stream in self._open.values():
            while stream.terminal.data_to_send():
                pass

    def disconnect_all(self) -> None:
        """Reset all open streams, as after power-up."""
        for stream in self._open.values():
            if stream.session is not None:
                stream.session.disconnect()
                stream.session.connect()
                self._settle(stream)

    def state(self) -> StreamsState:
        """All connections, for a snapshot."""
        opened = {
            number: StreamState(
                stream.terminal.state(),
                stream.session.name if stream.session else None,
                stream.moves_of,
                stream.credit,
            )
            for number, stream in self._open.items()
        }
        return StreamsState(self._next, opened)

    def restore(self, state: StreamsState) -> None:
        """Restore what `state` returned; sessions must have been restored before."""
        self._open.clear()
        for each in self._sessions.values():
            each.is_connected = False
        for number, kept in state.open.items():
            terminal = self._terminal(number, kept.terminal.kind)
            terminal.restore(kept.terminal)
            session = None if kept.channel is None else self._restored(kept.channel)
            terminal.takes_text = session is not None
            self._open[number] = Stream(terminal, session, kept.moves_of, kept.credit)
        self._next = max(state.next, *(number + 1 for number in state.open), 1)

    def _restored(self, name: str) -> Session:
        session = self._sessions.get(name)
        if session is None or session.is_connected:
            raise StoreError(f"the snapshot connects {name} to two streams")
        session.is_connected = True
        return session

    def _pump(self, stream: Stream) -> None:
        self._host.take_work()  # of programs
        while stream.credit > 0 and (event := stream.terminal.next_event()) is not NEED_DATA:
            stream.credit -= _work(event)
            self._deal(stream, event)
            stream.credit -= self._host.take_work()
            if not isinstance(event, Received):  # packets do not concern the session
                self._settle(stream)
        for key in stream.terminal.pause():
            self._press(key)
        if stream.session is not None:
            terminal = stream.terminal
            stream.session.show_waiting(terminal.waiting_characters, terminal.waiting_lines)

    def _deal(self, stream: Stream, event: Event) -> None:
        session = stream.session
        if isinstance(event, Received):
            if isinstance(event.packet, Move):
                stream.moves_of = event.packet.master
            reply = execute(self._host, event.packet)
            if reply:
                stream.terminal.send_packet(reply)
        elif isinstance(event, Control):
            self._press(event.code)
        elif session is None:
            return
        elif isinstance(event, ReceivedLine):
            session.feed_line(event.text)
        elif isinstance(event, LineTooLong):
            session.line_too_long()
        elif isinstance(event, Typed):
            session.typed(event.byte)
        elif isinstance(event, Escape):
            session.escape()

    def _settle(self, stream: Stream) -> None:
        """Copy the state of the session to its terminal and send its output."""
        session, terminal = stream.session, stream.terminal
        if session is None:
            return
        terminal.busy = session.busy
        attention = session.attention
        if (terminal.attention, attention) == (Attention.LISTENING, Attention.COMMANDS):
            # Characters the program has read are not part of the next command.
            terminal.begin_line(session.typed_ahead)
            session.typed_ahead = ""
        terminal.attention = attention
        terminal.echo = session.echo
        if terminal.mode != session.mode:
            terminal.mode = BinaryMode(session.mode)
        terminal.echo_line_end = session.echo_line_end
        output = session.take_output()
        if output:
            terminal.send_bytes(output)


def _work(event: Event) -> int:
    """The work an event may cause."""
    if isinstance(event, Received):
        return PACKET_WORK + VALUE_WORK * event.packet.value_count()
    if isinstance(event, ReceivedLine):
        return LINE_WORK + CHARACTER_WORK * len(event.text)
    if isinstance(event, Control):
        return KEY_WORK
    return LINE_WORK if isinstance(event, LineTooLong) else 0
