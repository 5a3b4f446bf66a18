"""Axis parameters: P(12288 + 256 * axis + row).

Positions are pulses, limits and jog settings programming units ("unit", PPU pulses each).
"""

from openacr.map.block import FP32, LONG, NS, RW, Block, R, Span, W, objects_apart

AXIS = Block(
    "Axis Parameters",
    object="AXIS",
    prefix="AX",
    family="axes",
    spans=(Span(12288, 16),),
    stride=256,
    packet=objects_apart,
    packet_erratum="Chapter 6 prints group 0x31 for axes 8 to 15 in one place; it is 0x38.",
)

AXIS.section("Axis Parameters: Position")
AXIS.row(0x00, "Current Position", LONG, NS, "pulse", "Position commanded by coordinated moves.")
AXIS.row(0x01, "Target Position", LONG, NS, "pulse", "End of the programmed move.")
AXIS.row(0x02, "Actual Position", LONG, NS, "pulse", "Position read back from the feedback.")
AXIS.row(0x03, "Following Error", LONG, NS, "pulse", "Secondary setpoint minus actual position.")
AXIS.row(0x04, "Hardware Capture", LONG, NS, "pulse", "Position at the last hardware capture.")
AXIS.row(0x05, "Software Capture", LONG, NS, "pulse", "Position at the last software capture.")
AXIS.row(0x06, "Primary Setpoint", LONG, NS, "pulse", "Current position + gear + jog + cam offset.")
AXIS.row(0x07, "Secondary Setpoint", LONG, NS, "pulse", "Primary setpoint + ballscrew + backlash.")

AXIS.section("Axis Parameters: Offset")
AXIS.row(0x08, "Gear Offset", LONG, NS, "pulse", "Present contribution of gearing.")
AXIS.row(0x09, "Jog Offset", LONG, NS, "pulse", "Present contribution of jogging.")
AXIS.row(0x0A, "Cam Offset", LONG, NS, "pulse", "Present contribution of the cam.")
AXIS.row(0x0B, "Ballscrew Offset", LONG, NS, "pulse", "Present ballscrew compensation.")
AXIS.row(0x0C, "Backlash Offset", LONG, NS, "pulse", "Present backlash compensation.")
AXIS.reserved(LONG, range(0x0D, 0x10))

AXIS.section("Axis Parameters: Servo")
AXIS.row(
    0x10,
    "Proportional Gain",
    FP32,
    NS,
    "V/pulse",
    "Gain of the error (PGAIN).",
    default=0.002441406,
)
AXIS.row(0x11, "Integral Gain", FP32, NS, "V/(pulse s)", "Gain of the error sum (IGAIN).")
AXIS.row(0x12, "Integral Limit", FP32, NS, "V", "Clamp of the integral term, 0: none (ILIMIT).")
AXIS.row(0x13, "Integral Delay", FP32, NS, "s", "Rest before integration starts (IDELAY).")
AXIS.row(0x14, "Derivative Gain", FP32, NS, "V s/pulse", "Gain of the error slope (DGAIN).")
AXIS.row(
    0x15, "Derivative Width", FP32, NS, "s", "Sampling time of the slope, 0: each tick (DWIDTH)."
)
AXIS.row(
    0x16, "Feedforward Velocity", FP32, NS, "V s/pulse", "Gain of the commanded speed (FFVEL)."
)
AXIS.row(
    0x17, "Feedforward Accel", FP32, NS, "V s²/pulse", "Gain of commanded acceleration (FFACC)."
)

AXIS.section("Axis Parameters: Monitor")
AXIS.row(0x18, "Proportional Term", FP32, NS, "V", "Output of the proportional block.")
AXIS.row(0x19, "Integral Term", FP32, NS, "V", "Output of the integral block.")
AXIS.row(0x1A, "Derivative Term", FP32, NS, "V", "Output of the derivative block.")
AXIS.row(
    0x1B, "Velocity", FP32, NS, "pulse/s", "Speed of the primary setpoint, cam and gear included."
)
AXIS.row(0x1C, "Acceleration", FP32, NS, "pulse/s²", "Acceleration of the primary setpoint.")
AXIS.row(0x1D, "Summation Point", FP32, NS, "V", "Sum of all servo terms.")
AXIS.row(0x1E, "Filter Output Signal", FP32, NS, "V", "Servo signal after the digital filters.")
AXIS.row(0x1F, "Output Signal", FP32, NS, "V", "Servo output sent to the DAC or stepper.")

AXIS.section("Axis Parameters: Limit")
AXIS.row(0x20, "Plus Excess Error", FP32, NS, "unit", "Upper end of the excess error band (EXC).")
AXIS.row(0x21, "Minus Excess Error", FP32, NS, "unit", "Lower end of the excess error band (EXC).")
AXIS.row(0x22, "Plus In Position", FP32, NS, "unit", "Upper end of the in-position band (IPB).")
AXIS.row(0x23, "Minus In Position", FP32, NS, "unit", "Lower end of the in-position band (IPB).")
AXIS.row(0x24, "Plus A Limit", FP32, NS, "unit", "Upper end of stroke limit A (ALM).")
AXIS.row(0x25, "Minus A Limit", FP32, NS, "unit", "Lower end of stroke limit A (ALM).")
AXIS.row(0x26, "Plus B Limit", FP32, NS, "unit", "Upper end of stroke limit B (BLM).")
AXIS.row(0x27, "Minus B Limit", FP32, NS, "unit", "Lower end of stroke limit B (BLM).")
AXIS.row(0x28, "Plus Torque Limit", FP32, NS, "V", "Highest output signal (TLM).", default=10)
AXIS.row(0x29, "Minus Torque Limit", FP32, NS, "V", "Lowest output signal (TLM).", default=-10)
AXIS.row(0x2A, "Plus Torque Band", FP32, NS, "V", "Upper end of the in-torque band (ITB).")
AXIS.row(0x2B, "Minus Torque Band", FP32, NS, "V", "Lower end of the in-torque band (ITB).")
AXIS.row(0x2C, "Backlash Setting", FP32, NS, "unit", "Lost motion on reversal (BKL).")
AXIS.reserved(FP32, (0x2D,))
AXIS.row(0x2E, "Plus Jog Limit", FP32, NS, "unit", "Highest jog offset, while checked (JLM).")
AXIS.row(0x2F, "Minus Jog Limit", FP32, NS, "unit", "Lowest jog offset, while checked (JLM).")

for _filter, _first in ((0, 0x30), (1, 0x35)):
    AXIS.section(f"Axis Parameters: Filter {_filter}")
    for _place, _name in enumerate(("b2", "a2", "b1", "a1", "a0")):
        AXIS.row(
            _first + _place,
            f"{_name} Coefficient",
            FP32,
            doc=f"Coefficient of biquad filter {_filter} (FLT, NOTCH, LOPASS).",
            ident=f"filter{_filter} {_name}",
        )

AXIS.section("Axis Parameters: Jog")
AXIS.row(0x3A, "Current Jog Veloc", FP32, NS, "unit/s", "Present jog speed.")
AXIS.row(0x3B, "Current Jog Accel", FP32, NS, "unit/s²", "Present jog acceleration.")
AXIS.row(0x3C, "Jog Veloc Setting", FP32, NS, "unit/s", "Jog speed (JOG VEL).")
AXIS.row(0x3D, "Jog Accel Setting", FP32, NS, "unit/s²", "Jog acceleration (JOG ACC).", default=10)
AXIS.row(0x3E, "Jog Decel Setting", FP32, NS, "unit/s²", "Jog deceleration (JOG DEC).", default=10)
AXIS.row(0x3F, "Jog Jerk Setting", FP32, NS, "unit/s³", "Jog jerk, 0: trapezoid (JOG JRK).")

AXIS.section("Axis Parameters: Servo 2")
AXIS.row(0x40, "FBVEL Gain Setting", FP32, NS, "V s/pulse", "Gain of the measured speed (FBVEL).")
AXIS.row(0x41, "FBVEL Term", FP32, NS, "V", "Output of the velocity feedback block.")
AXIS.row(0x42, "FFVEL Term", FP32, NS, "V", "Output of the velocity feedforward block.")
AXIS.row(0x43, "FFACC Term", FP32, NS, "V", "Output of the acceleration feedforward block.")
AXIS.reserved(FP32, range(0x44, 0x48))

AXIS.section("Axis Parameters: Other")
AXIS.row(0x48, "INVK Input", FP32, NS, "unit", "Cartesian input of the kinematics program.")
AXIS.row(0x49, "INVK Output", FP32, RW, "unit", "Joint value written by the kinematics program.")
AXIS.row(0x4A, "INVK Input Previous", FP32, NS, "unit", "Cartesian input of the previous step.")
AXIS.reserved(FP32, range(0x4B, 0x50))
AXIS.row(
    0x50, "Max Velocity Limit", FP32, RW, "unit/s", "Axis speed limit in moves, 0: none (MAXVEL)."
)
AXIS.row(0x51, "Gear Slip", FP32, RW, "pulse", "Pulses lost while the gear ratio ramps.")
AXIS.row(0x52, "RPM Factor", FP32, W, "", "60 / (pulses per revolution * servo period); 0: no RPM.")
AXIS.row(0x53, "RPM", FP32, R, "1/min", "Revolutions per minute, with an RPM factor set.")
AXIS.row(
    0x54, "Smooth Encoder Velocity", FP32, NS, "samples", "Averaging of measured speed.", default=1
)
AXIS.row(0x55, "Start Radius", FP32, NS, "unit", "Radius at the start of the present arc.")
AXIS.row(0x56, "End Radius", FP32, NS, "unit", "Radius at the end of the present arc.")
AXIS.row(
    0x57,
    "PPU",
    FP32,
    NS,
    "pulse/unit",
    "Pulses per programming unit (PPU).",
    default=1,
    erratum="The parameter table prints Reserved for axes 8 to 15.",
)
AXIS.row(0x58, "Lock Feedback Gain", FP32, NS, "V/pulse", "Coupling of a locked pair (LOCK).")
AXIS.row(0x59, "DIP", FP32, NS, "V", "Integrator on leaving the dead band upwards (DIP).")
AXIS.row(0x5A, "DIN", FP32, NS, "V", "Integrator on leaving the dead band downwards (DIN).")
AXIS.row(0x5B, "KVF", FP32, NS, "V s/pulse", "Speed feedforward of the PV loop (KVF).")
AXIS.row(0x5C, "KVI", FP32, NS, "1/s", "Integral gain of the PV loop (KVI).")
AXIS.row(0x5D, "KVP", FP32, NS, "V/V", "Above 0: PV loop instead of PID (KVP).")
AXIS.reserved(FP32, range(0x5E, 0x68))
AXIS.reserved(LONG, range(0x68, 0x6C))
AXIS.row(0x6C, "Gear Trigger On Offset", LONG, RW, "pulse", "Offset used by GEAR ON TRG.")
AXIS.row(0x6D, "Gear Trigger Off Offset", LONG, RW, "pulse", "Offset used by GEAR OFF TRG.")
AXIS.reserved(LONG, (0x6E, 0x6F))
AXIS.row(
    0x70, "CAM Cycles", LONG, RW, "cycle", "Cam cycles until it stops, 0: endless (CAM CYCLES)."
)
AXIS.row(
    0x71, "CAM Velocity Smooth", LONG, RW, "samples", "Averaging of the cam's speed.", default=10
)
AXIS.row(0x72, "Dgain Smooth", LONG, RW, "", "n averages the slope over 2^n samples; see DGAIN.")
AXIS.row(0x73, "DZU", LONG, NS, "pulse", "Error that ends the dead band, 0: no dead band (DZU).")
AXIS.row(0x74, "DZL", LONG, NS, "pulse", "Error that starts the dead band at rest (DZL).")
AXIS.row(0x75, "FFVC", LONG, NS, "pulse/s", "Speed below which FFVEL is left out (FFVC).")
AXIS.reserved(LONG, (0x76, 0x77))

BLOCKS = (AXIS,)
