"""The time base of a master: how much path time passes in a servo period (SRC, TOV).

From the clock one period passes, from any other source 1 s for 1000 of its pulses; TOV
multiplies that. Speed scales with the pace, acceleration with its square, the path stays.
A source that runs backwards takes the path back, to the start of the present plan.
"""

from openacr.kernel.path_cy import master_word2
from openacr.kernel.profile_cy import profile_advance
from openacr.kernel.words_cy import wrap32
from openacr.map.numbers import (
    MA_BASE,
    MA_STRIDE,
    MA_TIME_OVER_VELOCITY,
    MA_TOV_INTERNAL,
    MA_TOV_RATE,
    MF2_MASTER_TOV,
    MSF_BASE,
    MSF_PACE,
    MSF_SOURCE_OLD,
    MSF_STRIDE,
    MSI_BASE,
    MSI_PACED,
    MSI_SOURCE_INDEX,
    MSI_SOURCE_KIND,
    MSI_STRIDE,
    PRF_BASE,
    PRF_SEG_TIME_S,
    PRF_STRIDE,
    PRF_TIME_S,
    PRI_BASE,
    PRI_SEG_INDEX,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["source_reset"]

FROM_CLOCK = 0
FROM_NOTHING = 1
FROM_LONG = 2  # a LONG parameter, 32 bits round
FROM_SINGLE = 3  # an FP32 parameter
FROM_DOUBLE = 4  # a user variable
FROM_VOLTS = 5  # an FP32 parameter in 1/1000 of its unit
PULSES_PER_S = 1000.0
FASTEST = 2.0
LARGEST = 1e12  # pulses in one tick; what is beyond is no number


def source_value(F: F64, I: I32, S: F32, kind: int, row: int) -> float:
    """Present value of a source in pulses."""
    if kind == FROM_LONG:
        return I[row]
    if kind == FROM_SINGLE:
        return S[row]
    if kind == FROM_DOUBLE:
        return F[row]
    if kind == FROM_VOLTS:
        return S[row] * PULSES_PER_S
    return 0.0


def source_reset(F: F64, I: I32, S: F32, m: int) -> None:
    """Start counting the source of master m from its present value."""
    i: int = MSI_BASE + m * MSI_STRIDE
    F[MSF_BASE + m * MSF_STRIDE + MSF_SOURCE_OLD] = source_value(
        F, I, S, I[i + MSI_SOURCE_KIND], I[i + MSI_SOURCE_INDEX]
    )


def source_seconds(F: F64, I: I32, S: F32, m: int) -> float:
    """Time the source of master m has counted since the last tick."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    kind: int = I[i + MSI_SOURCE_KIND]
    value: float = source_value(F, I, S, kind, I[i + MSI_SOURCE_INDEX])
    delta: float = value - F[f + MSF_SOURCE_OLD]
    F[f + MSF_SOURCE_OLD] = value
    if kind == FROM_LONG:
        delta = wrap32(int(delta))
    if not -LARGEST < delta < LARGEST:
        return 0.0
    return delta / PULSES_PER_S


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
    i: int = MSI_BASE + m * MSI_STRIDE
    time: float = dt
    if I[i + MSI_SOURCE_KIND] != FROM_CLOCK:
        time = source_seconds(F, I, S, m)
    factor: float = tov_factor(I, S, m, dt)
    if I[i + MSI_SOURCE_KIND] == FROM_CLOCK and factor == 1.0:
        I[i + MSI_PACED] = I[master_word2(m)] & MF2_MASTER_TOV
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
