"""The Drive Talk lines of the card, one for each port, in rows of the map.

A line is open while a program has OPEN DTALK on its port. On it the card exchanges one line of
text after the other; a terminal may take it for itself (DTALK axis).
"""

from __future__ import annotations

from collections.abc import Iterator

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import drive_talk, drive_talk_lines, networks
from openacr.map.words import dtcf, dtsf
from openacr.network.drivetalk.real import RealDrives
from openacr.network.wake_cy import DRIVE_REQUESTS

PORTS = ("LPT1", "COM1", "COM2", "", "STREAM3", "STREAM4", "STREAM5")
FIRST_WORD = at.W_DTALK_LPT1  # the flag words of the ports follow each other
DEFAULT_BAUD = 9600
BS, LF, CR, DEL = 0x08, 0x0A, 0x0D, 0x7F
AT_ONCE_TK = 1.0


class TalkLine:
    """The line of one port."""

    def __init__(self, memory: Memory, port: int, real: RealDrives | None = None) -> None:
        self.memory, self.port, self.real = memory, port, real

    def get(self, row: tuple[int, ...]) -> int:
        """Read a row of the line."""
        return self.memory.I[row[self.port]]

    def put(self, row: tuple[int, ...], value: int) -> None:
        """Write a row of the line."""
        self.memory.I[row[self.port]] = value

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
        return self.get(drive_talk_lines.device) != 0

    def axes(self) -> Iterator[int]:
        """The axes whose drives are reached over this line."""
        if self.is_open:
            for axis in range(drive_talk.COUNT):
                if line_of(self.memory, axis) == self.port:
                    yield axis

    @property
    def is_busy(self) -> bool:
        """Whether an exchange is in progress or requested."""
        if self.due_tk or self.memory.I[FIRST_WORD + self.port] & dtsf.AUTO_ADDRESS_ALL:
            return True
        return any(pending(self.memory, axis) for axis in self.axes())

    def flag(self, mask: int) -> None:
        """Set a flag of the stream."""
        self.memory.I[FIRST_WORD + self.port] |= mask

    # text in rows

    def text(self, row: tuple[int, ...], count_row: tuple[int, ...]) -> str:
        """The characters from a row on."""
        first = row[self.port]
        return "".join(map(chr, self.memory.I[first : first + self.get(count_row)]))

    def put_text(self, row: tuple[int, ...], count_row: tuple[int, ...], text: str) -> None:
        """Keep characters, as many as there is room for."""
        kept = text[: drive_talk_lines.ANSWER_SIZE]
        self.put(count_row, len(kept))
        for place, character in enumerate(kept, row[self.port]):
            self.memory.I[place] = ord(character)


def lines(memory: Memory, real: RealDrives | None = None) -> list[TalkLine]:
    """The lines of all ports, some of whose drives may be real."""
    return [TalkLine(memory, port, real) for port in range(drive_talk_lines.COUNT)]


def line_of(memory: Memory, axis: int) -> int | None:
    """The port over which the card talks to the drive of an axis; None if none is open.

    P28672 + 256 n names a device; of several programs with that device the lowest counts.
    """
    device = memory.I[drive_talk.communication_device[axis]]
    found = [line for line in lines(memory) if line.is_open and line.get(_DEVICE) == device]
    return min(found, key=lambda line: line.get(drive_talk_lines.program)).port if found else None


_DEVICE = drive_talk_lines.device


def pending(memory: Memory, axis: int) -> int:
    """The requests of an axis, as its control flags."""
    return memory.I[dtcf.word[axis]] & DRIVE_REQUESTS


# opening and closing


def open_line(memory: Memory, name: str, key: tuple[int, int], settings: tuple[int, int]) -> None:
    """OPEN DTALK: `key` is program and device, `settings` baud rate and bits of a character."""
    line = TalkLine(memory, PORTS.index(name))
    rows = (
        drive_talk_lines.program,
        drive_talk_lines.device,
        drive_talk_lines.baud,
        drive_talk_lines.character_bits,
    )
    for row, value in zip(rows, (*key, *settings), strict=True):
        line.put(row, value)
    line.put(drive_talk_lines.axis, drive_talk.COUNT - 1)


def close_line(memory: Memory, name: str) -> None:
    """Close the line (CLOSE): later requests find no drive."""
    if name in PORTS:
        line = TalkLine(memory, PORTS.index(name))
        for place in range(drive_talk_lines.INTS_SIZE):
            memory.I[drive_talk_lines.ints[line.port] + place] = 0
        line.due_tk = 0.0


def is_busy(memory: Memory, name: str) -> bool:
    """Whether the line of a port has not finished yet."""
    return name in PORTS and TalkLine(memory, PORTS.index(name)).is_busy


# a terminal that talks to a drive


def connect(memory: Memory, port: int, channel: int, axis: int) -> None:
    """DTALK: what is typed on a channel goes to the drive of an axis."""
    line = TalkLine(memory, port)
    line.put(drive_talk_lines.channel, channel + 1)
    line.put(drive_talk_lines.talks_to, axis)
    line.put(drive_talk_lines.typed_count, 0)


def disconnect(memory: Memory, channel: int) -> None:
    """ESC: the line is free for the requests of programs again."""
    for line in lines(memory):
        if line.get(drive_talk_lines.channel) == channel + 1:
            line.put(drive_talk_lines.channel, 0)
            line.put(drive_talk_lines.typed_count, 0)
            wake(memory)


def type_byte(memory: Memory, channel: int, byte: int) -> str:
    """Take one byte typed for a drive; what the terminal shows of it."""
    line = next(
        (each for each in lines(memory) if each.get(drive_talk_lines.channel) == channel + 1), None
    )
    if line is None or byte == LF:
        return ""
    typed = line.text(drive_talk_lines.typed, drive_talk_lines.typed_count)
    if byte in (BS, DEL):
        last = typed[-1:]
        line.put_text(
            drive_talk_lines.typed,
            drive_talk_lines.typed_count,
            typed[:-1] if last != "\r" else typed,
        )
        return "\b \b" if last not in ("", "\r") else ""
    if len(typed) >= drive_talk_lines.TYPED_SIZE - (byte != CR):
        return ""  # the end of a line always finds room
    line.put_text(drive_talk_lines.typed, drive_talk_lines.typed_count, typed + chr(byte))
    if byte == CR:
        wake(memory)
        return "\r\n"
    return chr(byte)


def wake(memory: Memory) -> None:
    """Have the networks attended to in this tick or the next."""
    memory.F[networks.due_tk] = AT_ONCE_TK
