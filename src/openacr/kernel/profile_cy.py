"""One motion profile: pieces of constant jerk along a path.

                 velocity
                    |      cruise = target_velocity
                    |     ________________
                    |    /                \\
          velocity  |___/                  \\___ end velocity (FVEL)
                    |   ACC                STP
                    +------------------------------- distance
                  distance                  end_distance

A plan is a list of at most 16 segments. Segment k starts at seg_distance, seg_velocity,
seg_accel and runs for seg_time_s with constant jerk j, so that at time t within it

    s = s_k + v_k t + a_k t^2/2 + j t^3/6,   v = v_k + a_k t + j t^2/2,   a = a_k + j t.

The planner decides (profile_plan, profile_stop), the tick only evaluates
(profile_advance): positions come from the closed form of the segment, never from summing
increments, so the end is exact however many ticks a move takes.

Ramps. Without jerk a ramp is one segment. With jerk J a ramp from (v0, a0) to v1 at rest
of acceleration raises |a| to a peak p, holds it, and takes it back. With sign d = +-1 of
the change,

    p^2 = J d (v1 - v0) + a0^2/2     (no hold; cut to the limit, then the hold makes up)

which contains the textbook cases t = dv/a + a/J and t = 2 sqrt(dv/J) for a0 = 0.

A move too short for its cruising speed gets a lower peak, found in closed form without
jerk and by bisection with it; one that is braking already may need a softer end ramp
instead. Only if even the end ramp itself, begun at once, does not fit, its rate is raised
just enough: the target is never overshot. Distances run forwards only; the owner mirrors a
backward motion.

Instances 0-15 are the masters (programming units), 16-31 the jog profilers (pulses).
"""

from openacr.cmath import fabs, sqrt
from openacr.map.rows import profiles
from openacr.views import F64, I32

__all__ = ["profile_advance", "profile_plan", "profile_reset", "profile_stop"]

CRUISING = 0
ACCELERATING = 1
DECELERATING = 2
STOPPING = 3

FOREVER_S = 1e30  # a plan that waits at speed 0 for a new cruising speed
TIME_EPS_S = 1e-10  # far below a servo period, far above the rounding of a sum of them
BISECTIONS = 64
SLACK = 1e-12  # of a length: what sums of its parts may miss by rounding
BACKWARD = 1e-6  # of a speed: more than rounding, see plan_start
LARGEST = 1e15  # speeds and rates beyond are no numbers of any machine


def profile_reset(F: F64, I: I32, n: int, velocity: float, accel: float) -> None:
    """Start profile n at distance 0 with the given speed and acceleration and no plan."""
    F[profiles.distance[n]] = 0.0
    F[profiles.velocity[n]] = velocity
    F[profiles.accel[n]] = accel
    F[profiles.jerk[n]] = 0.0
    F[profiles.time_s[n]] = 0.0
    F[profiles.end_distance[n]] = 0.0
    F[profiles.end_velocity[n]] = velocity
    I[profiles.seg_count[n]] = 0
    I[profiles.seg_index[n]] = 0
    I[profiles.kind[n]] = CRUISING


def plan_start(F: F64, I: I32, n: int, jerk: float) -> None:
    """Empty the plan; planning continues from where the profile is now.

    A jerk too low to end the present braking before the path would run backwards (it has
    been lowered meanwhile) lets the acceleration start from 0 instead.
    """
    velocity: float = F[profiles.velocity[n]]
    accel: float = F[profiles.accel[n]]
    if jerk <= 0.0 or rest_speed(velocity, accel, jerk) < -BACKWARD * fabs(velocity):
        accel = 0.0
    F[profiles.plan_distance[n]] = F[profiles.distance[n]]
    F[profiles.plan_velocity[n]] = velocity
    F[profiles.plan_accel[n]] = accel
    F[profiles.time_s[n]] = 0.0
    I[profiles.seg_count[n]] = 0
    I[profiles.seg_index[n]] = 0


def rest_speed(velocity: float, accel: float, jerk: float) -> float:
    """Speed that is reached when the acceleration is taken to 0 at once."""
    if jerk <= 0.0:
        return velocity
    return velocity + accel * fabs(accel) / (2.0 * jerk)


def ramp_distance(velocity: float, accel: float, goal: float, limit: float, jerk: float) -> float:
    """Distance of a ramp under a jerk limit from a speed and acceleration to another speed."""
    sign: float = 1.0 if goal >= rest_speed(velocity, accel, jerk) else -1.0
    square: float = jerk * sign * (goal - velocity) + accel * accel / 2.0
    peak: float = sign * min(sqrt(max(square, 0.0)), limit)
    rise: float = jerk if peak > accel else -jerk
    t: float = (peak - accel) / rise
    distance: float = t * (velocity + t * (accel / 2.0 + t * rise / 6.0))
    speed: float = velocity + t * (accel + t * rise / 2.0)
    last: float = fabs(peak) / jerk
    if peak != 0.0:
        t = max((goal - speed - peak * last / 2.0) / peak, 0.0)
        distance += t * (speed + t * peak / 2.0)
        speed += t * peak
    return distance + last * (speed + last * (peak / 2.0 - sign * last * jerk / 6.0))


def plain(value: float) -> float:
    """A speed or rate as the planner can use it: 0 for less and for NaN, never infinite."""
    if not value > 0.0:
        return 0.0
    return min(value, LARGEST)


def plan_append(F: F64, I: I32, n: int, time: float, accel: float, jerk: float, kind: int) -> None:
    """Append a segment of constant jerk that starts with `accel`."""
    k: int = I[profiles.seg_count[n]]
    if time <= 0.0 or k >= profiles.SEG_TIME_S_SIZE:
        return
    distance: float = F[profiles.plan_distance[n]]
    velocity: float = F[profiles.plan_velocity[n]]
    F[profiles.seg_time_s[n] + k] = time
    F[profiles.seg_jerk[n] + k] = jerk
    F[profiles.seg_accel[n] + k] = accel
    F[profiles.seg_velocity[n] + k] = velocity
    F[profiles.seg_distance[n] + k] = distance
    I[profiles.seg_kind[n] + k] = kind
    I[profiles.seg_count[n]] = k + 1
    F[profiles.plan_distance[n]] = distance + time * (
        velocity + time * (accel / 2.0 + time * jerk / 6.0)
    )
    F[profiles.plan_velocity[n]] = velocity + time * (accel + time * jerk / 2.0)
    F[profiles.plan_accel[n]] = accel + time * jerk


def plan_ramp(
    F: F64, I: I32, n: int, velocity: float, limit: float, jerk: float, kind: int
) -> None:
    """Append the ramp from the end of the plan to `velocity`; limit 0 is a velocity step."""
    v0: float = F[profiles.plan_velocity[n]]
    a0: float = F[profiles.plan_accel[n]]
    if limit > 0.0 and jerk > 0.0:
        sign: float = 1.0 if velocity >= rest_speed(v0, a0, jerk) else -1.0
        square: float = jerk * sign * (velocity - v0) + a0 * a0 / 2.0
        peak: float = sign * min(sqrt(max(square, 0.0)), limit)
        rise: float = jerk if peak > a0 else -jerk
        gained: float = (peak * peak - a0 * a0) / (2.0 * rise) + peak * fabs(peak) / (2.0 * jerk)
        hold: float = 0.0
        if peak != 0.0:
            hold = (velocity - v0 - gained) / peak
        plan_append(F, I, n, (peak - a0) / rise, a0, rise, kind)
        plan_append(F, I, n, hold, peak, 0.0, kind)
        plan_append(F, I, n, fabs(peak) / jerk, peak, -sign * jerk, kind)
    elif limit > 0.0 and velocity != v0:
        rate: float = limit if velocity > v0 else -limit
        plan_append(F, I, n, (velocity - v0) / rate, rate, 0.0, kind)
    F[profiles.plan_velocity[n]] = velocity
    F[profiles.plan_accel[n]] = 0.0


def plan_build(
    F: F64,
    I: I32,
    n: int,
    peak: float,
    end_velocity: float,
    acc: float,
    dec: float,
    stp: float,
    jerk: float,
    cruise: float,
) -> float:
    """Plan ramp to `peak`, `cruise` seconds there, end ramp; return the distance used."""
    plan_start(F, I, n, jerk)
    if peak >= rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk):
        plan_ramp(F, I, n, peak, acc, jerk, ACCELERATING)
    else:
        plan_ramp(F, I, n, peak, dec, jerk, DECELERATING)
    plan_append(F, I, n, cruise, 0.0, 0.0, CRUISING)
    if end_velocity < peak:
        plan_ramp(F, I, n, end_velocity, stp, jerk, STOPPING)
    return F[profiles.plan_distance[n]] - F[profiles.distance[n]]


def plan_finish(F: F64, I: I32, n: int, end: float) -> None:
    """Make the end of the plan exact: `end` is reached however the sums were rounded."""
    F[profiles.end_distance[n]] = end
    F[profiles.end_velocity[n]] = F[profiles.plan_velocity[n]]


def plan_truncate(F: F64, I: I32, n: int, end: float) -> None:
    """Cut the plan where it passes `end`; speed and acceleration there become its end."""
    count: int = I[profiles.seg_count[n]]
    k: int = 0
    while k + 1 < count and F[profiles.seg_distance[n] + k + 1] < end:
        k += 1
    if count > 0:
        accel: float = F[profiles.seg_accel[n] + k]
        velocity: float = F[profiles.seg_velocity[n] + k]
        jerk: float = F[profiles.seg_jerk[n] + k]
        wanted: float = end - F[profiles.seg_distance[n] + k]
        low: float = 0.0
        high: float = F[profiles.seg_time_s[n] + k]
        for _ in range(BISECTIONS):
            time: float = (low + high) / 2.0
            if time * (velocity + time * (accel / 2.0 + time * jerk / 6.0)) < wanted:
                low = time
            else:
                high = time
        F[profiles.seg_time_s[n] + k] = high
        F[profiles.plan_velocity[n]] = velocity + high * (accel + high * jerk / 2.0)
        F[profiles.plan_accel[n]] = accel + high * jerk
        I[profiles.seg_count[n]] = k + 1
    plan_finish(F, I, n, end)


def profile_plan(
    F: F64,
    I: I32,
    n: int,
    end: float,
    cruise: float,
    end_velocity: float,
    acc: float,
    dec: float,
    stp: float,
    jerk: float,
) -> None:
    """Plan from the present state to distance `end`, cruising at `cruise`.

    ACC serves rises of speed, DEC falls to a lower cruising speed, STP the end ramp to
    `end_velocity`. STP 0 means no end ramp: the profile arrives with the speed (and
    acceleration) it has. A rate of 0 is a velocity step. `cruise` 0 slows to a stop and
    waits there.
    """
    F[profiles.target_velocity[n]] = cruise
    cruise = plain(cruise)
    acc = plain(acc)
    dec = plain(dec)
    stp = plain(stp)
    jerk = plain(jerk)
    distance: float = end - F[profiles.distance[n]]
    plan_start(F, I, n, jerk)
    rest: float = rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk)
    # FVEL never speeds up: at or below it there is nothing to slow down for.
    if end_velocity >= cruise and end_velocity >= rest:
        stp = 0.0
    if stp <= 0.0:
        end_velocity = cruise
    used: float = plan_build(F, I, n, cruise, end_velocity, acc, dec, stp, jerk, 0.0)
    if used <= distance:
        wait: float = (distance - used) / cruise if cruise > 0.0 else FOREVER_S
        plan_build(F, I, n, cruise, end_velocity, acc, dec, stp, jerk, wait)
        plan_finish(F, I, n, end)
    elif stp <= 0.0:
        plan_truncate(F, I, n, end)
    elif jerk > 0.0:
        plan_short_jerk(F, I, n, end, cruise, end_velocity, acc, dec, stp, jerk)
    else:
        plan_short(F, I, n, end, cruise, end_velocity, acc, dec, stp)


def plan_short(
    F: F64,
    I: I32,
    n: int,
    end: float,
    cruise: float,
    end_velocity: float,
    acc: float,
    dec: float,
    stp: float,
) -> None:
    """Plan a move too short for its cruising speed, without jerk limit.

    Two ramps that meet at the peak p cover the distance d:
    (p^2 - v^2)/(2r) + (p^2 - e^2)/(2 stp) = d with r = ACC on a rise (v <= p) and
    r = -DEC on a fall, which is linear in p^2.
    """
    velocity: float = F[profiles.velocity[n]]
    distance: float = end - F[profiles.distance[n]]
    peak: float = 0.0
    if velocity <= cruise:
        peak = short_peak(velocity, end_velocity, distance, acc, stp)
        if peak <= end_velocity:
            # Not even FVEL is reached: speed up to the end, no end ramp.
            plan_build(F, I, n, cruise, cruise, acc, dec, stp, 0.0, 0.0)
            plan_truncate(F, I, n, end)
            return
        peak = peak if peak >= velocity else -1.0
    else:
        peak = short_peak(velocity, end_velocity, distance, -dec, stp)
        peak = peak if end_velocity <= peak <= velocity else -1.0
    if peak >= 0.0:
        plan_build(F, I, n, peak, end_velocity, acc, dec, stp, 0.0, 0.0)
        plan_finish(F, I, n, end)
    else:
        plan_forced(F, I, n, end, end_velocity)


def short_peak(v: float, end_velocity: float, distance: float, rate: float, stp: float) -> float:
    """Speed at which a ramp of `rate` from v and the end ramp meet; -1 if they do not."""
    inverse: float = 1.0 / stp
    square: float = 2.0 * distance + end_velocity * end_velocity / stp
    if rate != 0.0:
        inverse += 1.0 / rate
        square += v * v / rate
    if inverse != 0.0 and square / inverse > 0.0:
        return sqrt(square / inverse)
    return -1.0


def plan_forced(F: F64, I: I32, n: int, end: float, end_velocity: float) -> None:
    """Brake at the one constant rate that still arrives with `end_velocity` (or less)."""
    velocity: float = F[profiles.velocity[n]]
    distance: float = end - F[profiles.distance[n]]
    plan_start(F, I, n, 0.0)
    if distance > 0.0 and velocity > end_velocity:
        # By time: exact even where the two speeds differ in their last bits only.
        time: float = 2.0 * distance / (velocity + end_velocity)
        plan_append(F, I, n, time, (end_velocity - velocity) / time, 0.0, STOPPING)
    elif distance > 0.0 and velocity > 0.0:
        plan_append(F, I, n, distance / velocity, 0.0, 0.0, STOPPING)
        end_velocity = velocity
    F[profiles.plan_velocity[n]] = end_velocity
    F[profiles.plan_accel[n]] = 0.0
    plan_finish(F, I, n, end)


def plan_short_jerk(
    F: F64,
    I: I32,
    n: int,
    end: float,
    cruise: float,
    end_velocity: float,
    acc: float,
    dec: float,
    stp: float,
    jerk: float,
) -> None:
    """Plan a move too short for its cruising speed under a jerk limit.

    The distance of "ramp to p, end ramp" is monotonic in the peak p between the bounds
    tried, so bisection finds the p that covers exactly the distance. The last bracket end
    that still fits is used and the tiny remainder becomes cruising time.
    """
    distance: float = end - F[profiles.distance[n]]
    plan_start(F, I, n, jerk)
    rest: float = rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk)
    fits: float = max(rest, 0.0)
    if rest <= end_velocity:
        # Not even FVEL is reached: speed up to the end, no end ramp.
        fits = end_velocity
        if plan_build(F, I, n, fits, fits, acc, dec, stp, jerk, 0.0) > distance:
            plan_truncate(F, I, n, end)
            return
    elif rest > cruise and dec > stp:
        fits = end_velocity
    fails: float = cruise
    if plan_build(F, I, n, fits, end_velocity, acc, dec, stp, jerk, 0.0) > distance:
        plan_brake(F, I, n, end, end_velocity, max(dec, stp), jerk)
        return
    for _ in range(BISECTIONS):
        peak: float = (fits + fails) / 2.0
        if plan_build(F, I, n, peak, end_velocity, acc, dec, stp, jerk, 0.0) > distance:
            fails = peak
        else:
            fits = peak
    used: float = plan_build(F, I, n, fits, end_velocity, acc, dec, stp, jerk, 0.0)
    wait: float = (distance - used) / fits if fits > 0.0 else 0.0
    plan_build(F, I, n, fits, end_velocity, acc, dec, stp, jerk, wait)
    plan_finish(F, I, n, end)


def plan_ramp_at_once(F: F64, I: I32, n: int, velocity: float, rate: float, jerk: float) -> float:
    """Plan an end ramp that begins now; return the distance it takes."""
    plan_start(F, I, n, jerk)
    plan_ramp(F, I, n, velocity, rate, jerk, STOPPING)
    return F[profiles.plan_distance[n]] - F[profiles.distance[n]]


def plan_brake(
    F: F64, I: I32, n: int, end: float, end_velocity: float, limit: float, jerk: float
) -> None:
    """Plan the end ramp from here, at the softest rate that still fits; else force it.

    A path that brakes already and has too little distance left to let go of the brake first
    keeps braking. The distance grows as the rate falls, so bisection finds the rate; it may be
    above STP, which is then too weak, but not above `limit`.
    """
    distance: float = end - F[profiles.distance[n]]
    if plan_ramp_at_once(F, I, n, end_velocity, limit, jerk) > distance + SLACK * fabs(end):
        plan_forced(F, I, n, end, end_velocity)
        return
    fails: float = 0.0
    fits: float = limit
    for _ in range(BISECTIONS):
        rate: float = (fits + fails) / 2.0
        if plan_ramp_at_once(F, I, n, end_velocity, rate, jerk) > distance:
            fails = rate
        else:
            fits = rate
    plan_ramp_at_once(F, I, n, end_velocity, fits, jerk)
    plan_finish(F, I, n, end)


def profile_stop(F: F64, I: I32, n: int, end: float, rate: float, jerk: float, kind: int) -> bool:
    """Plan a ramp to rest at `rate`, wherever that is; False if it would pass `end`.

    When False is returned the plan is cut at `end` and still moving there.
    """
    jerk = plain(jerk)
    plan_start(F, I, n, jerk)
    plan_ramp(F, I, n, 0.0, plain(rate), jerk, kind)
    if F[profiles.plan_distance[n]] > end:
        plan_truncate(F, I, n, end)
        return False
    plan_finish(F, I, n, F[profiles.plan_distance[n]])
    return True


def profile_advance(F: F64, I: I32, n: int, dt: float) -> float:
    """Advance profile n by `dt` seconds; return the time left over at its end, else -1."""
    count: int = I[profiles.seg_count[n]]
    k: int = I[profiles.seg_index[n]]
    t: float = F[profiles.time_s[n]] + dt
    while k < count and t >= F[profiles.seg_time_s[n] + k] - TIME_EPS_S:
        t -= F[profiles.seg_time_s[n] + k]
        k += 1
    I[profiles.seg_index[n]] = k
    F[profiles.time_s[n]] = t
    if k >= count:
        F[profiles.distance[n]] = F[profiles.end_distance[n]]
        F[profiles.velocity[n]] = F[profiles.end_velocity[n]]
        F[profiles.accel[n]] = F[profiles.plan_accel[n]]
        F[profiles.jerk[n]] = 0.0
        I[profiles.kind[n]] = CRUISING
        return max(t, 0.0)
    jerk: float = F[profiles.seg_jerk[n] + k]
    accel: float = F[profiles.seg_accel[n] + k]
    velocity: float = F[profiles.seg_velocity[n] + k]
    F[profiles.jerk[n]] = jerk
    F[profiles.accel[n]] = accel + t * jerk
    F[profiles.velocity[n]] = velocity + t * (accel + t * jerk / 2.0)
    distance: float = F[profiles.seg_distance[n] + k] + t * (
        velocity + t * (accel / 2.0 + t * jerk / 6.0)
    )
    # Just before the end the sum may be beyond it in its last bit.
    F[profiles.distance[n]] = min(distance, F[profiles.end_distance[n]])
    I[profiles.kind[n]] = I[profiles.seg_kind[n] + k]
    return -1.0
