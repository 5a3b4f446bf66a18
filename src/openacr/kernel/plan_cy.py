"""Plan the path of a master from where it is: the present move, or all that look-ahead joins."""

from openacr.kernel.lookahead_cy import (
    look_rate,
    look_record,
    look_scan,
    look_through,
)
from openacr.kernel.path_cy import master_limit, master_word, move_final_ups, move_record
from openacr.kernel.profile_cy import profile_plan
from openacr.kernel.round_cy import round_decelerate, round_plan, round_through
from openacr.map.numbers import (
    MF1_FVEL_ZERO_ACTIVE,
    MF4_LOOK_AHEAD_SLOWDOWN,
    MF4_WORD,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MSF_BASE,
    MSF_LOOK_CAP_UPS,
    MSF_LOOK_EXIT_UPS,
    MSF_ORIGIN_U,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSI_BASE,
    MSI_FINAL_ZERO,
    MSI_LOOK_DIRTY,
    MSI_PIECE,
    MSI_QUEUED,
    MSI_STRETCH,
    MSI_STRIDE,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["master_plan"]


def master_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the present move of master m from where it is."""
    record: int = move_record(I, m)
    I[MSI_BASE + m * MSI_STRIDE + MSI_FINAL_ZERO] = I[master_word(m)] & MF1_FVEL_ZERO_ACTIVE
    if round_through(F, I, m, record):
        round_plan(F, I, S, m)
        return
    I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE] = 0
    if look_through(F, I, m, record):
        look_scan(F, I, S, m)
        look_plan(F, I, S, m)
        return
    q: int = MQF_BASE + record * MQF_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    F[f + MSF_STRETCH_U] = F[f + MSF_ORIGIN_U] + F[q + MQF_LENGTH_U]
    F[f + MSF_LOOK_CAP_UPS] = 0.0
    I[MSI_BASE + m * MSI_STRIDE + MSI_STRETCH] = 1
    profile_plan(
        F,
        I,
        m,
        F[f + MSF_STRETCH_U],
        master_limit(F, I, S, m),
        move_final_ups(F, I, m, record),
        F[q + MQF_ACC_UPS2],
        F[q + MQF_DEC_UPS2],
        F[q + MQF_STP_UPS2],
        F[q + MQF_JRK_UPS3],
    )


def look_rebase(F: F64, m: int) -> None:
    """Count the path from the beginning of the present move again."""
    f: int = MSF_BASE + m * MSF_STRIDE
    origin: float = F[f + MSF_ORIGIN_U]
    F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] -= origin
    F[f + MSF_STRETCH_U] -= origin
    F[f + MSF_ORIGIN_U] = 0.0


def look_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan through the stretch that was found, to its end or to the junction there.

    A path already slower there than the junction allows arrives with the speed it has.
    """
    f: int = MSF_BASE + m * MSF_STRIDE
    stretch: int = I[MSI_BASE + m * MSI_STRIDE + MSI_STRETCH]
    last: int = look_record(I, m, stretch - 1)
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    limit: float = master_limit(F, I, S, m)
    leaving: float = F[f + MSF_LOOK_EXIT_UPS]
    rate: float = F[MQF_BASE + last * MQF_STRIDE + MQF_STP_UPS2]
    ends: bool = stretch >= I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED]
    if not ends:
        rate = look_rate(F, last) if leaving < limit else 0.0
    I[MF4_WORD + m] &= ~MF4_LOOK_AHEAD_SLOWDOWN
    if not ends and leaving < limit:
        I[MF4_WORD + m] |= MF4_LOOK_AHEAD_SLOWDOWN
    profile_plan(
        F,
        I,
        m,
        F[f + MSF_STRETCH_U],
        limit,
        leaving,
        F[q + MQF_ACC_UPS2],
        F[q + MQF_DEC_UPS2],
        rate,
        F[q + MQF_JRK_UPS3],
    )
    if not ends:
        round_decelerate(I, m)


def look_refresh(F: F64, I: I32, S: F32, m: int) -> None:
    """The buffer has changed: plan again if that makes a difference to the present plan."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    I[i + MSI_LOOK_DIRTY] = 0
    if round_through(F, I, m, move_record(I, m)):
        round_plan(F, I, S, m)
        return
    if not look_through(F, I, m, move_record(I, m)):
        return
    end: float = F[f + MSF_STRETCH_U]
    cap: float = F[f + MSF_LOOK_CAP_UPS]
    leaving: float = F[f + MSF_LOOK_EXIT_UPS]
    look_scan(F, I, S, m)
    if (
        end != F[f + MSF_STRETCH_U]
        or cap != F[f + MSF_LOOK_CAP_UPS]
        or leaving != F[f + MSF_LOOK_EXIT_UPS]
    ):
        look_rebase(F, m)
        look_plan(F, I, S, m)
