"""Process data of a slave: which objects its outputs and inputs are made of, and their bytes."""

from dataclasses import dataclass
from struct import Struct

from openacr.fieldbus.ethercat.emulated.dictionary import (
    RO,
    SETUP,
    Access,
    Dictionary,
    Entry,
    SdoError,
    Value,
)
from openacr.fieldbus.ethercat.wire.coe import Abort
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.sii import Entry as Mapped
from openacr.fieldbus.ethercat.wire.sii import Pdo

MOST_MAPPED = 16
MOST_ASSIGNED = 8
LONGEST = 256  # bytes of outputs or inputs
RECEIVE_ASSIGNED, TRANSMIT_ASSIGNED = 0x1C12, 0x1C13
_FORMATS = {
    DataType.INTEGER8: "b",
    DataType.INTEGER16: "h",
    DataType.INTEGER32: "i",
    DataType.UNSIGNED8: "B",
    DataType.UNSIGNED16: "H",
    DataType.UNSIGNED32: "I",
    DataType.REAL32: "f",
    DataType.INTEGER64: "q",
    DataType.UNSIGNED64: "Q",
    DataType.REAL64: "d",
}


class Image:
    """The bytes of process data, as a list of entries in order; None is a gap."""

    def __init__(self, mapped: list[tuple[Entry | None, int]]) -> None:
        self.bits = sum(bits for _, bits in mapped)
        self.size = (self.bits + 7) // 8
        self._mapped = mapped
        self._entries = [entry for entry, _ in mapped if entry is not None]
        self._form = self._whole_bytes()

    def _whole_bytes(self) -> Struct | None:
        """The form of entries that all are whole bytes; None if not."""
        form = "<"
        for entry, bits in self._mapped:
            if bits % 8 or (entry is not None and entry.kind not in _FORMATS):
                return None
            form += f"{bits // 8}x" if entry is None else _FORMATS[entry.kind]
        return Struct(form)

    def take(self, memory: bytearray, start: int) -> None:
        """Give the entries what is in the memory."""
        if self._form is not None:
            values = self._form.unpack_from(memory, start)
            for entry, value in zip(self._entries, values, strict=True):
                entry.value = value
            return
        whole = int.from_bytes(memory[start : start + self.size], "little")
        for one, bits in self._mapped:
            if one is not None:
                one.value = _signed(one, whole & (1 << bits) - 1, bits)
            whole >>= bits

    def put(self, memory: bytearray, start: int) -> None:
        """Write the entries into the memory."""
        if self._form is not None:
            self._form.pack_into(memory, start, *[entry.value for entry in self._entries])
            return
        whole = place = 0
        for one, bits in self._mapped:
            if one is not None:
                whole |= (one.number & (1 << bits) - 1) << place
            place += bits
        memory[start : start + self.size] = whole.to_bytes(self.size, "little")

    def clear(self) -> None:
        """Set all entries to 0."""
        for entry in self._entries:
            entry.value = 0


def _signed(entry: Entry, value: int, bits: int) -> int:
    is_signed = entry.kind.name.startswith("INTEGER")
    return value - (1 << bits) if is_signed and value >> bits - 1 else value


@dataclass(slots=True)
class Mapping:
    """The objects 0x16xx and 0x1C12, or 0x1Axx and 0x1C13, of a dictionary."""

    dictionary: Dictionary
    assigned: int
    access: Access
    pdos: tuple[Pdo, ...]

    def add(self) -> None:
        """Write them into the dictionary, as the device describes them."""
        for pdo in self.pdos:
            self._add_pdo(pdo)
        indexes = [pdo.index for pdo in self.pdos if pdo.sync != 0xFF]
        # Where all PDOs are fixed and assigned there is nothing to choose.
        has_choice = any(not pdo.is_fixed or pdo.sync == 0xFF for pdo in self.pdos)
        access = SETUP if has_choice else RO
        count = Entry("Number of entries", DataType.UNSIGNED8, access, len(indexes))
        padded = indexes + [0] * (MOST_ASSIGNED - len(indexes))
        entries = [
            Entry(f"PDO {n}", DataType.UNSIGNED16, access, index, check=_NeedsZero(count))
            for n, index in enumerate(padded, 1)
        ]
        count.check = lambda value: self._check_assigned(int(value), entries)
        name = "RxPDO assignment" if self.assigned == RECEIVE_ASSIGNED else "TxPDO assignment"
        self.dictionary.add_record(self.assigned, name, entries, count)

    def _add_pdo(self, pdo: Pdo) -> None:
        access = RO if pdo.is_fixed else SETUP
        count = Entry("Number of entries", DataType.UNSIGNED8, access, len(pdo.entries))
        places = len(pdo.entries) if pdo.is_fixed else MOST_MAPPED
        values = [entry.mapping for entry in pdo.entries]
        entries = [
            Entry(f"Object {n}", DataType.UNSIGNED32, access, value, check=_NeedsZero(count))
            for n, value in enumerate(values + [0] * (places - len(values)), 1)
        ]
        count.check = lambda value: self._check_mapped(int(value), entries)
        self.dictionary.add_record(pdo.index, pdo.name, entries, count)

    def _check_mapped(self, count: int, entries: list[Entry]) -> None:
        if count > len(entries):
            raise SdoError(Abort.TOO_HIGH)
        self._image(entries[:count])

    def _check_assigned(self, count: int, entries: list[Entry]) -> None:
        if count > len(entries):
            raise SdoError(Abort.TOO_HIGH)
        known = {pdo.index for pdo in self.pdos}
        if any(entry.number not in known for entry in entries[:count]):
            raise SdoError(Abort.NO_OBJECT)
        if self._of_pdos([entry.number for entry in entries[:count]]).size > LONGEST:
            raise SdoError(Abort.PDO_LENGTH)

    def image(self) -> Image:
        """The process data as it is mapped now; SdoError if an object is not there."""
        one = self.dictionary.object(self.assigned)
        count = one.entries[0].number
        return self._of_pdos([one.entries[n].number for n in range(1, count + 1)])

    def _of_pdos(self, indexes: list[int]) -> Image:
        mapped: list[Entry] = []
        for index in indexes:
            one = self.dictionary.object(index)
            mapped += [one.entries[n] for n in range(1, one.entries[0].number + 1)]
        return self._image(mapped)

    def _image(self, mapped: list[Entry]) -> Image:
        found: list[tuple[Entry | None, int]] = []
        for each in mapped:
            index, subindex = each.number >> 16, each.number >> 8 & 0xFF
            bits = each.number & 0xFF
            if index == 0:
                found.append((None, bits))
                continue
            entry = self.dictionary.entry(index, subindex)
            if not entry.access & self.access:
                raise SdoError(Abort.NOT_MAPPABLE)
            if entry.bits != bits:
                raise SdoError(Abort.PDO_LENGTH)
            found.append((entry, bits))
        return Image(found)


@dataclass(frozen=True, slots=True)
class _NeedsZero:
    """Entries can be changed while their count is 0."""

    count: Entry

    def __call__(self, _: Value) -> None:
        if self.count.number:
            raise SdoError(Abort.UNSUPPORTED)


def gap(bits: int) -> Mapped:
    """Bits without an object."""
    return Mapped(0, 0, bits)
