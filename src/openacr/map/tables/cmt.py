"""Sinusoidal commutators: P(16384 + 256 * commutator + row)."""

from openacr.map.block import (
    FP32,
    LONG,
    RW,
    UNDOCUMENTED,
    Block,
    R,
    Span,
    consecutive,
    objects_apart,
)
from openacr.map.flag_block import FlagBlock, reserved_words

COMMUTATOR = Block(
    "CMT Parameters",
    object="CMT",
    prefix="CMT",
    family="commutators",
    spans=(Span(16384, 8),),
    stride=256,
    packet=objects_apart,
)
COMMUTATOR.row(0x00, "FeedBackEncoder", LONG, RW, "", "Number of the feedback encoder.")
COMMUTATOR.row(0x01, "AngleBetweenPhases", LONG, RW, "deg", "Phase B minus phase A.", default=120)
COMMUTATOR.row(
    0x02, "EncoderShaftPosition", LONG, R, "pulse", "Counts since the last marker pulse."
)
COMMUTATOR.row(0x03, "PhaseADacChannel", LONG, RW, "", "DAC of phase A.")
COMMUTATOR.row(0x04, "PhaseBDacChannel", LONG, RW, "", "DAC of phase B.", default=1)
COMMUTATOR.row(
    0x05, "PulsePerRevolution", LONG, RW, "pulse/rev", "Encoder pulses before multiplication."
)
COMMUTATOR.row(0x06, "PhaseAADCCChannel", LONG, RW, "", "ADC of phase A.")
COMMUTATOR.row(0x07, "PhaseBADCCChannel", LONG, RW, "", "ADC of phase B.")
COMMUTATOR.row(
    0x08, "PhaseMarkerOffset", LONG, RW, "pulse", "Added to the count before the sine table."
)
COMMUTATOR.row(
    0x09, "ElecRevPerMechRev", LONG, RW, "", "Electrical cycles per revolution.", default=1
)
COMMUTATOR.row(0x0A, "HallEffectChannel", LONG, RW, "", "Hall inputs; the feedback encoder: none.")
COMMUTATOR.reserved(LONG, range(0x0B, 0x0E))
COMMUTATOR.row(0x0E, "MaxFollowingErr", LONG, RW, "pulse", "Beyond this the commutator turns off.")
COMMUTATOR.row(0x0F, "CommutationRegion", LONG, RW, "", "Present reading of the Hall signals.")
COMMUTATOR.row(0x10, "CommandSignal", FP32, R, "V", "Output of the servo loop.")
COMMUTATOR.row(0x11, "CommandField", FP32)
COMMUTATOR.row(
    0x12,
    "SineIndexPerEncCount",
    FP32,
    R,
    "",
    "Sine table steps per encoder count.",
    erratum="The printed text is that of EncoderShaftPosition.",
)
COMMUTATOR.row(0x13, "PhaseAdvance", FP32)
COMMUTATOR.row(0x14, "LookedUpPhaseASine", FP32, R, "", "Sine value of phase A.")
COMMUTATOR.row(0x15, "LookedUpPhaseBSine", FP32, R, "", "Sine value of phase B.")
COMMUTATOR.row(0x16, "CommandCurrentScale", FP32, RW, "A/V", "Current amplitude of one volt.")
COMMUTATOR.row(0x17, "FeedbackCurrentScale", FP32)
COMMUTATOR.row(0x18, "PhaseASignal", FP32, R, "V", "Signal of phase A.")
COMMUTATOR.row(0x19, "PhaseBSignal", FP32, R, "V", "Signal of phase B.")
COMMUTATOR.row(0x1A, "PhaseAOffset", FP32, RW, "V", "Added to phase A.")
COMMUTATOR.row(0x1B, "PhaseBOffset", FP32, RW, "V", "Added to phase B.")
COMMUTATOR.row(0x1C, "PhaseAGain", FP32, RW, "", "Factor on phase A.", default=1)
COMMUTATOR.row(0x1D, "PhaseBGain", FP32, RW, "", "Factor on phase B.", default=1)
COMMUTATOR.row(0x1E, "MaxMotorRPM", FP32, RW, "1/min", "Highest speed of the motor.")
COMMUTATOR.row(0x1F, "MaxMotorCurrent", FP32, RW, "A", "Highest current of the motor.")
COMMUTATOR.row(0x20, "MaxMotorCurrentNeg", FP32)
COMMUTATOR.row(0x21, "AverageVelocity", FP32, R, "", "Average speed.")
COMMUTATOR.row(0x22, "CommandCurrent", FP32)
COMMUTATOR.reserved(FP32, range(0x23, 0x28))

FLAGS = FlagBlock(
    "CMT Flags",
    object="CMT",
    prefix="CMF",
    spans=(Span(4208, 8),),
    word_name="CMT {n} Flags",
    packet=consecutive(0x10),
    rest=UNDOCUMENTED,
)
FLAGS.row(0, "CMT Commutator ON", R, "Set while the commutator is on.")
FLAGS.row(1, "CMT Sinusoidal ON", R, "Set in sinusoidal mode.")
FLAGS.row(2, "CMT Motor Overspeed", R, "Overspeed detected; commutator turns off.")
FLAGS.row(3, "CMT Encoder Fault", R, "Encoder fault; turns the commutator off if checked.")
FLAGS.row(4, "CMT EncCheck Disable", RW, "Set: an encoder fault does not turn it off.")
FLAGS.row(
    5, "CMT Following Error", R, "Following error above MaxFollowingErr; commutator turns off."
)
FLAGS.reserved(6, 7)

BLOCKS = (COMMUTATOR,)
FLAG_BLOCKS = (FLAGS, reserved_words("CMT Flags", Span(4216, 8)))
