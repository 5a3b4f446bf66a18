"""The time base of a master: how much path time passes in a servo period (SRC, TOV).

From the clock one period passes, from any other source 1 s for 1000 of its pulses; TOV
multiplies that. Speed scales with the pace, acceleration with its square, the path stays.
A source that runs backwards takes the path back, to the start of the present plan.
"""

from openacr.kernel.profile.profile_cy import profile_advance
from openacr.kernel.sources.source_cy import FROM_CLOCK, PULSES_PER_S, TIME_TAPS, source_follow
from openacr.map.rows import masters, profiles, sources
from openacr.map.words import mf2
from openacr.views import F32, F64, I32

FASTEST = 2.0


def tov_factor(I: I32, S: F32, m: int, dt_s: float) -> float:
    """TOV Internal, which approaches the commanded value with TOV Rate."""
    wanted: float = 1.0
    if I[mf2.word[m]] & mf2.MASTER_TOV:
        wanted = S[masters.time_over_velocity[m]]
        wanted = wanted if wanted > 0.0 else 0.0
        wanted = wanted if wanted < FASTEST else FASTEST
    factor: float = S[masters.tov_internal[m]]
    step: float = S[masters.tov_rate[m]] * dt_s
    if step > 0.0 and factor + step < wanted:
        wanted = factor + step
    elif step > 0.0 and factor - step > wanted:
        wanted = factor - step
    S[masters.tov_internal[m]] = wanted
    return wanted


def path_time(F: F64, I: I32, S: F32, m: int, dt_s: float) -> float:
    """Path time of a paced master m in a servo period of `dt_s` seconds; also while it rests."""
    tap: int = TIME_TAPS + m
    by_clock: bool = I[sources.kind[tap]] == FROM_CLOCK
    time_s: float = dt_s
    if not by_clock:
        source_follow(F, I, S, tap)
        time_s = F[sources.delta[tap]] / PULSES_PER_S
    factor: float = tov_factor(I, S, m, dt_s)
    if by_clock and factor == 1.0:
        I[masters.paced[m]] = I[mf2.word[m]] & mf2.MASTER_TOV
    time_s = time_s * factor
    F[masters.pace[m]] = time_s / dt_s
    return time_s


def path_advance(F: F64, I: I32, m: int, time_s: float) -> float:
    """Advance the path, backwards for negative times; as `profile_advance`."""
    if time_s < 0.0:
        k: int = I[profiles.seg_index[m]]
        t_s: float = F[profiles.time_s[m]] + time_s
        while t_s < 0.0 and k > 0:
            k -= 1
            t_s += F[profiles.seg_time_s[m] + k]
        F[profiles.time_s[m]] = t_s if t_s > 0.0 else 0.0
        I[profiles.seg_index[m]] = k
        time_s = 0.0
    return profile_advance(F, I, m, time_s)
