"""Commutators: one axis output shared out to the two phases of a brushless motor.

    electrical angle  th = 360 * ERPMR * (position + SHIFT) / (PPR * |MULT|)        [degrees]
    phase A = u * sin(th) * gain A + offset A,   phase B = u * sin(th + ANG) * ...

u is the output of the servo loop. The position counts from power-up: wherever RES and ROTARY put
the zero of the encoder, the magnets stay where they are. In trapezoidal mode the sine gives way
to its six steps of 60 degrees: two at +1, one at 0, two at -1, one at 0. Too much speed, a fault
of the encoder (unless it is not checked) or too large a following error turn a commutator off:
both phases are 0 V.
"""

from openacr.cmath import fabs, floor, fmod, sin
from openacr.kernel.feedback_cy import ENCODER_COUNT, encoder_row, encoder_shaft
from openacr.map.numbers import (
    AX_BASE,
    AX_FOLLOWING_ERROR,
    AX_STRIDE,
    CMF_CMT_COMMUTATOR_ON,
    CMF_CMT_ENCCHECK_DISABLE,
    CMF_CMT_ENCODER_FAULT,
    CMF_CMT_FOLLOWING_ERROR,
    CMF_CMT_MOTOR_OVERSPEED,
    CMF_CMT_SINUSOIDAL_ON,
    CMF_WORD,
    CMT_ANGLEBETWEENPHASES,
    CMT_AVERAGEVELOCITY,
    CMT_BASE,
    CMT_COMMANDCURRENT,
    CMT_COMMANDCURRENTSCALE,
    CMT_COMMANDSIGNAL,
    CMT_ELECREVPERMECHREV,
    CMT_ENCODERSHAFTPOSITION,
    CMT_FEEDBACKENCODER,
    CMT_LOOKEDUPPHASEASINE,
    CMT_LOOKEDUPPHASEBSINE,
    CMT_MAXFOLLOWINGERR,
    CMT_MAXMOTORCURRENT,
    CMT_MAXMOTORRPM,
    CMT_PHASEADACCHANNEL,
    CMT_PHASEAGAIN,
    CMT_PHASEAOFFSET,
    CMT_PHASEASIGNAL,
    CMT_PHASEBDACCHANNEL,
    CMT_PHASEBGAIN,
    CMT_PHASEBOFFSET,
    CMT_PHASEBSIGNAL,
    CMT_PHASEMARKEROFFSET,
    CMT_PULSEPERREVOLUTION,
    CMT_STRIDE,
    DAC_BASE,
    DAC_DAC_GAIN,
    DAC_DAC_OFFSET,
    DAC_DAC_OUTPUT,
    DAC_STRIDE,
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    ENC_ENCODER_VELOCITY,
    ENI_BASE,
    ENI_MULT,
    ENI_STRIDE,
)
from openacr.views import F32, I32

__all__ = ["commutator_step", "phase_shape"]

DAC_COUNT = 16
VOLTS_PER_COUNT = 1.0 / 3276.8
COUNTS_MAX = 32767.0
DEGREE = 0.017453292519943295
TURN = 360.0
SECTOR = 60.0


def dac_put(S: F32, k: int, volts: float) -> None:
    """Output stage of converter k: (volts + OFFSET) GAIN counts within its range."""
    if not 0 <= k < DAC_COUNT:
        return
    d: int = DAC_BASE + k * DAC_STRIDE
    counts: float = (volts + S[d + DAC_DAC_OFFSET]) * S[d + DAC_DAC_GAIN]
    counts = max(-COUNTS_MAX, min(COUNTS_MAX, counts))
    S[d + DAC_DAC_OUTPUT] = counts * VOLTS_PER_COUNT


def phase_shape(angle_deg: float, sinusoidal: int) -> float:
    """Sine of an angle, or the step of its sector of 60 degrees."""
    if sinusoidal:
        return sin(angle_deg * DEGREE)
    turned: float = fmod(angle_deg, TURN)
    if turned < 0.0:
        turned += TURN
    sector: int = int(floor(turned / SECTOR))
    if sector == 2 or sector >= 5:
        return 0.0
    return 1.0 if sector < 2 else -1.0


def counts_per_turn(I: I32, row: int, e: int) -> float:
    """Counts of the feedback encoder in one revolution of the motor; 1 where none are known."""
    counts: float = fabs(
        1.0 * I[row + CMT_PULSEPERREVOLUTION] * I[ENI_BASE + e * ENI_STRIDE + ENI_MULT]
    )
    return counts if counts > 0.0 else 1.0


def commutator_guard(I: I32, S: F32, n: int, c: int, e: int, rpm: float) -> None:
    """Turn commutator c of axis n off for what is wrong with its motor."""
    row: int = CMT_BASE + c * CMT_STRIDE
    word: int = CMF_WORD + c
    found: int = 0
    if S[row + CMT_MAXMOTORRPM] > 0.0 and fabs(rpm) > S[row + CMT_MAXMOTORRPM]:
        found = CMF_CMT_MOTOR_OVERSPEED
    broken: int = I[EF_WORD + e] & (EF_ENCODER_SIGNAL_FAULT | EF_ENCODER_SIGNAL_LOST)
    if broken and not I[word] & CMF_CMT_ENCCHECK_DISABLE:
        found = found | CMF_CMT_ENCODER_FAULT
    error: float = fabs(1.0 * I[AX_BASE + n * AX_STRIDE + AX_FOLLOWING_ERROR])
    if I[row + CMT_MAXFOLLOWINGERR] > 0 and error > I[row + CMT_MAXFOLLOWINGERR]:
        found = found | CMF_CMT_FOLLOWING_ERROR
    if found:
        I[word] = (I[word] | found) & ~CMF_CMT_COMMUTATOR_ON


def commutator_signal(S: F32, row: int, volts: float) -> float:
    """What the phases get of the command: no more than the highest current allows."""
    scale: float = S[row + CMT_COMMANDCURRENTSCALE]
    most: float = S[row + CMT_MAXMOTORCURRENT]
    if scale > 0.0:
        if most > 0.0:
            volts = max(-most / scale, min(most / scale, volts))
        S[row + CMT_COMMANDCURRENT] = volts * scale
    return volts


def commutator_step(I: I32, S: F32, n: int, c: int, volts: float) -> None:
    """Put the output of axis n out through commutator c."""
    row: int = CMT_BASE + c * CMT_STRIDE
    word: int = CMF_WORD + c
    e: int = I[row + CMT_FEEDBACKENCODER]
    first: float = 0.0
    second: float = 0.0
    S[row + CMT_COMMANDSIGNAL] = volts
    if 0 <= e < ENCODER_COUNT - 8 and I[word] & CMF_CMT_COMMUTATOR_ON:
        turn: float = counts_per_turn(I, row, e)
        position: float = encoder_shaft(I, e)
        rpm: float = SECTOR * I[encoder_row(e) + ENC_ENCODER_VELOCITY] / turn
        I[row + CMT_ENCODERSHAFTPOSITION] = int(fmod(position, turn))
        S[row + CMT_AVERAGEVELOCITY] = rpm
        commutator_guard(I, S, n, c, e, rpm)
        if I[word] & CMF_CMT_COMMUTATOR_ON:
            shift: float = I[row + CMT_PHASEMARKEROFFSET]
            share: float = (position + shift) * I[row + CMT_ELECREVPERMECHREV] / turn
            angle: float = TURN * (share - floor(share))
            kind: int = I[word] & CMF_CMT_SINUSOIDAL_ON
            other: float = angle + I[row + CMT_ANGLEBETWEENPHASES]
            S[row + CMT_LOOKEDUPPHASEASINE] = phase_shape(angle, kind)
            S[row + CMT_LOOKEDUPPHASEBSINE] = phase_shape(other, kind)
            signal: float = commutator_signal(S, row, volts)
            first = signal * S[row + CMT_LOOKEDUPPHASEASINE] * S[row + CMT_PHASEAGAIN]
            second = signal * S[row + CMT_LOOKEDUPPHASEBSINE] * S[row + CMT_PHASEBGAIN]
            first += S[row + CMT_PHASEAOFFSET]
            second += S[row + CMT_PHASEBOFFSET]
    S[row + CMT_PHASEASIGNAL] = first
    S[row + CMT_PHASEBSIGNAL] = second
    dac_put(S, I[row + CMT_PHASEADACCHANNEL], first)
    dac_put(S, I[row + CMT_PHASEBDACCHANNEL], second)
