"""Machine settings: the system parameters of the store, converted for the runner.

Feeds are per minute in the store and per second here.
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
from openacr.models import MODELS
from openacr.sysvar.schema import AXES
from openacr.sysvar.tabs import (
    AXIS,
    CELLS,
    COMPATIBILITY,
    CONTROL,
    GENERAL,
    HOME,
    IO,
    JOG,
    OFFSETS,
    PROBE,
    SERVO,
    SPEEDS,
    SPINDLE,
    TOOL,
    OverrideTab,
)

NONE = -1
S_PER_MIN = 60.0
REST_S, LONGEST_REST_S = 5.0, 60.0  # to come to rest: besides the ramp, and with it
BUFFERED_S = 2.0  # of motion that waits on the card, beyond the link timeout
HOMED = CELLS.homed_axes
GAINS = (
    SERVO.p_gain,
    SERVO.i_gain,
    SERVO.i_delay,
    SERVO.i_limit,
    SERVO.d_gain,
    SERVO.d_time,
    SERVO.acceleration_feedforward,
    SERVO.velocity_feedforward,
    SERVO.torque_limits,
    SERVO.velocity_feedback,
)


class Store(Protocol):
    """The cells of the SYSVAR store."""

    def read(self, n: int) -> float:
        """The number in a cell."""

    def write(self, n: int, value: float) -> None:
        """Set a cell."""

    def read_text(self, n: int) -> str:
        """The text in a cell."""


class Settings:
    """The settings of one run, read once when it starts."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self.model = MODELS[store.read_text(GENERAL.card_model)]
        self.master = self._int(GENERAL.master_program)
        self.axes = tuple(self._axis(a) for a in range(AXES) if self._is_configured(a))
        if not self.axes:
            raise UserError(f"no axis is configured: set P{AXIS.configured[0]} and up")
        self.speeds = self._speeds()
        self.spindle = self._spindle()
        self.wiring = self._wiring()
        self.burning = Burning(
            self._int(SPEEDS.plasma_output),
            self._real(SPEEDS.plasma_percent),
            self._int(CONTROL.under_burn_output),
            self._real(CONTROL.under_burn_distance),
        )
        self.io_modules = self._int(CONTROL.io_expansion_modules)
        self.drip_threshold = self._int(CONTROL.dripfeed_threshold)
        self.forward_threshold = self._int(CONTROL.forward_threshold)
        self.repeats = bool(self._int(CONTROL.repeat_forever))
        self.returns_to_start = bool(self._int(CONTROL.goto_start_after_start))
        self.lead_in_u = self._real(CONTROL.default_lead_in_radius)
        self.on_the_fly = bool(self._int(COMPATIBILITY.m_codes_on_the_fly))
        self.watchdog_program = self._int(CONTROL.watchdog_program)
        self.link_timeout_s = self._real(CONTROL.link_timeout)
        self.is_metric = bool(self._int(CONTROL.default_units))

    def _real(self, n: int) -> float:
        return self._store.read(n)

    def _int(self, n: int) -> int:
        return int(self._store.read(n))

    def _per_s(self, n: int) -> float:
        return self._store.read(n) / S_PER_MIN

    def _is_configured(self, axis: int) -> bool:
        return bool(self._int(AXIS.configured[axis]))

    def _axis(self, a: int) -> AxisSettings:
        high, low = self._real(AXIS.plus_soft_limit[a]), self._real(AXIS.minus_soft_limit[a])
        return AxisSettings(
            index=a,
            name=self._store.read_text(AXIS.name[a]),
            pulses_per_unit=self._real(AXIS.pulses_per_unit[a]),
            encoder=self._int(AXIS.encoder[a]),
            dac=self._int(AXIS.dac_number[a]),
            multiplier=self._int(AXIS.encoder_mult[a]),
            is_inverted=bool(self._int(AXIS.dac_polarity[a])),
            gains=tuple(self._real(gain[a]) for gain in GAINS),
            soft_limits=None if self._int(AXIS.disable_limit[a]) else (high, low),
            in_position_u=self._real(AXIS.in_position_band[a]),
            excess_error_u=self._real(AXIS.excess_error_band[a]),
            is_home_required=bool(self._int(AXIS.home_required[a])),
            max_speed_ups=self._per_s(AXIS.max_axis_speed[a]),
            max_acceleration_ups2=self._real(AXIS.max_axis_acceleration[a]),
            jerk_ups3=self._jerk(a),
            tolerance_radius_u=self._real(AXIS.tolerance_radius[a]),
            backlash_u=self._real(OFFSETS.backlash[a]),
            jog_ups=self._per_s(JOG.feedrate[a]),
            jog_rapid_ups=self._per_s(JOG.rapid[a]),
            jog_acc_ups2=self._real(JOG.acceleration[a]),
            jog_dec_ups2=self._real(JOG.deceleration[a]),
            jog_stp_ups2=self._real(JOG.stp_ramp[a]),
        )

    def _jerk(self, a: int) -> float:
        """The jerk limit of an axis; only a machine with a Path jerk has any."""
        path = self._real(SPEEDS.path_jerk)
        return (self._real(AXIS.max_axis_jerk[a]) or path) if path > 0.0 else 0.0

    def real(self, n: int) -> float:
        """The number in a cell."""
        return self._store.read(n)

    def home(self, a: int) -> HomeSettings:
        """The home settings of axis `a`."""
        return HomeSettings(
            is_negative=bool(self._int(HOME.direction[a])),
            preset_u=self._real(HOME.preset[a]),
            switch_input=self._int(HOME.switch_input[a]),
            fast_ups=self._per_s(HOME.fast_speed[a]),
            slow_ups=self._per_s(HOME.slow_speed[a]),
            marker_ups=self._real(SPEEDS.marker_speed) or self._per_s(HOME.marker_speed[a]),
            acc_ups2=self._real(HOME.acceleration[a]),
            dec_ups2=self._real(HOME.deceleration[a]),
            stp_ups2=self._real(HOME.stp[a]),
            priority=self._int(HOME.priority[a]),
        )

    def _speeds(self) -> Speeds:
        feed_acc = self._real(SPEEDS.master_feed_acc_dec)
        most = self._per_s(SPEEDS.max_machine_speed)
        return Speeds(
            max_ups=most,
            trial_ups=self._per_s(SPEEDS.trial_speed),
            trace_ups=self._per_s(SPEEDS.forward_backward_speed) or self._per_s(SPEEDS.cut_speed),
            rapid_ups=min(self._per_s(SPEEDS.rapid_speed) or most, most),
            rapid_acc_ups2=self._real(SPEEDS.master_rapid_acc_dec),
            feed_acc_ups2=feed_acc,
            arc_acc_ups2=self._real(SPEEDS.arc_acceleration) or feed_acc,
            corner_ups=self._per_s(SPEEDS.min_corner_speed),
            corner_step_ups=self._real(SPEEDS.corner_step),
            angle1_deg=self._real(CONTROL.acute_angle1_threshold),
            angle2_deg=self._real(CONTROL.acute_angle2),
            rotary_max=self._per_s(SPEEDS.max_rotary_speed),
            in_position_s=self._real(SPEEDS.in_position_time_out),
            jerk_ups3=self._real(SPEEDS.path_jerk),
            chord_u=self._real(SPEEDS.chord_tolerance),
            path_tolerance_u=self._real(SPEEDS.path_tolerance),
        )

    def _spindle(self) -> SpindleSettings:
        return SpindleSettings(
            code=self._int(SPINDLE.code),
            volts_per_rpm=self._real(SPINDLE.scaling),
            dac=self._int(SPINDLE.dac),
            at_zero=self._int(SPINDLE.at_zero_input),
            at_speed=self._int(SPINDLE.at_speed_input),
            cw=self._int(SPINDLE.cw_output),
            ccw=self._int(SPINDLE.ccw_output),
            off=self._int(SPINDLE.off_output),
            exception=self._int(SPINDLE.exception_input),
            mist=self._int(SPINDLE.coolant_mist_output),
            flood=self._int(SPINDLE.coolant_flood_output),
            coolant_off=self._int(SPINDLE.coolant_off_output),
            orient=self._int(SPINDLE.orient_output),
            oriented=self._int(SPINDLE.oriented_input),
            orient_s=self._real(SPINDLE.orient_time),
            time_out_s=self._real(SPINDLE.time_out),
        )

    def _wiring(self) -> Wiring:
        return Wiring(
            block_skip=self._int(IO.block_skip),
            optional_stop=self._int(IO.optional_stop),
            feed_hold=self._int(IO.feedhold_input),
            cycle_start=self._int(IO.cycle_start_input),
            emergency_stop=self._int(IO.emergency_stop),
            soft_limits=self._int(IO.soft_limits_input),
            joystick=self._int(IO.jog_joystick_input),
            g27_input=self._int(IO.g27_input),
            g27_output=self._int(IO.g27_output),
            lubrication=self._int(IO.lubrication_error),
            drive_enable=self._int(IO.drive_enable_output),
            g28_error=self._int(IO.g28_error_output),
            probe=self._int(PROBE.input),
            is_probe_trailing=bool(self._int(PROBE.edge)),
            is_probe_software=bool(self._int(PROBE.capture)),
            is_probe_on_each=bool(self._int(PROBE.wired_to_each_axis)),
            probe_back_ups=self._per_s(PROBE.back_up_feed),
            is_probe_checked=bool(self._int(PROBE.tripped_at_start_check)),
            reference_s=self._real(PROBE.reference_input_wait),
            tool_changed=self._int(TOOL.changed_input),
            tool_change=self._int(TOOL.change_output),
            is_manual_change=bool(self._int(TOOL.manual_tool_change)),
            tool_time_out_s=self._real(TOOL.change_time_out),
        )

    @property
    def lowest_jerk_ups3(self) -> float:
        """The jerk that every axis keeps in any move, 0 = any: the JRK of the card."""
        return min([self.speeds.jerk_ups3, *(axis.jerk_ups3 for axis in self.axes)])

    @property
    def rest_s(self) -> float:
        """Longest time to come to rest: twice the longest ramp plus a margin."""
        speeds = self.speeds
        ramps = [each for each in (speeds.rapid_acc_ups2, speeds.feed_acc_ups2) if each > 0.0]
        ramp_s = speeds.max_ups / min(ramps) if ramps else 0.0
        return min(REST_S + 2.0 * ramp_s, LONGEST_REST_S)

    @property
    def buffered_s(self) -> float:
        """Longest motion buffered on the card: without its host it must soon stop.

        It is longer than the link timeout, so that the watchdog holds the path before it ends.
        """
        return self.link_timeout_s + BUFFERED_S

    def table(self, tab: OverrideTab) -> tuple[float, ...]:
        """The percentages of the clicks of an override switch (FOV, ROV or SOV)."""
        return tuple(self._real(n) for n in tab.percents)

    def click(self, tab: OverrideTab) -> int:
        """The click of an override without a switch."""
        return self._int(tab.click)

    def switch(self, tab: OverrideTab) -> int:
        """The first of the four inputs of an override switch, -1 for none."""
        return self._int(tab.switch)

    def is_input_inverted(self, number: int) -> bool:
        """Whether an input counts as active when it is off."""
        return bool(self._int(CONTROL.input_inverted[number]))

    def is_output_inverted(self, number: int) -> bool:
        """Whether an output is switched off to act."""
        return bool(self._int(CONTROL.output_inverted[number]))

    def axis(self, index: int) -> AxisSettings:
        """The settings of a configured axis."""
        for one in self.axes:
            if one.index == index:
                return one
        raise UserError(f"axis {index} is not configured (P{AXIS.configured[index]})")

    def named(self, name: str) -> AxisSettings:
        """The settings of the axis of this name."""
        for one in self.axes:
            if one.name == name:
                return one
        raise UserError(f"axis {name} is not configured; configured are {' '.join(self.names())}")

    def is_homed(self, axis: int) -> bool:
        """Whether the reference point of an axis is known."""
        return bool(int(self._store.read(HOMED)) >> axis & 1)

    def mark_homed(self, axis: int, homed: bool) -> None:
        """Record that the reference point of an axis is known, or no longer known."""
        before = int(self._store.read(HOMED))
        self._store.write(HOMED, before | 1 << axis if homed else before & ~(1 << axis))

    def names(self) -> Iterator[str]:
        """The names of the configured axes."""
        return (one.name for one in self.axes)
