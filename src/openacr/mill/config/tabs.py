"""Records of machine settings, one for each tab of the system parameters.

Speeds are per second here and per minute in the store; inputs and outputs are -1 where not
configured. `settings` fills the records.
"""

from msgspec import Struct

LINEAR = frozenset("XYZUV")


class AxisSettings(Struct, frozen=True):
    """One axis: SERVO, AXES, HOME and JOG tabs."""

    index: int
    name: str
    pulses_per_unit: float
    encoder: int
    dac: int
    multiplier: int
    is_inverted: bool
    gains: tuple[float, ...]  # P I IDELAY ILIMIT D DWIDTH FFACC FFVEL TLM FBVEL
    soft_limits: tuple[float, float] | None
    in_position_u: float
    excess_error_u: float
    is_home_required: bool
    max_speed_ups: float
    max_acceleration_ups2: float
    jerk_ups3: float  # on paths, 0 = any
    tolerance_radius_u: float  # of a rotary axis, 0: by the unit of the machine
    backlash_u: float
    jog_ups: float
    jog_rapid_ups: float
    jog_acc_ups2: float
    jog_dec_ups2: float
    jog_stp_ups2: float

    @property
    def is_linear(self) -> bool:
        """Whether it moves along a line (X, Y, Z, U, V): such axes share the vector speed."""
        return self.name in LINEAR


class HomeSettings(Struct, frozen=True):
    """Settings of one axis for finding its reference point."""

    is_negative: bool
    preset_u: float
    switch_input: int
    fast_ups: float
    slow_ups: float
    marker_ups: float
    acc_ups2: float
    dec_ups2: float
    stp_ups2: float
    priority: int


class Speeds(Struct, frozen=True):
    """The SPEEDS tab and the corner angles of the CONTROL tab."""

    max_ups: float
    trial_ups: float
    trace_ups: float
    rapid_ups: float
    rapid_acc_ups2: float
    feed_acc_ups2: float
    arc_acc_ups2: float
    corner_ups: float
    corner_step_ups: float
    angle1_deg: float
    angle2_deg: float
    rotary_max: float  # degrees/s, 0 = any
    in_position_s: float
    jerk_ups3: float
    chord_u: float
    path_tolerance_u: float  # of paths planned with the jerk, where the program gives none


class SpindleSettings(Struct, frozen=True):
    """The SPINDLE tab; inputs, outputs and the DAC are -1 where not configured."""

    code: int
    volts_per_rpm: float
    dac: int
    at_zero: int
    at_speed: int
    cw: int
    ccw: int
    off: int
    exception: int
    mist: int
    flood: int
    coolant_off: int
    orient: int
    oriented: int
    orient_s: float
    time_out_s: float


class Wiring(Struct, frozen=True):
    """The I/O, PROBE and TOOL tabs."""

    block_skip: int
    optional_stop: int
    feed_hold: int
    cycle_start: int
    emergency_stop: int
    soft_limits: int
    joystick: int
    g27_input: int
    g27_output: int
    lubrication: int
    drive_enable: int
    g28_error: int
    probe: int
    is_probe_trailing: bool
    is_probe_software: bool
    is_probe_on_each: bool  # wired to the capture input of every axis, not of one
    probe_back_ups: float
    is_probe_checked: bool
    reference_s: float
    tool_changed: int
    tool_change: int
    is_manual_change: bool
    tool_time_out_s: float


class Burning(Struct, frozen=True):
    """Outputs of burning machines, -1 where not configured."""

    plasma: int
    plasma_percent: float
    under_burn: int
    under_burn_u: float
