"""Devices #0 to #3 of the programs: the listening channels, and channels held OPEN."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.basic.channels.channel_words import FLAG_WORDS
from openacr.basic.channels.listeners import Listeners
from openacr.basic.channels.session import Session
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.ranges import DeviceNumber, ProgramNumber
from openacr.errors import CardError
from openacr.map.memory import Memory
from openacr.map.rows import devices
from openacr.map.words import strm
from openacr.messages import DEVICE_IN_USE, DEVICE_NOT_OPEN, INVALID_DEVICE
from openacr.network.drivetalk import lines

PER_PROGRAM = 4
MOST_BYTES = 1 << 16  # received and not read; then the sender is held until half of it is read
RESUME_BYTES = MOST_BYTES // 2
BS, LF, CR = 0x08, 0x0A, 0x0D

Key = tuple[int, int]  # program, device number


class Waiting(Struct, frozen=True):
    """What a snapshot keeps of one device: bytes received and not read."""

    program: ProgramNumber
    device: DeviceNumber
    data: bytes
    after_cr: bool


@dataclass(slots=True)
class _Queue:
    """Bytes received and not read; an LF after the CR of a line does not end a second one."""

    data: bytearray = field(default_factory=bytearray)
    after_cr: bool = False
    is_full: bool = False  # its sender is held


class Devices:
    """Input queues of all devices, and which channel each open device is."""

    def __init__(
        self, memory: Memory, sessions: Mapping[str, Session], listeners: Listeners
    ) -> None:
        self._memory = memory
        self._sessions = sessions
        self._listeners = listeners
        self._queues = {
            (program, device): _Queue()
            for program in range(PROGRAMS)
            for device in range(PER_PROGRAM)
        }

    def open(self, key: Key, name: str) -> None:
        """OPEN: the channel stops taking commands and belongs to the program."""
        session = self._sessions.get(name)
        if session is None:
            raise CardError(INVALID_DEVICE)
        if session.opened_by == key:
            return
        if session.opened_by is not None or self._session(key) is not None:
            raise CardError(DEVICE_IN_USE)
        session.opened_by = key
        self._mark(name, True)

    def close(self, key: Key) -> None:
        """CLOSE: the channel takes commands again; nothing happens to a closed device."""
        session = self._session(key)
        if session is not None:
            session.opened_by = None
            self._mark(session.name, False)
            lines.close_line(self._memory, session.name)
        self._clear(key)

    def close_all(self, program: int) -> None:
        """Close every device of a program."""
        for device in range(1, PER_PROGRAM):
            self.close((program, device))

    def is_sending(self, key: Key) -> bool:
        """Whether output of the device has not left yet."""
        session = self._session(key)
        if session is None:
            return False
        return session.has_output or lines.is_busy(self._memory, session.name)

    def write(self, key: Key, text: str) -> None:
        """Send text; device 0 is every channel that listens to the program."""
        if key[1] == 0:
            self._listeners.print(key[0], text)
        else:
            self._open_session(key).write(text)

    def check_open(self, key: Key) -> None:
        """Refuse a device that was not opened."""
        if key[1] != 0:
            self._open_session(key)

    # input

    def receive(self, key: Key, byte: int) -> None:
        """One byte for the device; at #0, the terminal, BS takes the last one back."""
        queue = self._queues[key]
        if byte == BS and key[1] == 0:
            if queue.data and queue.data[-1] != CR:
                queue.data.pop()
        else:
            queue.data.append(byte)
        self._count(key)

    def is_full(self, key: Key) -> bool:
        """Whether so much waits to be read that the sender is to be held."""
        return self._queues[key].is_full

    def read_key(self, key: Key) -> str:
        """The oldest character, or an empty string; never waits."""
        queue = self._queues[key]
        character = chr(queue.data.pop(0)) if queue.data else ""
        self._count(key)
        return character

    def read_line(self, key: Key) -> str | None:
        """The oldest complete line without its end; None while there is none."""
        queue = self._queues[key]
        if queue.after_cr and queue.data:
            queue.after_cr = False
            if queue.data[0] == LF:
                del queue.data[0]
        ends = [place for place in (queue.data.find(CR), queue.data.find(LF)) if place >= 0]
        line = None
        if ends:
            line = queue.data[: min(ends)].decode("latin-1")
            queue.after_cr = queue.data[min(ends)] == CR
            del queue.data[: min(ends) + 1]
        self._count(key)
        return line

    def take_begun_line(self, key: Key) -> str:
        """The characters after the last line end, which no program will read."""
        data = self._queues[key].data
        begin = max(data.rfind(CR), data.rfind(LF)) + 1
        begun = data[begin:].decode("latin-1")
        del data[begin:]
        self._count(key)
        return begun

    def row(self, key: Key, row: tuple[int, ...]) -> int:
        """Index (into I) of a row of the device, to wait for."""
        return row[key[0] * PER_PROGRAM + key[1]]

    def state(self) -> list[Waiting]:
        """What waits to be read, for a snapshot."""
        return [
            Waiting(*key, bytes(queue.data), queue.after_cr)
            for key, queue in self._queues.items()
            if queue.data or queue.after_cr
        ]

    def restore(self, state: Iterable[Waiting]) -> None:
        """Take over what `state` returned."""
        kept = {(each.program, each.device): each for each in state}
        for key in self._queues:
            found = kept.get(key)
            self._queues[key] = _Queue(bytearray(found.data), found.after_cr) if found else _Queue()
            self._count(key)

    def _session(self, key: Key) -> Session | None:
        return next((each for each in self._sessions.values() if each.opened_by == key), None)

    def _open_session(self, key: Key) -> Session:
        session = self._session(key)
        if session is None:
            raise CardError(DEVICE_NOT_OPEN)
        return session

    def _clear(self, key: Key) -> None:
        self._queues[key] = _Queue()
        self._memory.I[self.row(key, devices.prompted)] = 0
        self._count(key)

    def _count(self, key: Key) -> None:
        queue = self._queues[key]
        data = queue.data
        queue.is_full = len(data) >= (RESUME_BYTES if queue.is_full else MOST_BYTES)
        self._memory.I[self.row(key, devices.characters)] = len(data)
        self._memory.I[self.row(key, devices.lines)] = data.count(CR) + data.count(LF)

    def _mark(self, name: str, on: bool) -> None:
        """Show OPEN in the flags of channels that have a flag word."""
        if name in FLAG_WORDS:
            word = FLAG_WORDS[name]
            self._memory.I[word] &= ~(strm.STREAM_OPENED | strm.OPEN_REQUEST)
            if on:
                self._memory.I[word] |= strm.STREAM_OPENED
