"""The distributed clock of a slave: its own time, the time of the system, SYNC0.

Each slave counts nanoseconds from its own start, at its own speed (`drift_ppm`). The time of the
system is that plus the offset the master writes and what the slave has corrected since: a slave
that is written the time of the reference clock moves by a sixteenth of the difference.
"""

from collections.abc import Iterator

from openacr.fieldbus.ethercat.wire.registers import Activation, Register

CORRECTED = 16  # the part of a difference that is corrected by each write of the time
FARTHEST_NS = 1_000_000  # differences beyond are no drift: the offset is wrong
HOP_NS = 600  # of a frame through a slave and its cable
_WRAP = 1 << 64
_ACTIVATION = int(Register.ACTIVATION)
_PULSES = int(Activation.CYCLIC | Activation.SYNC0)
_MOST_SYNCS = 1000  # that are made good after a pause


class Clock:
    """A clock over the registers of its slave."""

    def __init__(self, registers: bytearray, start_ns: int = 0, drift_ppm: float = 0.0) -> None:
        self._registers = registers
        self.start_ns = start_ns
        self.drift_ppm = drift_ppm
        self.corrected_ns = 0
        self.has_fired = False  # SYNC0, since it was activated
        self._next_ns: int | None = None

    def local_ns(self, now: int) -> int:
        """Its own time at a moment of the world."""
        return self.start_ns + now + int(now * self.drift_ppm * 1e-6)

    def system_ns(self, now: int) -> int:
        """The time of the system as this slave has it."""
        offset = int.from_bytes(self._get(Register.TIME_OFFSET, 8), "little", signed=True)
        return (self.local_ns(now) + offset + self.corrected_ns) % _WRAP

    def show(self, now: int) -> None:
        """Write the time of the system to its register."""
        self._put(Register.SYSTEM_TIME, self.system_ns(now), 8)

    def latch(self, now: int, before: int, after: int | None) -> None:
        """Note when a frame passed: `before` slaves precede this one, `after` follow, or None."""
        arrived = self.local_ns(now + before * HOP_NS)
        self._put(Register.RECEIVE_TIMES, arrived & 0xFFFFFFFF, 4)
        back = 0 if after is None else arrived + 2 * after * HOP_NS
        self._put(Register.RECEIVE_TIMES + 4, back & 0xFFFFFFFF, 4)
        self._put(Register.RECEIVE_TIME, arrived % _WRAP, 8)

    def compare(self, written: bytes, now: int) -> None:
        """The master writes the time of the reference clock: note the difference, correct it."""
        bits = 8 * len(written)
        delay = int.from_bytes(self._get(Register.TIME_DELAY, 4), "little")
        own, reference = self.system_ns(now), int.from_bytes(written, "little") + delay
        late = (own - reference + (1 << bits - 1)) % (1 << bits) - (1 << bits - 1)
        size = min(abs(late), 0x7FFFFFFF)
        self._put(Register.TIME_DIFFERENCE, size | (0 if late > 0 else 0x80000000), 4)
        if abs(late) <= FARTHEST_NS:
            self.corrected_ns -= int(late / CORRECTED)

    @property
    def cycle_ns(self) -> int:
        """The cycle of SYNC0 while it is active, otherwise 0."""
        if self._registers[_ACTIVATION] & _PULSES != _PULSES:
            return 0
        return int.from_bytes(self._get(Register.SYNC0_CYCLE, 4), "little")

    def activated(self) -> None:
        """The activation was written: SYNC0 starts anew."""
        self.has_fired, self._next_ns = False, None
        if self.cycle_ns:
            self._next_ns = int.from_bytes(self._get(Register.SYNC0_START, 8), "little")

    def syncs(self, now: int) -> Iterator[int]:
        """The times of SYNC0, in time of the system, that have come since it was asked last."""
        cycle = self.cycle_ns
        if self._next_ns is None or not cycle:
            return
        present = self.system_ns(now)
        late = (present - self._next_ns) // cycle
        if late > _MOST_SYNCS:
            self._next_ns += late * cycle
        while self._next_ns <= present:
            self.has_fired = True
            yield self._next_ns
            self._next_ns += cycle

    def _get(self, register: int, size: int) -> bytearray:
        return self._registers[register : register + size]

    def _put(self, register: int, value: int, size: int) -> None:
        self._registers[register : register + size] = value.to_bytes(size, "little")
