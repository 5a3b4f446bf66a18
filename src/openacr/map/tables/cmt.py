"""Sinusoidal commutators."""

from openacr.map.block import (
    FP32,
    LONG,
    RW,
    UNDOCUMENTED,
    Block,
    FlagBlock,
    R,
    Span,
    consecutive,
    objects_apart,
)

COMMUTATOR = Block(
    "CMT Parameters",
    object="CMT",
    prefix="CMT",
    spans=(Span(16384, 8),),
    stride=256,
    packet=objects_apart,
)
COMMUTATOR.row(0x00, "FeedBackEncoder", LONG, RW, "Feedback encoder channel.")
COMMUTATOR.row(0x01, "AngleBetweenPhases", LONG, RW, "Phase difference between phases B and A.")
COMMUTATOR.row(
    0x02, "EncoderShaftPosition", LONG, R, "Feedback encoder position; the marker pulse resets it."
)
COMMUTATOR.row(0x03, "PhaseADacChannel", LONG, RW, "DAC channel of phase A.")
COMMUTATOR.row(0x04, "PhaseBDacChannel", LONG, RW, "DAC channel of phase B.")
COMMUTATOR.row(
    0x05, "PulsePerRevolution", LONG, RW, "Encoder counts per revolution before multiplication."
)
COMMUTATOR.row(0x06, "PhaseAADCCChannel", LONG, RW, "ADC channel of phase A.")
COMMUTATOR.row(0x07, "PhaseBADCCChannel", LONG, RW, "ADC channel of phase B.")
COMMUTATOR.row(
    0x08,
    "PhaseMarkerOffset",
    LONG,
    RW,
    "Sinusoidal mode only: added to encoder counts to index the sine table.",
)
COMMUTATOR.row(0x09, "ElecRevPerMechRev", LONG, RW, "Electrical cycles per mechanical revolution.")
COMMUTATOR.row(
    0x0A,
    "HallEffectChannel",
    LONG,
    RW,
    "Hall input channel; equal to the feedback encoder in hall-less mode.",
)
COMMUTATOR.reserved(LONG, range(0x0B, 0x0E))
COMMUTATOR.row(
    0x0E, "MaxFollowingErr", LONG, RW, "Following error above this turns the commutator off."
)
COMMUTATOR.row(0x0F, "CommutationRegion", LONG, RW, "Hall effect signal reading.")
COMMUTATOR.row(0x10, "CommandSignal", FP32, R, "Servo loop output.")
COMMUTATOR.row(0x11, "CommandField", FP32)
COMMUTATOR.row(
    0x12,
    "SineIndexPerEncCount",
    FP32,
    R,
    "Printed text repeats that of the encoder shaft position.",
)
COMMUTATOR.row(0x13, "PhaseAdvance", FP32)
COMMUTATOR.row(0x14, "LookedUpPhaseASine", FP32, R, "Sine value of phase A.")
COMMUTATOR.row(0x15, "LookedUpPhaseBSine", FP32, R, "Sine value of phase B.")
COMMUTATOR.row(0x16, "CommandCurrentScale", FP32, RW, "Current amplitude equivalent to one volt.")
COMMUTATOR.row(0x17, "FeedbackCurrentScale", FP32)
COMMUTATOR.row(0x18, "PhaseASignal", FP32, R, "Signal of phase A.")
COMMUTATOR.row(0x19, "PhaseBSignal", FP32, R, "Signal of phase B.")
COMMUTATOR.row(0x1A, "PhaseAOffset", FP32, RW, "Offset of phase A.")
COMMUTATOR.row(0x1B, "PhaseBOffset", FP32, RW, "Offset of phase B.")
COMMUTATOR.row(0x1C, "PhaseAGain", FP32, RW, "Signal gain of phase A.")
COMMUTATOR.row(0x1D, "PhaseBGain", FP32, RW, "Signal gain of phase B.")
COMMUTATOR.row(0x1E, "MaxMotorRPM", FP32, RW, "Highest motor speed.")
COMMUTATOR.row(0x1F, "MaxMotorCurrent", FP32, RW, "Highest motor current.")
COMMUTATOR.row(0x20, "MaxMotorCurrentNeg", FP32)
COMMUTATOR.row(0x21, "AverageVelocity", FP32, R, "Average velocity.")
COMMUTATOR.row(0x22, "CommandCurrent", FP32)
COMMUTATOR.reserved(FP32, range(0x23, 0x28))

COMMUTATOR_FLAGS = FlagBlock(
    "CMT Flags",
    object="CMT",
    prefix="CMF",
    spans=(Span(4208, 8),),
    word_name="CMT {n} Flags",
    packet=consecutive(0x10),
    rest=UNDOCUMENTED,
)
COMMUTATOR_FLAGS.row(0, "CMT Commutator ON", R, doc="Set while the commutator is on.")
COMMUTATOR_FLAGS.row(1, "CMT Sinusoidal ON", R, doc="Set in sinusoidal mode.")
COMMUTATOR_FLAGS.row(2, "CMT Motor Overspeed", R, doc="Overspeed detected; commutator turns off.")
COMMUTATOR_FLAGS.row(
    3,
    "CMT Encoder Fault",
    R,
    doc="Encoder fault; commutator turns off unless the encoder check is disabled.",
)
COMMUTATOR_FLAGS.row(
    4,
    "CMT EncCheck Disable",
    RW,
    doc="Clear (default): encoder fault turns the commutator off; set: it does not.",
)
COMMUTATOR_FLAGS.row(
    5, "CMT Following Error", R, doc="Following error above MaxFollowingErr; commutator turns off."
)
COMMUTATOR_FLAGS.reserved(6, 7)
_RESERVED = FlagBlock(
    "CMT Flags",
    object="",
    prefix="",
    spans=(Span(4216, 8),),
    word_name="Reserved",
    packet=consecutive(0x10),
    first_index=None,
)

BLOCKS = (COMMUTATOR,)
FLAG_BLOCKS = (COMMUTATOR_FLAGS, _RESERVED)
