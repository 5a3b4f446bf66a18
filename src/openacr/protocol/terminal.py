"""The line discipline of one stream: turns bytes into lines, packets and control keys.

Feed bytes with `receive_data(data, tick)`, then pull events with `next_event()` until it
returns NEED_DATA. Act on each event before pulling the next: echo is produced as bytes
are scanned, so the answer to a line then precedes the echo of the following one, and
a changed ECHO or MODE applies from the next byte on.

While a line is being executed the owner sets `busy`. Scanning goes on (control keys and
packets never wait, typed characters are echoed), but complete lines queue up inside and
come out one by one after `busy` is cleared.

What the bytes mean (for TERMINAL and SERIAL streams):

    CR, LF, CR LF         end of line; an LF directly after a CR is ignored, however late
    BS, DEL               erase the last character
    Ctrl-X, Ctrl-Y, Ctrl-Z  act at once, leave the typed characters in place
    ESC                   ends listening; otherwise discards the typed characters
    XON, XOFF             serial only: resume, hold output
    00 04 07 1C 1D 1F     start of a binary packet; a typed line continues after it
    other controls        ignored, except TAB

On the port for packets the same holds once `takes_text` is set. Hosts pad a text there with zeros
to a multiple of TEXT_UNIT bytes: after the end of a line these begin no packet.
"""

import logging
import re
from collections import deque
from collections.abc import Callable
from typing import Annotated, TypeAlias

from msgspec import Meta, Struct

from openacr.channels import Attention, BinaryMode, EchoMode, StreamKind
from openacr.lang.lexer import LINE_LIMIT
from openacr.protocol.escape import encode_packet
from openacr.protocol.events import (
    NEED_DATA,
    Control,
    ControlKey,
    Escape,
    Event,
    LineTooLong,
    NeedData,
    Received,
    ReceivedLine,
    Typed,
)
from openacr.protocol.framing import PacketReader, ReaderState
from openacr.protocol.move import Move, unpadded
from openacr.protocol.output import Output, OutputState
from openacr.protocol.override import Override, belongs_to_next
from openacr.protocol.packets import (
    HEADER_IDS,
    REQUEST_BYTES,
    Packet,
    PacketError,
    decode,
    request,
)
from openacr.protocol.segment import Segment
from openacr.protocol.typed_line import TypedLine, bytes_of, text_of

log = logging.getLogger(__name__)

BACKLOG_LIMIT_BYTES = 1 << 16
RESUME_BYTES = (
    BACKLOG_LIMIT_BYTES // 2
)  # hysteresis: senders are not held and released all the time
BS, TAB, LF, CR, XON, XOFF, ESC, DEL = 0x08, 0x09, 0x0A, 0x0D, 0x11, 0x13, 0x1B, 0x7F
CRLF = b"\r\n"
TEXT_UNIT = 4  # bytes of which texts on the port for packets are multiples
ECHO_CHARACTERS = EchoMode.CHARACTERS.value  # an enum would cost more than the echo itself
ERASE = b"\b \b"
_CHARACTERS = re.compile(rb"[^\x00-\x08\x0a-\x1f\x7f]+")  # no key, no packet
_HEADERS = {b"", *(bytes((byte,)) for byte in HEADER_IDS)}
LineBytes: TypeAlias = Annotated[bytes, Meta(max_length=LINE_LIMIT)]


class TerminalState(Struct, frozen=True):
    """The state of a terminal in a snapshot; a line that was too long is None."""

    kind: StreamKind
    echo: Annotated[int, Meta(ge=0, le=7)]
    mode: Annotated[int, Meta(ge=0, le=3)]
    attention: Attention
    busy: bool
    echo_line_end: bool
    timeout_tk: Annotated[int, Meta(ge=1)]
    output: OutputState
    segments: list[tuple[bytes, int, bool]]  # bytes, their tick, none of them is scanned yet
    lines: list[LineBytes | None]
    is_full: bool
    typed: LineBytes
    typed_excess: Annotated[int, Meta(ge=0)]
    after_cr: bool
    reader: ReaderState
    odd: Annotated[int, Meta(ge=0, lt=TEXT_UNIT)] = 0


class Terminal:
    """One stream of the card, sans I/O; time is the tick given with the bytes."""

    def __init__(self, kind: StreamKind, *, timeout_tk: int, short_overrides: bool = False) -> None:
        self.kind = kind
        self.echo = ECHO_CHARACTERS  # bits of EchoMode
        self.mode: BinaryMode = kind.startup_mode
        self.attention = Attention.COMMANDS
        self.busy = False
        self.takes_text = kind is not StreamKind.PACKETS
        self.echo_line_end = True  # `INPUT;` turns this off for the line it reads
        self.timeout_tk = timeout_tk
        self.output = Output()
        self._looked: deque[Segment] = deque()  # segments whose control keys have been taken,
        self._fresh: deque[Segment] = deque()  # and those that follow
        self._lines: deque[ReceivedLine | LineTooLong] = deque()
        self._backlog = 0
        self._is_full = False
        self._typing = TypedLine()
        self._after_cr = False
        self._odd = 0  # count of the characters on the port for packets, in its last unit
        self._has_refused_override = False
        self._reader = PacketReader(kind is StreamKind.DPCB, short_overrides)
        self._keys = self._key_table()

    def _key_table(self) -> dict[int, Callable[[], Event | None]]:
        """Bytes with a special effect while text is typed."""
        keys: dict[int, Callable[[], Event | None]] = {
            CR: self._carriage_return,
            LF: self._line_feed,
            BS: self._erase,
            DEL: self._erase,
            ESC: self.escape,
        }
        if self.kind is StreamKind.SERIAL:
            keys |= {XON: self._resume, XOFF: self._hold}
        return keys

    # --- input ------------------------------------------------------------------------

    def begins_text(self, data: bytes) -> bool:
        """Whether bytes that arrive now begin with a character, not with a packet."""
        is_text = data[:1] not in _HEADERS
        return is_text and not (self._reader.reading or self._looked or self._fresh)

    def receive_data(self, data: bytes, tick: int) -> None:
        """Take bytes that arrived together at `tick`."""
        if data:
            self._fresh.append(Segment(data, tick))
            self._backlog += len(data)

    def next_event(self) -> Event | NeedData:
        """The next event, or NEED_DATA when everything received has been processed."""
        if self._lines and not self.busy and self.attention is Attention.COMMANDS:
            return self._dequeue()
        while self._looked or self._fresh:
            event = self._scan()
            if isinstance(event, ReceivedLine | LineTooLong) and (self.busy or self._lines):
                self._enqueue(event)
            elif event is not None:
                return event
        self._note_backlog()
        return NEED_DATA

    def _note_backlog(self) -> None:
        self._is_full = self._backlog >= (RESUME_BYTES if self._is_full else BACKLOG_LIMIT_BYTES)

    @property
    def has_next(self) -> bool:
        """Whether `next_event` could continue with received bytes."""
        if self._looked or self._fresh:
            return True
        return bool(self._lines) and not self.busy and self.attention is Attention.COMMANDS

    def pause(self) -> list[ControlKey]:
        """Stop pulling events for now; returns the control keys in the bytes not scanned yet.

        They act at once, whatever was typed before them; of equal ones the last, as no time
        passes between them. After the start of a packet a byte
        may be anything: no keys are taken from there. What has been looked through is not looked
        through again, so that a pause costs the same however much waits.
        """
        self._note_backlog()
        keys: list[ControlKey] = []
        is_packet = self._reader.reading or self.kind is StreamKind.PACKETS
        while self._fresh and not is_packet:
            found, is_packet = self._fresh[0].take_keys()
            self._backlog -= len(found)
            keys += found
            if not is_packet:
                segment = self._fresh.popleft()
                if not segment.is_scanned:
                    self._looked.append(segment)
        return list(dict.fromkeys(reversed(keys)))[::-1]

    def _enqueue(self, line: ReceivedLine | LineTooLong) -> None:
        self._lines.append(line)
        self._backlog += _size(line)

    def _dequeue(self) -> ReceivedLine | LineTooLong:
        line = self._lines.popleft()
        self._backlog -= _size(line)
        return line

    @property
    def accepts_input(self) -> bool:
        """False while the backlog is so long that the sender should be held back."""
        return not self._is_full

    @property
    def waiting_lines(self) -> int:
        """Complete lines that wait for the one being executed."""
        return len(self._lines)

    @property
    def waiting_characters(self) -> int:
        """Characters received and not yet executed."""
        return self._backlog + len(self._typing.kept)

    def _scan(self) -> Event | None:
        """Use up the next byte."""
        waiting = self._looked or self._fresh
        segment = waiting[0]
        byte = segment.data[segment.at]
        segment.at += 1
        self._backlog -= 1
        event = self._byte(byte, segment)
        if segment.is_scanned:
            waiting.popleft()
        return event

    def _byte(self, byte: int, segment: Segment) -> Event | None:
        if self._reader.continues(segment.tick, self.timeout_tk):
            return self._packet_byte(byte, segment)
        if self.attention is Attention.OPEN:
            return Control(ControlKey(byte)) if _is_control(byte) else Typed(byte)
        is_padding = self._odd and self._after_cr and byte == 0
        if byte in HEADER_IDS and not is_padding:
            return self._packet_start(byte, segment)
        if self.kind is StreamKind.PACKETS:
            if not self.takes_text:
                return None
            self._odd = (self._odd + 1) % TEXT_UNIT
            if is_padding:
                return None
        if _is_control(byte):
            return Control(ControlKey(byte))
        return self._character(byte, segment)

    # --- packets ----------------------------------------------------------------------

    def _packet_start(self, byte: int, segment: Segment) -> Event | None:
        if not self.mode.prefixes:
            if byte == Move.HEADER[0] and segment.at == 1:
                documented = unpadded(segment.data)
                if documented is not None:
                    self._skip(segment, len(segment.rest))
                    return Received(decode(documented))
            asked = request(segment.data[segment.at - 1 : segment.at + REQUEST_BYTES - 1])
            if asked is not None:
                self._skip(segment, REQUEST_BYTES - 1)
                return Received(asked)
            whole = self._reader.whole_packet(segment.data, segment.at - 1)
            if whole:
                return self._packet_at_once(whole, segment)
        self._reader.start(byte, self.mode, segment.tick)
        return None

    def _packet_at_once(self, whole: bytes, segment: Segment) -> Event | None:
        self._skip(segment, len(whole) - 1)
        try:
            return self._received(decode(whole), segment)
        except PacketError:
            return None  # a broken packet gets no reply

    def _packet_byte(self, byte: int, segment: Segment) -> Event | None:
        if self.kind is StreamKind.SERIAL and byte in (XON, XOFF) and self.mode.prefixes:
            return self._keys[byte]()
        try:
            packet = self._reader.feed(self._together(segment), segment.tick)
        except PacketError:
            return None  # a broken packet gets no reply
        return None if packet is None else self._received(packet, segment)

    def _received(self, packet: Packet, segment: Segment) -> Received | None:
        if isinstance(packet, Override):
            rest = belongs_to_next(packet.encode())
            if rest is not None:
                self._refuse_override(packet, rest, segment)
                return None
        if packet.HEADER in (b"\x1c", b"\x1d") and segment.left == 1 and segment.rest == b"\0":
            self._skip(segment, 1)  # padding of one host, see `bits`
        return Received(packet)

    def _refuse_override(self, packet: Override, rest: bytes, segment: Segment) -> None:
        """Read again the bytes that a packet of the first edition has taken from the next one."""
        if rest and not self._reader.short_overrides:
            again = encode_packet(rest, self.mode)
            segment.data, segment.at, segment.looked = again + segment.rest, 0, 0
            self._backlog += len(again)
        if not self._has_refused_override:
            self._has_refused_override = True
            log.warning(
                "an override of %g was refused: a host that sends FOV and ROV in six bytes needs"
                " short_override_packets = true in machine.toml",
                packet.value,
            )

    def _together(self, segment: Segment) -> bytes:
        """The byte just scanned and those after it that certainly belong to the packet."""
        first = segment.at - 1
        data = segment.data[first : first + self._reader.whole_bytes]
        self._skip(segment, len(data) - 1)
        return data

    def _skip(self, segment: Segment, count: int) -> None:
        segment.at += count
        self._backlog -= count

    # --- text -------------------------------------------------------------------------

    def _character(self, byte: int, segment: Segment) -> Event | None:
        if self.attention is Attention.PASS_THROUGH:
            return self.escape() if byte == ESC else Typed(byte)
        key = self._keys.get(byte)
        if byte != LF:
            self._after_cr = False
        if key is not None:
            return key()
        if byte < 0x20 and byte != TAB:
            return None
        is_alone = self.attention is Attention.LISTENING or self.kind is StreamKind.PACKETS
        typed = bytes((byte,)) if is_alone else self._run(segment)
        self._typing.add(typed)
        self._echo(typed)
        return self._typed(byte)

    def _run(self, segment: Segment) -> bytes:
        """The character just scanned and those after it: nothing happens between them."""
        first = segment.at - 1
        found = _CHARACTERS.match(segment.data, first)
        typed = found[0] if found else segment.data[first : first + 1]
        self._skip(segment, len(typed) - 1)
        return typed

    def _typed(self, byte: int) -> Typed | None:
        return Typed(byte) if self.attention is Attention.LISTENING else None

    def _carriage_return(self) -> Event | None:
        self._after_cr = True
        return self._line_end()

    def _line_feed(self) -> Event | None:
        if self._after_cr:
            self._after_cr = False
            return None
        return self._line_end()

    def _line_end(self) -> Event:
        listening = self.attention is Attention.LISTENING
        if self.echo_line_end or not listening:
            self._echo(CRLF)
        line = self._typing.finish()
        return Typed(CR) if listening else line

    def _erase(self) -> Event | None:
        if self._typing.erase():
            self._echo(ERASE)
        return self._typed(BS)

    def escape(self) -> Event | None:
        """ESC, typed or requested: ends listening or talking, else drops what was typed."""
        if self.attention is Attention.PASS_THROUGH:
            return Escape()
        self._typing.clear()
        return Escape() if self.attention is Attention.LISTENING else None

    def _resume(self) -> None:
        self.output.stopped = False

    def _hold(self) -> None:
        self.output.stopped = True

    def begin_line(self, text: str) -> None:
        """Go on with a line of which this much is typed (and has been echoed) already."""
        self._typing.clear()
        self._typing.add(text.encode("latin-1"))

    # --- output -----------------------------------------------------------------------

    def _echo(self, data: bytes) -> None:
        if self.echo & ECHO_CHARACTERS:
            self.output.text(data)

    def send_bytes(self, data: bytes) -> None:
        """Queue text, or bytes as they are; what is queued together leaves together."""
        self.output.text(data)

    def send_packet(self, packet: bytes) -> None:
        """Queue a reply packet, converted by MODE."""
        self.output.packet(encode_packet(packet, self.mode))

    def data_to_send(self) -> bytes:
        """The bytes of the next write, or none."""
        return self.output.take()

    # --- snapshot ---------------------------------------------------------------------

    def state(self) -> TerminalState:
        """Everything, as plain data."""
        return TerminalState(
            kind=self.kind,
            echo=self.echo,
            mode=int(self.mode),
            attention=self.attention,
            busy=self.busy,
            echo_line_end=self.echo_line_end,
            timeout_tk=self.timeout_tk,
            output=self.output.state(),
            segments=[
                (segment.rest, segment.tick, segment.at == 0)
                for segment in (*self._looked, *self._fresh)
            ],
            lines=[
                bytes_of(line.text) if isinstance(line, ReceivedLine) else None
                for line in self._lines
            ],
            is_full=self._is_full,
            typed=bytes(self._typing.kept),
            typed_excess=self._typing.excess,
            after_cr=self._after_cr,
            reader=self._reader.state(),
            odd=self._odd,
        )

    def restore(self, state: TerminalState) -> None:
        """Take over what `state` returned, of a terminal of the same kind."""
        self.echo, self.mode = state.echo, BinaryMode(state.mode)
        self.attention, self.busy = state.attention, state.busy
        self.echo_line_end, self.timeout_tk = state.echo_line_end, state.timeout_tk
        self.output.restore(state.output)
        self._looked.clear()
        self._fresh = deque(_segment(*each) for each in state.segments if each[0])
        self._lines = deque(
            LineTooLong() if line is None else ReceivedLine(text_of(line)) for line in state.lines
        )
        self._backlog = sum(segment.left for segment in self._fresh)
        self._backlog += sum(map(_size, self._lines))
        self._is_full, self._after_cr, self._odd = state.is_full, state.after_cr, state.odd
        self._typing = TypedLine(bytearray(state.typed), state.typed_excess)
        self._reader.restore(state.reader)


def _segment(rest: bytes, tick: int, is_whole: bool) -> Segment:
    """Bytes that are not scanned yet; of a segment that is begun the first byte is past."""
    return Segment(rest, tick) if is_whole else Segment(b"\0" + rest, tick, 1)


def _is_control(byte: int) -> bool:
    return ControlKey.CTRL_X <= byte <= ControlKey.CTRL_Z


def _size(line: ReceivedLine | LineTooLong) -> int:
    return len(line.text) + 1 if isinstance(line, ReceivedLine) else 1
