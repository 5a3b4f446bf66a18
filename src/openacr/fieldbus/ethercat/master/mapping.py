"""What is in the process data of a device: chosen by SDO where it can be, else as it is."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from struct import Struct

from openacr.fieldbus.cia402.objects import Entry
from openacr.fieldbus.ethercat.master.port import BusError
from openacr.fieldbus.ethercat.master.sdo import Objects, SdoError
from openacr.fieldbus.ethercat.wire.sii import Pdo

OUTPUTS_ASSIGNED = 0x1C12
INPUTS_ASSIGNED = 0x1C13
WORD = 16
FIRST_OUTPUT_PDO = 0x1600
FIRST_INPUT_PDO = 0x1A00


@dataclass(frozen=True, slots=True)
class Layout:
    """The objects of one direction in order: index, subindex and bits of each."""

    items: tuple[tuple[int, int, int], ...] = ()

    @property
    def size(self) -> int:
        """Bytes of it."""
        return (sum(bits for _, _, bits in self.items) + 7) // 8

    def place(self, entry: Entry) -> int | None:
        """The byte at which an object begins; None if it is not there, or not at a byte."""
        at = 0
        for index, subindex, bits in self.items:
            if (index, subindex, bits) == (entry.object, 0, entry.bits):
                return at // 8 if at % 8 == 0 else None
            at += bits
        return None

    def missing(self, entries: Iterable[Entry]) -> list[Entry]:
        """Which of these objects are not there."""
        return [entry for entry in entries if self.place(entry) is None]

    @property
    def contacts(self) -> list[int]:
        """The bits, counted from 0, that are objects of a bit: channels of a digital terminal.

        Beside analog channels bits are states of these, and no contacts.
        """
        if self.words:
            return []
        found, at = [], 0
        for index, _, bits in self.items:
            if index and bits == 1:
                found.append(at)
            at += bits
        return found

    @property
    def words(self) -> list[int]:
        """The bytes at which objects of 16 bits begin: channels of an analog terminal."""
        found, at = [], 0
        for index, _, bits in self.items:
            if index and bits == WORD and at % 8 == 0:
                found.append(at // 8)
            at += bits
        return found


@dataclass(frozen=True, slots=True)
class Signal:
    """An object in the process data of the whole bus."""

    form: Struct
    at: int

    @classmethod
    def of(cls, entry: Entry, layout: Layout, first: int) -> "Signal":
        """Where an object of a layout is, whose first byte is at `first`."""
        place = layout.place(entry)
        if place is None:
            raise BusError(f"object 0x{entry.object:04X} ({entry.name}) is not mapped")
        return cls(Struct("<" + entry.type), first + place)

    def get(self, image: bytes | bytearray) -> int:
        """Its value."""
        value: int = self.form.unpack_from(image, self.at)[0]
        return value

    def put(self, image: bytearray, value: int) -> None:
        """Give it a value."""
        self.form.pack_into(image, self.at, value)


def of_pdos(pdos: Iterable[Pdo]) -> Layout:
    """The layout of PDOs of an EEPROM that are assigned to a sync manager."""
    assigned = [pdo for pdo in pdos if pdo.sync != 0xFF]
    return Layout(tuple((e.index, e.subindex, e.bits) for pdo in assigned for e in pdo.entries))


def map_objects(
    objects: Objects, assigned: int, pdo: int, entries: Sequence[Entry], also: Sequence[Entry] = ()
) -> Layout:
    """Map these objects, `also` if the device has room for them; the layout as it is then.

    BusError if the device refuses, and has not all of `entries` in its process data by itself.
    """
    for wanted in ([*entries, *also], entries) if also else (entries,):
        try:
            _write(objects, assigned, pdo, wanted)
        except SdoError as refused:
            why = str(refused)
        else:
            return _read(objects, assigned)
    layout = _read(objects, assigned)
    if missing := layout.missing(entries):
        names = ", ".join(f"0x{entry.object:04X} ({entry.name})" for entry in missing)
        raise BusError(
            f"{objects.device.label} has no process data for {names},"
            f" and lets none be mapped: {why}"
        )
    return layout


def _write(objects: Objects, assigned: int, pdo: int, entries: Sequence[Entry]) -> None:
    objects.write(assigned, 0, b"\0")
    objects.write(pdo, 0, b"\0")
    for number, entry in enumerate(entries, 1):
        mapping = entry.object << 16 | entry.bits
        objects.write(pdo, number, mapping.to_bytes(4, "little"))
    objects.write(pdo, 0, bytes([len(entries)]))
    objects.write(assigned, 1, pdo.to_bytes(2, "little"))
    objects.write(assigned, 0, b"\1")


def _read(objects: Objects, assigned: int) -> Layout:
    return Layout(tuple(_items(objects, assigned)))


def _items(objects: Objects, assigned: int) -> Iterator[tuple[int, int, int]]:
    for number in range(1, objects.number(assigned) + 1):
        pdo = objects.number(assigned, number)
        for place in range(1, objects.number(pdo) + 1):
            mapping = objects.number(pdo, place)
            yield mapping >> 16, mapping >> 8 & 0xFF, mapping & 0xFF
