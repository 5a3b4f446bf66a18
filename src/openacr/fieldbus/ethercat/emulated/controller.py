"""The slave controller (ESC): registers, memory, sync managers and FMMUs.

It serves what a frame asks for. What the device itself does (states, mails, process data) is in
`slave.py`, which is called where the registers demand it.
"""

from dataclasses import dataclass
from typing import Protocol

from openacr.fieldbus.ethercat.emulated.clock import Clock
from openacr.fieldbus.ethercat.emulated.eeprom import EepromInterface
from openacr.fieldbus.ethercat.wire.managers import (
    ACTIVATE_PLACE,
    FMMU_SIZE,
    FULL,
    MAILBOX_MODE,
    MODE_MASK,
    PDI_PLACE,
    READS,
    REPEAT,
    STATUS_PLACE,
    SYNC_SIZE,
    WRITES,
    WRITTEN_BY_MASTER,
    Fmmu,
    SyncManager,
)
from openacr.fieldbus.ethercat.wire.registers import Feature, Register, State

FMMUS, SYNCS = 8, 8
MEMORY_BYTES = 0x3000
_TYPE, _REVISION, _PORTS = 0x11, 0x02, 0x0F
_DIVIDER, _WATCHDOG = 2498, 1000  # 100 us a unit, 100 ms
_DEVICE_OFF = 0x01  # of the byte of the PDI: the device has the sync manager disabled
# What the master cannot write: ranges of registers.
_READ_ONLY = (
    (0x0000, 0x000F),
    (Register.ALIAS, 0x0013),
    (0x0110, 0x0111),
    (0x0130, 0x0135),
    (0x0140, 0x0141),
    (0x0220, 0x0223),
    (0x0440, 0x0441),
    (0x0900, 0x091F),
    (0x092C, 0x092F),
    (0x098E, 0x098F),
)
_WRITABLE = bytearray(b"\x01") * 0x1000
for _first, _last in _READ_ONLY:
    _WRITABLE[_first : _last + 1] = bytes(_last + 1 - _first)
for _sync in range(SYNCS):
    for _place in (STATUS_PLACE, PDI_PLACE):
        _WRITABLE[Register.SYNC + SYNC_SIZE * _sync + _place] = 0


class Device(Protocol):
    """What the controller calls of its device."""

    def controlled(self, control: int, now: int) -> None:
        """AL_CONTROL was written."""

    def mailed(self, data: bytes) -> None:
        """A mail is in the mailbox of the master."""

    def collected(self) -> None:
        """The master read the mail of the slave."""

    def asked_again(self) -> None:
        """The master wants the last mail again."""

    def outputs_written(self, now: int) -> None:
        """The outputs were written."""

    def managers_written(self) -> None:
        """Sync managers were written."""


@dataclass(frozen=True, slots=True)
class _Map:
    """A mapping of whole bytes: logical addresses `start` to `end` lie at `physical`."""

    start: int
    end: int
    physical: int


class Controller:
    """Registers and memory; `now` of its calls is the time of the world in nanoseconds."""

    def __init__(self, device: Device, eeprom: bytes) -> None:
        self.memory = bytearray(MEMORY_BYTES)
        self.eeprom = EepromInterface(self.memory, eeprom)
        self.clock = Clock(self.memory)
        self._device = device
        self.syncs: list[SyncManager] = []
        self._reads: list[_Map] = []
        self._writes: list[_Map] = []
        self._bits: list[Fmmu] = []
        self.reset()

    def reset(self) -> None:
        """Power is switched on."""
        self.memory[:] = bytes(MEMORY_BYTES)
        self.memory[0:8] = bytes([_TYPE, _REVISION, 0, 0, FMMUS, SYNCS, 8, _PORTS])
        self.put(Register.FEATURES, Feature.CLOCK | Feature.CLOCK_64, 2)
        self.put(Register.AL_STATUS, State.INIT, 2)
        self.put(Register.PDI_CONTROL, 0x05, 1)
        self.put(Register.WATCHDOG_DIVIDER, _DIVIDER, 2)
        self.put(Register.PDI_WATCHDOG, _WATCHDOG, 2)
        self.put(Register.SYNC_WATCHDOG, _WATCHDOG, 2)
        self.put(Register.SPEED_START, 0x1000, 2)
        self.put(Register.TIME_FILTERS, 0x0C04, 2)
        self.eeprom.reset()
        self.clock.corrected_ns = 0
        self.clock.activated()
        self.arrange()

    def put(self, register: int, value: int, size: int) -> None:
        """Set a register from the side of the device."""
        self.memory[register : register + size] = value.to_bytes(size, "little")

    def get(self, register: int, size: int) -> int:
        """A register."""
        return int.from_bytes(self.memory[register : register + size], "little")

    # -- access by registers -----------------------------------------------------------------

    def read(self, address: int, size: int, now: int) -> bytes | None:
        """What a read gives; None where it is not served (no such memory, an empty mailbox)."""
        end = address + size
        if end > MEMORY_BYTES:
            return None
        if address < Register.SYSTEM_TIME + 8 and end > Register.SYSTEM_TIME:
            self.clock.show(now)
        if end > Register.MEMORY and (number := self._mailbox_at(address)) is not None:
            return self._collect(number, address, end)
        return bytes(self.memory[address:end])

    def write(self, address: int, data: bytes, now: int) -> bool:
        """Write; False where it is not served (no such memory, a full mailbox)."""
        end = address + len(data)
        if end > MEMORY_BYTES:
            return False
        if address >= Register.MEMORY:
            return self._write_memory(address, data, now)
        memory = self.memory
        kept = bytes(memory[Register.SYNC : Register.SYNC + SYNC_SIZE * SYNCS])
        for place, byte in enumerate(data, address):
            if place < Register.MEMORY and _WRITABLE[place]:
                memory[place] = byte
        self._act(address, end, data, now, kept)
        return True

    def _act(self, address: int, end: int, data: bytes, now: int, kept: bytes) -> None:
        """Do what registers demand that were written."""

        def is_written(first: int, size: int = 1) -> bool:
            return address < first + size and end > first

        if is_written(Register.FMMU, FMMU_SIZE * FMMUS):
            self.arrange()
        if is_written(Register.SYNC, SYNC_SIZE * SYNCS):
            self._sync_written(kept)
        if is_written(Register.RX_ERRORS, 0x14):
            self.memory[Register.RX_ERRORS : Register.RX_ERRORS + 0x14] = bytes(0x14)
        if is_written(Register.WATCHDOG_COUNT, 2):
            self.put(Register.WATCHDOG_COUNT, 0, 2)
        if is_written(Register.EEPROM_CONTROL, 2):
            self.eeprom.written()
        if address <= Register.SYSTEM_TIME and end >= Register.SYSTEM_TIME + 4:
            start = Register.SYSTEM_TIME - address
            self.clock.compare(data[start : start + 8], now)
        if is_written(Register.TIME_OFFSET, 8):
            self.clock.corrected_ns = 0
        if is_written(Register.ACTIVATION):
            self.clock.activated()
        if is_written(Register.AL_CONTROL, 2):
            self._device.controlled(self.get(Register.AL_CONTROL, 2), now)

    # -- sync managers -----------------------------------------------------------------------

    def _sync_written(self, kept: bytes) -> None:
        self.arrange()
        for number in range(SYNCS):
            place = SYNC_SIZE * number + ACTIVATE_PLACE
            before, after = kept[place], self.memory[Register.SYNC + place]
            if (before ^ after) & REPEAT and after & 1:
                self._device.asked_again()
                acknowledged = Register.SYNC + SYNC_SIZE * number + PDI_PLACE
                self.memory[acknowledged] = self.memory[acknowledged] & ~REPEAT | after & REPEAT
        self._device.managers_written()

    def enable_sync(self, number: int, on: bool) -> None:
        """Let the device enable or disable a sync manager."""
        place = Register.SYNC + SYNC_SIZE * number + PDI_PLACE
        self.memory[place] = self.memory[place] & ~_DEVICE_OFF | (0 if on else _DEVICE_OFF)
        self.arrange()

    def set_full(self, number: int, on: bool) -> None:
        """Set whether there is a mail in a mailbox."""
        place = Register.SYNC + SYNC_SIZE * number + STATUS_PLACE
        self.memory[place] = self.memory[place] & ~FULL | (FULL if on else 0)

    def is_full(self, number: int) -> bool:
        """Whether there is a mail in a mailbox."""
        return bool(self.memory[Register.SYNC + SYNC_SIZE * number + STATUS_PLACE] & FULL)

    def is_on(self, number: int) -> bool:
        """Whether a sync manager is enabled by both sides."""
        sync = self.syncs[number]
        return sync.is_enabled and not sync.pdi & _DEVICE_OFF and sync.size > 0

    def _mailbox_at(self, address: int) -> int | None:
        """The mailbox in which an address lies."""
        for number in (0, 1):
            sync = self.syncs[number]
            inside = sync.start <= address < sync.start + sync.size
            if inside and self.is_on(number) and sync.control & MODE_MASK == MAILBOX_MODE:
                return number
        return None

    def _collect(self, number: int, address: int, end: int) -> bytes | None:
        sync = self.syncs[number]
        if sync.control & WRITTEN_BY_MASTER or not self.is_full(number):
            return None
        data = bytes(self.memory[address:end])
        if end >= sync.start + sync.size:
            self.set_full(number, False)
            self._device.collected()
        return data

    def _write_memory(self, address: int, data: bytes, now: int) -> bool:
        end = address + len(data)
        number = self._mailbox_at(address)
        if number is None:
            return self._write_data(address, data, now)
        sync = self.syncs[number]
        if not sync.control & WRITTEN_BY_MASTER or self.is_full(number):
            return False
        self.memory[address:end] = data
        if end >= sync.start + sync.size:
            self._device.mailed(bytes(self.memory[sync.start : sync.start + sync.size]))
        return True

    def _write_data(self, address: int, data: bytes, now: int) -> bool:
        """Write process data, or memory that no sync manager has."""
        outputs = self.syncs[2]
        last = outputs.start + outputs.size
        inside = outputs.start <= address < last and outputs.is_enabled
        if inside and not self.is_on(2):
            return False
        self.memory[address : address + len(data)] = data
        if inside and address + len(data) >= last and outputs.control & WRITTEN_BY_MASTER:
            self._device.outputs_written(now)
        return True

    # -- logical addresses -------------------------------------------------------------------

    def arrange(self) -> None:
        """Read sync managers and FMMUs anew."""
        memory = self.memory
        self.syncs = [
            SyncManager.parse(memory, Register.SYNC + SYNC_SIZE * n) for n in range(SYNCS)
        ]
        fmmus = [Fmmu.parse(memory, Register.FMMU + FMMU_SIZE * n) for n in range(FMMUS)]
        active = [one for one in fmmus if one.activate and one.size and self._is_served(one)]
        self._bits = [one for one in active if not one.is_bytes]
        self._reads = [_mapped(one) for one in active if one.is_bytes and one.kind & READS]
        self._writes = [_mapped(one) for one in active if one.is_bytes and one.kind & WRITES]

    def _is_served(self, fmmu: Fmmu) -> bool:
        """Whether the memory of a mapping exists and its sync manager is enabled."""
        if fmmu.physical + fmmu.size > MEMORY_BYTES:
            return False
        for number in (2, 3):
            sync = self.syncs[number]
            if sync.is_enabled and sync.start <= fmmu.physical < sync.start + sync.size:
                return self.is_on(number)
        return True

    def logical(
        self, address: int, data: bytearray, place: int, size: int, how: int, now: int
    ) -> int:
        """Serve a logical datagram whose bytes are at a place of `data`; what it counts.

        `how`: READS, WRITES or both.
        """
        end = address + size
        counted = 0
        taken = data[place : place + size] if how & WRITES else b""
        if how & READS:
            for one in self._reads:
                low, high = max(one.start, address), min(one.end, end)
                if low < high:
                    start = one.physical + low - one.start
                    into = place + low - address
                    data[into : into + high - low] = self.memory[start : start + high - low]
                    counted |= 1
        if how & WRITES:
            for one in self._writes:
                low, high = max(one.start, address), min(one.end, end)
                if low < high:
                    part = bytes(taken[low - address : high - address])
                    if self._write_data(one.physical + low - one.start, part, now):
                        counted |= 2
        for bits in self._bits:
            counted |= self._map_bits(bits, address, data, place, size, how, now)
        if how == WRITES:
            return counted >> 1
        return counted

    def _map_bits(
        self,
        one: Fmmu,
        address: int,
        data: bytearray,
        place: int,
        size: int,
        how: int,
        now: int,
    ) -> int:
        """Serve a mapping that is not of whole bytes, bit by bit; what it counts."""
        first = 8 * one.logical + one.first_bit
        last = 8 * (one.logical + one.size - 1) + one.last_bit
        counted = 0
        length = (last - first + one.bit) // 8 + 1
        physical = self.memory[one.physical : one.physical + length]
        is_read, is_write = how & one.kind & READS, how & one.kind & WRITES
        for number in range(last - first + 1):
            byte, bit = divmod(first + number - 8 * address, 8)
            if not 0 <= byte < size:
                continue
            own_byte, own_bit = divmod(one.bit + number, 8)
            taken = data[place + byte] >> bit & 1
            if is_read:
                level = physical[own_byte] >> own_bit & 1
                data[place + byte] = data[place + byte] & ~(1 << bit) | level << bit
                counted |= 1
            if is_write:
                physical[own_byte] = physical[own_byte] & ~(1 << own_bit) | taken << own_bit
                counted |= 2
        if counted & 2 and not self._write_data(one.physical, bytes(physical), now):
            counted &= ~2
        return counted


def _mapped(one: Fmmu) -> _Map:
    return _Map(one.logical, one.logical + one.size, one.physical)
