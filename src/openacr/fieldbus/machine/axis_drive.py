"""A real drive in the place of a modelled one: rows of the card to process data, and back.

Positions. The drive's count at the first exchange is the card's count at power-up, as an
encoder starts where the axis is. A cyclic position is the one the secondary setpoint means:

    target = place of the raw count + (setpoint - actual position) * 4 / MULT

so that RES, REN and presets, which change setpoint and position together, move nothing.

Enabling. A drive is asked for operation only after DRIVE ON (or a set Drive Enabled flag) of its
axis. The flag stays clear until the drive operates; in that cycle the setpoint becomes the actual
position again (REN), so that enabling moves nothing.
"""

import logging

from openacr.errors import CardError
from openacr.fieldbus.cia402 import objects as of
from openacr.fieldbus.cia402.drive import Drive, Order
from openacr.fieldbus.cia402.faults import fault_text, group_of
from openacr.fieldbus.cia402.states import State, state_of
from openacr.fieldbus.ethercat.master.mapping import Signal
from openacr.fieldbus.ethercat.master.master import Member
from openacr.fieldbus.machine.report import DriveReport
from openacr.fieldbus.machine.touch_probes import TouchProbes
from openacr.map.memory import Memory
from openacr.map.rows import axes, bus_motors, encoders, motors
from openacr.map.words import af4
from openacr.motion.axis import drive as card_drive
from openacr.motion.axis import registers
from openacr.motion.card import Card
from openacr.plant import inputs
from openacr.plant.describe.bus_schema import INPUT_BITS, BusDriveTable, CyclicMode
from openacr.plant.describe.schema import Axis
from openacr.plant.physics.drive_cy import FAULT_REPORTED, FAULT_TAKEN_BACK, converter_volts

log = logging.getLogger(__name__)

RAW_COUNTS = 4.0  # raw counts per encoder line; MULT selects how many of them count
MIDDLE = 0.5  # of a count: where an encoder starts
MOST_PERMILLE = 0xFFFF  # of a torque limit
MOST_V = 10.0  # of an analog output
RESET_S = 0.5  # a drive may take to leave its fault
JITTER_CNT = 16  # of the drive, that a position may jump at rest


class AxisDrive:
    """The drive of one axis."""

    def __init__(self, card: Card, axis: Axis, table: BusDriveTable, member: Member) -> None:
        self.card, self.axis, self.table = card, axis, table
        self.memory: Memory = card.memory
        self.drive = Drive()
        self.may_enable = False
        self.alarm = ""
        self._n = axis.number  # of the motor and its encoder
        per_rev = table.counts_per_rev or axis.counts
        # Counts of the drive for a raw count.
        self._scale = table.direction.sign * per_rev / axis.counts
        self._fastest_cps = table.fastest_rev_s * per_rev
        self._is_anew = True  # the position of the first exchange is no jump
        self._counts: int | None = None  # of the drive, beyond 32 bits
        self._zero = 0
        self.is_resetting = self._was_reset = self._was_asked = self._is_ready = False
        self._since_s = 0.0
        self._reset_s = -RESET_S
        self._level: int | None = None
        self._most_permille = round(min(MOST_PERMILLE, MOST_V * (table.torque_limit or 0.0)))
        self._connect(member)
        self.memory.I[bus_motors.has_probe[self._n]] = int(table.probe)

    def connect(self, member: Member) -> None:
        """Use the drive anew after its bus has been brought up again; it is off."""
        self._connect(member)
        self.drive = Drive()
        self._was_asked = self._is_ready = False
        self._is_anew = True

    def _connect(self, member: Member) -> None:
        mode = of.MODES[self.table.mode]
        self.position = member.device.position
        out, in_ = member.outputs, member.inputs
        self._control = Signal.of(of.CONTROL_WORD, out, member.outputs_at)
        self._target = Signal.of(mode.target, out, member.outputs_at)
        self._status = Signal.of(of.STATUS_WORD, in_, member.inputs_at)
        self._actual = Signal.of(of.ACTUAL_POSITION, in_, member.inputs_at)
        self._mode = Signal.of(of.MODE_DISPLAY, in_, member.inputs_at)
        self._error = Signal.of(of.ERROR_CODE, in_, member.inputs_at)
        self._contacts = self._limit = self._probes = None
        if self.table.inputs:
            self._contacts = Signal.of(of.DIGITAL_INPUTS, in_, member.inputs_at)
        if self.table.torque_limit is not None:
            self._limit = Signal.of(of.MOST_TORQUE, out, member.outputs_at)
        if self.table.probe or self.table.marker:
            self._probes = TouchProbes(self.memory, self._n, member, self.table)
        self._word = 0x40  # the status word of the last exchange
        self._image = b""  # that came back last

    @property
    def label(self) -> str:
        """What messages call it."""
        return f"drive of axis {self.axis.label}"

    @property
    def owner(self) -> int | None:
        """The axis of the card whose drive it is, None while none has it."""
        rows = self.memory.I
        for n in range(axes.COUNT):
            if rows[axes.on[n]] and rows[axes.drive_motor[n]] == self._n:
                return n
        return None

    # --- before the exchange ----------------------------------------------------------

    def give(self, image: bytearray, now_s: float, patience_s: float) -> None:
        """Put control word and target of this tick into the image."""
        n = self.owner
        self._lead(n, now_s)
        if n is not None:
            self._settle(n, now_s, patience_s)
        self._control.put(image, self.drive.next_word(self._word))
        self._target.put(image, self._target_of(n))
        if self._limit is not None:
            self._limit.put(image, self._torque_limit(n))
        if self._probes is not None:
            self._probes.give(image)

    def _lead(self, n: int | None, now_s: float) -> None:
        """Ask the drive for what the card wants of it."""
        flags = self.memory.I[af4.word[n]] if n is not None else 0
        is_reset = bool(flags & af4.DRIVE_RESET_REQUEST)
        self.is_resetting = is_reset and not self._was_reset
        if self.is_resetting:
            self.alarm = ""
            self._report(FAULT_TAKEN_BACK)
            self._reset_s = now_s
            self.drive.reset()
        self._was_reset = is_reset
        if n is None or not self._is_asked(n):
            self._was_asked = self._is_ready = False
            if self.drive.order is Order.ON:
                self.drive.ask(Order.OFF)
        elif not self._was_asked:
            self._begin(n, now_s)

    def _begin(self, n: int, now_s: float) -> None:
        """DRIVE ON: ask for operation, if that is allowed."""
        if not self.may_enable:
            self._refuse(n, "is not enabled: the bus is open for reading only (serve --real)")
        elif self.alarm:
            self._refuse(n, f"is not enabled: {self.alarm} (DRIVE RES resets it)")
        elif self._counts is None:
            self._refuse(n, "is not enabled: it has not reported a position yet")
        elif self.drive.state in (State.OPERATING, State.QUICK_STOP):
            self._hold(n)  # it is still on its way down
        else:
            self.drive.ask(Order.ON)
            self._was_asked, self._since_s = True, now_s

    def bar(self, why: str) -> None:
        """Refuse DRIVE ON: the drive cannot hear it now."""
        n = self.owner
        if n is not None and self._is_asked(n):
            self._refuse(n, f"is not enabled: {why}")

    def _settle(self, n: int, now_s: float, patience_s: float) -> None:
        """Show on the card how far enabling has got."""
        if not self._was_asked or (self._is_ready and self.drive.order is Order.ON):
            return
        state = self.drive.state.value if self.drive.state else "an unknown state"
        if self.drive.order is not Order.ON:
            self.fail(f"it is in {state}, not in operation")
        elif self.drive.is_operating:
            self._take_over(n)
        elif now_s - self._since_s > patience_s:
            self._refuse(n, f"is not enabled: it is in {state} after {patience_s:g} s")
        else:
            self._hold(n)

    def _hold(self, n: int) -> None:
        """Keep the Drive Enabled flag clear, and the request for it."""
        rows = self.memory.I
        rows[af4.word[n]] &= ~(af4.DRIVE_ENABLED | af4.MOTOR_ON)
        rows[axes.drive_old[n]] = 0
        rows[axes.enable_ticks[n]] = 1

    def _is_asked(self, n: int) -> bool:
        rows = self.memory.I
        return bool(rows[af4.word[n]] & af4.DRIVE_ENABLED or rows[axes.enable_ticks[n]])

    def _take_over(self, n: int) -> None:
        """The drive operates: the setpoint becomes the actual position."""
        try:
            registers.ren(self.card, n)
        except CardError:
            self.fail("motion was commanded before it was ready")
        else:
            self._is_ready = True
            card_drive.confirm(self.card, n)

    def _refuse(self, n: int, text: str) -> None:
        log.warning("the %s %s", self.label, text)
        self.drive.ask(Order.OFF)
        card_drive.disable(self.card, n)
        self._was_asked = False

    def _target_of(self, n: int | None) -> int:
        """The target of this tick, in units of the drive."""
        if self.table.mode is CyclicMode.CSP:
            return _wrapped(self._position_of(n))
        if n is None or not self._is_ready:
            return 0
        rows = self.memory
        volts = converter_volts(
            rows.S, rows.I[motors.dac[self._n]], rows.F[motors.dac_step[self._n]]
        )
        value = round(volts * (self.table.per_volt or 0.0) * (1 if self._scale > 0 else -1))
        return max(-self.table.most, min(self.table.most, value))

    def _position_of(self, n: int | None) -> int:
        """Where the setpoint means the drive to be; where it is while it does not operate."""
        rows = self.memory
        mult = rows.I[encoders.mult[self._n]]
        if n is None or not self._is_ready or not mult:
            return self._counts or 0
        # With the fraction that the encoder carries the target depends on the setpoint alone.
        actual = rows.I[axes.actual_position[n]] + rows.F[encoders.partial_cnt[self._n]]
        missing = rows.F[axes.ssp_cnt[n]] - actual
        place_cnt = rows.F[motors.raw_count[self._n]] + missing * RAW_COUNTS / mult
        return self._zero + round(place_cnt * self._scale)

    def _torque_limit(self, n: int | None) -> int:
        """The smaller of the torque limits of both directions (TLM) in 0.1 % of rated torque.

        A drive that no axis has keeps its last one: it may still be on its ramp.
        """
        if n is not None:
            rows = self.memory.S
            volts = min(rows[axes.plus_torque_limit[n]], -rows[axes.minus_torque_limit[n]])
            value = volts * (self.table.torque_limit or 0.0)
            self._most_permille = round(max(0.0, min(MOST_PERMILLE, value)))
        return self._most_permille

    # --- after the exchange -----------------------------------------------------------

    def take(self, image: bytes, now_s: float, passed_s: float) -> None:
        """Bring what the drive reports into the rows of the next tick."""
        self._word, self._image = self._status.get(image), image
        self._take_position(self._actual.get(image), passed_s)
        if self._contacts is not None:
            self._take_contacts(self._contacts.get(image))
        if self._probes is not None:
            self._probes.take(image, self._place_cnt)
        self.drive.state = state_of(self._word)
        if self.drive.has_fault:
            if not self.alarm and now_s - self._reset_s > RESET_S:
                self.fail(f"it reports fault {_named(self._error.get(image))}")
        elif not self.alarm:
            self._report(FAULT_TAKEN_BACK)
        if self.drive.is_operating and self._mode.get(image) != of.MODES[self.table.mode].number:
            shown = self._mode.get(image)
            self.fail(f"it operates in mode {shown}, not in {self.table.mode.upper()}")

    def _take_position(self, actual: int, passed_s: float) -> None:
        if self._counts is None:
            self._counts = self._zero = actual
        moved = _wrapped(actual - self._counts)
        is_jump = abs(moved) > self._fastest_cps * passed_s + JITTER_CNT
        if is_jump and not self._is_anew:
            self.fail(f"its position jumped by {moved} counts within {passed_s * 1e3:.3g} ms")
        self._is_anew = False
        self._counts += moved
        self.memory.F[bus_motors.reported_cnt[self._n]] = self._place_cnt(self._counts)

    def _take_contacts(self, level: int) -> None:
        if level == self._level:
            return
        self._level = level
        for name, flag in self.table.inputs.items():
            inputs.drive(self.memory, flag, bool(level >> INPUT_BITS[name] & 1))

    def _place_cnt(self, latched: int) -> float:
        """The count of the card at a latched position of the drive."""
        counts = (self._counts or 0) + _wrapped(latched - (self._counts or 0))
        return (counts - self._zero) / self._scale + MIDDLE

    def report(self, sent: bytearray, *, is_heard: bool) -> DriveReport:
        """How the drive is, by what was sent last and what came back; `is_heard`: just now."""
        code = self._error.get(self._image) if self._image else 0
        n = self.owner
        return {
            "axis": self.axis.label,
            "number": self.axis.number,
            "position": self.position,
            "state": self.drive.state.name if self.drive.state and is_heard else "",
            "mode": self._mode.get(self._image) if self._image else 0,
            "actual": self._counts or 0,
            "target": self._target.get(sent),
            "is_enabled": n is not None and card_drive.is_enabled(self.card, n),
            "code": code,
            "group": group_of(code),
            "text": fault_text(code),
            "alarm": self.alarm,
        }

    # --- what goes wrong --------------------------------------------------------------

    def fail(self, text: str) -> None:
        """Stop the axis: its motion is killed, the drive stops quickly and is off; it is noted."""
        if not self.alarm:
            log.error("the %s is stopped: %s", self.label, text)
            self.alarm = text
        self._is_ready = False
        self._was_asked = False
        self.drive.ask(Order.QUICK_STOP)
        self._report(FAULT_REPORTED)
        n = self.owner
        if n is not None:
            rows = self.memory.I
            rows[af4.word[n]] |= af4.DRIVE_FAULT | af4.KILL_ALL_MOTION_REQUEST
            card_drive.disable(self.card, n)

    def _report(self, what: int) -> None:
        if what == FAULT_REPORTED or self.memory.I[motors.fault_report[self._n]]:
            self.memory.I[motors.fault_report[self._n]] = what


def _named(code: int) -> str:
    """An error code with its meaning."""
    text = fault_text(code)
    return f"0x{code:04X} ({text})" if text else f"0x{code:04X}"


def _wrapped(counts: int) -> int:
    """A count as the drive has it: in 32 bits."""
    return (counts + 0x80000000) % 0x100000000 - 0x80000000
