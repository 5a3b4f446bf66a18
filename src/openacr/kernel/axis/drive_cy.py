"""Drive enable, drive fault and the motion enable input (ACR90x0 class).

Drive Enabled (quaternary flag 17) is a status: a command or a write of the flag starts
enabling, the flag follows 10 ms later. It stays clear, silently, while something bars the
drive. With the drive I/O off the flag follows at once and a fault input has no meaning.

An axis that was disabled (DRIVE OFF, Ctrl-Z, a kill or fault that disables, a cleared flag) puts
out nothing until it is enabled. One never enabled nor disabled since power-up is driven unless its
drive I/O is in use: programs for amplifiers without an enable line have no DRIVE ON.

A signal fault or loss of the encoder that closes the loop disables the axis: its drive drops and
all its motion is killed (KAMR). ENC RES clears the fault flags.
"""

from openacr.map.numbers import W_MISC_CONTROL_1
from openacr.map.rows import axes, encoders, motors
from openacr.map.words import af4, ef
from openacr.views import I32

__all__ = ["drive_barred", "drive_disable", "drive_driven", "drive_step", "motion_enable_step"]

MODELLED = 16
MEI_LATCHED = 8192  # BIT5645
MEI_OPEN = 16384  # BIT5646
MEI_RESET = 32768  # BIT5647
RESET_S = 0.05
TO_DAC = 0
TO_STEPPER = 1
STEPPER_MOTOR = 5  # kinds of a motor of the world
BUS_MOTOR = 7


def drive_driven(I: I32, n: int) -> bool:
    """Whether axis n is under power, as far as its drive is concerned."""
    flags: int = I[af4.word[n]]
    if flags & af4.DRIVE_ENABLED:
        return True
    return not flags & af4.DRIVE_I_O_ENABLE and not I[axes.switched_off[n]]


def drive_disable(I: I32, n: int) -> None:
    """Disable the drive of axis n, enabled or not."""
    I[af4.word[n]] &= ~(af4.DRIVE_ENABLED | af4.MOTOR_ON)
    I[axes.enable_ticks[n]] = 0
    if not I[axes.switched_off[n]]:
        I[axes.switched_off[n]] = 1
        I[axes.drive_wired[n]] = -1  # its enable line may be on without the flag


def drive_barred(I: I32, n: int) -> bool:
    """Whether something keeps the drive of axis n from being enabled."""
    if I[W_MISC_CONTROL_1] & (MEI_OPEN | MEI_LATCHED):
        return True
    return drive_faulted(I, n) or feedback_broken(I, n) != 0


def feedback_broken(I: I32, n: int) -> int:
    """1 while an encoder that axis n takes its position or velocity from has a signal fault."""
    e: int = I[axes.position_index[n]]
    found: int = 0
    if I[axes.position_source[n]] == 0 and 0 <= e < 24:
        found = I[ef.word[e]]
    e = I[axes.velocity_index[n]]
    if I[axes.velocity_source[n]] == 0 and 0 <= e < 24:
        found |= I[ef.word[e]]
    return 1 if found & (ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST) else 0


def encoder_faults(I: I32) -> int:
    """Not 0 while any encoder has a signal fault."""
    found: int = 0
    for e in range(encoders.COUNT):
        found |= I[ef.word[e]]
    return found & (ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST)


def drive_faulted(I: I32, n: int) -> bool:
    """Whether the fault input of axis n says so, with drive I/O in use."""
    flags: int = I[af4.word[n]]
    active: bool = flags & af4.DRIVE_FAULT_INPUT != 0
    inverted: bool = flags & af4.DRIVE_FAULT_LEVEL_INVERT != 0
    return flags & af4.DRIVE_I_O_ENABLE != 0 and active != inverted


def is_motor(I: I32, source: int, k: int) -> bool:
    """Whether feedback k of a kind is the encoder of a motor."""
    return source == 0 and 0 <= k < MODELLED and I[motors.kind[k]] != 0


def drive_motor(I: I32, n: int) -> int:
    """Motor that axis n drives, -1 if there is none.

    It is that of its position encoder, else of its velocity encoder (the other one counts the
    load), else the one on its analog or stepper output.
    """
    if is_motor(I, I[axes.position_source[n]], I[axes.position_index[n]]):
        return I[axes.position_index[n]]
    if is_motor(I, I[axes.velocity_source[n]], I[axes.velocity_index[n]]):
        return I[axes.velocity_index[n]]
    if I[axes.signal_source[n]] == TO_DAC or I[axes.signal_source[n]] == TO_STEPPER:
        wants_stepper: bool = I[axes.signal_source[n]] == TO_STEPPER
        for m in range(MODELLED):
            is_stepper: bool = I[motors.kind[m]] == STEPPER_MOTOR
            if I[motors.kind[m]] and I[motors.dac[m]] == I[axes.signal_index[n]]:
                if is_stepper == wants_stepper:
                    return m
    return -1


def drive_wiring(I: I32, n: int) -> None:
    """Read the fault line of the drive of axis n, if it has one, and drive its enable line."""
    k: int = drive_motor(I, n)
    I[axes.drive_motor[n]] = k
    if k < 0:
        return
    flags: int = I[af4.word[n]]
    if I[motors.drive_fault[k]]:
        flags |= af4.DRIVE_FAULT_INPUT
    elif (
        I[motors.fault_mask[k]] | I[motors.fault_report[k]]
    ):  # without a fault line the flag is the user's
        flags &= ~af4.DRIVE_FAULT_INPUT
    I[af4.word[n]] = flags
    I[motors.drive_enabled[k]] = 1 if drive_driven(I, n) else 0


def drive_resting(I: I32, n: int, faults: int) -> bool:
    """Whether nothing about the drive of axis n has changed since its last step.

    `faults` of encoders as `encoder_faults` has found them.
    """
    flags: int = I[af4.word[n]]
    k: int = I[axes.position_index[n]]
    broken: int = 0
    if faults:
        broken = feedback_broken(I, n)
    changed: int = (flags ^ I[axes.drive_seen[n]]) | (k ^ I[axes.drive_wired[n]])
    if changed | (broken ^ I[axes.feedback_broken[n]]) | I[axes.enable_ticks[n]]:
        return False
    k = I[axes.drive_motor[n]]
    if k < 0:
        return True
    shown: bool = flags & af4.DRIVE_FAULT_INPUT != 0
    if I[motors.drive_fault[k]]:
        return shown
    return not shown or not I[motors.fault_mask[k]] | I[motors.fault_report[k]]


def on_bus(I: I32, n: int) -> bool:
    """Whether the drive of axis n is on a bus: the bus sets its flag once the drive operates."""
    k: int = I[axes.drive_motor[n]]
    return k >= 0 and I[motors.kind[k]] == BUS_MOTOR


def drive_step(I: I32, n: int, period_s: float) -> None:
    """Follow the drive flags of axis n, unless its drive rests (`drive_resting`)."""
    word: int = af4.word[n]
    drive_request(I, n)
    if I[axes.enable_ticks[n]] > 0 and not on_bus(I, n):
        I[axes.enable_ticks[n]] -= 1
        if I[axes.enable_ticks[n]] == 0 and not drive_barred(I, n):
            I[word] |= af4.DRIVE_ENABLED | af4.MOTOR_ON
    if I[word] & af4.DRIVE_RESET_REQUEST:
        I[axes.reset_ticks[n]] += 1
        if I[axes.reset_ticks[n]] * period_s >= RESET_S:
            I[axes.reset_ticks[n]] = 0
            I[word] &= ~(af4.DRIVE_RESET_REQUEST | af4.DRIVE_FAULT)
    if drive_faulted(I, n) and not I[word] & af4.DRIVE_FAULT:
        I[word] |= af4.DRIVE_FAULT | af4.KILL_ALL_MOTION_REQUEST
        drive_disable(I, n)
    if feedback_broken(I, n) != I[axes.feedback_broken[n]]:
        I[axes.feedback_broken[n]] = feedback_broken(I, n)
        if I[axes.feedback_broken[n]]:
            I[word] |= af4.KILL_ALL_MOTION_REQUEST
            drive_disable(I, n)
    I[axes.drive_old[n]] = I[word] & af4.DRIVE_ENABLED
    I[axes.drive_seen[n]] = I[word]  # a change of the fault line has to be looked at again
    I[axes.drive_wired[n]] = I[axes.position_index[n]]
    drive_wiring(I, n)
    if I[word] & af4.DRIVE_RESET_REQUEST:
        I[axes.drive_wired[n]] = -1  # the reset pulse counts ticks


def drive_request(I: I32, n: int) -> None:
    """A written Drive Enabled flag starts enabling; a cleared one ends it."""
    now: int = I[af4.word[n]] & af4.DRIVE_ENABLED
    if now == I[axes.drive_old[n]]:
        return
    if now:
        I[af4.word[n]] &= ~af4.DRIVE_ENABLED
        if I[axes.enable_ticks[n]] == 0:
            I[axes.enable_ticks[n]] = 1
    else:
        drive_disable(I, n)


def motion_enable_step(I: I32, axis_count: int) -> None:
    """The motion enable input: open, it latches, kills every axis and drops the drives."""
    flags: int = I[W_MISC_CONTROL_1]
    if not flags & (MEI_OPEN | MEI_RESET):
        return
    if flags & MEI_OPEN:
        flags |= MEI_LATCHED
        for n in range(axis_count):
            I[af4.word[n]] |= af4.KILL_ALL_MOTION_REQUEST
            drive_disable(I, n)
    elif flags & MEI_RESET:
        flags &= ~MEI_LATCHED
    I[W_MISC_CONTROL_1] = flags & ~MEI_RESET
