"""The object dictionary of an emulated slave."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntFlag

from openacr.errors import UserError
from openacr.fieldbus.ethercat.wire import data_types
from openacr.fieldbus.ethercat.wire.coe import Abort
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.registers import State
from openacr.fieldbus.ethercat.wire.sdo_info import ObjectCode

Value = int | float | str | bytes


class SdoError(UserError):
    """A transfer that is aborted, with its code."""

    def __init__(self, code: Abort) -> None:
        super().__init__(code.text)
        self.code = code


class Access(IntFlag):
    """Who may do what with an entry, and whether it can be in process data (ETG.1000.6)."""

    READ = 0x07
    WRITE_PREOP = 0x08
    WRITE_SAFEOP = 0x10
    WRITE_OP = 0x20
    RECEIVE = 0x40  # in outputs of the master
    TRANSMIT = 0x80  # in inputs of the master
    WRITE = WRITE_PREOP | WRITE_SAFEOP | WRITE_OP


RO = Access.READ
RW = Access.READ | Access.WRITE
SETUP = Access.READ | Access.WRITE_PREOP
INPUT = Access.READ | Access.TRANSMIT
OUTPUT = Access.READ | Access.WRITE | Access.RECEIVE
_NEEDED = {
    State.PREOP: Access.WRITE_PREOP,
    State.SAFEOP: Access.WRITE_SAFEOP,
    State.OP: Access.WRITE_OP,
}


@dataclass(slots=True, eq=False)
class Entry:
    """One value. `low` and `high` bound what may be written; `check` may refuse with SdoError."""

    name: str
    kind: DataType
    access: Access = RO
    value: Value = 0
    low: float | None = None
    high: float | None = None
    check: Callable[[Value], None] | None = None

    @property
    def bits(self) -> int:
        """Its length now."""
        return self.kind.bits or 8 * len(self.read())

    @property
    def number(self) -> int:
        """Its value, which is a whole number."""
        return int(self.value)

    def read(self) -> bytes:
        """Its bytes."""
        return data_types.encode(self.kind, self.value)

    def write(self, data: bytes, state: State) -> None:
        """Take new bytes; SdoError if they are too long or short, out of range or not allowed."""
        if not self.access & Access.WRITE:
            raise SdoError(Abort.READ_ONLY)
        if not self.access & _NEEDED[state]:
            raise SdoError(Abort.STATE)
        size = self.kind.byte_count
        if size and len(data) != size:
            raise SdoError(Abort.TOO_LONG if len(data) > size else Abort.TOO_SHORT)
        value = data_types.decode(self.kind, data)
        if isinstance(value, int | float):
            if self.high is not None and value > self.high:
                raise SdoError(Abort.TOO_HIGH)
            if self.low is not None and value < self.low:
                raise SdoError(Abort.TOO_LOW)
        if self.check is not None:
            self.check(value)
        self.value = value


@dataclass(slots=True, eq=False)
class Object:
    """A variable (entry 0), or a record or array whose entry 0 says how many there are."""

    name: str
    entries: dict[int, Entry] = field(default_factory=dict)
    code: ObjectCode = ObjectCode.VARIABLE

    @property
    def kind(self) -> DataType:
        """The type of its entries; of a record the one of its first."""
        return self.entries[max(0, min(1, len(self.entries) - 1))].kind


class Dictionary:
    """Objects by index."""

    def __init__(self) -> None:
        self.objects: dict[int, Object] = {}

    def add(self, index: int, entry: Entry) -> Entry:
        """A variable."""
        self.objects[index] = Object(entry.name, {0: entry})
        return entry

    def add_record(
        self, index: int, name: str, entries: list[Entry], count: Entry | None = None
    ) -> Object:
        """A record of entries from subindex 1 on; `count` is entry 0, the number by default."""
        first = count or Entry("Number of entries", DataType.UNSIGNED8, RO, len(entries))
        numbered = {0: first, **dict(enumerate(entries, 1))}
        one = Object(name, numbered, ObjectCode.RECORD)
        self.objects[index] = one
        return one

    def object(self, index: int) -> Object:
        """An object; SdoError if there is none."""
        try:
            return self.objects[index]
        except KeyError:
            raise SdoError(Abort.NO_OBJECT) from None

    def entry(self, index: int, subindex: int) -> Entry:
        """An entry; SdoError if there is none."""
        try:
            return self.object(index).entries[subindex]
        except KeyError:
            raise SdoError(Abort.NO_SUBINDEX) from None

    def read(self, index: int, subindex: int, complete: bool) -> bytes:
        """The bytes of an entry, or of all from subindex 0 or 1 on."""
        if not complete:
            return self.entry(index, subindex).read()
        return b"".join(_whole(n, entry) for n, entry in self._all(index, subindex))

    def write(self, index: int, subindex: int, data: bytes, complete: bool, state: State) -> None:
        """Write an entry, or all from subindex 0 or 1 on as far as there is data.

        Of an object whose first entry counts the others, it is cleared first and written last.
        """
        if not complete:
            self.entry(index, subindex).write(data, state)
            return
        counts: bytes | None = None
        place = 0
        for number, entry in self._all(index, subindex):
            size = max(1, entry.kind.byte_count)
            part = data[place : place + size]
            if not part:
                break
            place += 2 if number == 0 else size
            if number == 0:
                counts = part
                if entry.access & Access.WRITE:
                    entry.write(b"\0", state)
            elif entry.access & Access.WRITE:
                entry.write(part, state)
        if place < len(data):
            raise SdoError(Abort.TOO_LONG)
        first = self.entry(index, 0)
        if counts is not None and first.access & Access.WRITE:
            first.write(counts, state)

    def _all(self, index: int, subindex: int) -> list[tuple[int, Entry]]:
        if subindex > 1:
            raise SdoError(Abort.SUBINDEX_0)
        entries = self.object(index).entries
        return [(number, entry) for number, entry in entries.items() if number >= subindex]


def _whole(number: int, entry: Entry) -> bytes:
    return entry.read() + (b"\0" if number == 0 else b"")
