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
from openacr.kernel.axis.feedback_cy import ENCODER_COUNT, encoder_shaft
from openacr.map.rows import axes, commutators, dacs, encoders
from openacr.map.words import cmf, ef
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
    if not 0 <= k < dacs.COUNT:
        return
    counts: float = (volts + S[dacs.dac_offset[k]]) * S[dacs.dac_gain[k]]
    counts = max(-COUNTS_MAX, min(COUNTS_MAX, counts))
    S[dacs.dac_output[k]] = counts * VOLTS_PER_COUNT


def phase_shape(angle_deg: float, sinusoidal: int) -> float:
    """Sine of an angle, or the step of its sector of 60 degrees."""
    if sinusoidal:
        return sin(angle_deg * DEGREE)
    turned_deg: float = fmod(angle_deg, TURN)
    if turned_deg < 0.0:
        turned_deg += TURN
    sector: int = int(floor(turned_deg / SECTOR))
    if sector == 2 or sector >= 5:
        return 0.0
    return 1.0 if sector < 2 else -1.0


def counts_per_turn(I: I32, c: int, e: int) -> float:
    """Counts of the feedback encoder in one revolution of the motor; 1 where none are known."""
    counts: float = fabs(1.0 * I[commutators.pulseperrevolution[c]] * I[encoders.mult[e]])
    return counts if counts > 0.0 else 1.0


def commutator_guard(I: I32, S: F32, n: int, c: int, e: int, rpm: float) -> None:
    """Turn commutator c of axis n off for what is wrong with its motor."""
    word: int = cmf.word[c]
    found: int = 0
    if S[commutators.maxmotorrpm[c]] > 0.0 and fabs(rpm) > S[commutators.maxmotorrpm[c]]:
        found = cmf.CMT_MOTOR_OVERSPEED
    broken: int = I[ef.word[e]] & (ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST)
    if broken and not I[word] & cmf.CMT_ENCCHECK_DISABLE:
        found = found | cmf.CMT_ENCODER_FAULT
    error_cnt: float = fabs(1.0 * I[axes.following_error[n]])
    if I[commutators.maxfollowingerr[c]] > 0 and error_cnt > I[commutators.maxfollowingerr[c]]:
        found = found | cmf.CMT_FOLLOWING_ERROR
    if found:
        I[word] = (I[word] | found) & ~cmf.CMT_COMMUTATOR_ON


def commutator_signal(S: F32, c: int, volts: float) -> float:
    """What the phases get of the command: no more than the highest current allows."""
    scale: float = S[commutators.commandcurrentscale[c]]
    most_a: float = S[commutators.maxmotorcurrent[c]]
    if scale > 0.0:
        if most_a > 0.0:
            volts = max(-most_a / scale, min(most_a / scale, volts))
        S[commutators.commandcurrent[c]] = volts * scale
    return volts


def commutator_step(I: I32, S: F32, n: int, c: int, volts: float) -> None:
    """Put the output of axis n out through commutator c."""
    word: int = cmf.word[c]
    e: int = I[commutators.feedbackencoder[c]]
    first_v: float = 0.0
    second_v: float = 0.0
    S[commutators.commandsignal[c]] = volts
    if 0 <= e < ENCODER_COUNT - 8 and I[word] & cmf.CMT_COMMUTATOR_ON:
        turn_cnt: float = counts_per_turn(I, c, e)
        position_cnt: float = encoder_shaft(I, e)
        rpm: float = SECTOR * I[encoders.encoder_velocity[e]] / turn_cnt
        I[commutators.encodershaftposition[c]] = int(fmod(position_cnt, turn_cnt))
        S[commutators.averagevelocity[c]] = rpm
        commutator_guard(I, S, n, c, e, rpm)
        if I[word] & cmf.CMT_COMMUTATOR_ON:
            shift_cnt: float = I[commutators.phasemarkeroffset[c]]
            share: float = (
                (position_cnt + shift_cnt) * I[commutators.elecrevpermechrev[c]] / turn_cnt
            )
            angle_deg: float = TURN * (share - floor(share))
            kind: int = I[word] & cmf.CMT_SINUSOIDAL_ON
            other_deg: float = angle_deg + I[commutators.anglebetweenphases[c]]
            S[commutators.lookedupphaseasine[c]] = phase_shape(angle_deg, kind)
            S[commutators.lookedupphasebsine[c]] = phase_shape(other_deg, kind)
            signal_v: float = commutator_signal(S, c, volts)
            first_v = signal_v * S[commutators.lookedupphaseasine[c]] * S[commutators.phaseagain[c]]
            second_v = (
                signal_v * S[commutators.lookedupphasebsine[c]] * S[commutators.phasebgain[c]]
            )
            first_v += S[commutators.phaseaoffset[c]]
            second_v += S[commutators.phaseboffset[c]]
    S[commutators.phaseasignal[c]] = first_v
    S[commutators.phasebsignal[c]] = second_v
    dac_put(S, I[commutators.phaseadacchannel[c]], first_v)
    dac_put(S, I[commutators.phasebdacchannel[c]], second_v)
