"""LINK: a part program that arrives over a serial line to be kept as a file.

It ends with Ctrl-Z, with the second %, or with silence after a block that ends a program
(M2, M30, M99). Whatever ends otherwise is not complete and is not kept: a sender that fails
between two lines must not leave a shorter program that looks whole.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

from openacr.cnc.reading.text import CONTROL_Z
from openacr.errors import UserError
from openacr.mill.config.communications import Line
from openacr.mill.run.handshake import SerialInput

MOST_BYTES = 32 << 20
MOST_READ = 65_536
POLL_S = 0.1
_DROPPED = bytes((0x00, 0x11, 0x12, 0x13, 0x14, 0x7F))  # leader, DC1 to DC4, rub-out
_NO_TEXT = re.compile(rb"[\x01-\x08\x0e-\x1f]")
_PERCENT = re.compile(rb"(?:\A|[\r\n])[ \t]*%")
_COMMENT = re.compile(rb"\([^)]*\)?|;.*")
_END = re.compile(rb"(?<![A-Z0-9.])M0*(?:2|30|99)(?![0-9.])", re.IGNORECASE)


class ArrivingFile:
    """The text of a part program as far as it has arrived."""

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._data = bytearray()
        self._most_bytes = most_bytes
        self._searched = 0  # where the next search for % begins
        self._line_feeds = self._returns = 0
        self.is_framed = False  # began with %
        self.is_complete = False

    @property
    def bytes_cnt(self) -> int:
        """The count of bytes that are kept."""
        return len(self._data)

    @property
    def lines_cnt(self) -> int:
        """The count of lines that have arrived whole."""
        return self._line_feeds or self._returns

    def add(self, data: bytes) -> None:
        """Append what has arrived, up to the end of the program; UserError for what is no text."""
        if self.is_complete:
            return
        text, mark, _ = data.translate(None, _DROPPED).partition(CONTROL_Z)
        if wrong := _NO_TEXT.search(text):
            raise UserError(
                f"byte 0x{wrong[0][0]:02x} is no text: baud rate, data bits and parity must be"
                " those of the sender"
            )
        self._data += text
        self._line_feeds += text.count(b"\n")
        self._returns += text.count(b"\r")
        self._find_percent()
        self.is_complete |= bool(mark)
        if len(self._data) > self._most_bytes:
            raise UserError(f"the program is longer than {self._most_bytes} bytes")

    def _find_percent(self) -> None:
        while found := _PERCENT.search(self._data, self._searched):
            self._searched = found.end()
            if not self.is_framed and not self._data[: found.end() - 1].strip():
                self.is_framed = True
                continue
            del self._data[found.end() :]
            self.is_complete = True
            return
        last = max(self._data.rfind(mark, self._searched) for mark in (b"\r", b"\n"))
        self._searched = max(self._searched, last)

    @property
    def may_end(self) -> bool:
        """Whether silence ends the program: its last block ends one, and no % is missing."""
        last = bytes(self._data[-1000:]).strip().replace(b"\r", b"\n").rpartition(b"\n")[2]
        return not self.is_framed and bool(_END.search(_COMMENT.sub(b"", last)))

    @property
    def program(self) -> bytes:
        """The program with lines that end in LF; UserError when it is empty."""
        text = bytes(self._data)
        text = text.replace(b"\r", b"") if b"\n" in text else text.replace(b"\r", b"\n")
        if not text.strip(b"% \t\n"):
            raise UserError("the program is empty")
        return text.strip(b"\n") + b"\n"


@dataclass(frozen=True, slots=True)
class Patience:
    """Seconds of silence: before the first byte, after an end, and in the middle."""

    first_s: float = 30.0
    after_end_s: float = 3.0
    amid_s: float = 30.0


class Reception:
    """The reception of one part program."""

    def __init__(self, line: Line, patience: Patience, most_bytes: int = MOST_BYTES) -> None:
        self.port = line.port
        self.text = ArrivingFile(most_bytes)
        self._patience = patience
        self._silent_s = 0.0
        self._input = SerialInput(line, POLL_S)

    def run(self, is_cancelled: Callable[[], bool] = lambda: False) -> bytes | None:
        """Receive until the program ends; None when cancelled, UserError when it fails."""
        try:
            self._input.release()
            while not self.text.is_complete:
                if is_cancelled():
                    self._input.hold_back()
                    return None
                self._take()
            return self.text.program
        except UserError as error:
            text = str(error)
            raise UserError(
                text if text.startswith(self.port) else f"{self.port}: {text}"
            ) from None
        finally:
            self._input.close()

    def _take(self) -> None:
        data = self._input.read(MOST_READ)
        if data:
            self._silent_s = 0.0
            self._add(data)
            return
        self._silent_s += POLL_S
        if not self.text.bytes_cnt:
            self._require(self._patience.first_s, "nothing was received")
        elif not self.text.may_end:
            end = "the closing %" if self.text.is_framed else "%, Ctrl-Z, M2, M30 or M99"
            after = f"line {self.text.lines_cnt}" if self.text.lines_cnt else "the first line"
            self._require(self._patience.amid_s, f"the sender stopped after {after}, before {end}")
        elif self._silent_s >= self._patience.after_end_s:
            self.text.is_complete = True

    def _add(self, data: bytes) -> None:
        try:
            self.text.add(data)
        except UserError:
            self._input.hold_back()
            raise

    def _require(self, limit_s: float, why: str) -> None:
        """End the reception when the line has been silent for too long."""
        if self._silent_s >= limit_s:
            raise UserError(f"{why} (silent for {limit_s:g} s)")
