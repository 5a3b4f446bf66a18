"""A segment of emulated slaves in a line: what comes back of a frame.

`process` is the whole of it; time is the caller's: nanoseconds of any origin that never go back.
"""

from collections.abc import Iterable
from struct import Struct

from openacr.fieldbus.ethercat.emulated.motor import Plant
from openacr.fieldbus.ethercat.emulated.slave import Slave
from openacr.fieldbus.ethercat.wire.frames import (
    COUNTER_SIZE,
    DATAGRAM,
    FIRST,
    HEADER_SIZE,
    LENGTH_MASK,
    MORE,
    RETURNED,
    Command,
    WireError,
    end_of,
)
from openacr.fieldbus.ethercat.wire.managers import READS, WRITES
from openacr.fieldbus.ethercat.wire.registers import Register

_WORD = Struct("<H")
_SOURCE = 6
MOST_MADE_GOOD_NS = 1_000_000_000  # of time without a frame: motors do not run longer than that
_READS = READS
_WRITES = WRITES
# Of each command: by position, by station, of all, logical; and what it does.
_POSITION, _STATION, _ALL, _LOGICAL = range(4)
_COMMANDS = {
    Command.APRD: (_POSITION, _READS),
    Command.APWR: (_POSITION, _WRITES),
    Command.APRW: (_POSITION, _READS | _WRITES),
    Command.FPRD: (_STATION, _READS),
    Command.FPWR: (_STATION, _WRITES),
    Command.FPRW: (_STATION, _READS | _WRITES),
    Command.BRD: (_ALL, _READS),
    Command.BWR: (_ALL, _WRITES),
    Command.BRW: (_ALL, _READS | _WRITES),
    Command.LRD: (_LOGICAL, _READS),
    Command.LWR: (_LOGICAL, _WRITES),
    Command.LRW: (_LOGICAL, _READS | _WRITES),
}
_MULTIPLE = {Command.ARMW: _POSITION, Command.FRMW: _STATION}
# Bits of DL_STATUS: link, loop closed and communication of ports 0 and 1.
_DEVICE_READY = 0x0001
_LINK = (0x0010, 0x0020)
_LOOP = (0x0100, 0x0400, 0x1000, 0x4000)
_COMMUNICATION = (0x0200, 0x0800)


class Segment:
    """Slaves in the order of the cable, and the motors they have."""

    def __init__(self, slaves: Iterable[Slave], plant: Plant | None = None) -> None:
        self.slaves = list(slaves)
        self.plant = plant
        self.cable_out_at: int | None = None  # the slave whose incoming cable is pulled out
        self.frames = 0
        self._now: int | None = None
        for number, slave in enumerate(self.slaves):
            slave.controller.clock.start_ns = 1_000_000_007 * (number + 1)
        self._show_links()

    @property
    def reached(self) -> int:
        """How many slaves frames reach: up to a cable that is out, or a slave without power."""
        cut = len(self.slaves) if self.cable_out_at is None else self.cable_out_at
        for number, slave in enumerate(self.slaves[:cut]):
            if not slave.is_powered:
                return number
        return cut

    def connect(self, cable_out_at: int | None) -> None:
        """Pull the cable in front of a slave (counted from 0) out; None: it is in again."""
        self.cable_out_at = cable_out_at
        self._show_links()

    def power(self, number: int, on: bool) -> None:
        """Switch the power of a slave."""
        self.slaves[number].power(on)
        self._show_links()

    def _show_links(self) -> None:
        reached = self.reached
        for number, slave in enumerate(self.slaves):
            has_next = number + 1 < reached or (
                number >= reached
                and number + 1 < len(self.slaves)
                and self.slaves[number + 1].is_powered
                and self.cable_out_at != number + 1
            )
            status = _DEVICE_READY | _LINK[0] | _COMMUNICATION[0] | _LOOP[2] | _LOOP[3]
            status |= _LINK[1] | _COMMUNICATION[1] if has_next else _LOOP[1]
            control = slave.controller
            had_next = control.get(Register.DL_STATUS, 2) & _LINK[1]
            control.put(Register.DL_STATUS, status, 2)
            if had_next and not has_next:
                lost = control.memory[Register.LOST_LINKS + 1]
                control.memory[Register.LOST_LINKS + 1] = min(255, lost + 1)

    def advance(self, now: int) -> None:
        """Let time pass: motors, watchdogs, SYNC0."""
        if self._now is None or self.plant is None:
            self._now = now
        else:
            period = self.plant.period_ns
            self._now = max(self._now, now - MOST_MADE_GOOD_NS)
            while self._now + period <= now:
                self._now += period
                for slave in self.slaves:
                    slave.advance(self._now)
                    slave.step(self._now)
                self.plant.step()
        for slave in self.slaves:
            slave.advance(now)

    def process(self, frame: bytes, now: int) -> bytes:
        """The frame as it comes back; empty if no slave is reached or it is not of EtherCAT."""
        self.advance(now)
        try:
            end = end_of(frame)
        except WireError:
            return b""
        reached = self.slaves[: self.reached]
        if not reached:
            return b""
        self.frames += 1
        for slave in reached:
            slave.before_frame()
        data = bytearray(frame)
        data[_SOURCE] |= RETURNED
        place = FIRST
        more = True
        while more and place + HEADER_SIZE + COUNTER_SIZE <= end:
            bits = _WORD.unpack_from(data, place + 6)[0]
            size = bits & LENGTH_MASK
            if place + HEADER_SIZE + size + COUNTER_SIZE > end:
                break  # a datagram that is cut off is not served
            self._serve(data, place, size, reached, now)
            place += HEADER_SIZE + size + COUNTER_SIZE
            more = bool(bits & MORE)
        return bytes(data)

    def _serve(
        self, data: bytearray, place: int, size: int, reached: list[Slave], now: int
    ) -> None:
        command, index, position, offset, bits, events = DATAGRAM.unpack_from(data, place)
        start = place + HEADER_SIZE
        counter = _WORD.unpack_from(data, start + size)[0]
        one = _COMMANDS.get(command)
        if one is not None and one[0] == _LOGICAL:
            address = position | offset << 16
            for slave in reached:
                counter += slave.controller.logical(address, data, start, size, one[1], now)
        elif one is not None:
            counter += self._by_register(data, start, size, one, (position, offset), reached, now)
        elif command in _MULTIPLE:
            how = _MULTIPLE[Command(command)]
            counter += self._multiple(data, start, size, how, (position, offset), reached, now)
        if (one is not None and one[0] in (_POSITION, _ALL)) or command == Command.ARMW:
            position = position + len(reached) & 0xFFFF
        DATAGRAM.pack_into(data, place, command, index, position, offset, bits, events)
        _WORD.pack_into(data, start + size, counter & 0xFFFF)

    def _by_register(
        self,
        data: bytearray,
        start: int,
        size: int,
        one: tuple[int, int],
        address: tuple[int, int],
        reached: list[Slave],
        now: int,
    ) -> int:
        whom, how = one
        counter = 0
        for number, slave in enumerate(reached):
            if whom != _ALL and not _is_meant(slave, number, whom, address[0]):
                continue
            control = slave.controller
            taken = bytes(data[start : start + size])
            if how & _READS:
                found = control.read(address[1], size, now)
                if found is not None:
                    if whom == _ALL:
                        found = bytes(a | b for a, b in zip(found, taken, strict=True))
                    data[start : start + size] = found
                    counter += 1
            if how & _WRITES and self._write(slave, number, address[1], taken, len(reached), now):
                counter += 2 if how & _READS else 1
        return counter

    def _multiple(
        self,
        data: bytearray,
        start: int,
        size: int,
        whom: int,
        address: tuple[int, int],
        reached: list[Slave],
        now: int,
    ) -> int:
        """One slave is read, the ones after it are written what it had."""
        counter = 0
        for number, slave in enumerate(reached):
            if _is_meant(slave, number, whom, address[0]):
                found = slave.controller.read(address[1], size, now)
                if found is not None:
                    data[start : start + size] = found
                    counter += 1
            else:
                taken = bytes(data[start : start + size])
                counter += self._write(slave, number, address[1], taken, len(reached), now)
        return counter

    def _write(
        self, slave: Slave, number: int, register: int, data: bytes, reached: int, now: int
    ) -> bool:
        first = Register.RECEIVE_TIMES
        if register <= first < register + len(data):
            after = reached - 1 - number
            slave.controller.clock.latch(now, number, after or None)
        return slave.controller.write(register, data, now)


def _is_meant(slave: Slave, number: int, whom: int, address: int) -> bool:
    if whom == _POSITION:
        return address == -number & 0xFFFF
    memory = slave.controller.memory
    station = memory[Register.STATION] | memory[Register.STATION + 1] << 8
    if station == address:
        return True
    uses_alias = memory[Register.DL_CONTROL + 3] & 1
    return bool(uses_alias and slave.controller.get(Register.ALIAS, 2) == address)
