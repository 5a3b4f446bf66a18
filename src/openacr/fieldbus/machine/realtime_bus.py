"""The bus of a machine in the real-time loop: Python's part, which may be late.

The loop exchanges the frame and does what has to be on time (`exchange_cy.py`). Here drives are led
through their states, and what the loop has stopped gets its text; `look` does it, every few
milliseconds. The reactions are those of `real_machine.py`.
"""

import logging
import math
import time
from typing import Protocol

from openacr.fieldbus.cia402.objects import DIGITAL_INPUTS
from openacr.fieldbus.cia402.states import DISABLE_VOLTAGE
from openacr.fieldbus.ethercat.master.device import state_of
from openacr.fieldbus.ethercat.master.mapping import Signal
from openacr.fieldbus.ethercat.master.master import Master
from openacr.fieldbus.ethercat.master.port import BusError, Link
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.bringing_up import Brought, bring_up
from openacr.fieldbus.machine.exchange_layout import ExchangeLayout, numbers_at
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.fieldbus.machine.realtime_drive import RealtimeDrive
from openacr.fieldbus.machine.report import (
    BusReport,
    Counters,
    DeviceReport,
    LoopReport,
    devices_of,
    note_state,
)
from openacr.motion.card import Card
from openacr.plant.describe.bus_schema import INPUT_BITS, Bus
from openacr.plant.describe.schema import Axis, World
from openacr.wording import counted

log = logging.getLogger(__name__)

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
                self.memory.numbers[numbers_at(place) + at.ZERO] = math.nan
        else:
            for drive in self.drives:
                drive.connect_again(brought.drives[drive.axis.number], self._link.now_s())
        self._master = brought.master
        self._lay_out(brought, on_bus)

    @property
    def counters(self) -> Counters:
        """Frames by what became of them, since the loop has let the counters begin at 0."""
        numbers = self.memory.numbers
        return {
            "sent": int(numbers[at.SENT_FRAMES]),
            "lost": int(numbers[at.MISSING_FRAMES]),
            "wrong": int(numbers[at.WRONG_FRAMES]),
            "late": int(numbers[at.LATE_FRAMES]),
        }

    @property
    def cycles(self) -> int:
        """Exchanges so far."""
        return self.counters["sent"]

    @property
    def bad_cycles(self) -> int:
        """Those of them that were lost, damaged or not whole."""
        return self.counters["lost"] + self.counters["wrong"]

    def report(self, loop: LoopReport) -> BusReport:
        """The state of the bus, its devices and drives, beside the figures of its loop."""
        rows = self.memory.rows
        first = rows[at.IMAGE_AT]
        sent = bytearray(self.memory.out[first : first + len(self._image)])
        is_heard = not rows[at.BAD] and self.memory.numbers[at.LATEST_NS] > 0.0
        return {
            "interface": self._link.name,
            "is_real": self._is_real,
            "is_coming_up": False,  # Python does nothing else meanwhile
            "alarm": self.alarm,
            "cycle_s": self._bus.cycle * self._period_s,
            "counters": self.counters,
            "devices": self._seen_devices(),
            "drives": [drive.report(sent, is_heard=is_heard) for drive in self.drives],
            "loop": loop,
        }

    def _seen_devices(self) -> list[DeviceReport]:
        """The devices with their states, as the loop has heard them last."""
        rows = self.memory.rows
        found = [] if self._master is None else devices_of(self._master)
        for place, shown in enumerate(found):
            r = at.FIRST_DEVICE + at.DEVICE_ROWS * place
            status = rows[r + at.AL_STATUS]
            note_state(shown, state_of(status, rows[r + at.AL_CODE]) if status else None)
        return found

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

    def _lay_out(self, brought: Brought, on_bus: list[Axis]) -> None:
        """Describe frame, drives and contacts to the loop, and let it exchange."""
        rows, numbers, master = self.memory.rows, self.memory.numbers, brought.master
        layout = ExchangeLayout(self.memory)
        self._image = bytearray(master.image)
        layout.frame(master, self._link.fileno(), self._bus.cycle * self._period_s)
        contacts_in: list[tuple[int, int]] = []  # flag, and bit of the image
        outputs: list[tuple[int, int]] = []
        for place, (axis, drive) in enumerate(zip(on_bus, self.drives, strict=True)):
            member = brought.drives[axis.number]
            layout.drive(place, drive, member)
            if drive.table.inputs:
                first = 8 * Signal.of(DIGITAL_INPUTS, member.inputs, member.inputs_at).at
                contacts_in += [(f, first + INPUT_BITS[n]) for n, f in drive.table.inputs.items()]
        for table, member in zip(self._bus.terminal, brought.terminals, strict=True):
            ins, outs = member.inputs.contacts, member.outputs.contacts
            for found, number, bits, first, count in (
                (contacts_in, table.inputs_from, ins, member.inputs_at, table.inputs),
                (outputs, table.outputs_from, outs, member.outputs_at, table.outputs),
            ):
                if number is not None:
                    found += [(number + k, 8 * first + bit) for k, bit in enumerate(bits[:count])]
        layout.contacts(self._card.memory, contacts_in, outputs)
        numbers[at.LATE_NS] = 1e9 * self._bus.late_s
        numbers[at.LATEST_NS] = 0.0
        numbers[at.RETURN_NS] = 1e9 * RETURN_PART * self._period_s
        rows[at.CYCLE_TK], rows[at.WAIT_TK] = self._bus.cycle, 0
        rows[at.LOST_FRAMES], rows[at.BAD], rows[at.ALARM] = self._bus.lost_frames, 0, 0
        self._hand_over()
        rows[at.ACTIVE] = 1
