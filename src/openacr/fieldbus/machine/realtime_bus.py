"""The bus of a machine in the real-time loop: Python's part, which may be late.

The loop exchanges the frame and does what has to be on time (`exchange_cy.py`). Here drives are led
through their states, and what the loop has stopped gets its text; `look` does it, every few
milliseconds. The reactions are those of `real_machine.py`.
"""

import logging
import math
import time
from typing import Protocol

from openacr.fieldbus.cia402.objects import (
    ACTUAL_POSITION,
    CONTROL_WORD,
    DIGITAL_INPUTS,
    MODES,
    STATUS_WORD,
)
from openacr.fieldbus.cia402.states import DISABLE_VOLTAGE
from openacr.fieldbus.ethercat.master.mapping import Signal
from openacr.fieldbus.ethercat.master.master import Master, Member
from openacr.fieldbus.ethercat.master.port import BusError, Link
from openacr.fieldbus.ethercat.wire.frames import DATAGRAM, FIRST, HEADER_SIZE, pack
from openacr.fieldbus.ethercat.wire.registers import State
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.axis_drive import AxisDrive
from openacr.fieldbus.machine.bringing_up import Brought, bring_up
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.map.rows import axes
from openacr.motion.card import Card
from openacr.plant import inputs
from openacr.plant.describe.bus_schema import INPUT_BITS, Bus, CyclicMode
from openacr.plant.describe.schema import Axis, World
from openacr.views import F64
from openacr.wording import counted

log = logging.getLogger(__name__)

HOLD_TK = 20_000  # enabling waits that long for the next look at most
OFF_CYCLES = 5  # that switch the drives off at the end
RETURN_PART = 0.5  # of a period, that a frame may take
ALARMS = {
    at.ALARM_LOST: "no frame comes back, {} times in a row",
    at.ALARM_COUNTER: "the working counter is wrong, {} times in a row",
    at.ALARM_LATE: "no exchange for too long (late_s = {late_s:g})",
    at.ALARM_LEFT: "a device has left OP",
}


class SocketLink(Link, Protocol):
    """A link that the loop can use, too."""

    def fileno(self) -> int:
        """Number of its socket."""


class RealtimeDrive(AxisDrive):
    """A drive whose positions and contacts the loop takes."""

    def connect_again(self, member: Member, now_s: float) -> None:
        """Use the drive after its bus has been brought up again; what it reports is reset."""
        self.connect(member)
        self.alarm = ""
        self._reset_s = now_s
        self.drive.reset()

    def follow(self, numbers: F64, first: int) -> None:
        """Where the loop keeps its counts."""
        self._numbers, self._first = numbers, first

    def _take_position(self, actual: int, passed_s: float) -> None:
        zero = self._numbers[self._first + at.ZERO]
        if not math.isnan(zero):
            self._zero = round(zero)
            self._counts = round(self._numbers[self._first + at.COUNTS])

    def _take_contacts(self, level: int) -> None:
        """The loop has done it."""

    def _hold(self, n: int) -> None:
        super()._hold(n)
        self.memory.I[axes.enable_ticks[n]] = HOLD_TK

    def _take_over(self, n: int) -> None:
        super()._take_over(n)
        if self._is_ready:
            self.memory.I[axes.enable_ticks[n]] = 1

    @property
    def is_ready(self) -> bool:
        """Whether it is to follow the setpoint."""
        return self._is_ready

    @property
    def scale(self) -> float:
        """Counts of the drive for a raw count of the card."""
        return self._scale

    @property
    def fastest_cps(self) -> float:
        """Counts a second beyond which a move is a jump."""
        return self._fastest_cps


class RealtimeBus:
    """The drives and terminals of a machine; `connect` before the loop lives, then `look`."""

    def __init__(self, card: Card, world: World, link: SocketLink, *, is_real: bool) -> None:
        self._card, self._world, self._link, self._is_real = card, world, link, is_real
        self._bus = world.bus or Bus()
        self.memory = ExchangeMemory()
        self.drives: list[RealtimeDrive] = []
        self.alarm = ""
        self._good = 0
        self._master: Master | None = None
        self._period_s = 0.0
        self._image = bytearray()

    def connect(self) -> None:
        """Bring the bus up; BusError if it is not as described."""
        self._period_s = self._card.clock.period_s
        brought = bring_up(self._link, self._world, self._period_s)
        on_bus = [axis for axis in self._world.axis if axis.bus is not None]
        if not self.drives:
            for axis in on_bus:
                table = axis.bus
                if table is not None:
                    drive = RealtimeDrive(self._card, axis, table, brought.drives[axis.number])
                    drive.may_enable = self._is_real
                    self.drives.append(drive)
            for place in range(len(self.drives)):
                self.memory.numbers[self._numbers_at(place) + at.ZERO] = math.nan
        else:
            for drive in self.drives:
                drive.connect_again(brought.drives[drive.axis.number], self._link.now_s())
        self._master = brought.master
        self._lay_out(brought, on_bus)

    @property
    def cycles(self) -> int:
        """Exchanges so far."""
        return int(self.memory.numbers[at.CYCLES])

    @property
    def bad_cycles(self) -> int:
        """Those of them that were lost, damaged or not whole."""
        return int(self.memory.numbers[at.BAD_CYCLES])

    def began(self) -> str:
        """What a server says once the bus is up."""
        state = "can be enabled" if self._is_real else "read only, none can be enabled"
        drives = counted(len(self.drives), "drive")
        return f"bus {self._link.name}: {drives} in the real-time loop, {state}"

    def ended(self) -> str:
        """What a server says at the end."""
        worst_us = 1e-3 * self.memory.numbers[at.WORST_RETURN_NS]
        phase_us = 1e-3 * abs(self.memory.numbers[at.PHASE_NS])
        has_clock = self.memory.rows[at.CLOCK_AT] > 0
        place = f", the last was {phase_us:.0f} us from the middle between two SYNC0"
        clock = place if has_clock else ""
        return (
            f"bus {self._link.name}: {counted(self.cycles, 'cycle')}, {self.bad_cycles} lost or"
            f" wrong; a frame took at most {worst_us:.0f} us{clock}"
        )

    def close(self) -> None:
        """Switch all drives off and bring all devices into INIT; after the loop has ended."""
        rows, master = self.memory.rows, self._master
        rows[at.ACTIVE] = 0
        if master is None:
            return
        first, size = rows[at.IMAGE_AT], rows[at.OUTPUTS_SIZE]
        master.image[:size] = self.memory.out[first : first + size]  # as the loop has left it
        for place in range(len(self.drives)):
            control = rows[at.FIRST_DRIVE + at.DRIVE_ROWS * place + at.CONTROL_AT]
            master.image[control : control + 2] = DISABLE_VOLTAGE.to_bytes(2, "little")
        for _ in range(OFF_CYCLES):
            master.exchange()
            self._link.pause(self._period_s)
        master.shut_down()

    def look(self) -> None:
        """Lead the drives; the memory of Python is up to date, what changes goes to the loop."""
        rows, now_s = self.memory.rows, self._link.now_s()
        self._tell_failed(at.FAILED_JUMP)  # before the drive's own error, which follows on it
        if rows[at.GOOD] != self._good:
            self._good = rows[at.GOOD]
            first = rows[at.IMAGE_AT]
            image = bytes(self.memory.back[first : first + len(self._image)])
            for drive in self.drives:
                drive.take(image, now_s, 0.0)
        if rows[at.ALARM]:
            text = ALARMS[rows[at.ALARM]]
            self._stop(text.format(rows[at.BAD], late_s=self._bus.late_s))
        if self._card.clock.period_s != self._period_s:
            self._stop("the servo period was changed: the cycle of the bus is that of its start")
        self._tell_failed(at.FAILED_STATE)
        for drive in self.drives:
            drive.give(self._image, now_s, self._bus.enable_s)
        self._hand_over()
        if self.alarm and any(drive.is_resetting for drive in self.drives):
            self._reset()

    def _hand_over(self) -> None:
        """Give the loop what the devices are asked for: the outputs, and who follows."""
        rows = self.memory.rows
        for place, drive in enumerate(self.drives):
            r = at.FIRST_DRIVE + at.DRIVE_ROWS * place
            owner = drive.owner
            rows[r + at.OWNER] = -1 if owner is None else owner
            rows[r + at.READY] = int(drive.is_ready)
            if not drive.is_ready:
                rows[r + at.FAILED] = 0
        base = 1 - rows[at.BASE]
        first, size = at.BASES + at.FRAME_ROOM * base, rows[at.OUTPUTS_SIZE]
        self.memory.out[first : first + size] = self._image[:size]
        rows[at.BASE] = base

    def _tell_failed(self, what: int) -> None:
        """Stop the drives that the loop has stopped for this reason, with a text."""
        for place, drive in enumerate(self.drives):
            r = at.FIRST_DRIVE + at.DRIVE_ROWS * place
            if self.memory.rows[r + at.FAILED] != what or not drive.is_ready:
                continue
            if what == at.FAILED_JUMP:
                drive.fail(f"its position jumped by {self.memory.rows[r + at.JUMP_CNT]} counts")
            else:
                state = drive.drive.state
                shown = state.value if state else "an unknown state"
                drive.fail(f"it is in {shown}, not in operation")

    def _stop(self, text: str) -> None:
        if not self.alarm:
            log.error("the bus %s: %s; all its drives are stopped", self._link.name, text)
            self.alarm = text
        for drive in self.drives:
            drive.fail(self.alarm)

    def _reset(self) -> None:
        """Bring the bus up again; what cannot be brought up stays stopped."""
        self.memory.rows[at.ACTIVE] = 0
        time.sleep(2.0 * self._period_s)  # a frame of the loop is on its way at most
        try:
            self.connect()
        except BusError as failure:
            log.error("the bus %s stays stopped: %s", self._link.name, failure)
            self._stop(str(failure))
            return
        self.alarm = ""

    # --- rows of the loop ---------------------------------------------------------------

    @staticmethod
    def _numbers_at(place: int) -> int:
        return at.FIRST_NUMBERS + at.DRIVE_NUMBERS * place

    def _lay_out(self, brought: Brought, on_bus: list[Axis]) -> None:
        """Describe frame, drives and contacts to the loop, and let it exchange."""
        rows, numbers, master = self.memory.rows, self.memory.numbers, brought.master
        self._image = bytearray(master.image)
        self._lay_out_frame(master)
        contacts_in: list[tuple[int, int]] = []  # flag, and bit of the image
        outputs: list[tuple[int, int]] = []
        for place, (axis, drive) in enumerate(zip(on_bus, self.drives, strict=True)):
            member = brought.drives[axis.number]
            self._lay_out_drive(place, drive, member)
            if drive.table.inputs:
                first = 8 * Signal.of(DIGITAL_INPUTS, member.inputs, member.inputs_at).at
                contacts_in += [(f, first + INPUT_BITS[n]) for n, f in drive.table.inputs.items()]
        for table, member in zip(self._bus.terminal, brought.terminals, strict=True):
            for found, number, bits, first, count in (
                (
                    contacts_in,
                    table.inputs_from,
                    member.inputs.contacts,
                    member.inputs_at,
                    table.inputs,
                ),
                (
                    outputs,
                    table.outputs_from,
                    member.outputs.contacts,
                    member.outputs_at,
                    table.outputs,
                ),
            ):
                if number is not None:
                    found += [(number + k, 8 * first + bit) for k, bit in enumerate(bits[:count])]
        self._lay_out_contacts(contacts_in, outputs)
        numbers[at.LATE_NS] = 1e9 * self._bus.late_s
        numbers[at.LATEST_NS] = 0.0
        numbers[at.RETURN_NS] = 1e9 * RETURN_PART * self._period_s
        rows[at.CYCLE_TK], rows[at.WAIT_TK] = self._bus.cycle, 0
        rows[at.LOST_FRAMES], rows[at.BAD], rows[at.ALARM] = self._bus.lost_frames, 0, 0
        self._hand_over()
        rows[at.ACTIVE] = 1

    def _lay_out_frame(self, master: Master) -> None:
        rows = self.memory.rows
        datagrams = master.datagrams()
        frame = pack(datagrams)
        self.memory.out[: len(frame)] = frame
        place = FIRST
        starts = []
        for datagram in datagrams:
            starts.append(place)
            place += HEADER_SIZE + len(datagram.data) + 2
        rows[at.SOCKET], rows[at.FRAME_SIZE] = self._link.fileno(), len(frame)
        rows[at.DATAGRAMS] = len(datagrams)
        for number, start in enumerate(starts):
            rows[at.INDEX_AT + number] = start + 1
        rows[at.IMAGE_AT] = starts[0] + DATAGRAM.size
        rows[at.COUNTER_AT] = starts[0] + DATAGRAM.size + len(datagrams[0].data)
        rows[at.CLOCK_AT] = starts[2] + DATAGRAM.size if len(starts) > 2 else 0
        self.memory.numbers[at.CYCLE_NS] = round(1e9 * self._bus.cycle * self._period_s)
        rows[at.COUNTER] = master.counter
        rows[at.STATUS_AT] = starts[1] + DATAGRAM.size
        rows[at.FORBIDDEN] = master.forbidden
        rows[at.OPERATING] = State.OP
        rows[at.OUTPUTS_SIZE] = sum(member.outputs.size for member in master.members)

    def _lay_out_drive(self, place: int, drive: RealtimeDrive, member: Member) -> None:
        rows, numbers = self.memory.rows, self.memory.numbers
        r, f = at.FIRST_DRIVE + at.DRIVE_ROWS * place, self._numbers_at(place)
        target = Signal.of(MODES[drive.table.mode].target, member.outputs, member.outputs_at)
        rows[r + at.READY] = rows[r + at.FAILED] = rows[r + at.IS_KNOWN] = 0
        rows[r + at.CONTROL_AT] = Signal.of(CONTROL_WORD, member.outputs, member.outputs_at).at
        rows[r + at.TARGET_AT], rows[r + at.TARGET_SIZE] = target.at, target.form.size
        rows[r + at.STATE_AT] = Signal.of(STATUS_WORD, member.inputs, member.inputs_at).at
        rows[r + at.ACTUAL_AT] = Signal.of(ACTUAL_POSITION, member.inputs, member.inputs_at).at
        rows[r + at.IS_POSITION] = int(drive.table.mode is CyclicMode.CSP)
        rows[r + at.MOTOR] = drive.axis.number
        numbers[f + at.SCALE] = drive.scale
        numbers[f + at.PER_VOLT] = math.copysign(drive.table.per_volt or 0.0, drive.scale)
        numbers[f + at.FASTEST_CPS] = drive.fastest_cps
        drive.follow(numbers, f)
        rows[at.DRIVES] = place + 1

    def _lay_out_contacts(
        self, contacts: list[tuple[int, int]], outputs: list[tuple[int, int]]
    ) -> None:
        memory, rows = self._card.memory, self.memory.rows
        found = []
        for flag, bit in contacts:
            slot = inputs.driven_slot(memory, flag)
            if slot is not None:
                found.append((bit // 8, bit % 8, *inputs.input_place(flag), slot))
        rows[at.INPUTS] = len(found)
        found += [(bit // 8, bit % 8, *inputs.output_place(flag), 0) for flag, bit in outputs]
        rows[at.OUTPUTS] = len(outputs)
        if len(found) > at.MOST_CONTACTS:
            raise BusError(
                f"{len(found)} contacts on the bus: the real-time loop has room for"
                f" {at.MOST_CONTACTS}"
            )
        for number, contact in enumerate(found):
            first = at.FIRST_CONTACT + at.CONTACT_ROWS * number
            for offset, value in enumerate(contact):
                rows[first + offset] = value
