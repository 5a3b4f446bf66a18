"""Axis parameters: P(12288 + 256 * axis + row)."""

from openacr.map.block import FP32, LONG, RW, Block, R, Span, W, objects_apart

AXIS = Block(
    "Axis Parameters",
    object="AXIS",
    prefix="AX",
    spans=(Span(12288, 16),),
    stride=256,
    packet=objects_apart,
)

AXIS.section("Axis Parameters: Position")
AXIS.row(0x00, "Current Position", LONG, doc="Commanded position at this moment.")
AXIS.row(0x01, "Target Position", LONG, doc="Programmed target of the buffered move.")
AXIS.row(0x02, "Actual Position", LONG, doc="Position read back from the feedback device.")
AXIS.row(0x03, "Following Error", LONG, doc="Present following error of the servo loop.")
AXIS.row(0x04, "Hardware Capture", LONG, doc="Most recent hardware capture register value.")
AXIS.row(0x05, "Software Capture", LONG, doc="Most recent software capture register value.")
AXIS.row(0x06, "Primary Setpoint", LONG, doc="Sum of coordinated, jog, gear and cam positions.")
AXIS.row(
    0x07,
    "Secondary Setpoint",
    LONG,
    doc="Primary setpoint plus backlash and ballscrew compensation.",
)

AXIS.section("Axis Parameters: Offset")
AXIS.row(0x08, "Gear Offset", LONG, doc="Present gear contribution.")
AXIS.row(0x09, "Jog Offset", LONG, doc="Present jog contribution.")
AXIS.row(0x0A, "Cam Offset", LONG, doc="Present cam contribution.")
AXIS.row(0x0B, "Ballscrew Offset", LONG, doc="Present ballscrew compensation.")
AXIS.row(0x0C, "Backlash Offset", LONG, doc="Present backlash compensation.")
AXIS.reserved(LONG, range(0x0D, 0x10))

AXIS.section("Axis Parameters: Servo")
AXIS.row(0x10, "Proportional Gain", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(0x11, "Integral Gain", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(0x12, "Integral Limit", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(0x13, "Integral Delay", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(0x14, "Derivative Gain", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(0x15, "Derivative Width", FP32, doc="Servo loop constant; see the servo block diagram.")
AXIS.row(
    0x16, "Feedforward Velocity", FP32, doc="Servo loop constant; see the servo block diagram."
)
AXIS.row(0x17, "Feedforward Accel", FP32, doc="Servo loop constant; see the servo block diagram.")

AXIS.section("Axis Parameters: Monitor")
AXIS.row(0x18, "Proportional Term", FP32, doc="Output of the proportional block.")
AXIS.row(0x19, "Integral Term", FP32, doc="Output of the integral block.")
AXIS.row(0x1A, "Derivative Term", FP32, doc="Output of the derivative block.")
AXIS.row(0x1B, "Velocity", FP32, doc="Total axis velocity, cam and gear included.")
AXIS.row(0x1C, "Acceleration", FP32, doc="Total axis acceleration, cam and gear included.")
AXIS.row(0x1D, "Summation Point", FP32)
AXIS.row(0x1E, "Filter Output Signal", FP32, doc="Servo signal after the digital filter.")
AXIS.row(0x1F, "Output Signal", FP32, doc="Servo output sent to the DAC or stepper.")

AXIS.section("Axis Parameters: Limit")
AXIS.row(0x20, "Plus Excess Error", FP32, doc="Positive excess-error band (EXC command).")
AXIS.row(0x21, "Minus Excess Error", FP32, doc="Negative excess-error band (EXC command).")
AXIS.row(0x22, "Plus In Position", FP32, doc="Positive in-position band (IPB command).")
AXIS.row(0x23, "Minus In Position", FP32, doc="Negative in-position band (IPB command).")
AXIS.row(0x24, "Plus A Limit", FP32)
AXIS.row(0x25, "Minus A Limit", FP32)
AXIS.row(0x26, "Plus B Limit", FP32)
AXIS.row(0x27, "Minus B Limit", FP32)
AXIS.row(0x28, "Plus Torque Limit", FP32)
AXIS.row(0x29, "Minus Torque Limit", FP32)
AXIS.row(0x2A, "Plus Torque Band", FP32)
AXIS.row(0x2B, "Minus Torque Band", FP32)
AXIS.row(0x2C, "Backlash Setting", FP32)
AXIS.reserved(FP32, (0x2D,))
AXIS.row(0x2E, "Plus Jog Limit", FP32)
AXIS.row(0x2F, "Minus Jog Limit", FP32)

AXIS.section("Axis Parameters: Filter 0")
AXIS.row(0x30, "b2 Coefficient", FP32, ident="FILTER0 b2")
AXIS.row(0x31, "a2 Coefficient", FP32, ident="FILTER0 a2")
AXIS.row(0x32, "b1 Coefficient", FP32, ident="FILTER0 b1")
AXIS.row(0x33, "a1 Coefficient", FP32, ident="FILTER0 a1")
AXIS.row(0x34, "a0 Coefficient", FP32, ident="FILTER0 a0")

AXIS.section("Axis Parameters: Filter 1")
AXIS.row(0x35, "b2 Coefficient", FP32, ident="FILTER1 b2")
AXIS.row(0x36, "a2 Coefficient", FP32, ident="FILTER1 a2")
AXIS.row(0x37, "b1 Coefficient", FP32, ident="FILTER1 b1")
AXIS.row(0x38, "a1 Coefficient", FP32, ident="FILTER1 a1")
AXIS.row(0x39, "a0 Coefficient", FP32, ident="FILTER1 a0")

AXIS.section("Axis Parameters: Jog")
AXIS.row(0x3A, "Current Jog Veloc", FP32)
AXIS.row(0x3B, "Current Jog Accel", FP32)
AXIS.row(0x3C, "Jog Veloc Setting", FP32)
AXIS.row(0x3D, "Jog Accel Setting", FP32)
AXIS.row(0x3E, "Jog Decel Setting", FP32)
AXIS.row(0x3F, "Jog Jerk Setting", FP32)

AXIS.section("Axis Parameters: Servo 2")
AXIS.row(0x40, "FBVEL Gain Setting", FP32)
AXIS.row(0x41, "FBVEL Term", FP32)
AXIS.row(0x42, "FFVEL Term", FP32)
AXIS.row(0x43, "FFACC Term", FP32)
AXIS.reserved(FP32, range(0x44, 0x48))

AXIS.section("Axis Parameters: Other")
AXIS.row(0x48, "INVK Input", FP32, doc="Cartesian input of the inverse kinematics program (000).")
AXIS.row(
    0x49, "INVK Output", FP32, RW, "Joint value written by the inverse kinematics program (000)."
)
AXIS.row(0x4A, "INVK Input Previous", FP32)
AXIS.reserved(FP32, range(0x4B, 0x50))
AXIS.row(0x50, "Max Velocity Limit", FP32, RW, "Axis velocity ceiling (MAXVEL command).")
AXIS.row(0x51, "Gear Slip", FP32, RW, "Pulses slipped while the gear ratio ramps under GEAR ACC.")
AXIS.row(
    0x52,
    "RPM Factor",
    FP32,
    W,
    "Above 0 turns on RPM calculation; set to 60/(pulses per rev * servo period).",
)
AXIS.row(0x53, "RPM", FP32, R, "Computed revolutions per minute; axis must be attached.")
AXIS.row(0x54, "Smooth Encoder Velocity", FP32)
AXIS.row(0x55, "Start Radius", FP32)
AXIS.row(0x56, "End Radius", FP32)
AXIS.row(
    0x57, "PPU", FP32, doc="Pulses per programming unit of the axis (000 divides P12290 by P12375)."
)
AXIS.row(0x58, "Lock Feedback Gain", FP32)
AXIS.row(0x59, "DIP", FP32)
AXIS.row(0x5A, "DIN", FP32)
AXIS.row(0x5B, "KVF", FP32)
AXIS.row(0x5C, "KVI", FP32)
AXIS.row(0x5D, "KVP", FP32)
AXIS.reserved(FP32, range(0x5E, 0x68))
AXIS.reserved(LONG, range(0x68, 0x6C))
AXIS.row(0x6C, "Gear Trigger On Offset", LONG, RW, "Offset used by GEAR ON TRG.")
AXIS.row(0x6D, "Gear Trigger Off Offset", LONG, RW, "Offset used by GEAR OFF TRG.")
AXIS.reserved(LONG, (0x6E, 0x6F))
AXIS.row(
    0x70,
    "CAM Cycles",
    LONG,
    RW,
    "0 keeps CAM on until stopped; n>0 turns it off after n cycles, trigger mode included.",
)
AXIS.row(
    0x71,
    "CAM Velocity Smooth",
    LONG,
    RW,
    "Samples averaged for cam velocity feed forward, default 10; change before CAM is on.",
)
AXIS.row(
    0x72,
    "Dgain Smooth",
    LONG,
    RW,
    "Derivative smoothing 0..5, default 0; takes effect at the next DGAIN command.",
)
AXIS.row(0x73, "DZU", LONG)
AXIS.row(0x74, "DZL", LONG)
AXIS.row(0x75, "FFVC", LONG)
AXIS.reserved(LONG, (0x76, 0x77))

BLOCKS = (AXIS,)
