"""The flags of SPLINE and NURB, and what is left of a curve when its moves are dropped."""

from openacr.kernel.bezier_cy import is_bezier
from openacr.kernel.lookahead_cy import look_record
from openacr.kernel.path_cy import MARK_CURVE_BEGIN, MARK_NURB, move_record
from openacr.kernel.profile_cy import ACCELERATING, STOPPING
from openacr.map.numbers import (
    CPI_BASE,
    CPI_BEHIND,
    CPI_KNOTS,
    CPI_LIVE,
    CPI_OPEN,
    CPI_POINTS,
    CPI_STRIDE,
    MF3_NURB_ACC_RAMP,
    MF3_NURB_BUFFERED,
    MF3_NURB_LAST,
    MF3_NURB_LOADED,
    MF3_NURB_MOVED,
    MF3_NURB_NEG_KNOT,
    MF3_NURB_PENDING,
    MF3_NURB_PROFILER_ON,
    MF3_NURB_STARTED,
    MF3_NURB_STOP_ACTIVE,
    MF3_SPLINE_ACC_RAMP,
    MF3_SPLINE_BUFFERED,
    MF3_SPLINE_DATA_AVAIL,
    MF3_SPLINE_END,
    MF3_SPLINE_KNOT_PRESENT,
    MF3_SPLINE_LAST,
    MF3_SPLINE_LOADED,
    MF3_SPLINE_MOVED,
    MF3_SPLINE_NEG_KNOT,
    MF3_SPLINE_PENDING,
    MF3_SPLINE_PROFILER_ON,
    MF3_SPLINE_STARTED,
    MF3_WORD,
    MQI_BASE,
    MQI_MARKS,
    MQI_STRIDE,
    MSI_BASE,
    MSI_MOVING,
    MSI_QUEUED,
    MSI_STRIDE,
    PRI_BASE,
    PRI_KIND,
    PRI_STRIDE,
)
from openacr.views import I32

# What the kernel keeps true while a curve runs; the rest belongs to the commands.
SPLINE_RUNS = MF3_SPLINE_STARTED | MF3_SPLINE_PROFILER_ON | MF3_SPLINE_MOVED
SPLINE_SHOWN = (
    MF3_SPLINE_STARTED
    | MF3_SPLINE_PROFILER_ON
    | MF3_SPLINE_ACC_RAMP
    | MF3_SPLINE_LAST
    | MF3_SPLINE_BUFFERED
)
SPLINE_OVER = (
    MF3_SPLINE_LOADED
    | MF3_SPLINE_DATA_AVAIL
    | MF3_SPLINE_PENDING
    | MF3_SPLINE_END
    | MF3_SPLINE_KNOT_PRESENT
    | MF3_SPLINE_NEG_KNOT
)
NURB_RUNS = MF3_NURB_STARTED | MF3_NURB_PROFILER_ON | MF3_NURB_MOVED
NURB_SHOWN = (
    MF3_NURB_STARTED
    | MF3_NURB_PROFILER_ON
    | MF3_NURB_ACC_RAMP
    | MF3_NURB_LAST
    | MF3_NURB_BUFFERED
    | MF3_NURB_STOP_ACTIVE
)
NURB_OVER = MF3_NURB_LOADED | MF3_NURB_PENDING | MF3_NURB_NEG_KNOT


def curve_drop(I: I32, m: int) -> None:
    """Forget the points of an unfinished curve."""
    i: int = CPI_BASE + m * CPI_STRIDE
    I[i + CPI_POINTS] = 0
    I[i + CPI_KNOTS] = 0
    I[i + CPI_BEHIND] = 0
    I[i + CPI_OPEN] = 0


def pieces_behind(I: I32, m: int) -> int:
    """How many pieces of the present curve wait behind the present one."""
    count: int = 0
    queued: int = I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED]
    while count + 1 < queued:
        record: int = look_record(I, m, count + 1)
        begins: int = I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS] & MARK_CURVE_BEGIN
        if begins or not is_bezier(I, record):
            return count
        count += 1
    return count


def curve_show(I: I32, m: int) -> None:
    """Keep the flags of curves true; when the last one is over, there is nothing more to do."""
    i: int = MSI_BASE + m * MSI_STRIDE
    flags: int = I[MF3_WORD + m] & ~(SPLINE_SHOWN | NURB_SHOWN)
    runs: bool = I[i + MSI_QUEUED] > 0 and I[i + MSI_MOVING] != 0
    if runs and is_bezier(I, move_record(I, m)):
        flags |= running_flags(I, m)
    elif not curves_wait(I, m):
        flags &= ~(SPLINE_OVER | NURB_OVER)
        I[CPI_BASE + m * CPI_STRIDE + CPI_LIVE] = 0
    I[MF3_WORD + m] = flags


def curves_wait(I: I32, m: int) -> bool:
    """Whether a curve is unfinished or has pieces in the buffer."""
    i: int = CPI_BASE + m * CPI_STRIDE
    if I[i + CPI_OPEN] or I[i + CPI_POINTS]:
        return True
    for k in range(I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED]):
        if is_bezier(I, look_record(I, m, k)):
            return True
    return False


def running_flags(I: I32, m: int) -> int:
    """The flags of the piece that runs."""
    waiting: int = pieces_behind(I, m)
    kind: int = I[PRI_BASE + m * PRI_STRIDE + PRI_KIND]
    last: bool = waiting == 0 and not I[CPI_BASE + m * CPI_STRIDE + CPI_OPEN]
    flags: int = 0
    if I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_MARKS] & MARK_NURB:
        flags = NURB_RUNS
        if kind == ACCELERATING:
            flags |= MF3_NURB_ACC_RAMP
        if kind == STOPPING:
            flags |= MF3_NURB_STOP_ACTIVE
        if waiting:
            flags |= MF3_NURB_BUFFERED
        if last:
            flags |= MF3_NURB_LAST
        return flags
    flags = SPLINE_RUNS
    if kind == ACCELERATING:
        flags |= MF3_SPLINE_ACC_RAMP
    if waiting:
        flags |= MF3_SPLINE_BUFFERED
    if last:
        flags |= MF3_SPLINE_LAST
    return flags
