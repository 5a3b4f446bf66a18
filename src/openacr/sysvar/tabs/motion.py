"""SERVO, AXES, HOME, JOG and SPEEDS: how the axes move."""

from openacr.sysvar.schema import ANY, INPUT, OUTPUT, Tab

SERVO = Tab("SERVO", 150_000, per_axis=True)
SERVO.motion()
SERVO.real(0, "P Gain", "V/pulse", 0.00244, typical="0.001", low=0, doc="Volts per pulse of error.")
SERVO.real(
    1, "I Gain", "V/s/pulse", typical="0.001", low=0, doc="Volts per second and pulse of error."
)
SERVO.real(2, "I Delay", "s", typical="1", low=0, doc="Rest before integration starts.")
SERVO.real(3, "I Limit", "V", typical="1", low=0, high=10, doc="Largest integral part.")
SERVO.real(4, "D Gain", "V/(pulse/s)", typical="0.00001", low=0, doc="Volts per rate of the error.")
SERVO.real(
    5, "D Time", "s", typical="0.002", low=0, doc="Sampling time of the rate, 0 each period."
)
SERVO.real(
    6, "ACC FFwd", "V/(pulse/s2)", typical="0.0001", low=0, doc="Volts per commanded acceleration."
)
SERVO.real(7, "Vel FFwd", "V/(pulse/s)", typical="0", low=0, doc="Volts per commanded velocity.")
SERVO.real(
    8, "Torque Limits", "V", 10, typical="0..10", low=0, high=10, doc="Clamp of the drive output."
)
SERVO.real(9, "FBVEL", "V/(pulse/s)", typical="0", low=0, doc="Volts per actual velocity.")

AXES_TAB = Tab("AXES", 200_000, per_axis=True)
AXES_TAB.motion()
AXES_TAB.real(0, "+Soft Limit", "u", typical="machine +", doc="Farthest position from home.")
AXES_TAB.real(1, "-Soft Limit", "u", typical="machine -", doc="Lowest position from home.")
AXES_TAB.boolean(2, "Disable Limit", 1, typical="false", doc="True: the soft limits are off.")
AXES_TAB.real(
    3, "Inposition Band", "u", typical="0.001", low=0, doc="Error of an axis in position, 0 any."
)
AXES_TAB.real(
    4, "ExcessErr Band", "u", typical="0.25", low=0, doc="Error that stops the machine, 0 none."
)
AXES_TAB.choice(5, "Dac Polarity", {0: "pos", 1: "neg"}, doc="Sign of the drive output.")
AXES_TAB.real(
    6, "Pulses/Unit", "pulse/u", 10_000, typical="10000", doc="Encoder pulses of one unit."
)
AXES_TAB.boolean(7, "Home Reqd", typical="true", doc="True: the axis moves only when homed.")
AXES_TAB.text(
    8,
    "Axis Name",
    lambda at: "XYZABCUV"[at.axis],
    typical="X, Y ...",
    doc="One of X Y Z A B C U V, each once.",
)
AXES_TAB.integer(
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
AXES_TAB.real(
    10, "HandwheelRatio", "u per click", 0.005, typical="0.005", low=0, doc="Way of one click."
)
AXES_TAB.choice(
    11,
    "Encoder Mult",
    {value: str(value) for value in (-4, -2, -1, 1, 2, 4)},
    4,
    typical="4",
    doc="Counts per encoder line; negative counts the other way.",
)
AXES_TAB.boolean(
    12,
    "Configured",
    lambda at: float(at.axis < at.read(100_001)),
    doc="Whether the machine has the axis.",
)
AXES_TAB.integer(
    13, "Encoder", lambda at: float(at.axis), low=0, high=23, doc="Encoder of the axis."
)
AXES_TAB.integer(
    14, "DAC number", lambda at: float(at.axis), low=0, high=15, doc="Analog output of the axis."
)
AXES_TAB.real(15, "Max axis speed", "u/m", low=0, doc="Fastest the axis may go, 0 any.")
AXES_TAB.real(16, "Max axis acceleration", "u/s2", low=0, doc="Of the axis alone, 0 any.")

HOME = Tab("HOME", 300_000, per_axis=True)
HOME.motion()
HOME.choice(0, "Home Direction", {0: "pos", 1: "neg"}, doc="Search direction of the switch.")
HOME.real(1, "Home Preset", "u", doc="Position shown when homing has finished.")
HOME.integer(
    2,
    "Home Switch Input",
    16,
    typical="16",
    doc="Input of the switch.",
    **INPUT,
)
_SPEED = {"low": 0, "is_low_open": True, "high": 1e6}
_RAMP = {"low": 0, "is_low_open": True, "high": 1e9}
HOME.real(3, "Home Fast Speed", "u/m", 10, typical="100", doc="Towards the switch.", **_SPEED)
HOME.real(4, "Home Slow Speed", "u/m", 5, typical="10", doc="Away from the switch.", **_SPEED)
HOME.real(5, "Marker Speed", "u/m", 2, typical="10", doc="Search of the marker.", **_SPEED)
HOME.real(6, "Home Acceleration", "u/s2", 100, typical="100", doc="Ramp up.", **_RAMP)
HOME.real(7, "Home Deceleration", "u/s2", 100, typical="100", doc="Ramp down.", **_RAMP)
HOME.real(8, "Home STP", "u/s2", 100, typical="100", doc="Stop ramp.", **_RAMP)
HOME.integer(
    9, "Home Priority", 1, typical="1", low=0, high=8, doc="Order of homing, 0 leaves the axis out."
)

JOG = Tab("JOG", 350_000, per_axis=True)
JOG.motion()
JOG.real(0, "Jog Feedrate", "u/m", 10, typical="10", doc="Slow jog speed.", **_SPEED)
JOG.real(1, "Jog Rapid", "u/m", 100, typical="100", doc="Fast jog speed.", **_SPEED)
JOG.real(2, "Jog Acceleration", "u/s2", 150, typical="150", doc="Ramp up.", **_RAMP)
JOG.real(3, "Jog Deceleration", "u/s2", 10, typical="100", doc="Ramp down.", **_RAMP)
JOG.real(4, "Jog STP Ramp", "u/s2", 100, typical="100", doc="Stop ramp.", **_RAMP)
JOG.choice(5, "Jog Direction", {0: "pos", 1: "neg"}, doc="Direction of the plus key.")
for _k, _way in enumerate((1, 0.1, 0.01, 0.001, 0.0001)):
    JOG.real(
        6 + _k, f"Jog Increment {_k + 1}", "u", _way, typical=f"{_way:g}", low=0, doc="One press."
    )

SPEEDS = Tab("SPEEDS", 650_000)
SPEEDS.motion()
SPEEDS.real(0, "Max Machine Speed", "u/m", 200, typical="200", doc="Bound of all.", **_SPEED)
SPEEDS.real(1, "Trial Speed", "u/m", 100, typical="100", doc="Speed of DRY RUN.", **_SPEED)
SPEEDS.real(2, "Cut Speed", "u/m", 10, typical="10", doc="Feed without F.", **_SPEED)
SPEEDS.real(
    3, "Min Corner Speed", "u/m", 40, typical="40", low=0, high=1e6, doc="Lowest at corners (G62)."
)
SPEEDS.real(4, "Marker Speed", "u/s", low=0, high=1e6, doc="Replaces that of HOME, 0 does not.")
SPEEDS.real(
    5, "Plasma Hi/Lo Speed % Cut", "%", low=0, high=100, doc="Speed that switches Plasma output."
)
SPEEDS.real(6, "Forward Backward Speed", "u/m", low=0, high=1e6, doc="Retrace, 0 = Cut Speed.")
SPEEDS.real(7, "Master Rapid ACC/DEC", "u/s2", 100, typical="100", doc="Of rapids.", **_RAMP)
SPEEDS.real(8, "Master Feed ACC/DEC", "u/s2", 100, typical="100", doc="Of feed moves.", **_RAMP)
SPEEDS.real(10, "Max Rotary Speed", "deg/m", low=0, high=1e9, doc="Of rotary axes, 0 any.")
SPEEDS.real(11, "Rapid Speed", "u/m", low=0, high=1e6, doc="Of G0, 0 = Max Machine Speed.")
SPEEDS.real(12, "Corner Step", "u/s", low=0, high=1e6, doc="Step of one axis at a corner, 0 any.")
SPEEDS.real(13, "Arc Acceleration", "u/s2", low=0, high=1e9, doc="0 = Master Feed ACC/DEC.")
SPEEDS.real(14, "In-position time-out", "s", 5, low=0, high=3600, doc="Then alarm 24.")
SPEEDS.real(15, "Path jerk", "u/s3", low=0, high=1e12, doc="0: straight ramps.")
SPEEDS.real(
    16, "Chord tolerance", "u", 0.0001, low=0, is_low_open=True, high=ANY, doc="Of chords for arcs."
)
SPEEDS.integer(17, "Plasma output", -1, doc="Output of the plasma.", **OUTPUT)
