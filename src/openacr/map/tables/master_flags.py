"""Master flag words: four families of 32 flags for every master."""

from openacr.map.block import FAST, RW, SLOW, Access, R, Span, consecutive
from openacr.map.flag_block import FlagBlock

MASTER_1 = FlagBlock(
    "Master Flags",
    object="MASTER",
    prefix="MF1",
    spans=(Span(4112, 8), Span(4328, 8)),
    word_name="Master {n} Flags",
    packet=consecutive(0x10),
)
MASTER_1.row(0, "Accelerating", R, "Set while ramping up with ACC.", FAST)
MASTER_1.row(1, "Decelerating", R, "Set while ramping down with DEC.", FAST)
MASTER_1.row(2, "Stopping", R, "Set while ramping to a full stop with STP.", FAST)
MASTER_1.row(3, "Jerking", R, "Set while acceleration changes under JRK.", FAST)
MASTER_1.row(4, "In Motion", R, "Set while a move is active, including during feedhold.", FAST)
MASTER_1.row(5, "Move Buffered", R, "Set while another move waits after the current one.", FAST)
MASTER_1.row(6, "Feedholding", R, "From a feedhold request until cycle start.", FAST)
MASTER_1.row(
    7, "In Feedhold", R, "Set once the axes have stopped in feedhold, until cycle start.", FAST
)
MASTER_1.row(8, "Feedhold Request", RW, "Holds the present move; self clearing.", SLOW)
MASTER_1.row(9, "Cycle Start Request", RW, "Resumes a move held by feedhold; self clearing.", SLOW)
MASTER_1.row(10, "Kill All Moves Request", RW, "Stops all moves at once; to be cleared.", SLOW)
MASTER_1.row(
    11, "Stop All Moves Request", RW, "Feedhold, then kill all moves; self clearing.", SLOW
)
MASTER_1.row(12, "FVEL Zero Pending", RW, "Value FVEL Zero Active takes at the next move.", SLOW)
MASTER_1.row(13, "FVEL Zero Active", RW, "While set, final velocity is 0 instead of FVEL.", SLOW)
MASTER_1.row(
    14, "FOV/ROV Lock Pending", RW, "Value FOV/ROV Lock Active takes at the next move.", SLOW
)
MASTER_1.row(15, "FOV/ROV Lock Active", RW, "While set, moves run without override.", SLOW)
MASTER_1.row(16, "Not In Position", R, "Set if any attached axis is outside its IPB band.", SLOW)
MASTER_1.row(
    17,
    "Not Excess Error",
    R,
    "Set if every attached axis is inside its EXC band.",
    SLOW,
    erratum="The table for masters 0 to 7 merges this row with the next; later names slip.",
)
MASTER_1.row(18, "Within A Limit", R, "Set if every attached axis is inside ALM.", SLOW)
MASTER_1.row(19, "Not Within B Limit", R, "Set if any attached axis is outside BLM.", SLOW)
MASTER_1.row(20, "Not Torque Limit", R, "Set if no attached output is torque limited (TLM).", SLOW)
MASTER_1.row(21, "Not In Torque Band", R, "Set if any attached output is outside ITB.", SLOW)
MASTER_1.row(24, "Decrement Count", RW, "The move counter counts down at each move.", FAST)
MASTER_1.row(25, "Increment Count", RW, "The move counter counts up at each move.", FAST)
MASTER_1.row(26, "Interrupt On Move", RW, "Interrupts the host when a move is fetched.", FAST)
MASTER_1.row(27, "TRG Pending", RW, "Set while waiting for a TRG condition.", FAST)
MASTER_1.row(
    28, "Start Move Inhibit", RW, "While set, buffered moves do not start; used by BLK/STEP.", FAST
)
MASTER_1.row(29, "REN Request Flag", RW, "Attached axes perform REN; self clearing.", SLOW)
MASTER_1.row(30, "Cycle Start Lockout", RW, "While set, cycle start requests are ignored.", FAST)

MASTER_2 = FlagBlock(
    "Secondary Master Flags",
    object="MASTER",
    prefix="MF2",
    spans=(Span(4160, 8), Span(4344, 8)),
    word_name="Secondary Master {n} Flags",
    packet=consecutive(0x10),
)
MASTER_2.row(0, "Block Skip Check", RW, "With Block Skip Input: skips the next move, then clears.")
MASTER_2.row(1, "Block Skip Input", RW, "Must be set for Block Skip Check to take effect.")
MASTER_2.row(2, "Rapid Pending", RW, "Value Rapid Active takes at the next move.")
MASTER_2.row(3, "Rapid Active", RW, "While set, ROV is used instead of FOV.")
MASTER_2.row(4, "Enable Clear Request", RW, "Set: kill and stop clear themselves (up to 1.17.04).")
MASTER_2.row(
    5, "Enable Rapid Move Modes", RW, "Set: move packets carry rapid modes (from 1.17.05)."
)
MASTER_2.row(6, "Master Short Time", RW, "TMOV: the move cannot be done in the time set.")
MASTER_2.row(
    7, "Master in TMOV", RW, "Enables time based moves; set by TMOV ON, cleared by TMOV OFF."
)
MASTER_2.row(9, "Master TOV")
MASTER_2.row(
    10,
    "Reserved",
    Access.RESERVED,
    erratum="Printed as BIT2188; the stride gives BIT2186.",
    erratum_at=4,
)
MASTER_2.row(16, "Sync Mode", R, "Set by SYNC ON, cleared by SYNC OFF.")
MASTER_2.row(17, "Sync Manual", RW, "Synchronised moves are started by hand (SYNC MDI).")
MASTER_2.row(19, "Sync Manual Loaded", R, "A synchronised move waits for its start.")
MASTER_2.row(24, "Spiral mode", RW)
MASTER_2.row(26, "TANG mode", R, "Follows TANG ON and TANG OFF.")
MASTER_2.row(28, "SlaveMaxVel", R, "Set when axis velocity limiting is on (MAXVEL).")
MASTER_2.row(29, "TARC Mode", R, "Follows TARC ON and TARC OFF.")

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
MASTER_3.row(2, "Spline Interpolation", RW, "From SPLINE MODE to the end of the curve.")
MASTER_3.row(3, "Spline Last")
MASTER_3.row(4, "Spline Velocity Mode", RW, "Spline mode 1 in use.")
MASTER_3.row(5, "Spline Time Mode", RW, "Spline mode 0 in use.")
MASTER_3.row(6, "Spline End")
MASTER_3.row(7, "Spline Knot Present", RW, "Spline data carry the optional knots.")
MASTER_3.row(8, "Spline Acc Ramp")
MASTER_3.row(9, "Spline Started", RW, "Set once the spline move started, clears at its end.")
MASTER_3.row(10, "Spline Neg. Knot", RW, "Set by a negative knot, clears at the spline end.")
MASTER_3.row(11, "Spline Moved")
MASTER_3.row(12, "Spline Loaded")
MASTER_3.row(13, "Spline Data Avail")
MASTER_3.row(14, "Spline Profiler On", RW, "Spline profiler is computing curve points.")
MASTER_3.row(16, "NURB Loaded")
MASTER_3.row(17, "NURB New Segment")
MASTER_3.row(18, "NURB Delta Done")
MASTER_3.row(19, "NURB Stop Active")
MASTER_3.row(20, "NURB Moved")
MASTER_3.row(21, "NURB Interpolation", RW, "From NURB MODE to the end of the curve.")
MASTER_3.row(22, "NURB Buffered")
MASTER_3.row(23, "NURB Profiler On", RW, "NURB profiler is computing curve points.")
MASTER_3.row(24, "NURB Pending")
MASTER_3.row(25, "NURB Acc Ramp")
MASTER_3.row(26, "NURB Last")
MASTER_3.row(27, "NURB Started", RW, "Set once the NURB move started, clears at its end.")
MASTER_3.row(28, "NURB Time", RW, "NURB mode 0 in use.")
MASTER_3.row(29, "NURB Smooth", RW, "NURB mode 4 in use.")
MASTER_3.row(30, "NURB Dynamic", RW, "NURB mode 1 in use.")
MASTER_3.row(31, "NURB Neg Knot", RW, "Set by a negative knot, clears at the NURB end.")

MASTER_4 = FlagBlock(
    "Quaternary Master Flags",
    object="MASTER",
    prefix="MF4",
    spans=(Span(4280, 16),),
    word_name="Quaternary Master {n} Flags",
    word_erratum="The parameter list prints Tertiary Master Flags once more.",
    packet=consecutive(0x10),
)
MASTER_4.row(0, "VEL LIMIT", R, "Set when the vector velocity hits the VEL limit; self clearing.")
MASTER_4.row(1, "Look Ahead SlowDown", R, "Look-ahead is forcing a slow-down.")
MASTER_4.row(4, "MBUF mode", R, "Follows MBUF ON and MBUF OFF.")
MASTER_4.row(5, "Look Ahead mode", R, "Follows LOOK ON and LOOK OFF.")
MASTER_4.row(10, "MBUF user RAM", R, "Set by DIM MBUF, cleared by MBUF OFF.")
MASTER_4.row(11, "Look Ahead Neglect", RW, "Set to suspend look-ahead on the fly.")
MASTER_4.row(16, "Perform Kinematics")

FLAG_BLOCKS = (MASTER_1, MASTER_2, MASTER_3, MASTER_4)
