"""Look-ahead: how fast the path may be at the junctions of the moves that wait.

At a junction with turn angle q the speed is bounded by the law

    q <= a1          both moves' own speed (no slow-down)
    q >= a2          Look Ahead Min Vel
    between          linear from the one to the other

Corners with a tolerance are rounded (round_law_cy) or, where that takes longer, stops.

A plan runs through a *section*: the present move and those after it up to the first
junction that slows the path down, a change of speed or ramps, or the end of the buffer.
Inside a section a ramp takes no notice of junctions, so that short moves lose nothing, with
jerk or without. With jerk, junctions that slow down little do not end a section either:
it runs at the lowest of their speeds throughout, instead of dipping at each.

    speed  ___________
          /           \\____            The backward pass: from the last move on, what a
         /                 \\__ c2      ramp over each section can still slow down from
    ____/                     \\        bounds the junction in front of it.
        | move | move | move | m |     The first section is planned to the smaller of
        '-- section --'               that and of its law.

Moves with a time, a capture or a trigger of their own are entered and left at rest.
"""

from openacr.cmath import sqrt
from openacr.kernel.path.bezier_cy import is_bezier, is_timed
from openacr.kernel.path.path_cy import (
    MARK_CURVE_BEGIN,
    MARK_TURN,
    move_final_ups,
    move_limit,
    move_override,
)
from openacr.map.rows import masters, moves
from openacr.map.words import mf4
from openacr.views import F32, F64, I32

__all__ = ["ramp_start"]

FREE = 1.0 - 1e-6  # of the speed: what rounding makes of a straight junction
SLIGHT = 0.8  # of the speed: with jerk, slow-downs down to here do not end a section
BISECTIONS = 50
ENDLESS_UPS = 1e30
# What is decided about the junction after a move (row ahead), for good: see round_between_cy.
AS_LOOK = 0  # nothing: LOOK rules as it is when the path comes there
JOINED = 1  # the path goes on, through a rounded corner or straight
STOPS = 2  # a corner with a tolerance that is better passed by a stop
APART = 3  # the move ends as moves do without LOOK
BY_LOOK = 4  # LOOK rules, and has planned to go on: too late to end there when LOOK goes off


def look_active(I: I32, m: int) -> bool:
    """Whether master m looks ahead."""
    flags: int = I[mf4.word[m]]
    return flags & mf4.LOOK_AHEAD_MODE != 0 and not flags & mf4.LOOK_AHEAD_NEGLECT


def look_beyond(I: I32, m: int, record: int) -> bool:
    """Whether plans may run beyond a move: as LOOK says, or as its junction was decided."""
    decided: int = I[moves.ahead[record]]
    return look_active(I, m) if decided == AS_LOOK else decided != APART


def look_through(F: F64, I: I32, m: int, record: int) -> bool:
    """Whether plans may run beyond a move: with look-ahead, and along SPLINE and NURB always."""
    if not look_plain(F, I, record):
        return False
    return look_active(I, m) or is_bezier(I, record) or I[moves.ahead[record]] == BY_LOOK


def same_curve(I: I32, a: int, b: int) -> bool:
    """Whether both of two moves that follow each other are moves of one curve."""
    marks: int = I[moves.marks[b]]
    return is_bezier(I, a) and is_bezier(I, b) and not marks & MARK_CURVE_BEGIN


def look_record(I: I32, m: int, k: int) -> int:
    """Record of the move `k` places after the present one."""
    place: int = I[masters.head[m]] + k
    if place >= I[masters.size[m]]:
        place -= I[masters.size[m]]
    return I[masters.first[m]] + place


def look_plain(F: F64, I: I32, record: int) -> bool:
    """Whether a move may merge: it has no time, flag, capture or trigger of its own."""
    special: int = (
        I[moves.seek_axis[record]] | I[moves.hsint_axis[record]] | I[moves.interrupt[record]]
    )
    special = special | I[moves.trigger[record]] | I[moves.trigger_axis[record]]
    special = special | (I[moves.marks[record]] & MARK_TURN)
    return special == 0 and F[moves.tmov_s[record]] <= 0.0


def look_speed(F: F64, I: I32, S: F32, m: int, record: int) -> float:
    """Speed of a move the junctions are laid out for; overrides below 1 come on top."""
    override: float = move_override(I, S, m, record)
    return move_limit(F, I, S, m, record, override if override > 1.0 else 1.0)


def look_corner(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Speed the law allows between two moves."""
    if not (look_plain(F, I, a) and look_plain(F, I, b)):
        return 0.0
    velocity_ups: float = min(look_speed(F, I, S, m, a), look_speed(F, I, S, m, b))
    if F[moves.corner_u[a]] > 0.0:  # see round_law_cy
        return min(velocity_ups, F[moves.corner_ups[a]])
    if same_curve(I, a, b) or is_timed(I, a):
        return velocity_ups
    if is_timed(I, b):
        return 0.0
    if I[moves.ahead[a]] == STOPS:
        return 0.0
    if not look_beyond(I, m, a):  # beside a curve moves merge as they do without look-ahead
        return min(velocity_ups, look_final(F, I, S, m, a))
    turn_deg: float = F[moves.turn_deg[a]]
    from_deg: float = F[masters.look_from_deg[m]]
    to_deg: float = F[masters.look_to_deg[m]]
    lowest_ups: float = S[masters.look_ahead_min_vel[m]]
    lowest_ups = lowest_ups if lowest_ups > 0.0 else 0.0
    lowest_ups = min(lowest_ups, velocity_ups)
    if turn_deg <= from_deg:
        return velocity_ups
    if turn_deg >= to_deg:
        return lowest_ups
    return velocity_ups - (velocity_ups - lowest_ups) * (turn_deg - from_deg) / (to_deg - from_deg)


def look_merges(F: F64, I: I32, S: F32, m: int, a: int, b: int, corner_ups: float) -> bool:
    """Whether one plan may run through the junction of two moves."""
    if F[moves.corner_u[a]] > 0.0 or F[moves.corner_u[b]] > 0.0:
        return False
    return look_alike(F, I, S, m, a, b, corner_ups)


def look_alike(F: F64, I: I32, S: F32, m: int, a: int, b: int, corner_ups: float) -> bool:
    """Whether two moves with `corner_ups` between them have one speed and the same ramps."""
    velocity_ups: float = look_speed(F, I, S, m, a)
    if velocity_ups != look_speed(F, I, S, m, b) or not velocity_ups > 0.0:
        return False
    if F[moves.acc_ups2[a]] != F[moves.acc_ups2[b]] or F[moves.dec_ups2[a]] != F[moves.dec_ups2[b]]:
        return False
    if F[moves.jrk_ups3[a]] != F[moves.jrk_ups3[b]]:
        return False
    rapid: int = I[moves.rapid[a]]
    if rapid != I[moves.rapid[b]]:
        return False
    return corner_ups >= velocity_ups * (SLIGHT if F[moves.jrk_ups3[a]] > 0.0 else FREE)


def ramp_start(length_u: float, end_ups: float, rate_ups2: float, jerk_ups3: float) -> float:
    """The highest speed from which a ramp down to `end_ups` fits into `length_u`.

    Its length is (v + e)/2 times its time. With h = rate^2/(2 J) a ramp that reaches its
    rate takes (v - e)/rate + rate/J, so (v + h)^2 = (e - h)^2 + 2 rate length; one that
    does not takes 2 sqrt((v - e)/J), found by bisection.
    """
    if rate_ups2 <= 0.0:
        return ENDLESS_UPS
    if jerk_ups3 <= 0.0:
        return sqrt(end_ups * end_ups + 2.0 * rate_ups2 * length_u)
    half_ups: float = rate_ups2 * rate_ups2 / (2.0 * jerk_ups3)
    start_ups: float = (
        sqrt((end_ups - half_ups) * (end_ups - half_ups) + 2.0 * rate_ups2 * length_u) - half_ups
    )
    if start_ups - end_ups >= 2.0 * half_ups:
        return start_ups
    low_ups: float = 0.0
    high_ups: float = 2.0 * half_ups
    for _ in range(BISECTIONS):
        middle_ups: float = (low_ups + high_ups) / 2.0
        if (2.0 * end_ups + middle_ups) * sqrt(middle_ups / jerk_ups3) > length_u:
            high_ups = middle_ups
        else:
            low_ups = middle_ups
    return end_ups + low_ups


def look_final(F: F64, I: I32, S: F32, m: int, record: int) -> float:
    """Speed at which the last move of the buffer ends."""
    if F[moves.stp_ups2[record]] <= 0.0:
        return look_speed(F, I, S, m, record)
    return move_final_ups(F, I, m, record)


def look_rate(F: F64, record: int) -> float:
    """The ramp for slowing down inside a path: DEC, or STP if that is 0."""
    return (
        F[moves.dec_ups2[record]] if F[moves.dec_ups2[record]] > 0.0 else F[moves.stp_ups2[record]]
    )


def look_jerk(F: F64, record: int) -> float:
    """The jerk of a move."""
    return F[moves.jrk_ups3[record]]


def look_entry(F: F64, I: I32, S: F32, m: int, first: int) -> float:
    """Backward pass: the highest entry speed of the move `first` places after the present one."""
    k: int = I[masters.queued[m]] - 1
    b: int = look_record(I, m, k)
    end_ups: float = look_final(F, I, S, m, b)
    rate_ups2: float = F[moves.stp_ups2[b]]
    length_u: float = F[moves.length_u[b]]
    cap_ups: float = look_speed(F, I, S, m, b)
    while k > first:
        a: int = look_record(I, m, k - 1)
        corner_ups: float = look_corner(F, I, S, m, a, b)
        if look_merges(F, I, S, m, a, b, corner_ups):
            length_u += F[moves.length_u[a]]
            cap_ups = min(cap_ups, corner_ups)
        else:
            length_u -= F[moves.corner_u[a]]
            jerk_ups3: float = F[moves.jrk_ups3[b]]
            entry_ups: float = ramp_start(max(length_u, 0.0), end_ups, rate_ups2, jerk_ups3)
            end_ups = min(corner_ups, min(entry_ups, cap_ups))
            rate_ups2 = look_rate(F, a)
            if I[moves.ahead[a]] == AS_LOOK and not look_through(F, I, m, a):
                rate_ups2 = F[moves.stp_ups2[a]]
            length_u = F[moves.length_u[a]]
            length_u -= F[moves.corner_u[a]]
            cap_ups = look_speed(F, I, S, m, a)
        b = a
        k -= 1
    return min(cap_ups, ramp_start(length_u, end_ups, rate_ups2, look_jerk(F, b)))


def look_scan(F: F64, I: I32, S: F32, m: int) -> None:
    """Find the section of the present move: its end, its cap and the speed at its end."""
    queued: int = I[masters.queued[m]]
    a: int = look_record(I, m, 0)
    end_u: float = F[masters.origin_u[m]] + F[moves.length_u[a]]
    cap_ups: float = 0.0
    velocity_ups: float = look_speed(F, I, S, m, a)
    k: int = 1
    corner_ups: float = 0.0
    active: bool = look_active(I, m)
    while k < queued:
        if active and I[moves.ahead[a]] == AS_LOOK:
            I[moves.ahead[a]] = BY_LOOK
        b: int = look_record(I, m, k)
        corner_ups = look_corner(F, I, S, m, a, b)
        if not look_merges(F, I, S, m, a, b, corner_ups):
            break
        if corner_ups < velocity_ups * FREE and (cap_ups <= 0.0 or corner_ups < cap_ups):
            cap_ups = corner_ups
        end_u += F[moves.length_u[b]]
        a = b
        k += 1
    exit_ups: float = 0.0
    if k < queued:
        exit_ups = min(corner_ups, look_entry(F, I, S, m, k))
    else:
        exit_ups = look_final(F, I, S, m, a)
    I[masters.section_cnt[m]] = k
    F[masters.section_u[m]] = end_u
    F[masters.look_cap_ups[m]] = cap_ups
    F[masters.look_exit_ups[m]] = exit_ups
