"""User variables: numbered storage without a meaning of its own."""

from openacr.map.block import FP32, FP64, LONG, RW, Block, ManualRef, Span

VARIABLES = Block(
    "User Parameters",
    object="USER",
    prefix="USRD",
    family="variables",
    spans=(Span(0, 4096),),
    stride=1,
    indexed=False,
)
VARIABLES.row(
    0, "User Variable", FP64, RW, "", "Shared by all programs; as many exist as DIM P reserved."
)

INTEGERS = Block(
    "User Integer Parameters",
    object="USER",
    prefix="USRI",
    family="user_integers",
    spans=(Span(38912, 256),),
    stride=1,
    ref=ManualRef.KNOWLEDGE_BASE,
)
INTEGERS.row(0, "User Integer", LONG, RW, "", "Shared by all programs; always there.")

FLOATS = Block(
    "User Float Parameters",
    object="USER",
    prefix="USRS",
    family="user_floats",
    spans=(Span(39168, 256),),
    stride=1,
    ref=ManualRef.KNOWLEDGE_BASE,
)
FLOATS.row(0, "User Float", FP32, RW, "", "Shared by all programs; always there.")

BLOCKS = (VARIABLES, INTEGERS, FLOATS)
