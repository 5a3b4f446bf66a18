"""Master flag words: four families of 32 flags for every master."""

from openacr.map.block import FAST, RW, SLOW, Access, FlagBlock, R, Span, consecutive

MASTER_1 = FlagBlock(
    "Master Flags",
    object="MASTER",
    prefix="MF1",
    spans=(Span(4112, 8), Span(4328, 8)),
    word_name="Master {n} Flags",
    packet=consecutive(0x10),
)
MASTER_1.row(0, "Accelerating", R, FAST, "Set while ramping up with ACC.")
MASTER_1.row(1, "Decelerating", R, FAST, "Set while ramping down with DEC.")
MASTER_1.row(2, "Stopping", R, FAST, "Set while ramping to a full stop with STP.")
MASTER_1.row(3, "Jerking", R, FAST, "Set while acceleration changes under JRK.")
MASTER_1.row(4, "In Motion", R, FAST, "Set while a move is active, including during feedhold.")
MASTER_1.row(5, "Move Buffered", R, FAST, "Set while another move waits behind the current one.")
MASTER_1.row(
    6,
    "Feedholding",
    R,
    FAST,
    "Set from a feedhold request (axes slowing or stopped) until cycle start.",
)
MASTER_1.row(
    7, "In Feedhold", R, FAST, "Set once the axes have stopped in feedhold, until cycle start."
)
MASTER_1.row(
    8, "Feedhold Request", RW, SLOW, "Decelerates the current move to zero; self clearing."
)
MASTER_1.row(9, "Cycle Start Request", RW, SLOW, "Resumes a move held by feedhold; self clearing.")
MASTER_1.row(
    10,
    "Kill All Moves Request",
    RW,
    SLOW,
    "Stops all moves without a ramp; user clears it unless Enable Clear Request is set.",
)
MASTER_1.row(
    11,
    "Stop All Moves Request",
    RW,
    SLOW,
    "Feedhold, wait for In Feedhold, then kill all moves; self clearing.",
)
MASTER_1.row(12, "FVEL Zero Pending", RW, SLOW, "Value FVEL Zero Active takes at the next move.")
MASTER_1.row(13, "FVEL Zero Active", RW, SLOW, "While set, final velocity is 0 instead of FVEL.")
MASTER_1.row(
    14, "FOV/ROV Lock Pending", RW, SLOW, "Value FOV/ROV Lock Active takes at the next move."
)
MASTER_1.row(
    15,
    "FOV/ROV Lock Active",
    RW,
    SLOW,
    "While set, 1.0 replaces FOV in feed moves and ROV in rapid moves.",
)
MASTER_1.row(16, "Not In Position", R, SLOW, "Set if any attached axis is outside its IPB band.")
MASTER_1.row(
    17,
    "Not Excess Error",
    R,
    SLOW,
    "Set if every attached axis is inside its EXC band.",
    erratum="The table for masters 0 to 7 merges this row with the next; the names behind slip.",
)
MASTER_1.row(
    18, "Within A Limit", R, SLOW, "Set if every attached axis command is inside limit A (ALM)."
)
MASTER_1.row(
    19, "Not Within B Limit", R, SLOW, "Set if any attached axis command is outside limit B (BLM)."
)
MASTER_1.row(20, "Not Torque Limit", R, SLOW, "Set if no attached output is torque limited (TLM).")
MASTER_1.row(
    21,
    "Not In Torque Band",
    R,
    SLOW,
    "Set if any attached output is outside its torque band (ITB).",
)
MASTER_1.row(
    24, "Decrement Count", RW, FAST, "While set, the move counter counts down at each move start."
)
MASTER_1.row(
    25, "Increment Count", RW, FAST, "While set, the move counter counts up at each move start."
)
MASTER_1.row(
    26,
    "Interrupt On Move",
    RW,
    FAST,
    "While set, the host bus is interrupted when a move is fetched and buffered.",
)
MASTER_1.row(27, "TRG Pending", RW, FAST, "Set while waiting for a TRG condition.")
MASTER_1.row(
    28, "Start Move Inhibit", RW, FAST, "While set, buffered moves do not start; used by BLK/STEP."
)
MASTER_1.row(29, "REN Request Flag", RW, SLOW, "Attached axes perform REN; self clearing.")
MASTER_1.row(30, "Cycle Start Lockout", RW, FAST, "While set, cycle start requests are ignored.")

MASTER_2 = FlagBlock(
    "Secondary Master Flags",
    object="MASTER",
    prefix="MF2",
    spans=(Span(4160, 8), Span(4344, 8)),
    word_name="Secondary Master {n} Flags",
    packet=consecutive(0x10),
)
MASTER_2.row(
    0,
    "Block Skip Check",
    RW,
    doc="With Block Skip Input set, the next move is skipped; clears at the next move.",
)
MASTER_2.row(1, "Block Skip Input", RW, doc="Must be set for Block Skip Check to take effect.")
MASTER_2.row(2, "Rapid Pending", RW, doc="Value Rapid Active takes at the next move.")
MASTER_2.row(3, "Rapid Active", RW, doc="While set, ROV is used instead of FOV.")
MASTER_2.row(
    4,
    "Enable Clear Request",
    RW,
    doc="Set: Kill and Stop All Moves clear themselves, as up to firmware 1.17.04.",
)
MASTER_2.row(
    5,
    "Enable Rapid Move Modes",
    RW,
    doc="Set: move packets have rapid modes in header code 0, as from firmware 1.17.05.",
)
MASTER_2.row(
    6,
    "Master Short Time",
    RW,
    doc="Set under TMOV when a move cannot finish in the set time; cleared by one that can.",
)
MASTER_2.row(
    7, "Master in TMOV", RW, doc="Enables time based moves; set by TMOV ON, cleared by TMOV OFF."
)
MASTER_2.row(9, "Master TOV")
MASTER_2.row(
    10,
    "Reserved",
    Access.RESERVED,
    erratum="Printed as BIT2188; the stride gives BIT2186.",
    erratum_at=4,
)
MASTER_2.row(16, "Sync Mode", R, doc="Set by SYNC ON, cleared by SYNC OFF.")
MASTER_2.row(
    17,
    "Sync Manual",
    RW,
    doc="Synchronised moves are loaded and started by hand; set by SYNC MDI, cleared by SYNC PROG.",
)
MASTER_2.row(
    19,
    "Sync Manual Loaded",
    R,
    doc="Set when a move was issued to the synchronised master; clears when it starts.",
)
MASTER_2.row(24, "Spiral mode", RW)
MASTER_2.row(26, "TANG mode", R, doc="Follows TANG ON and TANG OFF.")
MASTER_2.row(28, "SlaveMaxVel", R, doc="Set when axis velocity limiting is on (MAXVEL).")
MASTER_2.row(29, "TARC Mode", R, doc="Follows TARC ON and TARC OFF.")

MASTER_3 = FlagBlock(
    "Tertiary Master Flags",
    object="MASTER",
    prefix="MF3",
    spans=(Span(4256, 16),),
    word_name="Tertiary Master {n} Flags",
    packet=consecutive(0x10),
)
MASTER_3.row(0, "Spline Pending")
MASTER_3.row(1, "Spline Buffered")
MASTER_3.row(
    2,
    "Spline Interpolation",
    RW,
    doc="Set by the SPLINE mode command until the interpolation ends.",
)
MASTER_3.row(3, "Spline Last")
MASTER_3.row(4, "Spline Velocity Mode", RW, doc="Spline mode 1 in use.")
MASTER_3.row(5, "Spline Time Mode", RW, doc="Spline mode 0 in use.")
MASTER_3.row(6, "Spline End")
MASTER_3.row(7, "Spline Knot Present", RW, doc="Spline data carry the optional knots.")
MASTER_3.row(8, "Spline Acc Ramp")
MASTER_3.row(9, "Spline Started", RW, doc="Set once the spline move started, clears at its end.")
MASTER_3.row(10, "Spline Neg. Knot", RW, doc="Set by a negative knot, clears at the spline end.")
MASTER_3.row(11, "Spline Moved")
MASTER_3.row(12, "Spline Loaded")
MASTER_3.row(13, "Spline Data Avail")
MASTER_3.row(14, "Spline Profiler On", RW, doc="Spline profiler is computing curve points.")
MASTER_3.row(16, "NURB Loaded")
MASTER_3.row(17, "NURB New Segment")
MASTER_3.row(18, "NURB Delta Done")
MASTER_3.row(19, "NURB Stop Active")
MASTER_3.row(20, "NURB Moved")
MASTER_3.row(
    21, "NURB Interpolation", RW, doc="Set by the NURB mode command until the interpolation ends."
)
MASTER_3.row(22, "NURB Buffered")
MASTER_3.row(23, "NURB Profiler On", RW, doc="NURB profiler is computing curve points.")
MASTER_3.row(24, "NURB Pending")
MASTER_3.row(25, "NURB Acc Ramp")
MASTER_3.row(26, "NURB Last")
MASTER_3.row(27, "NURB Started", RW, doc="Set once the NURB move started, clears at its end.")
MASTER_3.row(28, "NURB Time", RW, doc="NURB mode 0 in use.")
MASTER_3.row(29, "NURB Smooth", RW, doc="NURB mode 4 in use.")
MASTER_3.row(30, "NURB Dynamic", RW, doc="NURB mode 1 in use.")
MASTER_3.row(31, "NURB Neg Knot", RW, doc="Set by a negative knot, clears at the NURB end.")

MASTER_4 = FlagBlock(
    "Quaternary Master Flags",
    object="MASTER",
    prefix="MF4",
    spans=(Span(4280, 16),),
    word_name="Quaternary Master {n} Flags",
    word_erratum="The parameter list prints Tertiary Master Flags once more.",
    packet=consecutive(0x10),
)
MASTER_4.row(
    0, "VEL LIMIT", R, doc="Set when the vector velocity hits the VEL limit; self clearing."
)
MASTER_4.row(1, "Look Ahead SlowDown", R, doc="Look-ahead is forcing a slow-down.")
MASTER_4.row(4, "MBUF mode", R, doc="Follows MBUF ON and MBUF OFF.")
MASTER_4.row(5, "Look Ahead mode", R, doc="Follows LOOK ON and LOOK OFF.")
MASTER_4.row(10, "MBUF user RAM", R, doc="Set by DIM MBUF, cleared by MBUF OFF.")
MASTER_4.row(11, "Look Ahead Neglect", RW, doc="Set to suspend look-ahead on the fly.")
MASTER_4.row(16, "Perform Kinematics")

FLAG_BLOCKS = (MASTER_1, MASTER_2, MASTER_3, MASTER_4)
