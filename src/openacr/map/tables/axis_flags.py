"""Axis flag words: six families of 32 flags for every axis."""

from openacr.map.block import FAST, NS, RW, SLOW, UNDOCUMENTED, ManualRef, R, Span, consecutive
from openacr.map.flag_block import FlagBlock

AXIS_1 = FlagBlock(
    "Axis Flags",
    object="AXIS",
    prefix="AF1",
    spans=(Span(4120, 8), Span(4336, 8)),
    word_name="Axis {n} Flags",
    packet=consecutive(0x10),
)
AXIS_1.row(0, "Not In Position", R, "Set when following error is outside the IPB band.", SLOW)
AXIS_1.row(1, "Not Excess Error", R, "Set when following error is inside the EXC band.", SLOW)
AXIS_1.row(2, "Within A Limit", R, "Set when the command is inside limit A (ALM).", SLOW)
AXIS_1.row(3, "Not Within B Limit", R, "Set when the command is outside limit B (BLM).", SLOW)
AXIS_1.row(
    4,
    "Not Torque Limit",
    R,
    "Set when the output is not limited (TLM).",
    SLOW,
    erratum="The printed text says the opposite of the name.",
)
AXIS_1.row(5, "Not In Torque Band", R, "Set when the output is outside its band (ITB).", SLOW)
AXIS_1.row(8, "Not Marker", R, "Set while the encoder marker is absent.", SLOW)
AXIS_1.row(
    9, "Capture Complete", R, "An INTCAP capture has completed; the next INTCAP clears it.", FAST
)
AXIS_1.row(10, "HSINT Registered", R, "The capture of HSINT came within its window.")
AXIS_1.row(11, "HSINT Aborted", R, "The abort flag of HSINT ended the sequence.")
AXIS_1.row(12, "Sinusoidal Mode", RW, "While set, linear moves are turned into SINE moves.", FAST)
AXIS_1.row(13, "Gear Lock", RW, "Set to bypass GEAR ACC/DEC and force the programmed ratio.")
AXIS_1.row(14, "Gear At Speed", R, "The gear ratio is the programmed one; clear during ramps.")
AXIS_1.row(15, "Gear Stopping", R, "Set during the last GEAR DEC ramp after GEAR OFF.")
AXIS_1.row(16, "Clamp Output Signal", RW, "While set, the output signal is forced to zero.", FAST)
AXIS_1.row(17, "Open Servo Loop", RW, "While set, the servo loop is not run.", FAST)
AXIS_1.row(18, "Biquad Filter Activate", RW, "While set, the digital filters run.", FAST)
AXIS_1.row(19, "REN Request Flag", RW, "Axis performs REN; self clearing.", SLOW)
AXIS_1.row(20, "Gear Activate", RW, "Follows GEAR ON and GEAR OFF; may be written.", FAST)
AXIS_1.row(
    21, "Gear Active", R, "Set while gearing acts; stays set through the ramp after GEAR OFF."
)
AXIS_1.row(22, "Cam Activate", RW, "Follows CAM ON and CAM OFF; may be written.", FAST)
AXIS_1.row(23, "Ballscrew Activate", RW, "Follows BSC ON and BSC OFF; may be written.", FAST)
AXIS_1.row(24, "Jog Active", R, "Set in any jog mode.", FAST)
AXIS_1.row(25, "Jog Direction", R, "Set when jogging negative, clear when positive or idle.", FAST)
AXIS_1.row(26, "Jog At Speed", R, "Set when the axis runs at the JOG VEL speed.", FAST)
AXIS_1.row(27, "Jog Stopping", R, "Set while jogging ramps to zero.", FAST)
AXIS_1.row(28, "Jog Forward", RW, "Jogging forward; set to start, clear to stop.", FAST)
AXIS_1.row(29, "Jog Reverse", RW, "Jogging in reverse; set to start, clear to stop.", FAST)
AXIS_1.row(30, "Jog Limit Check", RW, "While set, JLM limits apply to JOG FWD and JOG REV.", FAST)
AXIS_1.row(31, "Jog Lockout", RW, "While set, jog commands give no motion.", FAST)

AXIS_2 = FlagBlock(
    "Secondary Axis Flags",
    object="AXIS",
    prefix="AF2",
    spans=(Span(4168, 8), Span(4352, 8)),
    word_name="Secondary Axis {n} Flags",
    packet=consecutive(0x10),
)
AXIS_2.row(0, "Positive Dir Limit", RW, "With Dir Limit Activate: holds positive motion.")
AXIS_2.row(1, "Negative Dir Limit", RW, "With Dir Limit Activate: holds negative motion.")
AXIS_2.row(2, "Dir Limit Activate", RW, "Set to enable directional limit checking.")
AXIS_2.row(3, "Dir Limit Tripped", RW, "Set when a directional limit caused a feedhold.")
AXIS_2.row(4, "CAM Trigger Mode", R, "Set by CAM trigger mode, clears when CAM turns off.")
AXIS_2.row(5, "CAM Trigger Started", R, "The trigger has started the cam; cleared by CAM OFF.")
AXIS_2.row(8, "Gear On Trig Armed", R, "Set by gear trigger mode, cleared when the gear starts.")
AXIS_2.row(9, "Gear On Position")
AXIS_2.row(10, "Gear Trigger Started", R, "The trigger has started the gear; cleared by GEAR OFF.")
AXIS_2.row(
    11,
    "Dir Limit Tripped",
    ident="DIR_LIMIT_TRIPPED_AGAIN",
    erratum="Printed with the name of flag 3; its meaning is not known.",
)
AXIS_2.row(12, "Gear Off Armed", R, "Set by gear-off trigger mode, cleared by the processor.")
AXIS_2.row(13, "Gear Off Position")
AXIS_2.row(14, "Gear Max", NS, "Set while the upper gear limit is hit; self clearing.")
AXIS_2.row(15, "Gear Min", NS, "Set while the lower gear limit is hit; self clearing.")
AXIS_2.row(17, "3D ARC", ident="ARC_3D")
AXIS_2.row(22, "Don't use capture Register", RW, "For steppers: capture the commanded position.")
AXIS_2.row(23, "Stepper FeedBack", NS, "Open-loop stepper with an encoder used for captures only.")
AXIS_2.row(24, "Fast EXC Flags", RW, "With BIT5632: Not Excess Error in the servo interrupt.")
AXIS_2.row(25, "Fast IPB Flags", RW, "With BIT5632: Not In Position in the servo interrupt.")
AXIS_2.row(26, "Fast ALM Flags", RW, "With BIT5632: Within A Limit in the servo interrupt.")
AXIS_2.row(27, "Fast BLM Flags", RW, "With BIT5632: Not Within B Limit in the servo interrupt.")
AXIS_2.row(28, "Fast TLM Flags", RW, "With BIT5632: Not Torque Limit in the servo interrupt.")
AXIS_2.row(29, "Fast TIB Flags", RW, "With BIT5632: Not In Torque Band in the servo interrupt.")
AXIS_2.row(31, "Fast Master Flags", RW, "With BIT5632: limit flags of its master, too.")

AXIS_3 = FlagBlock(
    "Tertiary Axis Flags",
    object="AXIS",
    prefix="AF3",
    spans=(Span(4296, 16),),
    word_name="Tertiary Slave {n} Flags",
    word_erratum="The flag tables print packet index 0x14 or 0x19; it is 0x19 or 0x1A.",
    packet=consecutive(0x10),
)
AXIS_3.row(4, "Filter Moved", R, "Follows FLT ON and FLT OFF.")
AXIS_3.row(5, "In Dead Band", R, "Set when following error is below DZL at rest; clears above DZU.")
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
    16, "Step Direction Output", RW, "Set: step and direction; clear: two pulse trains."
)
AXIS_4.row(17, "Drive Enabled", NS, "The drive is enabled; write it to enable or disable.")
AXIS_4.inferred(18, "Drive Reset Request", NS, "Resets the drive; self clearing.")
AXIS_4.row(
    19, "Kill All Motion Request", RW, "Stops and bars all motion; Ctrl-Y or DRIVE ON clear it."
)
AXIS_4.inferred(
    20,
    "Drive I/O Enable",
    RW,
    "Enable output and fault input of the drive are used: no output before DRIVE ON.",
)
AXIS_4.inferred(21, "EXC Response Enable", RW, "Set: excess error kills and disables the drive.")
AXIS_4.inferred(
    22, "Disable Drive On EXC Only", RW, "Set: excess error disables the drive, no kill."
)
AXIS_4.inferred(23, "Disable Drive On Kill", RW, "Set: a kill of the axis also disables its drive.")
AXIS_4.inferred(
    28, "Motor On", NS, "Follows Drive Enabled; undocumented, one host reads it so on real cards."
)
AXIS_4.row(29, "Drive Fault", NS, "Latched drive fault input.")
AXIS_4.row(
    31, "Excess Error Fault", RW, "The axis was disabled for excess error; DRIVE ON clears it."
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
AXIS_5.row(4, "Positive Hardware Limit Encountered", RW, "The switch was hit; stays, bars nothing.")
AXIS_5.row(5, "Negative Hardware Limit Encountered", RW, "The switch was hit; stays, bars nothing.")
AXIS_5.row(6, "Home Successful", NS, "Set when homing ended at the home position.")
AXIS_5.row(7, "Home Failed", NS, "Set when homing failed.")
AXIS_5.inferred(8, "Positive Limit Input Previous", NS, "State of that input one tick ago.")
AXIS_5.inferred(9, "Negative Limit Input Previous", NS, "State of that input one tick ago.")
AXIS_5.inferred(10, "Home Input Previous", NS, "State of that input one tick ago.")
AXIS_5.row(12, "Positive Software Limit Encountered", RW, "The limit is crossed; clears itself.")
AXIS_5.row(13, "Negative Software Limit Encountered", RW, "The limit is crossed; clears itself.")
AXIS_5.row(
    16, "Positive Limit Level Invert", RW, "Set to invert the active level of this limit input."
)
AXIS_5.row(
    17, "Negative Limit Level Invert", RW, "Set to invert the active level of this limit input."
)
AXIS_5.inferred(18, "Home Level Invert", NS, "Set to invert the active level of the home input.")
AXIS_5.row(20, "Positive Hardware Limit Enable", RW, "The switch stops the axis (HLIM).")
AXIS_5.row(21, "Negative Hardware Limit Enable", RW, "The switch stops the axis (HLIM).")
AXIS_5.row(22, "Positive Software Limit Enable", RW, "SLM stops the axis (SLIM).")
AXIS_5.row(23, "Negative Software Limit Enable", RW, "SLM stops the axis (SLIM).")
AXIS_5.row(24, "Home Backup Enable", RW, "Homing returns to the edge chosen by flags 25 and 26.")
AXIS_5.row(25, "Home Negative Edge Select", RW, "Homing uses the negative edge of the home input.")
AXIS_5.row(26, "Home Negative Final Direction", RW, "The last approach runs negative.")

AXIS_6 = FlagBlock(
    "Senary Axis Flags",
    object="AXIS",
    prefix="AF6",
    spans=(Span(4632, 16),),
    word_name="Senary Axis {n} Flags",
    rest=UNDOCUMENTED,
    ref=ManualRef.KNOWLEDGE_BASE,
)
AXIS_6.row(8, "Jog Home Request", RW, "Starts JOG HOME; self clearing.")
AXIS_6.row(9, "Jog Home Direction", RW, "Direction of JOG HOME: clear positive, set negative.")

FLAG_BLOCKS = (AXIS_1, AXIS_2, AXIS_3, SLAVE_4, AXIS_4, AXIS_5, AXIS_6)
