"""Encoders and the stepper outputs that share their address range."""

from openacr.map.block import (
    FP32,
    LONG,
    NS,
    UNDOCUMENTED,
    Block,
    R,
    Span,
    consecutive,
    sixteen_apart,
)
from openacr.map.flag_block import FlagBlock, reserved_words

ENCODER = Block(
    "Object Parameters: ENC",
    object="ENC",
    prefix="ENC",
    family="encoders",
    spans=(Span(6144, 16), Span(24576, 8)),
    stride=16,
    packet=sixteen_apart,
    named=20,
)
ENCODER.row(0x00, "Encoder Position", LONG, NS, "pulse", "Present position of the encoder.")
ENCODER.row(0x01, "Encoder Velocity", LONG, NS, "pulse/tick", "Pulses in the last servo period.")
ENCODER.reserved(LONG, (0x02, 0x03))
ENCODER.row(0x04, "ABS Revolution", LONG, NS, "rev", "Turn counter of an absolute encoder.")
ENCODER.reserved(LONG, range(0x05, 0x08))

STEPPER = Block(
    "Object Parameters: STEPPER",
    object="STEPPER",
    prefix="STPR",
    family="steppers",
    spans=(Span(6144, 16), Span(24576, 8)),
    stride=16,
    packet=sixteen_apart,
    named=20,
)
STEPPER.row(0x08, "Stepper Signal", FP32, NS, "V", "Servo output driving the stepper.")
STEPPER.reserved(FP32, (0x09,))
STEPPER.row(
    0x0A,
    "Stepper Gain",
    FP32,
    NS,
    "",
    "Factor on the stepper signal.",
    erratum="Appendix A prints Reserved; chapter 6 names it.",
)
STEPPER.reserved(FP32, (0x0B,))
STEPPER.row(0x0C, "Stepper Count", LONG, NS, "pulse", "Steps sent so far.")
STEPPER.reserved(LONG, range(0x0D, 0x10))

FLAGS = FlagBlock(
    "Encoder Flags",
    object="ENC",
    prefix="EF",
    spans=(Span(4176, 24),),
    word_name="Encoder {n} Flags",
    packet=consecutive(0x10),
    named=20,
    word_erratum="For encoders 16 to 23 the flag table prints packet index 0x0B; it is 0x0C.",
    word_erratum_from=16,
    rest=UNDOCUMENTED,
)
FLAGS.row(0, "Encoder Signal Fault", R, "Signals out of order (ACR1200, 8010); ENC RES clears it.")
FLAGS.row(1, "Encoder Signal Lost", R, "Signals missing (ACR1200, 8010); ENC RES clears it.")
FLAGS.row(4, "ABS DATA Fault")
FLAGS.row(5, "ABS DATA Ready")
FLAGS.reserved(2, 3, 6, 7)

BLOCKS = (ENCODER, STEPPER)
FLAG_BLOCKS = (FLAGS, reserved_words("Encoder Flags", Span(4200, 8)))
