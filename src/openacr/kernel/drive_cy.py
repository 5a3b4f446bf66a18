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

from openacr.map.numbers import (
    AF4_DRIVE_ENABLED,
    AF4_DRIVE_FAULT,
    AF4_DRIVE_FAULT_INPUT,
    AF4_DRIVE_FAULT_LEVEL_INVERT,
    AF4_DRIVE_I_O_ENABLE,
    AF4_DRIVE_RESET_REQUEST,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AXI_BASE,
    AXI_DRIVE_MOTOR,
    AXI_DRIVE_OLD,
    AXI_DRIVE_SEEN,
    AXI_DRIVE_WIRED,
    AXI_ENABLE_TICKS,
    AXI_FEEDBACK_BROKEN,
    AXI_POSITION_INDEX,
    AXI_POSITION_SOURCE,
    AXI_RESET_TICKS,
    AXI_SIGNAL_INDEX,
    AXI_SIGNAL_SOURCE,
    AXI_STRIDE,
    AXI_SWITCHED_OFF,
    AXI_VELOCITY_INDEX,
    AXI_VELOCITY_SOURCE,
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    PLI_BASE,
    PLI_DAC,
    PLI_DRIVE_ENABLED,
    PLI_DRIVE_FAULT,
    PLI_FAULT_MASK,
    PLI_FAULT_REPORT,
    PLI_KIND,
    PLI_STRIDE,
    W_MISC_CONTROL_1,
)
from openacr.views import I32

__all__ = ["drive_disable", "drive_driven", "drive_step", "motion_enable_step"]

MODELLED = 16
MEI_LATCHED = 8192  # BIT5645
MEI_OPEN = 16384  # BIT5646
MEI_RESET = 32768  # BIT5647
RESET_S = 0.05
TO_DAC = 0
TO_STEPPER = 1
STEPPER_MOTOR = 5  # kind of a motor of the world


def drive_driven(I: I32, n: int) -> bool:
    """Whether axis n is under power, as far as its drive is concerned."""
    flags: int = I[AF4_WORD + n]
    if flags & AF4_DRIVE_ENABLED:
        return True
    return not flags & AF4_DRIVE_I_O_ENABLE and not I[AXI_BASE + n * AXI_STRIDE + AXI_SWITCHED_OFF]


def drive_disable(I: I32, n: int) -> None:
    """Disable the drive of axis n, enabled or not."""
    i: int = AXI_BASE + n * AXI_STRIDE
    I[AF4_WORD + n] &= ~AF4_DRIVE_ENABLED
    I[i + AXI_ENABLE_TICKS] = 0
    if not I[i + AXI_SWITCHED_OFF]:
        I[i + AXI_SWITCHED_OFF] = 1
        I[i + AXI_DRIVE_WIRED] = -1  # its enable line may be on without the flag


def drive_barred(I: I32, n: int) -> bool:
    """Whether something keeps the drive of axis n from being enabled."""
    if I[W_MISC_CONTROL_1] & (MEI_OPEN | MEI_LATCHED):
        return True
    return drive_faulted(I, n) or feedback_broken(I, n) != 0


def feedback_broken(I: I32, n: int) -> int:
    """1 while an encoder that axis n takes its position or velocity from has a signal fault."""
    i: int = AXI_BASE + n * AXI_STRIDE
    e: int = I[i + AXI_POSITION_INDEX]
    found: int = 0
    if I[i + AXI_POSITION_SOURCE] == 0 and 0 <= e < 24:
        found = I[EF_WORD + e]
    e = I[i + AXI_VELOCITY_INDEX]
    if I[i + AXI_VELOCITY_SOURCE] == 0 and 0 <= e < 24:
        found |= I[EF_WORD + e]
    return 1 if found & (EF_ENCODER_SIGNAL_FAULT | EF_ENCODER_SIGNAL_LOST) else 0


def drive_faulted(I: I32, n: int) -> bool:
    """Whether the fault input of axis n says so, with drive I/O in use."""
    flags: int = I[AF4_WORD + n]
    active: bool = flags & AF4_DRIVE_FAULT_INPUT != 0
    inverted: bool = flags & AF4_DRIVE_FAULT_LEVEL_INVERT != 0
    return flags & AF4_DRIVE_I_O_ENABLE != 0 and active != inverted


def is_motor(I: I32, source: int, k: int) -> bool:
    """Whether feedback k of a kind is the encoder of a motor."""
    return source == 0 and 0 <= k < MODELLED and I[PLI_BASE + k * PLI_STRIDE + PLI_KIND] != 0


def drive_motor(I: I32, n: int) -> int:
    """Motor that axis n drives, -1 if there is none.

    It is that of its position encoder, else of its velocity encoder (the other one counts the
    load), else the one on its analog or stepper output.
    """
    i: int = AXI_BASE + n * AXI_STRIDE
    if is_motor(I, I[i + AXI_POSITION_SOURCE], I[i + AXI_POSITION_INDEX]):
        return I[i + AXI_POSITION_INDEX]
    if is_motor(I, I[i + AXI_VELOCITY_SOURCE], I[i + AXI_VELOCITY_INDEX]):
        return I[i + AXI_VELOCITY_INDEX]
    if I[i + AXI_SIGNAL_SOURCE] == TO_DAC or I[i + AXI_SIGNAL_SOURCE] == TO_STEPPER:
        wants_stepper: bool = I[i + AXI_SIGNAL_SOURCE] == TO_STEPPER
        for m in range(MODELLED):
            row: int = PLI_BASE + m * PLI_STRIDE
            is_stepper: bool = I[row + PLI_KIND] == STEPPER_MOTOR
            if I[row + PLI_KIND] and I[row + PLI_DAC] == I[i + AXI_SIGNAL_INDEX]:
                if is_stepper == wants_stepper:
                    return m
    return -1


def drive_wiring(I: I32, n: int) -> None:
    """Read the fault line of the drive of axis n, if it has one, and drive its enable line."""
    i: int = AXI_BASE + n * AXI_STRIDE
    k: int = drive_motor(I, n)
    I[i + AXI_DRIVE_MOTOR] = k
    if k < 0:
        return
    row: int = PLI_BASE + k * PLI_STRIDE
    flags: int = I[AF4_WORD + n]
    if I[row + PLI_DRIVE_FAULT]:
        flags |= AF4_DRIVE_FAULT_INPUT
    elif (
        I[row + PLI_FAULT_MASK] | I[row + PLI_FAULT_REPORT]
    ):  # without a fault line the flag is the user's
        flags &= ~AF4_DRIVE_FAULT_INPUT
    I[AF4_WORD + n] = flags
    I[row + PLI_DRIVE_ENABLED] = 1 if drive_driven(I, n) else 0


def drive_resting(I: I32, n: int) -> bool:
    """Whether nothing about the drive of axis n has changed since its last step."""
    i: int = AXI_BASE + n * AXI_STRIDE
    flags: int = I[AF4_WORD + n]
    k: int = I[i + AXI_POSITION_INDEX]
    if flags != I[i + AXI_DRIVE_SEEN] or I[i + AXI_ENABLE_TICKS] or k != I[i + AXI_DRIVE_WIRED]:
        return False
    if feedback_broken(I, n) != I[i + AXI_FEEDBACK_BROKEN]:
        return False
    k = I[i + AXI_DRIVE_MOTOR]
    if k < 0:
        return True
    shown: bool = flags & AF4_DRIVE_FAULT_INPUT != 0
    if I[PLI_BASE + k * PLI_STRIDE + PLI_DRIVE_FAULT]:
        return shown
    k = PLI_BASE + k * PLI_STRIDE
    return not shown or not I[k + PLI_FAULT_MASK] | I[k + PLI_FAULT_REPORT]


def drive_step(I: I32, n: int, period_s: float) -> None:
    """Follow the drive flags of axis n."""
    i: int = AXI_BASE + n * AXI_STRIDE
    word: int = AF4_WORD + n
    if drive_resting(I, n):
        return
    drive_request(I, n)
    if I[i + AXI_ENABLE_TICKS] > 0:
        I[i + AXI_ENABLE_TICKS] -= 1
        if I[i + AXI_ENABLE_TICKS] == 0 and not drive_barred(I, n):
            I[word] |= AF4_DRIVE_ENABLED
    if I[word] & AF4_DRIVE_RESET_REQUEST:
        I[i + AXI_RESET_TICKS] += 1
        if I[i + AXI_RESET_TICKS] * period_s >= RESET_S:
            I[i + AXI_RESET_TICKS] = 0
            I[word] &= ~(AF4_DRIVE_RESET_REQUEST | AF4_DRIVE_FAULT)
    if drive_faulted(I, n) and not I[word] & AF4_DRIVE_FAULT:
        I[word] |= AF4_DRIVE_FAULT | AF4_KILL_ALL_MOTION_REQUEST
        drive_disable(I, n)
    if feedback_broken(I, n) != I[i + AXI_FEEDBACK_BROKEN]:
        I[i + AXI_FEEDBACK_BROKEN] = feedback_broken(I, n)
        if I[i + AXI_FEEDBACK_BROKEN]:
            I[word] |= AF4_KILL_ALL_MOTION_REQUEST
            drive_disable(I, n)
    I[i + AXI_DRIVE_OLD] = I[word] & AF4_DRIVE_ENABLED
    I[i + AXI_DRIVE_SEEN] = I[word]  # a change of the fault line has to be looked at again
    I[i + AXI_DRIVE_WIRED] = I[i + AXI_POSITION_INDEX]
    drive_wiring(I, n)
    if I[word] & AF4_DRIVE_RESET_REQUEST:
        I[i + AXI_DRIVE_WIRED] = -1  # the reset pulse counts ticks


def drive_request(I: I32, n: int) -> None:
    """A written Drive Enabled flag starts enabling; a cleared one ends it."""
    i: int = AXI_BASE + n * AXI_STRIDE
    now: int = I[AF4_WORD + n] & AF4_DRIVE_ENABLED
    if now == I[i + AXI_DRIVE_OLD]:
        return
    if now:
        I[AF4_WORD + n] &= ~AF4_DRIVE_ENABLED
        if I[i + AXI_ENABLE_TICKS] == 0:
            I[i + AXI_ENABLE_TICKS] = 1
    else:
        drive_disable(I, n)


def motion_enable_step(I: I32, axes: int) -> None:
    """The motion enable input: open, it latches, kills every axis and drops the drives."""
    flags: int = I[W_MISC_CONTROL_1]
    if not flags & (MEI_OPEN | MEI_RESET):
        return
    if flags & MEI_OPEN:
        flags |= MEI_LATCHED
        for n in range(axes):
            I[AF4_WORD + n] |= AF4_KILL_ALL_MOTION_REQUEST
            drive_disable(I, n)
    elif flags & MEI_RESET:
        flags &= ~MEI_LATCHED
    I[W_MISC_CONTROL_1] = flags & ~MEI_RESET
