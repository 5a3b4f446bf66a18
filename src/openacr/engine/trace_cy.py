"""Samples of all axes over time, and of chosen values, recorded while the engine runs."""

from openacr.engine.watch_cy import WATCH_WORD, watch_value
from openacr.map import numbers as at
from openacr.map.rows import engine, kernel, system
from openacr.views import F32, F64, I32

__all__ = ["trace_tick"]

TRACE_HEAD = 3  # time, input word, output word
TRACE_AXIS = 4  # setpoint, actual position, velocity, following error


def trace_columns(I: I32) -> int:
    """Numbers in a row of the trace."""
    return TRACE_HEAD + TRACE_AXIS * I[kernel.axes] + I[engine.sample_count]


def trace_place(F: F64, I: I32, S: F32, trace: F64, row: int) -> None:
    """Write time, inputs, outputs, positions and chosen values of this tick into a row."""
    axes: int = I[kernel.axes]
    cell: int = row * trace_columns(I)
    trace[cell] = F[system.time_s]
    trace[cell + 1] = I[at.W_INPUTS]
    trace[cell + 2] = I[at.W_OUTPUTS]
    cell += TRACE_HEAD
    for n in range(axes):
        trace[cell] = F[at.AXF_BASE + n * at.AXF_STRIDE + at.AXF_SSP_CNT]
        trace[cell + 1] = I[at.AX_BASE + n * at.AX_STRIDE + at.AX_ACTUAL_POSITION]
        cell += TRACE_AXIS
    for k in range(I[engine.sample_count]):
        v: int = at.SMVI_BASE + k * at.SMVI_STRIDE
        place: int = I[v + at.SMVI_ROW]
        if I[v + at.SMVI_KIND] == WATCH_WORD:
            trace[cell + k] = 1.0 if I[place] & I[v + at.SMVI_MASK] else 0.0
        else:
            trace[cell + k] = watch_value(F, I, S, I[v + at.SMVI_KIND], place)


def trace_rates(F: F64, I: I32, trace: F64, low: int, high: int, first: bool) -> None:
    """Keep the lowest velocities and following errors in one row, the highest in another."""
    axes: int = I[kernel.axes]
    columns: int = trace_columns(I)
    for n in range(axes):
        a: int = at.AXF_BASE + n * at.AXF_STRIDE
        place: int = TRACE_HEAD + TRACE_AXIS * n + 2
        lowest: int = low * columns + place
        highest: int = high * columns + place
        velocity: float = F[a + at.AXF_PSP_VELOCITY_CPS]
        error: float = (
            F[a + at.AXF_SSP_CNT] - I[at.AX_BASE + n * at.AX_STRIDE + at.AX_ACTUAL_POSITION]
        )
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
    every: int = I[engine.trace_every]
    row: int = I[engine.trace_row]
    I[engine.trace_wait] -= 1
    wait: int = I[engine.trace_wait]
    if wait <= 0:
        pair: int = 1 if I[engine.trace_peaks] else 0
        trace_place(F, I, S, trace, row)
        trace_place(F, I, S, trace, row + pair)
        trace_rates(F, I, trace, row, row + pair, True)
        I[engine.trace_row] = row + 1 + pair
        I[engine.trace_wait] = every + every * pair
    elif I[engine.trace_peaks] and row >= 2:
        if wait == every:
            trace_place(F, I, S, trace, row - 1)
        trace_rates(F, I, trace, row - 2, row - 1, False)
