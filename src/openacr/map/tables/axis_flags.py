"""Axis flag words: six families of 32 flags for every axis."""

from openacr.map.block import (
    FAST,
    NS,
    RW,
    SLOW,
    UNDOCUMENTED,
    FlagBlock,
    ManualRef,
    R,
    Span,
    consecutive,
)

AXIS_1 = FlagBlock(
    "Axis Flags",
    object="AXIS",
    prefix="AF1",
    spans=(Span(4120, 8), Span(4336, 8)),
    word_name="Axis {n} Flags",
    packet=consecutive(0x10),
)
AXIS_1.row(0, "Not In Position", R, SLOW, "Set when following error is outside the IPB band.")
AXIS_1.row(1, "Not Excess Error", R, SLOW, "Set when following error is inside the EXC band.")
AXIS_1.row(2, "Within A Limit", R, SLOW, "Set when the command is inside limit A (ALM).")
AXIS_1.row(3, "Not Within B Limit", R, SLOW, "Set when the command is outside limit B (BLM).")
AXIS_1.row(
    4,
    "Not Torque Limit",
    R,
    SLOW,
    "Set when the output is not limited (TLM).",
    erratum="The printed text says the opposite of the name.",
)
AXIS_1.row(
    5, "Not In Torque Band", R, SLOW, "Set when the output is outside its torque band (ITB)."
)
AXIS_1.row(8, "Not Marker", R, SLOW, "Set while the encoder marker is absent.")
AXIS_1.row(
    9,
    "Capture Complete",
    R,
    FAST,
    "Set when an INTCAP capture completes; cleared by the next INTCAP.",
)
AXIS_1.row(
    10,
    "HSINT Registered",
    R,
    doc="Cleared when HSINT starts; set when the capture lands in its window.",
)
AXIS_1.row(
    11,
    "HSINT Aborted",
    R,
    doc="Cleared when HSINT starts; set when the abort bit ends the sequence.",
)
AXIS_1.row(12, "Sinusoidal Mode", RW, FAST, "While set, linear moves are turned into SINE moves.")
AXIS_1.row(13, "Gear Lock", RW, doc="Set to bypass GEAR ACC/DEC and force the programmed ratio.")
AXIS_1.row(
    14,
    "Gear At Speed",
    R,
    doc="Set when the internal gear ratio equals the programmed one; clear during ramps.",
)
AXIS_1.row(15, "Gear Stopping", R, doc="Set during the last GEAR DEC ramp after GEAR OFF.")
AXIS_1.row(16, "Clamp Output Signal", RW, FAST, "While set, the output signal is forced to zero.")
AXIS_1.row(17, "Open Servo Loop", RW, FAST, "While set, the servo loop is not run.")
AXIS_1.row(18, "Biquad Filter Activate", RW, FAST, "While set, the digital filters run.")
AXIS_1.row(19, "REN Request Flag", RW, SLOW, "Axis performs REN; self clearing.")
AXIS_1.row(
    20, "Gear Activate", RW, FAST, "Set by GEAR ON, cleared by GEAR OFF; may be driven by hand."
)
AXIS_1.row(
    21, "Gear Active", R, doc="Set while gearing acts; stays set through the ramp after GEAR OFF."
)
AXIS_1.row(
    22, "Cam Activate", RW, FAST, "Set by CAM ON, cleared by CAM OFF; may be driven by hand."
)
AXIS_1.row(
    23, "Ballscrew Activate", RW, FAST, "Set by BSC ON, cleared by BSC OFF; may be driven by hand."
)
AXIS_1.row(24, "Jog Active", R, FAST, "Set in any jog mode.")
AXIS_1.row(25, "Jog Direction", R, FAST, "Set when jogging negative, clear when positive or idle.")
AXIS_1.row(26, "Jog At Speed", R, FAST, "Set when the axis runs at the JOG VEL speed.")
AXIS_1.row(27, "Jog Stopping", R, FAST, "Set while jogging ramps to zero.")
AXIS_1.row(
    28,
    "Jog Forward",
    RW,
    FAST,
    "Set while jogging forward; setting starts, clearing stops the jog.",
)
AXIS_1.row(
    29,
    "Jog Reverse",
    RW,
    FAST,
    "Set while jogging in reverse; setting starts, clearing stops the jog.",
)
AXIS_1.row(30, "Jog Limit Check", RW, FAST, "While set, JLM limits apply to JOG FWD and JOG REV.")
AXIS_1.row(
    31,
    "Jog Lockout",
    RW,
    FAST,
    "While set, jog commands set their flag but give no motion until cleared.",
)

AXIS_2 = FlagBlock(
    "Secondary Axis Flags",
    object="AXIS",
    prefix="AF2",
    spans=(Span(4168, 8), Span(4352, 8)),
    word_name="Secondary Axis {n} Flags",
    packet=consecutive(0x10),
)
AXIS_2.row(
    0,
    "Positive Dir Limit",
    RW,
    doc="With Dir Limit Activate: positive motion trips the limit and feedholds.",
)
AXIS_2.row(
    1,
    "Negative Dir Limit",
    RW,
    doc="With Dir Limit Activate: negative motion trips the limit and feedholds.",
)
AXIS_2.row(2, "Dir Limit Activate", RW, doc="Set to enable directional limit checking.")
AXIS_2.row(3, "Dir Limit Tripped", RW, doc="Set when a directional limit caused a feedhold.")
AXIS_2.row(4, "CAM Trigger Mode", R, doc="Set by CAM trigger mode, clears when CAM turns off.")
AXIS_2.row(
    5,
    "CAM Trigger Started",
    R,
    doc="Set when the external input has started a triggered CAM; cleared by CAM OFF.",
)
AXIS_2.row(
    8, "Gear On Trig Armed", R, doc="Set by gear trigger mode, cleared when the gear starts."
)
AXIS_2.row(9, "Gear On Position")
AXIS_2.row(
    10,
    "Gear Trigger Started",
    R,
    doc="Set when the external input has started a triggered gear; cleared by GEAR OFF.",
)
AXIS_2.row(
    11,
    "Dir Limit Tripped",
    ident="DIR_LIMIT_TRIPPED_AGAIN",
    erratum="Printed with the name of flag 3; its meaning is not known.",
)
AXIS_2.row(12, "Gear Off Armed", R, doc="Set by gear-off trigger mode, cleared by the processor.")
AXIS_2.row(13, "Gear Off Position")
AXIS_2.row(14, "Gear Max", doc="Set while the upper gear limit is hit; self clearing.")
AXIS_2.row(15, "Gear Min", doc="Set while the lower gear limit is hit; self clearing.")
AXIS_2.row(17, "3D ARC")
AXIS_2.row(
    22,
    "Don't use capture Register",
    RW,
    doc="Set for a stepper without encoder: captures the commanded position.",
)
AXIS_2.row(
    23,
    "Stepper FeedBack",
    doc="Open-loop stepper that still reports encoder counts for HSINT, INTCAP and MSEEK.",
)
AXIS_2.row(
    24,
    "Fast EXC Flags",
    RW,
    doc="Selects Not Excess Error for servo-period update (needs BIT5632).",
)
AXIS_2.row(
    25, "Fast IPB Flags", RW, doc="Selects Not In Position for servo-period update (needs BIT5632)."
)
AXIS_2.row(
    26, "Fast ALM Flags", RW, doc="Selects Within A Limit for servo-period update (needs BIT5632)."
)
AXIS_2.row(
    27,
    "Fast BLM Flags",
    RW,
    doc="Selects Not Within B Limit for servo-period update (needs BIT5632).",
)
AXIS_2.row(
    28,
    "Fast TLM Flags",
    RW,
    doc="Selects Not Torque Limit for servo-period update (needs BIT5632).",
)
AXIS_2.row(
    29,
    "Fast TIB Flags",
    RW,
    doc="Selects Not In Torque Band for servo-period update (needs BIT5632).",
)
AXIS_2.row(
    31, "Fast Master Flags", RW, doc="Selects all master limit flags for servo-period update."
)

AXIS_3 = FlagBlock(
    "Tertiary Axis Flags",
    object="AXIS",
    prefix="AF3",
    spans=(Span(4296, 16),),
    word_name="Tertiary Slave {n} Flags",
    word_erratum="The flag tables print packet index 0x14 or 0x19; it is 0x19 or 0x1A.",
    packet=consecutive(0x10),
)
AXIS_3.row(4, "Filter Moved", R, doc="Follows FLT ON and FLT OFF.")
AXIS_3.row(
    5, "In Dead Band", R, doc="Set when following error is below DZL at rest; clears above DZU."
)
AXIS_3.row(16, "Tangential")

SLAVE_4 = FlagBlock(
    "Quaternary Slave Flags",
    object="AXIS",
    prefix="SF4",
    spans=(Span(4312, 16),),
    word_name="Quaternary Slave {n} Flags",
    word_erratum="The parameter list prints Tertiary Slave Flags once more.",
    rest=UNDOCUMENTED,
    packet=consecutive(0x10),
)


AXIS_4 = FlagBlock(
    "Quaternary Axis Flags",
    object="AXIS",
    prefix="AF4",
    spans=(Span(4360, 16),),
    word_name="Quaternary Axis {n} Flags",
    word_erratum="The User's Guide gives these words to PLC/stepper 8 to 15 or none.",
    rest=UNDOCUMENTED,
    ref=ManualRef.PROGRAMMERS_GUIDE,
    packet=consecutive(0x10),
)
AXIS_4.inferred(0, "Drive Fault Input", NS, "Present state of the drive fault input.")
AXIS_4.inferred(
    5, "Drive Fault Level Invert", RW, "Set to invert the active level of the drive fault input."
)
AXIS_4.inferred(
    16,
    "Step Direction Output",
    RW,
    "Set: step and direction outputs; clear: clockwise and counter-clockwise.",
)
AXIS_4.row(
    17,
    "Drive Enabled",
    doc="Set while the drive of the axis is enabled; writing it enables or disables.",
)
AXIS_4.inferred(18, "Drive Reset Request", NS, "Resets the drive; self clearing.")
AXIS_4.row(
    19,
    "Kill All Motion Request",
    RW,
    doc="Stops and bars motion of the axis and its master; cleared by Ctrl-Y or DRIVE ON.",
)
AXIS_4.inferred(
    20, "Drive I/O Enable", RW, "Set: the enable output and fault input of the drive are used."
)
AXIS_4.inferred(
    21,
    "EXC Response Enable",
    RW,
    "Set: an excess position error kills motion and disables the drive.",
)
AXIS_4.inferred(
    22,
    "Disable Drive On EXC Only",
    RW,
    "Set: an excess position error disables the drive without killing motion.",
)
AXIS_4.inferred(23, "Disable Drive On Kill", RW, "Set: a kill of the axis also disables its drive.")
AXIS_4.row(29, "Drive Fault", doc="Latched drive fault input.")
AXIS_4.row(
    31,
    "Excess Error Fault",
    RW,
    doc="Axis disabled for excess position error; cleared by the user or DRIVE ON.",
)

AXIS_5 = FlagBlock(
    "Quinary Axis Flags",
    object="AXIS",
    prefix="AF5",
    spans=(Span(4600, 16),),
    word_name="Quinary Axis {n} Flags",
    rest=UNDOCUMENTED,
    ref=ManualRef.PROGRAMMERS_GUIDE,
    word_doc="Limit and homing control and status.",
)
AXIS_5.inferred(0, "Positive Limit Input", NS, "Present state of the positive limit input.")
AXIS_5.inferred(1, "Negative Limit Input", NS, "Present state of the negative limit input.")
AXIS_5.inferred(2, "Home Input", NS, "Present state of the home input.")
AXIS_5.inferred(3, "Homing In Progress", NS, "Set from JOG HOME until the search ends.")
AXIS_5.row(
    4,
    "Positive Hardware Limit Encountered",
    RW,
    doc="Positive end-of-travel input was hit; program must clear it.",
)
AXIS_5.row(
    5,
    "Negative Hardware Limit Encountered",
    RW,
    doc="Negative end-of-travel input was hit; program must clear it.",
)
AXIS_5.row(6, "Home Successful", doc="Set when homing ended at the home position.")
AXIS_5.row(7, "Home Failed", doc="Set when homing failed.")
AXIS_5.inferred(
    8,
    "Positive Limit Input Previous",
    NS,
    "State of the positive limit input one servo period ago.",
)
AXIS_5.inferred(
    9,
    "Negative Limit Input Previous",
    NS,
    "State of the negative limit input one servo period ago.",
)
AXIS_5.inferred(10, "Home Input Previous", NS, "State of the home input one servo period ago.")
AXIS_5.row(
    12,
    "Positive Software Limit Encountered",
    RW,
    doc="Positive software limit was crossed; clears by itself.",
)
AXIS_5.row(
    13,
    "Negative Software Limit Encountered",
    RW,
    doc="Negative software limit was crossed; clears by itself.",
)
AXIS_5.row(
    16, "Positive Limit Level Invert", RW, doc="Set to invert the active level of this limit input."
)
AXIS_5.row(
    17, "Negative Limit Level Invert", RW, doc="Set to invert the active level of this limit input."
)
AXIS_5.inferred(18, "Home Level Invert", NS, "Set to invert the active level of the home input.")
AXIS_5.row(
    20,
    "Positive Hardware Limit Enable",
    RW,
    doc="Enables the positive hardware limit; off by default (HLIM).",
)
AXIS_5.row(
    21,
    "Negative Hardware Limit Enable",
    RW,
    doc="Enables the negative hardware limit; off by default (HLIM).",
)
AXIS_5.row(
    22,
    "Positive Software Limit Enable",
    RW,
    doc="Enables the positive software limit; off by default (SLIM).",
)
AXIS_5.row(
    23,
    "Negative Software Limit Enable",
    RW,
    doc="Enables the negative software limit; off by default (SLIM).",
)
AXIS_5.row(
    24,
    "Home Backup Enable",
    RW,
    doc="Homing backs up to the selected edge; when clear, bits 25 and 26 are ignored.",
)
AXIS_5.row(
    25, "Home Negative Edge Select", RW, doc="Homing uses the negative edge of the home input."
)
AXIS_5.row(
    26,
    "Home Negative Final Direction",
    RW,
    doc="Final homing approach runs in the negative direction.",
)

AXIS_6 = FlagBlock(
    "Senary Axis Flags",
    object="AXIS",
    prefix="AF6",
    spans=(Span(4632, 16),),
    word_name="Senary Axis {n} Flags",
    rest=UNDOCUMENTED,
    ref=ManualRef.KNOWLEDGE_BASE,
)
AXIS_6.row(8, "Jog Home Request", RW, doc="Starts JOG HOME; self clearing.")
AXIS_6.row(9, "Jog Home Direction", RW, doc="Direction of JOG HOME: clear positive, set negative.")

FLAG_BLOCKS = (AXIS_1, AXIS_2, AXIS_3, SLAVE_4, AXIS_4, AXIS_5, AXIS_6)
