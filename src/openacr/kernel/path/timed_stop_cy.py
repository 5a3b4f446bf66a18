"""Feed hold of a curve in time: the quickest ramp that keeps the limits of every axis.

The path s of such a curve is time, counted in knots, and the curve is planned: it uses the limits
of the axes up. While a ramp slows s with the acceleration a and the jerk j, an axis at q(s) has

    q'' v^2 + q' a                     acceleration
    q''' v^3 + 3 q'' v a + q' j        jerk

so that no rate is right everywhere. Ramps of three phases (profile_cy.py) are tried from short to
long over the points that are known; the first one that keeps the limits is run. The limits of an
axis are DEC and JRK, or what the curve itself does on the known path where that is more. As long
as there is no such ramp the curve goes on for another piece, and in every piece a shorter one may
replace what was found. Where too little of the curve is known, and for curves other than cubic
ones without weights, or without JRK, the ramp is that of any other move: DEC over the highest
speed of the piece.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.bezier_cy import is_timed
from openacr.kernel.path.lookahead_cy import look_record
from openacr.kernel.path.path_cy import MARK_CURVE_BEGIN, move_record
from openacr.kernel.profile.profile_cy import profile_stop
from openacr.kernel.profile.ramps_cy import DECELERATING
from openacr.map.rows import curves, masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["stop_seek"]

SLAVES = 16
SHORTEST_S = 0.008
LONGER = 1.06
LONGEST_S = 1.0
SHORTER = 0.97  # what a shorter ramp takes at most of the time that is left
SAMPLE_S = 0.001
FEWEST = 48  # samples of a ramp
ENOUGH_S = 0.12  # of the curve known: a ramp may be found further on
WITHIN = 0.995  # of a limit, between two samples
FAR_U = 1e30
# What `stop_seek` has found.
PLAIN = 0  # the ramp of any other move
FOUND = 1
GOES_ON = 2


def stop_pole(F: F64, record: int, s: int, k: int) -> float:
    """Pole k of slave s, relative to the target."""
    return F[curves.amplitude_cnt[record] + k * SLAVES + s]


def stop_is_cubic(F: F64, I: I32, record: int) -> bool:
    """Whether a move is a cubic piece in time without weights."""
    if not is_timed(I, record) or I[moves.degree[record]] != 3:
        return False
    w: int = curves.pole_weight[record]
    return F[w] == F[w + 1] and F[w] == F[w + 2] and F[w] == F[w + 3] and F[w] > 0.0


def stop_slope(F: F64, record: int, s: int, u: float) -> float:
    """Velocity of slave s at u, per unit of the path."""
    r: float = 1.0 - u
    q0: float = stop_pole(F, record, s, 0)
    q1: float = stop_pole(F, record, s, 1)
    q2: float = stop_pole(F, record, s, 2)
    q3: float = stop_pole(F, record, s, 3)
    return (3.0 * (r * r * (q1 - q0) + 2.0 * r * u * (q2 - q1) + u * u * (q3 - q2))) / F[
        moves.length_u[record]
    ]


def stop_bend(F: F64, record: int, s: int, u: float) -> float:
    """Acceleration of slave s at u, per square of the path."""
    q1: float = stop_pole(F, record, s, 1)
    q2: float = stop_pole(F, record, s, 2)
    span: float = F[moves.length_u[record]]
    first: float = q2 - 2.0 * q1 + stop_pole(F, record, s, 0)
    last: float = stop_pole(F, record, s, 3) - 2.0 * q2 + q1
    return 6.0 * ((1.0 - u) * first + u * last) / (span * span)


def stop_twist(F: F64, record: int, s: int) -> float:
    """Jerk of slave s, per cube of the path."""
    span: float = F[moves.length_u[record]]
    third: float = stop_pole(F, record, s, 3) - stop_pole(F, record, s, 0)
    third -= 3.0 * (stop_pole(F, record, s, 2) - stop_pole(F, record, s, 1))
    return 6.0 * third / (span * span * span)


def stop_known(F: F64, I: I32, m: int) -> float:
    """The path left on pieces that are known; 0 where a piece is no plain cubic one."""
    known: float = F[masters.origin_u[m]] - F[profiles.distance[m]]
    for k in range(I[masters.queued[m]]):
        record: int = look_record(I, m, k)
        if k > 0 and I[moves.marks[record]] & MARK_CURVE_BEGIN:
            break
        if not stop_is_cubic(F, I, record):
            return 0.0
        if k > 0:  # the geometry of the present one is known, of the others only their span
            F[moves.length_u[record]] = F[curves.span[record]]
        known += F[moves.length_u[record]]
    return known


def stop_limits(F: F64, I: I32, S: F32, m: int) -> None:
    """Write the limits of every axis in pulses: those of the master, or those of the curve."""
    rate: float = F[moves.vel_ups[move_record(I, m)]]
    for s in range(SLAVES):
        axis: int = I[masters.slave_axis[m] + s]
        accel: float = 0.0
        jerk: float = 0.0
        if axis >= 0:
            scale: float = fabs(axis_scale(S, axis))
            accel = F[masters.dec_ups2[m]] * scale
            jerk = F[masters.jrk_ups3[m]] * scale
        for k in range(I[masters.queued[m]]):
            record: int = look_record(I, m, k)
            if k > 0 and I[moves.marks[record]] & MARK_CURVE_BEGIN:
                break
            if I[moves.curved[record]] & (1 << s):
                bend: float = max(
                    fabs(stop_bend(F, record, s, 0.0)), fabs(stop_bend(F, record, s, 1.0))
                )
                accel = max(accel, bend * rate * rate)
                jerk = max(jerk, fabs(stop_twist(F, record, s)) * rate * rate * rate)
        F[masters.stop_accel[m] + s] = accel * WITHIN
        F[masters.stop_jerk[m] + s] = jerk * WITHIN


def stop_point_keeps(F: F64, I: I32, m: int, record: int, u: float, row: int) -> bool:
    """Whether all axes are within their limits at u, with speed, rate and jerk at F[row]."""
    v: float = F[row]
    a: float = F[row + 1]
    j: float = F[row + 2]
    curved: int = I[moves.curved[record]]
    for s in range(SLAVES):
        if curved & (1 << s):
            slope: float = stop_slope(F, record, s, u)
            bend: float = stop_bend(F, record, s, u)
            if fabs(bend * v * v + slope * a) > F[masters.stop_accel[m] + s]:
                return False
            twist: float = stop_twist(F, record, s) * v * v * v
            if fabs(twist + 3.0 * bend * v * a + slope * j) > F[masters.stop_jerk[m] + s]:
                return False
    return True


def stop_keeps(F: F64, I: I32, m: int) -> bool:
    """Whether the plan of the profile keeps all limits of the axes at every sample."""
    count: int = I[profiles.seg_count[m]]
    step_s: float = min(SAMPLE_S, stop_time(F, I, m) / FEWEST)
    row: int = masters.stop_now[m]
    place: int = 0
    record: int = move_record(I, m)
    begin: float = F[masters.origin_u[m]]
    for k in range(count):
        t: float = 0.0
        left_s: float = F[profiles.seg_time_s[m] + k]
        jerk: float = F[profiles.seg_jerk[m] + k]
        while t <= left_s:
            accel: float = F[profiles.seg_accel[m] + k]
            speed: float = F[profiles.seg_velocity[m] + k]
            s: float = F[profiles.seg_distance[m] + k] + t * (
                speed + t * (accel / 2.0 + t * jerk / 6.0)
            )
            F[row] = speed + t * (accel + t * jerk / 2.0)
            F[row + 1] = accel + t * jerk
            F[row + 2] = jerk
            while s > begin + F[moves.length_u[record]] and place + 1 < I[masters.queued[m]]:
                begin += F[moves.length_u[record]]
                place += 1
                record = look_record(I, m, place)
            u: float = min((s - begin) / F[moves.length_u[record]], 1.0)
            if not stop_point_keeps(F, I, m, record, u, row):
                return False
            t = left_s if t < left_s < t + step_s else t + step_s
    return True


def stop_time(F: F64, I: I32, m: int) -> float:
    """How long the plan of the profile takes."""
    total_s: float = 0.0
    for k in range(I[profiles.seg_count[m]]):
        total_s += F[profiles.seg_time_s[m] + k]
    return total_s


def stop_try(F: F64, I: I32, m: int, end_u: float, rate: float, jerk: float) -> bool:
    """Plan a ramp of this rate and jerk, and examine it."""
    return profile_stop(F, I, m, end_u, rate, jerk, DECELERATING) and stop_keeps(F, I, m)


def stop_shorter(F: F64, I: I32, m: int, end_u: float, most_s: float) -> bool:
    """Take over the shortest ramp that keeps all limits, where it is shorter than `most_s`."""
    speed: float = F[profiles.velocity[m]]
    total_s: float = SHORTEST_S
    while total_s < most_s:
        for n in range(4):
            ramp_s: float = total_s * (4 - n) / 8.0  # a half, 3/8, a quarter, an eighth
            rate: float = speed / (total_s - ramp_s)
            if stop_try(F, I, m, end_u, rate, rate / ramp_s) and stop_time(F, I, m) < most_s:
                F[masters.stop_ups2[m]] = rate
                F[masters.stop_ups3[m]] = rate / ramp_s
                return True
        total_s = total_s * LONGER
    return False


def stop_rests(F: F64, I: I32, m: int) -> bool:
    """Whether the known path ends at rest."""
    record: int = look_record(I, m, I[masters.queued[m]] - 1)
    for s in range(SLAVES):
        if I[moves.curved[record]] & (1 << s) and stop_slope(F, record, s, 1.0) != 0.0:
            return False
    return True


def stop_seek(F: F64, I: I32, S: F32, m: int) -> int:
    """Find the ramp of a feed hold from where the path is: FOUND, GOES_ON or PLAIN.

    Rate and jerk of what is found are left in the rows of the master, and stay for the pieces that
    follow. The plan of the profile is lost.
    """
    rate: float = F[moves.vel_ups[move_record(I, m)]]
    found: bool = F[masters.stop_ups3[m]] > 0.0
    if not F[masters.jrk_ups3[m]] > 0.0 or F[masters.stop_ups3[m]] < 0.0:
        return PLAIN
    known: float = stop_known(F, I, m)
    if known <= 0.0 or not F[profiles.velocity[m]] > 0.0:
        return FOUND if found else PLAIN
    stop_limits(F, I, S, m)
    end_u: float = F[profiles.distance[m]] + known
    most_s: float = LONGEST_S
    if found:
        profile_stop(F, I, m, FAR_U, F[masters.stop_ups2[m]], F[masters.stop_ups3[m]], DECELERATING)
        most_s = stop_time(F, I, m) * SHORTER
    if stop_shorter(F, I, m, end_u, most_s) or found:
        return FOUND
    if stop_rests(F, I, m) or known >= rate * ENOUGH_S:
        return GOES_ON
    F[masters.stop_ups3[m]] = -1.0
    return PLAIN
