"""The Drive Talk lines of the card, one for each port, in rows of the map.

A line is open while a program has OPEN DTALK on its port. On it the card exchanges one line of
text after the other; a terminal may take it for itself (DTALK axis).
"""

from __future__ import annotations

from collections.abc import Iterator

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import drive_talk, drive_talk_lines
from openacr.network.wake_cy import DRIVE_REQUESTS

PORTS = ("LPT1", "COM1", "COM2", "", "STREAM3", "STREAM4", "STREAM5")
FIRST_WORD = at.W_DTALK_LPT1  # the flag words of the ports follow each other
DEFAULT_BAUD = 9600
BS, LF, CR, DEL = 0x08, 0x0A, 0x0D, 0x7F
AT_ONCE_TK = 1.0


class TalkLine:
    """The line of one port."""

    def __init__(self, memory: Memory, port: int) -> None:
        self.memory, self.port = memory, port

    def get(self, row: int) -> int:
        """Read a row of the line."""
        return self.memory.I[at.NETLI_BASE + self.port * at.NETLI_STRIDE + row]

    def put(self, row: int, value: int) -> None:
        """Write a row of the line."""
        self.memory.I[at.NETLI_BASE + self.port * at.NETLI_STRIDE + row] = value

    @property
    def due_tk(self) -> float:
        """End of the exchange in progress; 0 if there is none."""
        return self.memory.F[drive_talk_lines.due_tk[self.port]]

    @due_tk.setter
    def due_tk(self, tick: float) -> None:
        self.memory.F[drive_talk_lines.due_tk[self.port]] = tick

    @property
    def is_open(self) -> bool:
        """Whether a program has opened it."""
        return self.get(at.NETLI_DEVICE) != 0

    def axes(self) -> Iterator[int]:
        """The axes whose drives are reached over this line."""
        if self.is_open:
            for axis in range(at.DTK_COUNT):
                if line_of(self.memory, axis) == self.port:
                    yield axis

    @property
    def is_busy(self) -> bool:
        """Whether an exchange is in progress or requested."""
        if self.due_tk or self.memory.I[FIRST_WORD + self.port] & at.DTSF_AUTO_ADDRESS_ALL:
            return True
        return any(pending(self.memory, axis) for axis in self.axes())

    def flag(self, mask: int) -> None:
        """Set a flag of the stream."""
        self.memory.I[FIRST_WORD + self.port] |= mask

    # text in rows

    def text(self, row: int, count_row: int) -> str:
        """The characters from a row on."""
        return "".join(chr(self.get(row + place)) for place in range(self.get(count_row)))

    def put_text(self, row: int, count_row: int, text: str) -> None:
        """Keep characters, as many as there is room for."""
        kept = text[: at.NETLI_ANSWER_SIZE]
        self.put(count_row, len(kept))
        for place, character in enumerate(kept):
            self.put(row + place, ord(character))


def lines(memory: Memory) -> list[TalkLine]:
    """The lines of all ports."""
    return [TalkLine(memory, port) for port in range(at.NETL_COUNT)]


def line_of(memory: Memory, axis: int) -> int | None:
    """The port over which the card talks to the drive of an axis; None if none is open.

    P28672 + 256 n names a device; of several programs with that device the lowest counts.
    """
    device = memory.I[drive_talk.communication_device[axis]]
    found = [line for line in lines(memory) if line.is_open and line.get(_DEVICE) == device]
    return min(found, key=lambda line: line.get(at.NETLI_PROGRAM)).port if found else None


_DEVICE = at.NETLI_DEVICE


def pending(memory: Memory, axis: int) -> int:
    """The requests of an axis, as its control flags."""
    return memory.I[at.DTCF_WORD + axis] & DRIVE_REQUESTS


# opening and closing


def open_line(memory: Memory, name: str, key: tuple[int, int], settings: tuple[int, int]) -> None:
    """OPEN DTALK: `key` is program and device, `settings` baud rate and bits of a character."""
    line = TalkLine(memory, PORTS.index(name))
    rows = (at.NETLI_PROGRAM, at.NETLI_DEVICE, at.NETLI_BAUD, at.NETLI_CHARACTER_BITS)
    for row, value in zip(rows, (*key, *settings), strict=True):
        line.put(row, value)
    line.put(at.NETLI_AXIS, at.DTK_COUNT - 1)


def close_line(memory: Memory, name: str) -> None:
    """Close the line (CLOSE): later requests find no drive."""
    if name in PORTS:
        line = TalkLine(memory, PORTS.index(name))
        for row in range(at.NETLI_STRIDE):
            line.put(row, 0)
        line.due_tk = 0.0


def is_busy(memory: Memory, name: str) -> bool:
    """Whether the line of a port has not finished yet."""
    return name in PORTS and TalkLine(memory, PORTS.index(name)).is_busy


# a terminal that talks to a drive


def connect(memory: Memory, port: int, channel: int, axis: int) -> None:
    """DTALK: what is typed on a channel goes to the drive of an axis."""
    line = TalkLine(memory, port)
    line.put(at.NETLI_CHANNEL, channel + 1)
    line.put(at.NETLI_TALKS_TO, axis)
    line.put(at.NETLI_TYPED_COUNT, 0)


def disconnect(memory: Memory, channel: int) -> None:
    """ESC: the line is free for the requests of programs again."""
    for line in lines(memory):
        if line.get(at.NETLI_CHANNEL) == channel + 1:
            line.put(at.NETLI_CHANNEL, 0)
            line.put(at.NETLI_TYPED_COUNT, 0)
            wake(memory)


def type_byte(memory: Memory, channel: int, byte: int) -> str:
    """Take one byte typed for a drive; what the terminal shows of it."""
    line = next((each for each in lines(memory) if each.get(at.NETLI_CHANNEL) == channel + 1), None)
    if line is None or byte == LF:
        return ""
    typed = line.text(at.NETLI_TYPED, at.NETLI_TYPED_COUNT)
    if byte in (BS, DEL):
        last = typed[-1:]
        line.put_text(at.NETLI_TYPED, at.NETLI_TYPED_COUNT, typed[:-1] if last != "\r" else typed)
        return "\b \b" if last not in ("", "\r") else ""
    if len(typed) >= at.NETLI_TYPED_SIZE - (byte != CR):
        return ""  # the end of a line always finds room
    line.put_text(at.NETLI_TYPED, at.NETLI_TYPED_COUNT, typed + chr(byte))
    if byte == CR:
        wake(memory)
        return "\r\n"
    return chr(byte)


def wake(memory: Memory) -> None:
    """Have the networks attended to in this tick or the next."""
    memory.F[at.NETF_BASE + at.NETF_DUE_TK] = AT_ONCE_TK
