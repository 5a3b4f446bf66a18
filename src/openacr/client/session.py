"""The host's end of one stream, sans I/O: requests become bytes, bytes become answers.

`begin(request)` returns the bytes to send, `receive_data` accepts the reply in pieces of
any size, `next_event` interprets it: an Answer when the request is complete, Heard
while a program is followed, NEED_DATA while bytes are missing. One request at a time:
a card answers in order and sends nothing unprompted, so one at a time is unambiguous.

How the end of a text answer is found depends on the ECHO mode:

    1, 0 (prompts on)    the prompt after the last output line
    4 (no prompts)       a second line is sent after the first: it prints a unique mark;
                         the answer ends where the mark is received

A packet reply repeats the request, followed by data of known length. It is found by the
repeated request, so text and packets may alternate on one stream.
"""

import re
from collections.abc import Callable

from openacr.channels import BinaryMode, EchoMode
from openacr.client.lines import bytes_of, split
from openacr.client.requests import (
    SYS,
    Align,
    Answer,
    Ask,
    Follow,
    Heard,
    Leave,
    Level,
    Line,
    Press,
    Request,
)
from openacr.errors import UserError
from openacr.lang.characters import readable
from openacr.protocol.escape import Decoder, encode_packet
from openacr.protocol.events import NEED_DATA, NeedData
from openacr.protocol.packet import WORD_BYTES
from openacr.protocol.packets import Packet

CR, CRLF, ESC = b"\r", b"\r\n", b"\x1b"
ECHO_MODES = (EchoMode.CHARACTERS, EchoMode.NO_PROMPT, EchoMode(0))
_PROMPT = rb"(SYS>|P\d\d>|PLC\d>)"
_AT_LINE_START = re.compile(rb"(?:^|\n)" + _PROMPT + rb"\Z")
_ANYWHERE = re.compile(_PROMPT + rb"\Z")
PROMPT_BYTES = len(b"\nPLC0>")  # the longest prompt
# A tail of a text that may become a prompt or a line end.
_UNFINISHED = re.compile(rb"(?:^|\n)(?:SY?|SYS|P\d{0,2}|PLC?|PLC\d)\Z|\r\Z")

Event = Answer | Heard | NeedData


class Session:
    """One stream as its host sees it."""

    def __init__(self, echo: EchoMode = EchoMode.CHARACTERS) -> None:
        if echo not in ECHO_MODES:
            raise UserError(f"ECHO {int(echo)}: the client works with ECHO 1, 4 and 0")
        self.echo = echo
        self.mode = BinaryMode.PLAIN
        self.level = SYS
        self.is_listening = False
        self._request: Request | None = None
        self._received = bytearray()
        self._total = 0
        self._scanned = 0  # bytes already searched for the mark
        self._marks = 0
        self._mark = b""
        self._is_echoed = False  # the echo of the line that began listening is removed
        self._wires: list[bytes] = []  # the packets of the request, as they travel
        self._readers: dict[type, Callable[[bool], Event]] = {
            Line: self._line,
            Ask: self._packet,
            Follow: self._followed,
            Leave: self._left,
            Align: self._aligned,
        }

    @property
    def has_prompts(self) -> bool:
        """The card ends every line with a prompt."""
        return not self.echo & EchoMode.NO_PROMPT

    @property
    def received(self) -> bytes:
        """The received bytes that are not interpreted yet."""
        return bytes(self._received)

    @property
    def received_bytes(self) -> int:
        """Bytes received since the last event, interpreted or discarded."""
        return self._total

    @property
    def is_fitting(self) -> bool:
        """Whether the received bytes can be the beginning of the answer."""
        expected = self._expected
        return self._received[: len(expected)] == expected[: len(self._received)]

    @property
    def _expected(self) -> bytes:
        """The bytes with which the answer begins."""
        if isinstance(self._request, Line) and self.echo & EchoMode.CHARACTERS:
            return bytes_of(self._request.text) + CRLF
        return self._wires[0] if isinstance(self._request, Ask) else b""

    def forget(self) -> None:
        """Discard an unfinished request, as after a lost connection."""
        self._request = None
        self._received.clear()
        self._total = self._scanned = 0
        self.is_listening = False

    # --- requests ---------------------------------------------------------------------

    def begin(self, request: Request) -> bytes:
        """Begin a request and return the bytes to send; earlier received bytes are discarded."""
        if not isinstance(request, Ask | Press | Leave):
            self.forget()
        self._request, self._total, self._scanned = request, 0, 0
        if isinstance(request, Line):
            return self._typed(request.text) + self._fence()
        if isinstance(request, Follow):
            self.is_listening, self._is_echoed = True, not self.echo & EchoMode.CHARACTERS
            return self._typed(request.text)
        if isinstance(request, Align):
            echo = self._typed(f"ECHO {int(self.echo)}")
            return ESC + CR + self._typed("SYS") + echo + self._mark_line()
        if isinstance(request, Ask):
            self._wires = [encode_packet(each.encode(), self.mode) for each in request.packets]
            return b"".join(self._wires)
        return ESC if isinstance(request, Leave) else bytes((request.key,))

    def _typed(self, text: str) -> bytes:
        return bytes_of(text) + CR

    def _fence(self) -> bytes:
        return b"" if self.has_prompts else self._mark_line()

    def _mark_line(self) -> bytes:
        """A line with unique output."""
        self._marks += 1
        self._mark = b"=%d=" % self._marks
        return b'PRINT "' + self._mark + b'"' + CR

    # --- answers ----------------------------------------------------------------------

    def receive_data(self, data: bytes) -> None:
        """Accept received bytes."""
        self._received += data
        self._total += len(data)

    @property
    def may_be_done(self) -> bool:
        """Whether the answer may be complete: wait only a moment, then call `end_of_data`."""
        if not self.has_prompts:
            return self.is_listening and bool(self._received)
        return self.is_listening or _ANYWHERE.search(self._received, self._tail) is not None

    @property
    def _tail(self) -> int:
        """The index at which a prompt at the end of the received bytes can begin."""
        return max(0, len(self._received) - PROMPT_BYTES)

    def next_event(self) -> Event:
        """Interpret the received bytes; Answer once the request is complete."""
        return self._next(is_silent=False)

    def end_of_data(self) -> Event:
        """Like `next_event`, when nothing more has arrived for a while."""
        return self._next(is_silent=True)

    def _next(self, *, is_silent: bool) -> Event:
        request = self._request
        if request is None:
            return self._followed(is_silent) if self.is_listening else NEED_DATA
        if isinstance(request, Press):
            return self._done(Answer())
        return self._readers[type(request)](is_silent)

    def _done(self, answer: Answer) -> Answer:
        """End the request; while listening the followed program continues to print."""
        self._request = None
        if not self.is_listening:
            self._received.clear()
        return answer

    def _reach(self, prompt: bytes) -> None:
        level = Level.of_prompt(prompt.decode())
        if level is not None:
            self.level = level

    # --- text -------------------------------------------------------------------------

    def _line(self, is_silent: bool) -> Event:
        request = self._request
        sent = request.text if isinstance(request, Line) else ""
        body = self._without_end(is_silent)
        if body is None:
            return NEED_DATA
        expected = bytes_of(sent) + CRLF if self.echo & EchoMode.CHARACTERS else b""
        if not body.startswith(expected):
            return self._done(Answer(is_garbled=True, raw=body))
        lines = split(body[len(expected) :])
        if not self.has_prompts and not lines:
            self.level = Level.of_line(sent) or self.level
        return self._done(Answer(lines))

    def _without_end(self, is_silent: bool) -> bytes | None:
        """The answer without prompt or mark, once its end has arrived."""
        if not self.has_prompts:
            end = self._received.find(self._mark + CRLF, self._scanned)
            self._scanned = max(0, len(self._received) - len(self._mark + CRLF))
            return None if end < 0 else bytes(self._received[:end])
        # The echo may contain anything, so a prompt counts only after it.
        begin = len(self._expected) if self.is_fitting else 0
        if len(self._received) < begin:
            return None
        pattern = _ANYWHERE if is_silent else _AT_LINE_START
        found = pattern.search(self._received, max(begin, self._tail))
        found = found or _ANYWHERE.fullmatch(self._received, begin)
        if found is None:
            return None
        self._reach(bytes(found[1]))
        return bytes(self._received[: found.start(1)])

    def _aligned(self, is_silent: bool) -> Event:
        end = self._mark + CRLF
        at = self._received.rfind(end)
        if at < 0:
            del self._received[: -len(end)]  # earlier output of the stream is discarded
            return NEED_DATA
        if self.has_prompts and not _ANYWHERE.fullmatch(self._received, at + len(end)):
            return NEED_DATA
        self.level = SYS
        return self._done(Answer())

    # --- packets ----------------------------------------------------------------------

    def _packet(self, is_silent: bool) -> Event:
        request = self._request
        if not isinstance(request, Ask):
            return NEED_DATA
        at, data, found = 0, b"", []
        for packet, wire in zip(request.packets, self._wires, strict=True):
            if not self.is_listening and not wire.startswith(self._received[at : at + len(wire)]):
                return self._done(Answer(is_garbled=True, raw=self.received))
            begin = self._received.find(wire, at)
            if begin < 0:
                return NEED_DATA
            reply = self._reply_data(packet, begin + len(wire))
            if reply is None:
                return NEED_DATA
            data, at = data + reply[0], reply[1]
            found.append((begin, at))
        for begin, end in reversed(found):
            del self._received[begin:end]
        return self._done(Answer(data=data))

    def _reply_data(self, packet: Packet, begin: int) -> tuple[bytes, int] | None:
        """The data after the repeated request, and the end of the reply."""
        wanted = packet.reply_words() * WORD_BYTES
        if not self.mode.prefixes:
            end = begin + wanted
            return (bytes(self._received[begin:end]), end) if end <= len(self._received) else None
        decoder, data = Decoder(self.mode), bytearray()
        for at in range(begin, len(self._received)):
            if len(data) == wanted:
                return bytes(data), at
            byte = decoder.feed(self._received[at])
            if byte is not None:
                data.append(byte)
        return (bytes(data), len(self._received)) if len(data) == wanted else None

    # --- listening --------------------------------------------------------------------

    def _followed(self, is_silent: bool) -> Event:
        """Text of the followed program; an Answer when it has ended."""
        if not self._is_echoed:
            _, end, rest = bytes(self._received).partition(CRLF)
            if not end:
                return NEED_DATA
            self._is_echoed, self._received = True, bytearray(rest)
        text = self.received
        prompt = _AT_LINE_START.search(text) if self.has_prompts else None
        if prompt is not None:
            return self._heard(prompt.start(1)) if prompt.start(1) else self._end(prompt[1])
        held = None if is_silent else _UNFINISHED.search(text)
        return self._heard(held.end() - len(held[0].lstrip(b"\n")) if held else len(text))

    def _heard(self, length: int) -> Event:
        """Report the first bytes as printed text; keep the rest."""
        if not length:
            return NEED_DATA
        self._total = 0
        text = readable(self._received[:length].decode("latin-1"))
        del self._received[:length]
        return Heard(text.replace("\r\n", "\n"))

    def _end(self, prompt: bytes) -> Answer:
        self._reach(prompt)
        self.is_listening = False
        return self._done(Answer())

    def _left(self, is_silent: bool) -> Event:
        if not self.is_listening:
            return self._done(Answer())
        if self.has_prompts:
            return self._followed(is_silent)
        if not self._received.endswith(CRLF) or not is_silent:
            return NEED_DATA
        self.is_listening = False
        return self._done(Answer())
