"""SERVO, AXES, HOME, JOG and SPEEDS: how the axes move."""

from openacr.sysvar.schema import ANY, INPUT, OUTPUT, Tab
from openacr.sysvar.tabs.control import GENERAL

_SPEED = {"low": 0, "is_low_open": True, "high": 1e6}
_RAMP = {"low": 0, "is_low_open": True, "high": 1e9}
# The output of a drive is 10 V at most: a gain above it gives all of it for a single pulse (or
# pulse/s, pulse/s2) of error, and the integral above _MOST_V_PER_S within one servo period.
_GAIN = {"low": 0, "high": 10}
_MOST_V_PER_S = 1e5
_MOST_DELAY_S, _MOST_WIDTH_S = 1000, 1


class SERVO:
    """Gains and limits of the servo loops, by axis."""

    tab = Tab("SERVO", 150_000)
    tab.motion()
    p_gain = tab.per_axis.real(
        0, "P Gain", "V/pulse", 0.00244, typical="0.001", doc="Volts per pulse of error.", **_GAIN
    )
    i_gain = tab.per_axis.real(
        1,
        "I Gain",
        "V/s/pulse",
        typical="0.001",
        low=0,
        high=_MOST_V_PER_S,
        doc="Volts per second and pulse of error.",
    )
    i_delay = tab.per_axis.real(
        2,
        "I Delay",
        "s",
        typical="1",
        low=0,
        high=_MOST_DELAY_S,
        doc="Time at rest before integration starts.",
    )
    i_limit = tab.per_axis.real(
        3, "I Limit", "V", typical="1", low=0, high=10, doc="Limit of the integral term."
    )
    d_gain = tab.per_axis.real(
        4,
        "D Gain",
        "V/(pulse/s)",
        typical="0.00001",
        doc="Volts per rate of change of the error.",
        **_GAIN,
    )
    d_time = tab.per_axis.real(
        5,
        "D Time",
        "s",
        typical="0.002",
        low=0,
        high=_MOST_WIDTH_S,
        doc="Sampling time of the D term, 0: every servo period.",
    )
    acceleration_feedforward = tab.per_axis.real(
        6,
        "ACC FFwd",
        "V/(pulse/s2)",
        typical="0.0001",
        doc="Volts per commanded acceleration.",
        **_GAIN,
    )
    velocity_feedforward = tab.per_axis.real(
        7, "Vel FFwd", "V/(pulse/s)", typical="0", doc="Volts per commanded velocity.", **_GAIN
    )
    torque_limits = tab.per_axis.real(
        8,
        "Torque Limits",
        "V",
        10,
        typical="0..10",
        low=0,
        high=10,
        doc="Clamp of the drive output.",
    )
    velocity_feedback = tab.per_axis.real(
        9, "FBVEL", "V/(pulse/s)", typical="0", doc="Volts per actual velocity.", **_GAIN
    )


class AXIS:
    """Limits, scaling and wiring, by axis."""

    tab = Tab("AXES", 200_000)
    tab.motion()
    plus_soft_limit = tab.per_axis.real(
        0, "+Soft Limit", "u", typical="machine +", doc="Highest position, from home."
    )
    minus_soft_limit = tab.per_axis.real(
        1, "-Soft Limit", "u", typical="machine -", doc="Lowest position, from home."
    )
    disable_limit = tab.per_axis.boolean(
        2, "Disable Limit", 1, typical="false", doc="True: the soft limits are off."
    )
    in_position_band = tab.per_axis.real(
        3,
        "Inposition Band",
        "u",
        typical="0.001",
        low=0,
        doc="Largest error in position, 0: unlimited.",
    )
    excess_error_band = tab.per_axis.real(
        4,
        "ExcessErr Band",
        "u",
        typical="0.25",
        low=0,
        doc="Error that stops the machine, 0: unlimited.",
    )
    dac_polarity = tab.per_axis.choice(
        5, "Dac Polarity", {0: "pos", 1: "neg"}, doc="Sign of the drive output."
    )
    pulses_per_unit = tab.per_axis.real(
        6, "Pulses/Unit", "pulse/u", 10_000, typical="10000", doc="Encoder pulses per unit."
    )
    home_required = tab.per_axis.boolean(
        7, "Home Reqd", typical="true", doc="True: the axis must be homed before it moves."
    )
    name = tab.per_axis.text(
        8,
        "Axis Name",
        lambda at: "XYZABCUV"[at.axis],
        typical="X, Y ...",
        doc="One of X Y Z A B C U V, unique.",
    )
    handwheel_src = tab.per_axis.integer(
        9,
        "Handwheel Src",
        -1,
        typical="Axis4",
        low=-1,
        high=23,
        words={-1: "None"},
        noun="Axis",
        doc="Encoder of the handwheel.",
    )
    handwheel_ratio = tab.per_axis.real(
        10,
        "HandwheelRatio",
        "u per click",
        0.005,
        typical="0.005",
        low=0,
        doc="Distance per click.",
    )
    encoder_mult = tab.per_axis.choice(
        11,
        "Encoder Mult",
        {value: str(value) for value in (-4, -2, -1, 1, 2, 4)},
        4,
        typical="4",
        doc="Counts per encoder line; negative reverses the counting direction.",
    )
    configured = tab.per_axis.boolean(
        12,
        "Configured",
        lambda at: float(at.axis < at.read(GENERAL.axis_count)),
        doc="Whether the machine has the axis.",
    )
    encoder = tab.per_axis.integer(
        13, "Encoder", lambda at: float(at.axis), low=0, high=23, doc="Encoder of the axis."
    )
    dac_number = tab.per_axis.integer(
        14,
        "DAC number",
        lambda at: float(at.axis),
        low=0,
        high=15,
        doc="Analog output of the axis.",
    )
    max_axis_speed = tab.per_axis.real(
        15, "Max axis speed", "u/m", low=0, doc="Highest speed of the axis, 0: unlimited."
    )
    max_axis_acceleration = tab.per_axis.real(
        16,
        "Max axis acceleration",
        "u/s2",
        low=0,
        doc="Highest acceleration of the axis, 0: unlimited.",
    )
    max_axis_jerk = tab.per_axis.real(
        17,
        "Max axis jerk",
        "u/s3",
        low=0,
        high=1e12,
        doc="With Path jerk: highest jerk of the axis, 0: the number of Path jerk.",
    )
    tolerance_radius = tab.per_axis.real(
        18,
        "Tolerance radius",
        "u",
        low=0,
        high=1e6,
        is_of_tool=True,
        doc="Of rotary axes: radius at which turns keep the tolerance of a path, 0: a degree counts"
        " as 1 mm or 1/32 inch.",
    )


class HOME:
    """Homing, by axis."""

    tab = Tab("HOME", 300_000)
    tab.motion()
    direction = tab.per_axis.choice(
        0, "Home Direction", {0: "pos", 1: "neg"}, doc="Direction of the search for the switch."
    )
    preset = tab.per_axis.real(
        1, "Home Preset", "u", doc="Position of the axis when homing has finished."
    )
    switch_input = tab.per_axis.integer(
        2,
        "Home Switch Input",
        16,
        typical="16",
        doc="Input of the home switch.",
        **INPUT,
    )
    fast_speed = tab.per_axis.real(
        3, "Home Fast Speed", "u/m", 10, typical="100", doc="Speed towards the switch.", **_SPEED
    )
    slow_speed = tab.per_axis.real(
        4, "Home Slow Speed", "u/m", 5, typical="10", doc="Speed away from the switch.", **_SPEED
    )
    marker_speed = tab.per_axis.real(
        5, "Marker Speed", "u/m", 2, typical="10", doc="Speed of the marker search.", **_SPEED
    )
    acceleration = tab.per_axis.real(
        6, "Home Acceleration", "u/s2", 100, typical="100", doc="Ramp up.", **_RAMP
    )
    deceleration = tab.per_axis.real(
        7, "Home Deceleration", "u/s2", 100, typical="100", doc="Ramp down.", **_RAMP
    )
    stp = tab.per_axis.real(8, "Home STP", "u/s2", 100, typical="100", doc="Stop ramp.", **_RAMP)
    priority = tab.per_axis.integer(
        9,
        "Home Priority",
        1,
        typical="1",
        low=0,
        high=8,
        doc="Order of homing, 0: the axis is not homed.",
    )


_JOG = Tab("JOG", 350_000)
_INCREMENTS = (1, 0.1, 0.01, 0.001, 0.0001)


def _increment(place: int, size: float) -> range:
    """An increment of jogging, by axis."""
    name, shown = f"Jog Increment {place + 1}", f"{size:g}"
    return _JOG.per_axis.real(
        6 + place, name, "u", size, typical=shown, low=0, doc="Distance per press."
    )


class JOG:
    """Jogging, by axis."""

    tab = _JOG
    tab.motion()
    feedrate = tab.per_axis.real(
        0, "Jog Feedrate", "u/m", 10, typical="10", doc="Slow jog speed.", **_SPEED
    )
    rapid = tab.per_axis.real(
        1, "Jog Rapid", "u/m", 100, typical="100", doc="Fast jog speed.", **_SPEED
    )
    acceleration = tab.per_axis.real(
        2, "Jog Acceleration", "u/s2", 150, typical="150", doc="Ramp up.", **_RAMP
    )
    deceleration = tab.per_axis.real(
        3, "Jog Deceleration", "u/s2", 10, typical="100", doc="Ramp down.", **_RAMP
    )
    stp_ramp = tab.per_axis.real(
        4, "Jog STP Ramp", "u/s2", 100, typical="100", doc="Stop ramp.", **_RAMP
    )
    direction = tab.per_axis.choice(
        5, "Jog Direction", {0: "pos", 1: "neg"}, doc="Direction of the plus key."
    )
    increments = tuple(_increment(place, size) for place, size in enumerate(_INCREMENTS))


class SPEEDS:
    """Speeds and ramps of the machine."""

    tab = Tab("SPEEDS", 650_000)
    tab.motion()
    max_machine_speed = tab.real(
        0,
        "Max Machine Speed",
        "u/m",
        200,
        typical="200",
        doc="Upper limit of all speeds.",
        **_SPEED,
    )
    trial_speed = tab.real(
        1, "Trial Speed", "u/m", 100, typical="100", doc="Speed of DRY RUN.", **_SPEED
    )
    cut_speed = tab.real(
        2, "Cut Speed", "u/m", 10, typical="10", doc="Feed of programs without F.", **_SPEED
    )
    min_corner_speed = tab.real(
        3,
        "Min Corner Speed",
        "u/m",
        40,
        typical="40",
        low=0,
        high=1e6,
        doc="Lowest speed at corners (G62).",
    )
    marker_speed = tab.real(
        4, "Marker Speed", "u/s", low=0, high=1e6, doc="Replaces Marker Speed of HOME, 0: does not."
    )
    plasma_percent = tab.real(
        5,
        "Plasma Hi/Lo Speed % Cut",
        "%",
        low=0,
        high=100,
        doc="Speed that switches the plasma output.",
    )
    forward_backward_speed = tab.real(
        6,
        "Forward Backward Speed",
        "u/m",
        low=0,
        high=1e6,
        doc="Speed of retracing, 0 = Cut Speed.",
    )
    master_rapid_acc_dec = tab.real(
        7,
        "Master Rapid ACC/DEC",
        "u/s2",
        100,
        typical="100",
        doc="Acceleration of rapids.",
        **_RAMP,
    )
    master_feed_acc_dec = tab.real(
        8,
        "Master Feed ACC/DEC",
        "u/s2",
        100,
        typical="100",
        doc="Acceleration of feed moves.",
        **_RAMP,
    )
    max_rotary_speed = tab.real(
        10,
        "Max Rotary Speed",
        "deg/m",
        low=0,
        high=1e9,
        doc="Highest speed of rotary axes, 0: unlimited.",
    )
    rapid_speed = tab.real(
        11, "Rapid Speed", "u/m", low=0, high=1e6, doc="Speed of G0, 0 = Max Machine Speed."
    )
    corner_step = tab.real(
        12,
        "Corner Step",
        "u/s",
        low=0,
        high=1e6,
        doc="Largest speed step of an axis at a corner, 0: unlimited."
        " A degree counts as the arc at Tolerance radius.",
    )
    arc_acceleration = tab.real(
        13,
        "Arc Acceleration",
        "u/s2",
        low=0,
        high=1e9,
        doc="Largest acceleration on arcs, of the turn and along it; 0 = Master Feed ACC/DEC.",
    )
    in_position_time_out = tab.real(
        14,
        "In-position time-out",
        "s",
        5,
        low=0,
        high=3600,
        doc="Longest wait for position, then alarm 24.",
    )
    path_jerk = tab.real(
        15, "Path jerk", "u/s3", low=0, high=1e12, doc="Jerk along the path, 0: linear ramps."
    )
    chord_tolerance = tab.real(
        16,
        "Chord tolerance",
        "u",
        0.0001,
        low=0,
        is_low_open=True,
        high=ANY,
        doc="Largest error of chords for arcs.",
    )
    plasma_output = tab.integer(
        17, "Plasma output", -1, doc="Output of the plasma torch.", **OUTPUT
    )
    path_tolerance = tab.real(
        18,
        "Path tolerance",
        "u",
        low=0,
        high=ANY,
        doc="With Path jerk: how far paths without G64 P may leave corners to keep moving, 0: not.",
    )
