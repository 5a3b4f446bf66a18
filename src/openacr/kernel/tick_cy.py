"""One servo interrupt, in the order of the card.

The world outside has moved during the period before; its new state is read first, and the
outputs computed here act on it during the next one.
"""

from openacr.kernel.axis.analog_cy import analog_step
from openacr.kernel.axis.axis_cy import axis_setpoints, axis_show, axis_take_written
from openacr.kernel.axis.capture_cy import capture_step
from openacr.kernel.axis.drive_cy import (
    drive_resting,
    drive_step,
    encoder_faults,
    motion_enable_step,
)
from openacr.kernel.axis.feedback_cy import (
    encoder_filters_step,
    encoder_links_step,
    encoder_step,
    feedback_step,
)
from openacr.kernel.axis.modules_cy import missing_inputs_step, missing_outputs_step
from openacr.kernel.axis.servo_cy import servo_step
from openacr.kernel.followers.object_cy import object_outputs_step, object_sources_step
from openacr.kernel.followers.offset_cy import (
    followers_step,
    followers_used,
    jog_time,
    lock_leader,
    lock_step,
    locks_couple,
    wheel_step,
)
from openacr.kernel.jog.jog_cy import JOG_IDLE, jog_idle, jog_numbers_show, jog_step
from openacr.kernel.path.master_cy import master_busy, master_step
from openacr.kernel.path.sync_cy import sync_step
from openacr.kernel.sources.clock_cy import clock_step
from openacr.kernel.sources.source_cy import sources_follow, triggers_watch
from openacr.kernel.status.fast_flags_cy import fast_flags_step
from openacr.kernel.status.fast_status_cy import fast_status_step
from openacr.kernel.status.limits_cy import limits_step
from openacr.kernel.status.sample_cy import sample_step
from openacr.kernel.status.slow_cy import slow_scan
from openacr.map.numbers import W_FSTAT, W_MISC_CONTROL_1, W_MISC_OUTPUTS
from openacr.map.rows import (
    axes,
    followers,
    hand_wheels,
    kernel,
    motors,
    objects,
    plant,
    sampler,
    system,
)
from openacr.map.words import af1, mc1, mf1, mo
from openacr.views import F32, F64, I32

__all__ = ["tick"]
__inlined__ = ["axis_advance"]

MODELLED = 16
OFFSETS_ACTIVE = af1.JOG_ACTIVE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE | af1.BALLSCREW_ACTIVATE


def axis_changing(I: I32, n: int) -> bool:
    """Whether the shown positions of axis n may change although its setpoint rests.

    Parts can cancel each other out.
    """
    m: int = I[axes.master[n]]
    if I[af1.word[n]] & OFFSETS_ACTIVE:
        return True
    return m >= 0 and I[mf1.word[m]] & mf1.IN_MOTION != 0


def axis_advance(F: F64, I: I32, S: F32, n: int, period_s: float, rate_hz: float) -> None:
    """Jog and all offsets of axis n, and its setpoint sums.

    Positions are shown while they may change and once more; at rest with every slow scan.
    """
    dt_s: float = period_s
    used: bool = followers_used(I, n) != 0
    if used:
        if I[hand_wheels.on[n]]:
            wheel_step(F, I, S, n)
        if I[followers.live[n]]:
            dt_s = jog_time(F, I, n, period_s)
    if not jog_idle(I, n):
        jog_step(F, I, S, n, dt_s)
    if used:
        followers_step(F, I, S, n, period_s, rate_hz)
    changing: bool = axis_setpoints(F, S, n, rate_hz) or used or axis_changing(I, n)
    if changing and I[kernel.unread]:
        I[axes.show_due[n]] = 1
        I[kernel.shows_due] = 1
    elif changing or I[axes.changing[n]] or I[system.slow_phase] == 0:
        axis_show(F, I, n)
    I[axes.changing[n]] = 1 if changing else 0


def shows_settle(F: F64, I: I32, S: F32) -> None:
    """Show what axes have put off while nothing read it."""
    if not I[kernel.shows_due]:
        return
    I[kernel.shows_due] = 0
    for n in range(axes.COUNT):
        if I[axes.show_due[n]]:
            I[axes.show_due[n]] = 0
            axis_show(F, I, n)
            if I[axes.jog_mode[n]] != JOG_IDLE:
                jog_numbers_show(F, I, S, n)


def locked_advance(
    F: F64, I: I32, S: F32, axis_count: int, period_s: float, rate_hz: float
) -> None:
    """Axes locked to others, after their leaders."""
    for n in range(axis_count):
        if I[axes.on[n]] and lock_leader(I, n) >= 0:
            lock_step(F, I, S, n)
            axis_advance(F, I, S, n, period_s, rate_hz)
    locks_couple(F, I, S)


def joints_keep(F: F64, I: I32, axis_count: int) -> None:
    """INVK: note the joint positions before the masters go on."""
    for n in range(axis_count):
        F[axes.joint_cnt[n]] = F[axes.position_cnt[n]] + F[axes.kinematics_cnt[n]]


def joints_stay(F: F64, I: I32, axis_count: int) -> None:
    """INVK: the joints are where the last evaluation has put them, not where the path is."""
    for n in range(axis_count):
        m: int = I[axes.master[n]]
        if m >= 0 and I[kernel.kinematics] & (1 << m):
            F[axes.kinematics_cnt[n]] = F[axes.joint_cnt[n]] - F[axes.position_cnt[n]]


def tick(F: F64, I: I32, S: F32) -> None:
    """Everything the card does in one servo period."""
    period_s: float = F[system.period_s]
    rate_hz: float = 1.0 / period_s
    inputs_read(F, I, S, period_s, rate_hz)
    sources_read(F, I, S, period_s)
    axes_guard(F, I, S, period_s)
    masters_advance(F, I, S, period_s)
    axes_advance(F, I, S, period_s, rate_hz)
    outputs_write(F, I, S, period_s, rate_hz)
    flags_show(F, I, S)


def inputs_read(F: F64, I: I32, S: F32, period_s: float, rate_hz: float) -> None:
    """Encoders and analog inputs, then the actual positions of the axes."""
    if I[kernel.filtered_encoders]:
        encoder_filters_step(F, I, period_s)
    for e in range(MODELLED):
        if I[motors.kind[e]]:
            encoder_step(F, I, e, rate_hz)
    if I[plant.analogs]:
        analog_step(F, I, S)
    if I[kernel.missing_encoders] | I[kernel.missing_adcs] | I[kernel.missing_steppers]:
        missing_inputs_step(I, S)
    if I[kernel.linked_encoders]:
        encoder_links_step(I, rate_hz)
    for n in range(I[kernel.axes]):
        if I[axes.on[n]]:
            if not I[kernel.untouched]:
                axis_take_written(F, I, n)
            feedback_step(F, I, S, n, rate_hz)


def sources_read(F: F64, I: I32, S: F32, period_s: float) -> None:
    """Captures and clocks, then what gears, cams and objects take their pulses from."""
    if not I[kernel.untouched]:  # else no trigger is armed
        for n in range(I[kernel.axes]):
            if I[followers.live[n]]:
                triggers_watch(F, I, S, n)
    capture_step(F, I)
    clock_step(F, I, period_s)
    if I[objects.live]:
        object_sources_step(F, I, S, period_s)
    for n in range(I[kernel.axes]):
        if I[followers.live[n]]:
            sources_follow(F, I, S, n)


def axes_guard(F: F64, I: I32, S: F32, period_s: float) -> None:
    """Drives and limits: what kills motion does so before anything moves."""
    motion_enable_step(I, I[kernel.axes])
    faults: int = encoder_faults(I)
    for n in range(I[kernel.axes]):
        if I[axes.on[n]]:
            if not drive_resting(I, n, faults):
                drive_step(I, n, period_s)
            limits_step(F, I, S, n)


def masters_advance(F: F64, I: I32, S: F32, period_s: float) -> None:
    """Coordinated moves; with INVK the joints stay where their program has put them."""
    if I[kernel.synced]:
        sync_step(F, I, S, I[kernel.masters])
    if I[kernel.kinematics]:
        joints_keep(F, I, I[kernel.axes])
    for m in range(I[kernel.masters]):
        if master_busy(I, m):
            master_step(F, I, S, m, period_s)
    if I[kernel.kinematics]:
        joints_stay(F, I, I[kernel.axes])


def axes_advance(F: F64, I: I32, S: F32, period_s: float, rate_hz: float) -> None:
    """Jogs, gears, cams and the setpoint sums; locked axes after those that lead them."""
    for n in range(I[kernel.axes]):
        if I[axes.on[n]] and lock_leader(I, n) < 0:
            axis_advance(F, I, S, n, period_s, rate_hz)
    if I[objects.locked]:
        locked_advance(F, I, S, I[kernel.axes], period_s, rate_hz)


def outputs_write(F: F64, I: I32, S: F32, period_s: float, rate_hz: float) -> None:
    """Servo loops, then output objects, samples and status, which see what they have put out."""
    for n in range(I[kernel.axes]):
        if I[axes.on[n]]:
            servo_step(F, I, S, n, period_s, rate_hz)
    if I[objects.live]:
        object_outputs_step(F, I, S)
    if I[W_MISC_OUTPUTS] & mo.SAMPLE_TRIGGER_ARMED or I[sampler.armed_old]:
        sample_step(F, I, S, period_s)
    if I[W_FSTAT]:
        fast_status_step(F, I, S, period_s)
    if I[kernel.missing_dacs]:
        missing_outputs_step(I, S)


def flags_show(F: F64, I: I32, S: F32) -> None:
    """Limit flags: the fast ones in each tick, all of them every 50 ms."""
    if I[W_MISC_CONTROL_1] & mc1.ENABLE_FAST_FLAGS_UPDATE_MODE:
        fast_flags_step(F, I, S, I[kernel.axes])
    slow: int = I[system.slow_phase] + 1
    if slow >= I[kernel.slow_ticks]:
        slow = 0
        slow_scan(F, I, S, I[kernel.axes], I[kernel.masters])
    I[system.slow_phase] = slow
