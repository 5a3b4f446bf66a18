"""Fast status: parameters the card copies to the host at a fixed period."""

from openacr.map.block import LONG, RW, Block, FlagBlock, Span, consecutive, sixteen_apart

FSTAT = Block(
    "Miscellaneous Parameters: FSTAT Information",
    object="FSTAT",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
FSTAT.row(0x90, "FSTAT Period", LONG)
FSTAT.row(0x91, "FSTAT Count", LONG)

FSTAT_SETUP = Block(
    "FSTAT Setup Parameters",
    object="FSTAT",
    prefix="FST",
    spans=(Span(7424, 10),),
    stride=16,
    packet=sixteen_apart,
)
FSTAT_SETUP.row(0x03, "FSTAT Code", LONG)
FSTAT_SETUP.row(0x04, "FSTAT Index", LONG)
FSTAT_SETUP.row(0x05, "FSTAT Type", LONG)

FSTAT_FLAGS = FlagBlock(
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
FSTAT_FLAGS.row(
    0, "FSTAT ON", RW, doc="Set while FSTAT runs; clearing stops it; not to be set directly."
)
FSTAT_FLAGS.row(
    1, "FSTAT ON REQUEST", RW, doc="Loads the FSTAT parameters and starts FSTAT; self clearing."
)

BLOCKS = (FSTAT, FSTAT_SETUP)
FLAG_BLOCKS = (FSTAT_FLAGS,)
