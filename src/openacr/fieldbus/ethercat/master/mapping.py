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
MOST_PDOS, SMALL_PDO_BITS = 8, 64
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
    objects: Objects, assigned: int, pdo: int, entries: Sequence[Entry], described: Sequence[Pdo]
) -> Layout:
    """Map these objects; the layout as it is then.

    They are mapped to one PDO, else to several small ones from `pdo` on, else PDOs that the device
    has `described` and that hold them are assigned as they are. BusError if it refuses all of it,
    and has not all of `entries` in its process data by itself.
    """
    why = ""
    for mapped in _choices(pdo, entries, described):
        try:
            _write(objects, assigned, mapped)
        except SdoError as refused:
            why = why or str(refused)
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


# The PDOs to assign, each with the objects to map, or None to leave it as it is.
_Mapped = dict[int, Sequence[Entry] | None]


def _choices(pdo: int, entries: Sequence[Entry], described: Sequence[Pdo]) -> Iterator[_Mapped]:
    yield {pdo: entries}
    for most in (8, 4, 2):
        parts = list(_parts(entries, most))
        if 1 < len(parts) <= MOST_PDOS:
            yield dict(enumerate(parts, pdo))
    if chosen := _holding(entries, described):
        yield dict.fromkeys(chosen)


def _parts(entries: Sequence[Entry], most: int) -> Iterator[list[Entry]]:
    """The objects in order, in PDOs of at most 8 bytes and `most` objects, as CANopen has them."""
    part: list[Entry] = []
    for entry in entries:
        if part and (
            len(part) == most or sum(one.bits for one in part) + entry.bits > SMALL_PDO_BITS
        ):
            yield part
            part = []
        part.append(entry)
    yield part


def _holding(entries: Sequence[Entry], described: Sequence[Pdo]) -> list[int]:
    """PDOs that hold all these objects, those with most of them first; none if they do not."""
    left = {(entry.object, entry.bits) for entry in entries}
    chosen: list[int] = []
    while left:
        held = {
            pdo.index: left & {(e.index, e.bits) for e in pdo.entries if not e.subindex}
            for pdo in described
        }
        best = max(held, key=lambda index: len(held[index]), default=None)
        if best is None or not held[best]:
            return []
        chosen.append(best)
        left -= held[best]
    return sorted(chosen)


def _write(objects: Objects, assigned: int, mapped: _Mapped) -> None:
    objects.write(assigned, 0, b"\0")
    for pdo, entries in mapped.items():
        if entries is None:
            continue
        objects.write(pdo, 0, b"\0")
        for number, entry in enumerate(entries, 1):
            mapping = entry.object << 16 | entry.bits
            objects.write(pdo, number, mapping.to_bytes(4, "little"))
        objects.write(pdo, 0, bytes([len(entries)]))
    for number, pdo in enumerate(mapped, 1):
        objects.write(assigned, number, pdo.to_bytes(2, "little"))
    objects.write(assigned, 0, bytes([len(mapped)]))


def _read(objects: Objects, assigned: int) -> Layout:
    return Layout(tuple(_items(objects, assigned)))


def _items(objects: Objects, assigned: int) -> Iterator[tuple[int, int, int]]:
    for number in range(1, objects.number(assigned) + 1):
        pdo = objects.number(assigned, number)
        for place in range(1, objects.number(pdo) + 1):
            mapping = objects.number(pdo, place)
            yield mapping >> 16, mapping >> 8 & 0xFF, mapping & 0xFF
