"""User programs: line number and state flags."""

from openacr.map.block import FAST, LONG, NS, RW, SLOW, Block, R, Span, consecutive, sixteen_apart
from openacr.map.flag_block import FlagBlock

PROGRAM = Block(
    "Program Parameters",
    object="PROG",
    prefix="PROG",
    family="programs",
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
FLAGS.row(0, "Program Running", R, "Set while the program runs.", FAST)
FLAGS.row(1, "Program Dwelling", R, "Set during a DWL command.", FAST)
FLAGS.row(2, "Program Inhibited", R, "Set while suspended by INH or IHPOS.", FAST)
FLAGS.row(3, "Move Pending", R, "The block being executed contains a move.")
FLAGS.row(4, "Program Timeout", R, "Set if IHPOS times out; cleared by the next IHPOS.", FAST)
FLAGS.row(5, "Program Modified", R, "Set when program lines change; cleared by running.", FAST)
FLAGS.row(8, "Run Request Flag", RW, "Runs the program; self clearing.", SLOW)
FLAGS.row(9, "Halt Request Flag", RW, "Halts the program; self clearing.", SLOW)
FLAGS.row(12, "Trace Mode Enable", RW, "Follows TRON and TROFF; may be written.", FAST)
FLAGS.row(16, "Block Control", RW, "Follows BLK and AUT; may be written.", SLOW)
FLAGS.row(17, "Block Edge Detect", R, "Previous state of Block Control.", SLOW)
FLAGS.row(18, "Block Mode", R, "Block mode is in force, motion held.", FAST)
FLAGS.row(19, "Block Mode Waiting", R, "Set while waiting for STEP.", FAST)
FLAGS.row(20, "Step First Block", R, "Set on entering block mode, cleared by the first step.", FAST)
FLAGS.row(21, "Step Request Flag", RW, "Set by STEP; executes the next line in block mode.", SLOW)
FLAGS.row(22, "Step Control", RW, "Rising edge sets the step request.", SLOW)
FLAGS.row(23, "Step Edge Detect", R, "Previous state of Step Control.", SLOW)
FLAGS.row(24, "Pause Control", RW, "Follows PAUSE and RESUME; may be written.", SLOW)
FLAGS.row(25, "Pause Edge Detect", R, "Previous state of Pause Control.", SLOW)
FLAGS.row(26, "Pause Mode", R, "Pause is in force, motion held.", FAST)
FLAGS.row(27, "Pause Mode Waiting", R, "Set while waiting for RESUME.", FAST)

BLOCKS = (PROGRAM,)
FLAG_BLOCKS = (FLAGS,)
