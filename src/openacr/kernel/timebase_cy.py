"""The time base of a master: how much path time passes in a servo period (SRC, TOV).

From the clock one period passes, from any other source 1 s for 1000 of its pulses; TOV
multiplies that. Speed scales with the pace, acceleration with its square, the path stays.
A source that runs backwards takes the path back, to the start of the present plan.
"""

from openacr.kernel.path_cy import master_word2
from openacr.kernel.profile_cy import profile_advance
from openacr.kernel.source_cy import FROM_CLOCK, PULSES_PER_S, TIME_TAPS, source_follow
from openacr.map.numbers import (
    MA_BASE,
    MA_STRIDE,
    MA_TIME_OVER_VELOCITY,
    MA_TOV_INTERNAL,
    MA_TOV_RATE,
    MF2_MASTER_TOV,
    MSF_BASE,
    MSF_PACE,
    MSF_STRIDE,
    MSI_BASE,
    MSI_PACED,
    MSI_STRIDE,
    PRF_BASE,
    PRF_SEG_TIME_S,
    PRF_STRIDE,
    PRF_TIME_S,
    PRI_BASE,
    PRI_SEG_INDEX,
    PRI_STRIDE,
    SRF_BASE,
    SRF_DELTA,
    SRF_STRIDE,
    SRI_BASE,
    SRI_KIND,
    SRI_STRIDE,
)
from openacr.views import F32, F64, I32

FASTEST = 2.0


def tov_factor(I: I32, S: F32, m: int, dt: float) -> float:
    """TOV Internal, on its way to the value wanted with TOV Rate."""
    p: int = MA_BASE + m * MA_STRIDE
    wanted: float = 1.0
    if I[master_word2(m)] & MF2_MASTER_TOV:
        wanted = S[p + MA_TIME_OVER_VELOCITY]
        wanted = wanted if wanted > 0.0 else 0.0
        wanted = wanted if wanted < FASTEST else FASTEST
    factor: float = S[p + MA_TOV_INTERNAL]
    step: float = S[p + MA_TOV_RATE] * dt
    if step > 0.0 and factor + step < wanted:
        wanted = factor + step
    elif step > 0.0 and factor - step > wanted:
        wanted = factor - step
    S[p + MA_TOV_INTERNAL] = wanted
    return wanted


def path_time(F: F64, I: I32, S: F32, m: int, dt: float) -> float:
    """Path time of a paced master m in a servo period of `dt` seconds; also while it rests."""
    tap: int = TIME_TAPS + m
    by_clock: bool = I[SRI_BASE + tap * SRI_STRIDE + SRI_KIND] == FROM_CLOCK
    time: float = dt
    if not by_clock:
        source_follow(F, I, S, tap)
        time = F[SRF_BASE + tap * SRF_STRIDE + SRF_DELTA] / PULSES_PER_S
    factor: float = tov_factor(I, S, m, dt)
    if by_clock and factor == 1.0:
        I[MSI_BASE + m * MSI_STRIDE + MSI_PACED] = I[master_word2(m)] & MF2_MASTER_TOV
    time = time * factor
    F[MSF_BASE + m * MSF_STRIDE + MSF_PACE] = time / dt
    return time


def path_advance(F: F64, I: I32, m: int, time: float) -> float:
    """Advance the path, backwards for negative times; as `profile_advance`."""
    if time < 0.0:
        f: int = PRF_BASE + m * PRF_STRIDE
        k: int = I[PRI_BASE + m * PRI_STRIDE + PRI_SEG_INDEX]
        t: float = F[f + PRF_TIME_S] + time
        while t < 0.0 and k > 0:
            k -= 1
            t += F[f + PRF_SEG_TIME_S + k]
        F[f + PRF_TIME_S] = t if t > 0.0 else 0.0
        I[PRI_BASE + m * PRI_STRIDE + PRI_SEG_INDEX] = k
        time = 0.0
    return profile_advance(F, I, m, time)
