"""JOG HOME: find the edge of the home input and make it position 0.

    SEARCH    JOG VEL in the given direction until the home input changes (without backup)
              or its selected edge is crossed (with backup); a limit turns the search round
              once, the second limit fails
    REVERSE   ramp down with HLDEC or SLDEC, then search the other way
    STOP0     ramp down; the rest position becomes 0 (no backup)
    STOP1     ramp down, then approach the edge
    APPROACH  JOG HOMVF until the selected edge; done at once if the direction is the final
              one, otherwise
    STOP2     ramp down, then approach again in the final direction

The positive edge is the border on the positive side of the region where the home input is
active. Moving in direction m, edge e is met when the input turns off for m = e, on for
m = -e.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_preload, axis_scale, axis_sense, limit_bars
from openacr.kernel.axis.capture_cy import capture_input_position, encoder_shift
from openacr.kernel.jog.jogplan_cy import FAR_CNT, JOG_PROFILE, jog_ramp_down, jog_run, jog_setting
from openacr.kernel.profile.ramps_cy import DECELERATING
from openacr.map.rows import axes, plant, profiles
from openacr.map.words import af4, af5
from openacr.views import F32, F64, I32

__all__ = ["home_abort", "home_begin"]

HOME_OFF = 0
HOME_START = 1
HOME_SEARCH = 2
HOME_REVERSE = 3
HOME_STOP0 = 4
HOME_STOP1 = 5
HOME_APPROACH = 6
HOME_STOP2 = 7

HARD_LIMIT_HIT = 1
SOFT_LIMIT_HIT = 2
INPUTS = 32  # those whose edges within a tick are seen
SLOW_SHARE = 0.1  # of JOG VEL, where HOMVF is 0


def home_edge(I: I32, n: int) -> int:
    """+1 or -1: which side of the active region is the reference edge."""
    return -1 if I[af5.word[n]] & af5.HOME_NEGATIVE_EDGE_SELECT else 1


def home_final(I: I32, n: int) -> int:
    """+1 or -1: direction in which the final approach has to end."""
    return -1 if I[af5.word[n]] & af5.HOME_NEGATIVE_FINAL_DIRECTION else 1


def home_run(F: F64, I: I32, S: F32, n: int, state: int, sign: int, speed_cps: float) -> None:
    """Enter `state` and move in direction `sign` of the units, without a target."""
    I[axes.home_state[n]] = state
    I[axes.home_moving[n]] = sign
    jog_run(F, I, S, n, sign * axis_sense(S, n), FAR_CNT, speed_cps)


def home_brake(F: F64, I: I32, S: F32, n: int, state: int) -> None:
    """Enter `state` and ramp down with JOG DEC and JRK."""
    I[axes.home_state[n]] = state
    dec_cps2: float = jog_setting(S, n, axes.jog_decel_setting[n])
    jog_ramp_down(F, I, n, dec_cps2, jog_setting(S, n, axes.jog_jerk_setting[n]), DECELERATING)


def home_approach(F: F64, I: I32, S: F32, n: int, sign: int) -> None:
    """Approach the edge slowly in direction `sign`."""
    scale: float = fabs(axis_scale(S, n))
    speed_cps: float = F[axes.homvf_ups[n]] * scale
    if speed_cps <= 0.0:
        speed_cps = SLOW_SHARE * jog_setting(S, n, axes.jog_veloc_setting[n])
    home_run(F, I, S, n, HOME_APPROACH, sign, speed_cps)


def home_end(I: I32, n: int, result: int) -> None:
    """Leave homing with the given result flag."""
    I[axes.home_state[n]] = HOME_OFF
    I[af5.word[n]] = (I[af5.word[n]] & ~af5.HOMING_IN_PROGRESS) | result


def home_abort(I: I32, n: int) -> None:
    """Homing was ended from outside (JOG OFF, kill): it has failed."""
    if I[axes.home_state[n]] != HOME_OFF:
        home_end(I, n, af5.HOME_FAILED)


def home_zero(F: F64, I: I32, S: F32, n: int, origin_cnt: float) -> None:
    """Make the actual position `origin_cnt` the new 0; the axis is commanded to stand there."""
    encoder_shift(F, I, S, n, int(origin_cnt))
    axis_preload(F, I, n, 0.0)


def home_fail(I: I32, n: int) -> None:
    """Both limits were met: failed, and the axis is killed as by a limit."""
    home_end(I, n, af5.HOME_FAILED)
    I[af4.word[n]] |= af4.KILL_ALL_MOTION_REQUEST


def home_limit(F: F64, I: I32, S: F32, n: int) -> None:
    """A limit was met in search: turn round once, then fail."""
    hit: int = I[axes.home_limit_hit[n]]
    I[axes.home_limit_hit[n]] = 0
    if I[axes.home_state[n]] == HOME_REVERSE:
        return
    if I[axes.home_reversed[n]] or I[axes.home_state[n]] != HOME_SEARCH:
        home_fail(I, n)
        return
    I[axes.home_reversed[n]] = 1
    I[axes.home_state[n]] = HOME_REVERSE
    rate_cps2: float = F[axes.sldec_ups2[n]] if hit == SOFT_LIMIT_HIT else F[axes.hldec_ups2[n]]
    jog_ramp_down(F, I, n, rate_cps2 * fabs(axis_scale(S, n)), 0.0, DECELERATING)


def home_begin(I: I32, n: int, direction: int) -> None:
    """Let the search in `direction` begin with the next tick."""
    results: int = af5.HOME_SUCCESSFUL | af5.HOME_FAILED
    I[af5.word[n]] = (I[af5.word[n]] & ~results) | af5.HOMING_IN_PROGRESS
    I[axes.home_search[n]] = direction
    I[axes.home_state[n]] = HOME_START


def home_start(F: F64, I: I32, S: F32, n: int) -> None:
    """Begin the search; a home input that is already on is left towards its edge first.

    A limit that bars the direction already turns the search round before anything moves.
    """
    flags: int = I[af5.word[n]]
    sign: int = I[axes.home_search[n]]
    if flags & af5.HOME_BACKUP_ENABLE and flags & af5.HOME_INPUT:
        sign = home_edge(I, n)
    I[axes.home_input_old[n]] = flags & af5.HOME_INPUT
    I[axes.home_reversed[n]] = 0
    I[axes.home_limit_hit[n]] = 0
    if limit_bars(F, I, S, n, sign):
        I[axes.home_reversed[n]] = 1
        sign = -sign
        if limit_bars(F, I, S, n, sign):
            home_fail(I, n)
            return
    home_run(F, I, S, n, HOME_SEARCH, sign, jog_setting(S, n, axes.jog_veloc_setting[n]))


def home_step(F: F64, I: I32, S: F32, n: int) -> bool:
    """Look at limits and home input of this tick; True when the axis is to rest at once."""
    state: int = I[axes.home_state[n]]
    if state == HOME_START:
        home_start(F, I, S, n)
        return False
    if I[axes.home_limit_hit[n]]:
        home_limit(F, I, S, n)
    if I[axes.home_state[n]] == HOME_SEARCH:
        home_pace(F, I, S, n)
    now: int = I[af5.word[n]] & af5.HOME_INPUT
    old: int = I[axes.home_input_old[n]]
    I[axes.home_input_old[n]] = now
    if now == old and not home_passed(I, n):
        return False
    same: bool = I[axes.home_moving[n]] == home_edge(I, n)
    if now == old:  # of the two edges that were met, the one that counts
        now = 0 if same else af5.HOME_INPUT
    crossed: bool = now == 0 if same else now != 0
    backup: bool = I[af5.word[n]] & af5.HOME_BACKUP_ENABLE != 0
    state = I[axes.home_state[n]]
    if state == HOME_SEARCH and not backup:
        home_brake(F, I, S, n, HOME_STOP0)
    elif state == HOME_SEARCH and crossed:
        home_brake(F, I, S, n, HOME_STOP1)
    elif state == HOME_APPROACH and crossed:
        if I[axes.home_moving[n]] == home_final(I, n):
            F[axes.home_edge_cnt[n]] = home_edge_position(F, I, n, now)
            home_stop_dead(F, I, S, n)
            return True
        home_brake(F, I, S, n, HOME_STOP2)
    return False


def home_pace(F: F64, I: I32, S: F32, n: int) -> None:
    """Follow a JOG VEL changed during the search."""
    speed_cps: float = jog_setting(S, n, axes.jog_veloc_setting[n])
    if speed_cps != F[profiles.target_velocity[JOG_PROFILE + n]]:
        home_run(F, I, S, n, HOME_SEARCH, I[axes.home_moving[n]], speed_cps)


def home_passed(I: I32, n: int) -> bool:
    """Whether the home input has changed and changed back within this tick."""
    number: int = I[axes.hlbit[n]] + 2
    both: int = I[plant.rises] & I[plant.falls]
    return 0 <= number < INPUTS and (both >> number) & 1 != 0


def home_edge_position(F: F64, I: I32, n: int, now: int) -> float:
    """Actual position at which the home input changed within this tick.

    The edge of the input itself is the other one where its level is inverted.
    """
    number: int = I[axes.hlbit[n]] + 2
    inverted: bool = I[af5.word[n]] & af5.HOME_LEVEL_INVERT != 0
    return capture_input_position(F, I, n, number, (now == 0) != inverted)


def home_stop_dead(F: F64, I: I32, S: F32, n: int) -> None:
    """End the approach in this tick; the reference edge becomes 0."""
    home_zero(F, I, S, n, F[axes.home_edge_cnt[n]])
    home_end(I, n, af5.HOME_SUCCESSFUL)


def home_arrived(F: F64, I: I32, S: F32, n: int) -> bool:
    """A ramp of the sequence has come to rest; True when homing is over."""
    state: int = I[axes.home_state[n]]
    speed_cps: float = jog_setting(S, n, axes.jog_veloc_setting[n])
    if state == HOME_REVERSE:
        home_run(F, I, S, n, HOME_SEARCH, -I[axes.home_moving[n]], speed_cps)
    elif state == HOME_STOP1:
        home_approach(F, I, S, n, -I[axes.home_moving[n]])
    elif state == HOME_STOP2:
        home_approach(F, I, S, n, home_final(I, n))
    elif state == HOME_STOP0:
        home_zero(F, I, S, n, I[axes.actual_position[n]])
        home_end(I, n, af5.HOME_SUCCESSFUL)
    return I[axes.home_state[n]] == HOME_OFF
