"""Fast status: parameters the card copies to the host at a fixed period."""

from openacr.map.block import LONG, NS, RW, Block, Span, consecutive, sixteen_apart
from openacr.map.flag_block import FlagBlock

FSTAT = Block(
    "Miscellaneous Parameters: FSTAT Information",
    object="FSTAT",
    prefix="",
    spans=(Span(7056, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
FSTAT.row(0, "FSTAT Period", LONG, NS, "ms", "Time from copy to copy.", default=50)
FSTAT.row(1, "FSTAT Count", LONG, NS, "", "Copies made so far.")

FSTAT_SETUP = Block(
    "FSTAT Setup Parameters",
    object="FSTAT",
    prefix="FST",
    family="fast_status",
    spans=(Span(7424, 10),),
    stride=16,
    packet=sixteen_apart,
    packet_erratum="Appendix A lacks this table; the numbers follow from packet group 0x1D.",
)
FSTAT_SETUP.row(3, "FSTAT Code", LONG, NS, "", "Packet group code to copy.")
FSTAT_SETUP.row(4, "FSTAT Index", LONG, NS, "", "Packet group index to copy.")
FSTAT_SETUP.row(5, "FSTAT Type", LONG, NS, "", "How to copy: 0 LONG, 1 FP32.")

FLAGS = FlagBlock(
    "FSTAT Flags",
    object="FSTAT",
    prefix="FSF",
    spans=(Span(4278, 1),),
    word_name="FSTAT",
    packet=consecutive(0x10),
    first_index=None,
    group="Misc Control Flags",
    ident="FSTAT",
    rest="Spare",
)
FLAGS.row(0, "FSTAT ON", RW, "Set while FSTAT runs; clearing stops it; not to be set directly.")
FLAGS.row(1, "FSTAT ON REQUEST", RW, "Loads the FSTAT parameters and starts FSTAT; self clearing.")

BLOCKS = (FSTAT, FSTAT_SETUP)
FLAG_BLOCKS = (FLAGS,)
