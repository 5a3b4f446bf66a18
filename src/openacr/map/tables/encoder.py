"""Encoders and the stepper outputs that share their address range."""

from openacr.map.block import (
    FP32,
    LONG,
    UNDOCUMENTED,
    Block,
    FlagBlock,
    R,
    Span,
    consecutive,
    sixteen_apart,
)

ENCODER = Block(
    "Object Parameters: ENC",
    object="ENC",
    prefix="ENC",
    spans=(Span(6144, 16), Span(24576, 8)),
    stride=16,
    packet=sixteen_apart,
    named=20,
)
ENCODER.row(0x00, "Encoder Position", LONG, doc="Present encoder position.")
ENCODER.row(0x01, "Encoder Velocity", LONG)
ENCODER.reserved(LONG, (0x02, 0x03))
ENCODER.row(0x04, "ABS Revolution", LONG)
ENCODER.reserved(LONG, range(0x05, 0x08))

STEPPER = Block(
    "Object Parameters: STEPPER",
    object="STEPPER",
    prefix="STPR",
    spans=(Span(6144, 16), Span(24576, 8)),
    stride=16,
    packet=sixteen_apart,
    named=20,
)
STEPPER.row(0x08, "Stepper Signal", FP32)
STEPPER.reserved(FP32, (0x09,))
STEPPER.row(0x0A, "Stepper Gain", FP32)
STEPPER.reserved(FP32, (0x0B,))
STEPPER.row(0x0C, "Stepper Count", LONG)
STEPPER.reserved(LONG, range(0x0D, 0x10))

ENCODER_FLAGS = FlagBlock(
    "Encoder Flags",
    object="ENC",
    prefix="EF",
    spans=(Span(4176, 24),),
    word_name="Encoder {n} Flags",
    packet=consecutive(0x10),
    named=20,
    rest=UNDOCUMENTED,
)
ENCODER_FLAGS.row(
    0,
    "Encoder Signal Fault",
    R,
    doc="Encoder fault seen by the FPGA; cleared by ENCx RES; ACR1200/8010 only.",
)
ENCODER_FLAGS.row(
    1,
    "Encoder Signal Lost",
    R,
    doc="Encoder fault seen by the check circuit; cleared by ENCx RES; ACR1200/8010 only.",
)
ENCODER_FLAGS.row(4, "ABS DATA Fault")
ENCODER_FLAGS.row(5, "ABS DATA Ready")
ENCODER_FLAGS.reserved(2, 3, 6, 7)
_RESERVED = FlagBlock(
    "Encoder Flags",
    object="",
    prefix="",
    spans=(Span(4200, 8),),
    word_name="Reserved",
    packet=consecutive(0x10),
    first_index=None,
)

BLOCKS = (ENCODER, STEPPER)
FLAG_BLOCKS = (ENCODER_FLAGS, _RESERVED)
