"""PLC programs and their timers, counters and latches."""

from openacr.map.block import FAST, LONG, NS, RW, SLOW, Block, R, Span, consecutive, sixteen_apart
from openacr.map.flag_block import FlagBlock

PLC = Block(
    "PLC Parameters",
    object="PLC",
    prefix="PLC",
    family="plcs",
    spans=(Span(6656, 8),),
    stride=16,
    packet=sixteen_apart,
)
PLC.row(0x00, "Tick Preload", LONG, NS, "tick", "Servo periods from scan to scan.", default=1)
PLC.row(0x01, "Tick Count", LONG, NS, "tick", "Servo periods left until the next scan.")
PLC.reserved(LONG, (0x02, 0x03))

TIMER = Block(
    "PLC Parameters",
    object="TIM",
    prefix="TIM",
    family="plc_timers",
    spans=(Span(6656, 8),),
    stride=16,
    packet=sixteen_apart,
)
TIMER.row(0x04, "Timer Preload", LONG, NS, "ms", "Time from input to output.")
TIMER.row(0x05, "Timer Count", LONG, NS, "ms", "Time left until the output is set.")

COUNTER = Block(
    "PLC Parameters",
    object="CNT",
    prefix="CNT",
    family="plc_counters",
    spans=(Span(6656, 8),),
    stride=16,
    packet=sixteen_apart,
)
COUNTER.row(0x06, "Counter Preload", LONG, NS, "", "Clock edges until the output is set.")
COUNTER.row(0x07, "Counter Count", LONG, NS, "", "Clock edges left.")

FLAGS = FlagBlock(
    "PLC Flags",
    object="PLC",
    prefix="PLF",
    spans=(Span(4144, 8),),
    word_name="PLC {n} Flags",
    packet=consecutive(0x10),
    parts=((0, "PLC"), (8, "STEPPER"), (16, "TIM"), (20, "CNT"), (24, "KR")),
)
FLAGS.row(0, "PLC Running", R, "Set while the PLC program runs.", FAST)
FLAGS.row(1, "First Scan", R, "Set during the first scan only.", FAST)
FLAGS.row(2, "Run Request", RW, "Runs the PLC; self clearing.", SLOW)
FLAGS.row(3, "Halt Request", RW, "Halts the PLC; self clearing.", SLOW)
FLAGS.row(8, "Stepper Direction", RW, "Inverts the direction output of the stepper module.", FAST)
FLAGS.row(9, "Stepper Low Power", RW, "Activates the low-power output of the stepper module.", FAST)
FLAGS.row(16, "Timer Output", R, "The count is zero; clears with the input.", FAST)
FLAGS.row(17, "Timer Input", RW, "Set: counts down; clear: reloads.", FAST)
FLAGS.row(
    20, "Counter Output", R, "Set when the count reaches zero, until counter reset is set.", FAST
)
FLAGS.row(21, "Counter Clock", RW, "Rising edge decrements the counter.", FAST)
FLAGS.row(
    22, "Counter Reset", RW, "While set, clears the counter output and blocks its clock.", FAST
)
FLAGS.row(28, "Latch Output", R, "Latched by Latch Set, cleared by Latch Reset.", FAST)
FLAGS.row(29, "Latch Set", RW, "Sets the latch output.", FAST)
FLAGS.row(30, "Latch Reset", RW, "Clears the latch output and blocks Latch Set while set.", FAST)

BLOCKS = (PLC, TIMER, COUNTER)
FLAG_BLOCKS = (FLAGS,)
