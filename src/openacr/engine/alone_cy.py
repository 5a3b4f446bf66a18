"""Ticks in which nothing but the servo interrupt reads or writes: some of its work is left out.

Two rows say so to the interrupt, while it runs:

    untouched   nothing else has written since the tick before: what was written is not looked
                for, and what was found of settings and arrays is still right
    unread      nothing else will read before the next tick: what is only shown is put off

What was put off is shown before anything reads it, the caller included, so that every reader
finds what it would have found, to the bit. Flags are never put off.

The interrupt itself may read and write parameters by their numbers (sampler, triggers, copies of
captures and encoders ...). Where it may, nothing is left out. To look for that costs as much as a
few ticks save, so it is done once for a row of ticks without a statement or a call of Python.
"""

from openacr.kernel.followers.cam_cy import tables_forget
from openacr.kernel.sources.source_cy import DISARMED, FROM_PARAMETER, taps_settle
from openacr.kernel.tick_cy import shows_settle
from openacr.map.numbers import W_FSTAT, W_MISC_CONTROL_1, W_MISC_OUTPUTS
from openacr.map.rows import (
    axes,
    engine,
    filters,
    kernel,
    network_master,
    objects,
    sampler,
    scheduler,
    sources,
    system,
    triggers,
)
from openacr.map.words import mc1, mo
from openacr.network.wake_cy import RUNNING
from openacr.views import F32, F64, I32

CALM = 8  # ticks after which it is worth looking whether the interrupt is alone
LATER = 1000  # ticks until the next look, if it is not


def alone(I: I32) -> bool:
    """Whether nothing reads or writes parameters by their numbers, as far as settings say."""
    if I[objects.live] | I[kernel.linked_encoders] | I[kernel.kinematics] | I[kernel.synced]:
        return False
    if I[engine.watch_count] or I[engine.trace_every] > 0 or I[network_master.phase] == RUNNING:
        return False
    for n in range(I[kernel.axes]):
        if I[axes.capture_mode[n]] >= 0 and I[axes.capture_copy[n]]:
            return False
        if I[filters.on[n]] and I[filters.out[n]] >= 0:
            return False
    for t in range(sources.COUNT):
        if I[sources.kind[t]] == FROM_PARAMETER:
            return False
    for t in range(triggers.COUNT):
        if I[triggers.kind[t]] != DISARMED:
            return False
    return True


def alone_now(I: I32) -> bool:
    """Whether flags, which may change in any tick, leave the interrupt alone, too."""
    if I[W_FSTAT] | I[sampler.armed_old]:
        return False
    if I[W_MISC_OUTPUTS] & mo.SAMPLE_TRIGGER_ARMED:
        return False
    return I[W_MISC_CONTROL_1] & mc1.ENABLE_FAST_FLAGS_UPDATE_MODE == 0


def alone_begin(F: F64, I: I32, S: F32, calm: int) -> None:
    """A tick begins: say what may be left out of it.

    `calm` counts the ticks since anything else could write, in which `alone` was found to hold.
    """
    if calm < CALM or not alone_now(I):
        alone_end(F, I, S)
        return
    I[kernel.untouched] = 1
    scan: bool = I[system.slow_phase] + 1 >= I[kernel.slow_ticks]
    if scan or I[scheduler.programs] | I[scheduler.channels]:
        I[kernel.unread] = 0
        shows_settle(F, I, S)
    else:
        I[kernel.unread] = 1


def alone_end(F: F64, I: I32, S: F32) -> None:
    """Others may read and write again: show what was put off, and leave nothing out."""
    if I[kernel.untouched]:
        I[kernel.untouched] = 0
        I[kernel.unread] = 0
        shows_settle(F, I, S)
        tables_forget(I)
        taps_settle(F, I, S)
