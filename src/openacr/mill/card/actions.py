"""Actions of the machine between moves: spindle, coolant, tool change, waits.

An action is a generator. It switches something, then yields the condition that has to be
met before it continues; the runner polls the card, shows the reason, counts the time-out
and closes the action when the program is aborted (`finally` then restores outputs).
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from math import inf
from typing import TypeAlias

from openacr.client import ConnectionLostError
from openacr.cnc.occupied import TOOL_LOADED, TOOL_REQUESTED
from openacr.mill.card import alarms
from openacr.mill.card.alarms import Kind
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE

CW, CCW, OFF = 3, 4, 5
FULL_VOLTS = 10.0
DAC_VALUE, DAC_STRIDE = 6400, 16
DROP_S = 2.0  # longest wait for the tool-changed input to go off again

# Bits of the spindle code.
BIPOLAR, WAITS_FOR_SPEED, SPEED_LEVEL, WAITS_FOR_ZERO, ZERO_LEVEL = 1, 2, 4, 8, 16


@dataclass(frozen=True, slots=True)
class Until:
    """A condition the program waits for, with its time limit and the alarm after it."""

    reason: str
    is_met: Callable[[CardState], bool]
    limit_s: float = inf
    alarm: Kind | None = None  # None: continue after the limit
    is_dwell: bool = False  # G4: predicted run times count it


Steps: TypeAlias = Generator[Until, None, None]


def pause(seconds: float, reason: str, *, is_dwell: bool = False) -> Until:
    """A wait for a given time."""
    return Until(reason, lambda _sample: False, seconds, is_dwell=is_dwell)


class Spindle:
    """The spindle and its handshake."""

    def __init__(self, io: MachineIo) -> None:
        self._io = io
        self._row = io.settings.spindle
        self.state = OFF
        self.rpm = 0.0
        self.override = 1.0

    def volts(self) -> float:
        """The voltage of the DAC, from speed, scaling and override."""
        if self.state == OFF:
            return 0.0
        volts = min(self.rpm * self._row.volts_per_rpm * self.override, FULL_VOLTS)
        return -volts if self.state == CCW and self._row.code & BIPOLAR else volts

    def write(self) -> None:
        """Write the voltage to the DAC."""
        if self._row.dac != NONE:
            self._io.machine.write(DAC_VALUE + DAC_STRIDE * self._row.dac, self.volts())

    def set_speed(self, rpm: float) -> None:
        """Set the speed (S word); a running spindle follows at once, without handshake."""
        self.rpm = rpm
        if self.state != OFF:
            self.write()

    def set_override(self, factor: float) -> None:
        """Set the spindle override, 1 = as programmed."""
        before, self.override = self.override, factor
        if factor == before:
            return
        try:
            self.set_speed(self.rpm)
        except ConnectionLostError:
            self.override = before  # so that it is written again
            raise

    def start(self, direction: int, rpm: float) -> Steps:
        """Start the spindle (M3 or M4)."""
        row, io = self._row, self._io
        if self.state not in (OFF, direction):
            yield from self.stop()
        io.output(row.off, False)
        io.output(row.ccw if direction == CW else row.cw, False)
        self.state, self.rpm = direction, rpm
        self.write()
        io.output(row.cw if direction == CW else row.ccw, True)
        if row.code & WAITS_FOR_SPEED:
            yield from self._level(row.at_speed, bool(row.code & SPEED_LEVEL), "spindle at speed")

    def stop(self, *, always_waits: bool = False) -> Steps:
        """Stop the spindle (M5); a tool change always waits until it is at rest."""
        self.switch_off()
        if self._row.code & WAITS_FOR_ZERO or always_waits:
            yield from self._rest()

    def _rest(self) -> Steps:
        """Wait until the spindle is at rest, where an input shows it."""
        row = self._row
        yield from self._level(row.at_zero, bool(row.code & ZERO_LEVEL), "spindle at rest")

    def switch_off(self) -> None:
        """Switch the spindle off at once, as ABORT and E-stop do."""
        try:
            self._io.output(self._row.off, True)
        finally:
            self._remove_drive()

    def _remove_drive(self) -> None:
        """Remove the drive in both directions."""
        self.state = OFF
        try:  # flags first: they have no reply whose loss could keep the rest from being sent
            self._io.output(self._row.cw, False)
            self._io.output(self._row.ccw, False)
        finally:
            self.write()

    def _level(self, number: int, level: bool, reason: str) -> Steps:
        io = self._io
        if io.has_input(number):
            limit_s = self._row.time_out_s or inf
            is_met = lambda sample: io.is_in(sample, number) == level  # noqa: E731
            yield Until(reason, is_met, limit_s, alarms.SPINDLE_TIME_OUT)

    def orient(self) -> Steps:
        """Stop the spindle, orient it to the fixed angle of fine boring and hold it there.

        The OFF output stays off: a drive that it disables could not turn to the angle.
        """
        row, io = self._row, self._io
        self._remove_drive()
        if row.code & WAITS_FOR_ZERO:
            yield from self._rest()
        io.output(row.orient, True)
        if io.has_input(row.oriented):
            yield from self._level(row.oriented, True, "spindle oriented")
        else:
            yield pause(row.orient_s, "spindle orients")

    def release(self) -> None:
        """End the orientation."""
        self._io.output(self._row.orient, False)


class Coolant:
    """Mist and flood coolant (M7, M8, M9)."""

    def __init__(self, io: MachineIo) -> None:
        self._io = io
        self.has_mist = self.has_flood = False

    def set(self, mist: bool, flood: bool) -> None:
        """Switch both; the coolant-off output is on while neither runs."""
        row = self._io.settings.spindle
        self._io.output(row.mist, mist)
        self._io.output(row.flood, flood)
        self._io.output(row.coolant_off, not mist and not flood)
        self.has_mist, self.has_flood = mist, flood


class ToolChanger:
    """Tool change (M6): requests a tool and waits until it is loaded."""

    def __init__(self, io: MachineIo, spindle: Spindle) -> None:
        self._io = io
        self._spindle = spindle
        self.wants_confirmation = False  # no input reports the tool: a key confirms it
        self._is_confirmed = False

    def change(self, tool: int, old: int) -> Steps:
        """Load a tool; it counts as loaded only when the action completes."""
        wiring, io = self._io.settings.wiring, self._io
        yield from self._spindle.stop(always_waits=True)
        io.machine.write(TOOL_REQUESTED, tool)
        io.machine.write(TOOL_LOADED, old)
        io.output(wiring.tool_change, True)
        try:
            yield from self._wait(tool)
        finally:
            io.output(wiring.tool_change, False)
        if io.has_input(wiring.tool_changed):
            is_off = lambda sample: not io.is_in(sample, wiring.tool_changed)  # noqa: E731
            yield Until("tool-changed signal off", is_off, DROP_S)
        io.machine.write(TOOL_LOADED, tool)

    def confirm(self) -> None:
        """Confirm that the requested tool is loaded (confirmation key)."""
        self._is_confirmed = True

    def _wait(self, tool: int) -> Steps:
        wiring, io = self._io.settings.wiring, self._io
        limit_s = wiring.tool_time_out_s or inf
        reason = f"load tool {tool}" if wiring.is_manual_change else f"tool {tool} is changed"
        if not io.has_input(wiring.tool_changed):
            self._is_confirmed, self.wants_confirmation = False, True
            try:
                yield Until(reason, lambda _: self._is_confirmed, limit_s, alarms.TOOL_TIME_OUT)
            finally:
                self.wants_confirmation = False
            return
        is_off = lambda sample: not io.is_in(sample, wiring.tool_changed)  # noqa: E731
        is_on = lambda sample: io.is_in(sample, wiring.tool_changed)  # noqa: E731
        yield Until(reason, is_off, limit_s, alarms.TOOL_TIME_OUT)
        yield Until(reason, is_on, limit_s, alarms.TOOL_TIME_OUT)
