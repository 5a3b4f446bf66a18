"""The objects of an emulated I/O node, and its side of the SDO protocol."""

from collections.abc import Iterator

from openacr.fieldbus.canopen.frames import Cob
from openacr.fieldbus.canopen.io_node import (
    EACH_SYNC,
    GUARDING,
    INVALID,
    ON_CHANGE,
    PREDEFINED,
    PROFILE,
    Kind,
    parts,
)
from openacr.fieldbus.ethercat.wire import coe
from openacr.fieldbus.ethercat.wire.coe import Abort
from openacr.fieldbus.ethercat.wire.frames import WireError
from openacr.map.memory import Memory
from openacr.map.rows import bus_nodes
from openacr.plant.bus import bus, terminals

VENDOR, PRODUCT = 0x0ACC, 0x0401  # no registered vendor
NAME = b"openacr I/O node"
PDOS = 16
SEGMENT = 7
READ_ONLY = {0x1000, 0x1001, 0x1008, 0x1018, 0x6000, 0x6401}


class AbortedError(Exception):
    """An access that the node refuses."""

    def __init__(self, code: Abort) -> None:
        super().__init__(code.text)
        self.code = code


class Objects:
    """The objects of a node after power-up; those of signals are its terminals."""

    def __init__(self, memory: Memory, place: int) -> None:
        self._memory, self._place = memory, place
        number = memory.I[bus_nodes.id[place]]
        found = bus.describe(memory, place)
        kinds = [
            found.digital_input_bytes,
            found.digital_output_bytes,
            found.analog_inputs,
            found.analog_outputs,
        ]
        self._counts = dict(zip(Kind, kinds, strict=True))
        equipment = sum(bool(count) << 16 + bit for bit, count in enumerate(kinds))
        self.values: dict[tuple[int, int], bytes] = {
            (0x1000, 0): _u32(equipment | PROFILE),
            (0x1001, 0): b"\0",
            (0x1008, 0): NAME,
            (0x1018, 0): b"\4",
            (0x1018, 1): _u32(VENDOR),
            (0x1018, 2): _u32(PRODUCT),
            (0x1018, 3): _u32(1),
            (0x1018, 4): _u32(number),
            (0x6423, 0): b"\0",
        }
        if memory.I[bus_nodes.health[place]] == GUARDING:
            self.values |= {(0x100C, 0): b"\0\0", (0x100D, 0): b"\0"}
        else:
            self.values |= {(0x1017, 0): b"\0\0", (0x1016, 0): b"\1", (0x1016, 1): bytes(4)}
        self._add_pdos(number, 0x1800, Cob.INPUTS, (Kind.DIGITAL_INPUTS, Kind.ANALOG_INPUTS))
        self._add_pdos(number, 0x1400, Cob.OUTPUTS, (Kind.DIGITAL_OUTPUTS, Kind.ANALOG_OUTPUTS))
        self._sending, self._toggle = b"", False
        self._words, self._values = [0] * 16, [0] * self._counts[Kind.ANALOG_OUTPUTS]

    def _add_pdos(self, number: int, first: int, base: int, kinds: tuple[Kind, Kind]) -> None:
        digital, analog = (self._counts[kind] for kind in kinds)
        own = {part.pdo: part for part in parts(digital, analog, kinds)}
        for pdo in range(PDOS):
            identifier = base + 0x100 * pdo + number if pdo < PREDEFINED else 0
            part = own.get(pdo)
            is_used = part is not None and pdo < PREDEFINED
            is_digital = part is not None and part.kind is Kind.DIGITAL_INPUTS
            self.values[first + pdo, 0] = b"\2"
            self.values[first + pdo, 1] = _u32(identifier | (0 if is_used else INVALID))
            self.values[first + pdo, 2] = bytes((ON_CHANGE if is_digital else EACH_SYNC,))
            places = [] if part is None else range(part.first + 1, part.first + part.count + 1)
            self.values[first + 0x200 + pdo, 0] = bytes((len(places),))
            for place in range(8):
                entry = 0
                if part is not None and place < len(places):
                    entry = part.kind.value[0] << 16 | places[place] << 8 | part.kind.value[1]
                self.values[first + 0x200 + pdo, place + 1] = _u32(entry)

    def pdos(self, first: int) -> Iterator[int]:
        """The process data that are valid, of those whose first object this is."""
        for pdo in range(PDOS):
            if not int.from_bytes(self.values[first + pdo, 1], "little") & INVALID:
                yield pdo

    def cob(self, first: int, pdo: int) -> int:
        """The identifier of process data."""
        return int.from_bytes(self.values[first + pdo, 1][:2], "little") & 0x7FF

    def mapped(self, mapping: int) -> Iterator[tuple[int, int, int]]:
        """Index, subindex and bytes of what process data carry."""
        for place in range(1, self.values[mapping, 0][0] + 1):
            entry = int.from_bytes(self.values[mapping, place], "little")
            yield entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8

    def serve(self, data: bytes) -> bytes | None:
        """The answer to a frame of the SDO protocol; None to one that wants none."""
        index = subindex = 0
        try:
            request = coe.parse_request(data)
            if isinstance(request, coe.Upload | coe.Download):
                index, subindex = request.index, request.subindex
            reply = self._reply(request)
        except WireError:
            reply = coe.Aborted(index, subindex, Abort.COMMAND)
        except AbortedError as refusal:
            reply = coe.Aborted(index, subindex, refusal.code)
        return None if reply is None else reply.pack()[coe.COE_SIZE :]

    def _reply(self, request: coe.Request) -> coe.Reply | None:
        if isinstance(request, coe.Upload):
            data = self.get(request.index, request.subindex)
            first = data if len(data) <= coe.EXPEDITED else b""
            self._sending, self._toggle = data[len(first) :], False
            return coe.Uploaded(request.index, request.subindex, first, len(data))
        if isinstance(request, coe.UploadNext):
            if not self._sending or request.toggle is not self._toggle:
                raise AbortedError(Abort.TOGGLE if self._sending else Abort.COMMAND)
            part, self._sending = self._sending[:SEGMENT], self._sending[SEGMENT:]
            self._toggle = not self._toggle
            return coe.Segment(request.toggle, part, not self._sending)
        if isinstance(request, coe.Download):
            if len(request.data) != request.size:
                raise AbortedError(Abort.TOO_LONG)
            self.put(request.index, request.subindex, request.data)
            return coe.Downloaded(request.index, request.subindex)
        if isinstance(request, coe.DownloadNext):
            raise AbortedError(Abort.COMMAND)
        return None

    def get(self, index: int, subindex: int) -> bytes:
        """The bytes of an object; AbortedError if there is none."""
        kind = next((kind for kind in Kind if kind.value[0] == index and self._counts[kind]), None)
        if kind is None:
            if (index, subindex) in self.values:
                return self.values[index, subindex]
            is_known = any(each == index for each, _ in self.values)
            raise AbortedError(Abort.NO_SUBINDEX if is_known else Abort.NO_OBJECT)
        if subindex == 0:
            return bytes((self._counts[kind],))
        if subindex > self._counts[kind]:
            raise AbortedError(Abort.NO_SUBINDEX)
        word, byte = divmod(subindex - 1, 4)
        if kind is Kind.DIGITAL_INPUTS:
            level = self._memory.I[bus_nodes.levels[self._place] + word]
            return bytes((level >> 8 * byte & 0xFF,))
        if kind is Kind.DIGITAL_OUTPUTS:
            return bytes((self._words[word] >> 8 * byte & 0xFF,))
        counts = self._values
        if kind is Kind.ANALOG_INPUTS:
            counts = terminals.convert_inputs(self._memory, self._place)
        return counts[subindex - 1].to_bytes(2, "little", signed=True)

    def put(self, index: int, subindex: int, data: bytes) -> None:
        """Write an object; AbortedError if that is not possible."""
        has = self.get(index, subindex)
        if index in READ_ONLY or (subindex == 0 and index in (0x6200, 0x6411)):
            raise AbortedError(Abort.READ_ONLY)
        if len(data) != len(has):
            raise AbortedError(Abort.LENGTH)
        if index not in (0x6200, 0x6411):
            self.values[index, subindex] = data
            return
        if index == 0x6200:
            word, byte = divmod(subindex - 1, 4)
            changed = self._words[word] & 0xFFFFFFFF & ~(0xFF << 8 * byte) | data[0] << 8 * byte
            self._words[word] = changed - (changed >> 31 << 32)
        else:
            self._values[subindex - 1] = int.from_bytes(data, "little", signed=True)
        words = -(-self._memory.I[bus_nodes.digital_outputs[self._place]] // 32)
        terminals.set_outputs(self._memory, self._place, self._words[:words], self._values)


def _u32(value: int) -> bytes:
    return value.to_bytes(4, "little")
