"""The flags of SPLINE and NURB, and what is left of a curve when its moves are dropped."""

from openacr.kernel.path.bezier_cy import is_bezier
from openacr.kernel.path.lookahead_cy import look_record
from openacr.kernel.path.path_cy import MARK_CURVE_BEGIN, MARK_NURB, move_record
from openacr.kernel.profile.ramps_cy import ACCELERATING, STOPPING
from openacr.map.rows import curve_points, masters, moves, profiles
from openacr.map.words import mf3
from openacr.views import I32

# What the kernel keeps true while a curve runs; the rest belongs to the commands.
SPLINE_RUNS = mf3.SPLINE_STARTED | mf3.SPLINE_PROFILER_ON | mf3.SPLINE_MOVED
SPLINE_SHOWN = (
    mf3.SPLINE_STARTED
    | mf3.SPLINE_PROFILER_ON
    | mf3.SPLINE_ACC_RAMP
    | mf3.SPLINE_LAST
    | mf3.SPLINE_BUFFERED
)
SPLINE_OVER = (
    mf3.SPLINE_LOADED
    | mf3.SPLINE_DATA_AVAIL
    | mf3.SPLINE_PENDING
    | mf3.SPLINE_END
    | mf3.SPLINE_KNOT_PRESENT
    | mf3.SPLINE_NEG_KNOT
)
NURB_RUNS = mf3.NURB_STARTED | mf3.NURB_PROFILER_ON | mf3.NURB_MOVED
NURB_SHOWN = (
    mf3.NURB_STARTED
    | mf3.NURB_PROFILER_ON
    | mf3.NURB_ACC_RAMP
    | mf3.NURB_LAST
    | mf3.NURB_BUFFERED
    | mf3.NURB_STOP_ACTIVE
)
NURB_OVER = mf3.NURB_LOADED | mf3.NURB_PENDING | mf3.NURB_NEG_KNOT


def curve_drop(I: I32, m: int) -> None:
    """Forget the points of an unfinished curve."""
    I[curve_points.points[m]] = 0
    I[curve_points.knots[m]] = 0
    I[curve_points.points_before[m]] = 0
    I[curve_points.open[m]] = 0


def curve_moves_waiting(I: I32, m: int) -> int:
    """Moves of the present curve that wait after the present one."""
    count: int = 0
    queued: int = I[masters.queued[m]]
    while count + 1 < queued:
        record: int = look_record(I, m, count + 1)
        begins: int = I[moves.marks[record]] & MARK_CURVE_BEGIN
        if begins or not is_bezier(I, record):
            return count
        count += 1
    return count


def curve_show(I: I32, m: int) -> None:
    """Keep the flags of curves true; when the last one is over, there is nothing more to do."""
    flags: int = I[mf3.word[m]] & ~(SPLINE_SHOWN | NURB_SHOWN)
    runs: bool = I[masters.queued[m]] > 0 and I[masters.moving[m]] != 0
    if runs and is_bezier(I, move_record(I, m)):
        flags |= running_flags(I, m)
    elif not curves_wait(I, m):
        flags &= ~(SPLINE_OVER | NURB_OVER)
        I[curve_points.live[m]] = 0
    I[mf3.word[m]] = flags


def curves_wait(I: I32, m: int) -> bool:
    """Whether a curve is unfinished or has moves in the buffer."""
    if I[curve_points.open[m]] or I[curve_points.points[m]]:
        return True
    for k in range(I[masters.queued[m]]):
        if is_bezier(I, look_record(I, m, k)):
            return True
    return False


def running_flags(I: I32, m: int) -> int:
    """The flags of the piece that runs."""
    waiting: int = curve_moves_waiting(I, m)
    kind: int = I[profiles.kind[m]]
    last: bool = waiting == 0 and not I[curve_points.open[m]]
    flags: int = 0
    if I[moves.marks[move_record(I, m)]] & MARK_NURB:
        flags = NURB_RUNS
        if kind == ACCELERATING:
            flags |= mf3.NURB_ACC_RAMP
        if kind == STOPPING:
            flags |= mf3.NURB_STOP_ACTIVE
        if waiting:
            flags |= mf3.NURB_BUFFERED
        if last:
            flags |= mf3.NURB_LAST
        return flags
    flags = SPLINE_RUNS
    if kind == ACCELERATING:
        flags |= mf3.SPLINE_ACC_RAMP
    if waiting:
        flags |= mf3.SPLINE_BUFFERED
    if last:
        flags |= mf3.SPLINE_LAST
    return flags
