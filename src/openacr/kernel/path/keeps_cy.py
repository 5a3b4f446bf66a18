"""Whether a path can still do what lies ahead of it, and the moves that it needs to brake."""

from openacr.kernel.path.lookahead_cy import look_scan, look_through
from openacr.kernel.path.path_cy import move_record
from openacr.kernel.path.plan_cy import look_fits
from openacr.kernel.path.round_between_cy import round_keeps
from openacr.kernel.path.round_cy import round_through
from openacr.map.rows import masters
from openacr.views import F32, F64, I32

__all__ = ["path_drop"]


def path_keeps(F: F64, I: I32, S: F32, m: int) -> bool:
    """Whether the path, from where it is, can do what its moves and junctions ask for now."""
    if round_through(F, I, m, move_record(I, m)):
        return round_keeps(F, I, S, m)
    section: int = I[masters.section_cnt[m]]
    end_u: float = F[masters.section_u[m]]
    cap_ups: float = F[masters.look_cap_ups[m]]
    exit_ups: float = F[masters.look_exit_ups[m]]
    look_scan(F, I, S, m)
    fits: bool = look_fits(F, I, m)
    I[masters.section_cnt[m]] = section  # that of the plan in force
    F[masters.section_u[m]] = end_u
    F[masters.look_cap_ups[m]] = cap_ups
    F[masters.look_exit_ups[m]] = exit_ups
    return fits


def path_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the moves that wait, but for those without which the path could not brake in time."""
    queued: int = I[masters.queued[m]]
    kept: int = I[masters.section_cnt[m]]
    record: int = move_record(I, m)
    if round_through(F, I, m, record) or look_through(F, I, m, record):
        while kept < queued:
            I[masters.queued[m]] = kept
            if path_keeps(F, I, S, m):
                break
            kept += 1
        I[masters.look_dirty[m]] = 1
    I[masters.queued[m]] = kept
