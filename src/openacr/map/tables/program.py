"""User programs: line number and state flags."""

from openacr.map.block import (
    FAST,
    LONG,
    NS,
    RW,
    SLOW,
    Block,
    FlagBlock,
    R,
    Span,
    consecutive,
    sixteen_apart,
)

PROGRAM = Block(
    "Program Parameters",
    object="PROG",
    prefix="PROG",
    spans=(Span(7168, 16),),
    stride=16,
    packet=sixteen_apart,
)
PROGRAM.row(
    0x00,
    "Line Number",
    LONG,
    NS,
    "",
    "Line being executed; of a line without number the stored one.",
)

FLAGS = FlagBlock(
    "Program Flags",
    object="PROG",
    prefix="PF",
    spans=(Span(4128, 16),),
    word_name="Program {n} Flags",
    packet=consecutive(0x10),
)
FLAGS.row(0, "Program Running", R, FAST, "Set while the program runs.")
FLAGS.row(1, "Program Dwelling", R, FAST, "Set during a DWL command.")
FLAGS.row(2, "Program Inhibited", R, FAST, "Set while suspended by INH or IHPOS.")
FLAGS.row(
    3,
    "Move Pending",
    R,
    doc="Internal: the block being processed contains a move that starts at block end.",
)
FLAGS.row(4, "Program Timeout", R, FAST, "Set if IHPOS times out; cleared by the next IHPOS.")
FLAGS.row(5, "Program Modified", R, FAST, "Set when program lines change; cleared by running.")
FLAGS.row(8, "Run Request Flag", RW, SLOW, "Runs the program; self clearing.")
FLAGS.row(9, "Halt Request Flag", RW, SLOW, "Halts the program; self clearing.")
FLAGS.row(
    12, "Trace Mode Enable", RW, FAST, "Set by TRON, cleared by TROFF; may be driven by hand."
)
FLAGS.row(16, "Block Control", RW, SLOW, "Set by BLK, cleared by AUT; may be driven by hand.")
FLAGS.row(17, "Block Edge Detect", R, SLOW, "Previous state of Block Control.")
FLAGS.row(
    18,
    "Block Mode",
    R,
    FAST,
    "Set when block mode is in force, after feedhold if a master is attached.",
)
FLAGS.row(19, "Block Mode Waiting", R, FAST, "Set while waiting for STEP.")
FLAGS.row(20, "Step First Block", R, FAST, "Set on entering block mode, cleared by the first step.")
FLAGS.row(21, "Step Request Flag", RW, SLOW, "Set by STEP; executes the next line in block mode.")
FLAGS.row(22, "Step Control", RW, SLOW, "Rising edge sets the step request.")
FLAGS.row(23, "Step Edge Detect", R, SLOW, "Previous state of Step Control.")
FLAGS.row(24, "Pause Control", RW, SLOW, "Set by PAUSE, cleared by RESUME; may be driven by hand.")
FLAGS.row(25, "Pause Edge Detect", R, SLOW, "Previous state of Pause Control.")
FLAGS.row(
    26, "Pause Mode", R, FAST, "Set when pause is in force, after feedhold if a master is attached."
)
FLAGS.row(27, "Pause Mode Waiting", R, FAST, "Set while waiting for RESUME.")

BLOCKS = (PROGRAM,)
FLAG_BLOCKS = (FLAGS,)
