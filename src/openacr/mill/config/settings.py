"""What the system parameters of the store say about the machine, as the runner needs it.

The store knows numbers; `cell(tab, k, axis)` is their one rule. Feeds are per minute in the
store and per second here.
"""

from collections.abc import Iterator
from typing import Protocol

from openacr.errors import UserError
from openacr.mill.config.tabs import (
    AxisSettings,
    Burning,
    HomeSettings,
    Speeds,
    SpindleSettings,
    Wiring,
)

FIRST_CELL, TAB_CELLS, AXIS_CELLS = 100_000, 50_000, 1_000
AXES = 8
NONE = -1
S_PER_MIN = 60.0
CLICKS = 16
REST_S, LONGEST_REST_S = 5.0, 60.0  # to come to rest: besides the ramp, and with it
BUFFERED_S = 2.0  # of motion that waits on the card, beyond the link timeout
HOMED = 271  # cell with the mask of homed axes

GENERAL, SERVO, AXIS, CONTROL, HOME, JOG, IO, FOV, ROV, SOV, PROBE, SPEEDS, COMPATIBILITY = range(
    13
)
SPINDLE, DISPLAY, TOOL, OFFSETS, MESSAGES = 14, 15, 16, 17, 18


class Store(Protocol):
    """The cells of the SYSVAR store."""

    def read(self, n: int) -> float:
        """The number in a cell."""

    def write(self, n: int, value: float) -> None:
        """Set a cell."""

    def read_text(self, n: int) -> str:
        """The text in a cell."""


def cell(tab: int, k: int, axis: int = 0) -> int:
    """The number of a system parameter."""
    return FIRST_CELL + TAB_CELLS * tab + AXIS_CELLS * axis + k


class Settings:
    """The settings of one run, read once when it starts."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self.master = self._int(GENERAL, 5)
        self.axes = tuple(self._axis(a) for a in range(AXES) if self._is_configured(a))
        if not self.axes:
            raise UserError("no axis is configured: set P200012 and up")
        self.speeds = self._speeds()
        self.spindle = self._spindle()
        self.wiring = self._wiring()
        self.burning = Burning(
            self._int(SPEEDS, 17), self._real(SPEEDS, 5), self._int(CONTROL, 14),
            self._real(CONTROL, 12),
        )  # fmt: skip
        self.io_modules = self._int(CONTROL, 124)
        self.drip_threshold = self._int(CONTROL, 116)
        self.forward_threshold = self._int(CONTROL, 117)
        self.repeats = bool(self._int(CONTROL, 13))
        self.returns_to_start = bool(self._int(CONTROL, 6))
        self.lead_in_u = self._real(CONTROL, 5)
        self.on_the_fly = bool(self._int(COMPATIBILITY, 4))
        self.watchdog_program = self._int(CONTROL, 125)
        self.link_timeout_s = self._real(CONTROL, 126)
        self.is_metric = bool(self._int(CONTROL, 1))

    def _real(self, tab: int, k: int, axis: int = 0) -> float:
        return self._store.read(cell(tab, k, axis))

    def _int(self, tab: int, k: int, axis: int = 0) -> int:
        return int(self._store.read(cell(tab, k, axis)))

    def _per_s(self, tab: int, k: int, axis: int = 0) -> float:
        return self._real(tab, k, axis) / S_PER_MIN

    def _is_configured(self, axis: int) -> bool:
        return bool(self._int(AXIS, 12, axis))

    def _axis(self, a: int) -> AxisSettings:
        high, low = self._real(AXIS, 0, a), self._real(AXIS, 1, a)
        return AxisSettings(
            index=a,
            name=self._store.read_text(cell(AXIS, 8, a)),
            pulses_per_unit=self._real(AXIS, 6, a),
            encoder=self._int(AXIS, 13, a),
            dac=self._int(AXIS, 14, a),
            multiplier=self._int(AXIS, 11, a),
            is_inverted=bool(self._int(AXIS, 5, a)),
            gains=tuple(self._real(SERVO, k, a) for k in range(10)),
            soft_limits=None if self._int(AXIS, 2, a) else (high, low),
            in_position_u=self._real(AXIS, 3, a),
            excess_error_u=self._real(AXIS, 4, a),
            is_home_required=bool(self._int(AXIS, 7, a)),
            max_speed_ups=self._per_s(AXIS, 15, a),
            max_acceleration_ups2=self._real(AXIS, 16, a),
            backlash_u=self._real(OFFSETS, a),
            jog_ups=self._per_s(JOG, 0, a),
            jog_rapid_ups=self._per_s(JOG, 1, a),
            jog_acc_ups2=self._real(JOG, 2, a),
            jog_dec_ups2=self._real(JOG, 3, a),
            jog_stp_ups2=self._real(JOG, 4, a),
        )

    def real(self, tab: int, k: int, axis: int = 0) -> float:
        """One cell of a tab."""
        return self._real(tab, k, axis)

    def home(self, a: int) -> HomeSettings:
        """How axis `a` is homed."""
        return HomeSettings(
            is_negative=bool(self._int(HOME, 0, a)),
            preset_u=self._real(HOME, 1, a),
            switch_input=self._int(HOME, 2, a),
            fast_ups=self._per_s(HOME, 3, a),
            slow_ups=self._per_s(HOME, 4, a),
            marker_ups=self._real(SPEEDS, 4) or self._per_s(HOME, 5, a),
            acc_ups2=self._real(HOME, 6, a),
            dec_ups2=self._real(HOME, 7, a),
            stp_ups2=self._real(HOME, 8, a),
            priority=self._int(HOME, 9, a),
        )

    def _speeds(self) -> Speeds:
        feed_acc = self._real(SPEEDS, 8)
        most = self._per_s(SPEEDS, 0)
        return Speeds(
            max_ups=most,
            trial_ups=self._per_s(SPEEDS, 1),
            trace_ups=self._per_s(SPEEDS, 6) or self._per_s(SPEEDS, 2),
            rapid_ups=min(self._per_s(SPEEDS, 11) or most, most),
            rapid_acc_ups2=self._real(SPEEDS, 7),
            feed_acc_ups2=feed_acc,
            arc_acc_ups2=self._real(SPEEDS, 13) or feed_acc,
            corner_ups=self._per_s(SPEEDS, 3),
            corner_step_ups=self._real(SPEEDS, 12),
            angle1_deg=self._real(CONTROL, 10),
            angle2_deg=self._real(CONTROL, 11),
            rotary_max=self._per_s(SPEEDS, 10),
            in_position_s=self._real(SPEEDS, 14),
            jerk_ups3=self._real(SPEEDS, 15),
            chord_u=self._real(SPEEDS, 16),
        )

    def _spindle(self) -> SpindleSettings:
        return SpindleSettings(
            code=self._int(SPINDLE, 0),
            volts_per_rpm=self._real(SPINDLE, 1),
            dac=self._int(SPINDLE, 2),
            at_zero=self._int(SPINDLE, 3),
            at_speed=self._int(SPINDLE, 4),
            cw=self._int(SPINDLE, 5),
            ccw=self._int(SPINDLE, 6),
            off=self._int(SPINDLE, 7),
            exception=self._int(SPINDLE, 8),
            mist=self._int(SPINDLE, 9),
            flood=self._int(SPINDLE, 10),
            coolant_off=self._int(SPINDLE, 11),
            orient=self._int(SPINDLE, 12),
            oriented=self._int(SPINDLE, 13),
            orient_s=self._real(SPINDLE, 14),
            time_out_s=self._real(SPINDLE, 15),
        )

    def _wiring(self) -> Wiring:
        return Wiring(
            block_skip=self._int(IO, 0),
            optional_stop=self._int(IO, 1),
            feed_hold=self._int(IO, 2),
            cycle_start=self._int(IO, 3),
            emergency_stop=self._int(IO, 4),
            soft_limits=self._int(IO, 5),
            joystick=self._int(IO, 6),
            g27_input=self._int(IO, 10),
            g27_output=self._int(IO, 11),
            lubrication=self._int(IO, 12),
            drive_enable=self._int(IO, 13),
            g28_error=self._int(IO, 19),
            probe=self._int(PROBE, 0),
            is_probe_trailing=bool(self._int(PROBE, 1)),
            is_probe_software=bool(self._int(PROBE, 2)),
            is_probe_on_each=bool(self._int(PROBE, 6)),
            probe_back_ups=self._per_s(PROBE, 3),
            is_probe_checked=bool(self._int(PROBE, 4)),
            reference_s=self._real(PROBE, 5),
            tool_changed=self._int(TOOL, 0),
            tool_change=self._int(TOOL, 1),
            is_manual_change=bool(self._int(TOOL, 2)),
            tool_time_out_s=self._real(TOOL, 3),
        )

    @property
    def rest_s(self) -> float:
        """How long the machine may take to come to rest: twice its longest ramp, and a little."""
        speeds = self.speeds
        ramps = [each for each in (speeds.rapid_acc_ups2, speeds.feed_acc_ups2) if each > 0.0]
        ramp_s = speeds.max_ups / min(ramps) if ramps else 0.0
        return min(REST_S + 2.0 * ramp_s, LONGEST_REST_S)

    @property
    def buffered_s(self) -> float:
        """Motion that may wait on the card: what a lost host has sent must not go on for long.

        It is longer than the link timeout, so that the watchdog holds a path before it ends.
        """
        return self.link_timeout_s + BUFFERED_S

    def table(self, tab: int) -> tuple[float, ...]:
        """The percentages of the clicks of an override switch (FOV, ROV or SOV)."""
        return tuple(self._real(tab, k) for k in range(CLICKS))

    def click(self, tab: int) -> int:
        """The click an override stands at without a switch."""
        return self._int(tab, 17)

    def switch(self, tab: int) -> int:
        """The first of the four inputs of an override switch, -1 for none."""
        return self._int(tab, 16)

    def is_input_inverted(self, number: int) -> bool:
        """Whether an input counts as active when it is off."""
        return bool(self._int(CONTROL, 1000 + number))

    def is_output_inverted(self, number: int) -> bool:
        """Whether an output is switched off to act."""
        return bool(self._int(CONTROL, 2000 + number))

    def axis(self, index: int) -> AxisSettings:
        """The settings of a configured axis."""
        for one in self.axes:
            if one.index == index:
                return one
        raise UserError(f"axis {index} is not configured (P{cell(AXIS, 12, index)})")

    def named(self, name: str) -> AxisSettings:
        """The settings of the axis of this name."""
        for one in self.axes:
            if one.name == name:
                return one
        raise UserError(f"axis {name} is not configured: {' '.join(self.names())} are")

    def is_homed(self, axis: int) -> bool:
        """Whether the reference point of an axis is known."""
        return bool(int(self._store.read(HOMED)) >> axis & 1)

    def mark_homed(self, axis: int, homed: bool) -> None:
        """Note that the reference point of an axis is known, or not any more."""
        before = int(self._store.read(HOMED))
        self._store.write(HOMED, before | 1 << axis if homed else before & ~(1 << axis))

    def names(self) -> Iterator[str]:
        """The names of the configured axes."""
        return (one.name for one in self.axes)
