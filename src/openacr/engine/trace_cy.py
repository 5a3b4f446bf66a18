"""Samples of all axes over time, and of chosen values, recorded while the engine runs."""

from openacr.engine.watch_cy import WATCH_WORD, watch_value
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_STRIDE,
    AXF_BASE,
    AXF_PSP_VELOCITY_CPS,
    AXF_SSP_CNT,
    AXF_STRIDE,
    ENGI_BASE,
    ENGI_SAMPLE_COUNT,
    ENGI_TRACE_EVERY,
    ENGI_TRACE_PEAKS,
    ENGI_TRACE_ROW,
    ENGI_TRACE_WAIT,
    KRI_AXES,
    KRI_BASE,
    SMVI_BASE,
    SMVI_KIND,
    SMVI_MASK,
    SMVI_ROW,
    SMVI_STRIDE,
    SYSF_BASE,
    SYSF_TIME_S,
    W_INPUTS,
    W_OUTPUTS,
)
from openacr.views import F32, F64, I32

__all__ = ["trace_tick"]

TRACE_HEAD = 3  # time, input word, output word
TRACE_AXIS = 4  # setpoint, actual position, velocity, following error


def trace_columns(I: I32) -> int:
    """Numbers in a row of the trace."""
    return TRACE_HEAD + TRACE_AXIS * I[KRI_BASE + KRI_AXES] + I[ENGI_BASE + ENGI_SAMPLE_COUNT]


def trace_place(F: F64, I: I32, S: F32, trace: F64, row: int) -> None:
    """Write time, inputs, outputs, positions and chosen values of this tick into a row."""
    axes: int = I[KRI_BASE + KRI_AXES]
    at: int = row * trace_columns(I)
    trace[at] = F[SYSF_BASE + SYSF_TIME_S]
    trace[at + 1] = I[W_INPUTS]
    trace[at + 2] = I[W_OUTPUTS]
    at += TRACE_HEAD
    for n in range(axes):
        trace[at] = F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT]
        trace[at + 1] = I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
        at += TRACE_AXIS
    for k in range(I[ENGI_BASE + ENGI_SAMPLE_COUNT]):
        v: int = SMVI_BASE + k * SMVI_STRIDE
        place: int = I[v + SMVI_ROW]
        if I[v + SMVI_KIND] == WATCH_WORD:
            trace[at + k] = 1.0 if I[place] & I[v + SMVI_MASK] else 0.0
        else:
            trace[at + k] = watch_value(F, I, S, I[v + SMVI_KIND], place)


def trace_rates(F: F64, I: I32, trace: F64, low: int, high: int, first: bool) -> None:
    """Keep the lowest velocities and following errors in one row, the highest in another."""
    axes: int = I[KRI_BASE + KRI_AXES]
    columns: int = trace_columns(I)
    for n in range(axes):
        a: int = AXF_BASE + n * AXF_STRIDE
        place: int = TRACE_HEAD + TRACE_AXIS * n + 2
        lowest: int = low * columns + place
        highest: int = high * columns + place
        velocity: float = F[a + AXF_PSP_VELOCITY_CPS]
        error: float = F[a + AXF_SSP_CNT] - I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
        if first or velocity < trace[lowest]:
            trace[lowest] = velocity
        if first or velocity > trace[highest]:
            trace[highest] = velocity
        if first or error < trace[lowest + 1]:
            trace[lowest + 1] = error
        if first or error > trace[highest + 1]:
            trace[highest + 1] = error


def trace_tick(F: F64, I: I32, S: F32, trace: F64) -> None:
    """Record this tick if a sample is due.

    To keep the peaks, rows are written in pairs for twice the time between two samples. The
    positions are those of the begin and the middle of that time; velocity and following
    error are the lowest and highest of all its ticks.
    """
    e: int = ENGI_BASE
    every: int = I[e + ENGI_TRACE_EVERY]
    row: int = I[e + ENGI_TRACE_ROW]
    I[e + ENGI_TRACE_WAIT] -= 1
    wait: int = I[e + ENGI_TRACE_WAIT]
    if wait <= 0:
        pair: int = 1 if I[e + ENGI_TRACE_PEAKS] else 0
        trace_place(F, I, S, trace, row)
        trace_place(F, I, S, trace, row + pair)
        trace_rates(F, I, trace, row, row + pair, True)
        I[e + ENGI_TRACE_ROW] = row + 1 + pair
        I[e + ENGI_TRACE_WAIT] = every + every * pair
    elif I[e + ENGI_TRACE_PEAKS] and row >= 2:
        if wait == every:
            trace_place(F, I, S, trace, row - 1)
        trace_rates(F, I, trace, row - 2, row - 1, False)
