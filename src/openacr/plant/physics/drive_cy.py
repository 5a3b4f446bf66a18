"""Drives and friction: what a motor does during one tick of constant voltage.

The voltage is constant during a tick, so the equation of motion

    v' = a - r v - c sign(v)        a drive, r viscous, c Coulomb friction per inertia

is linear as long as v keeps its sign, and is solved exactly instead of integrated. With
z = r t and n = a -+ c:

    v(t) = v0 exp(-z) + n t phi1(z)
    x(t) = x0 + v0 t phi1(z) + n t^2 phi2(z)
    phi1(z) = (1 - exp(-z)) / z,    phi2(z) = (1 - phi1(z)) / z

This is stable for every friction and every length of the tick, so there are no sub-steps.
Where v would change its sign, the moment of standstill is

    t = ln(1 + y) / r,   y = -r v0 / n

and from there the axis either sticks (the drive is weaker than static friction: the speed
is exactly 0 and the position does not creep) or leaves in the other direction.
"""

from openacr.cmath import exp, fabs, log, rint
from openacr.map import numbers as at
from openacr.views import F32, F64, I32

FULL_SCALE_DAC = 32767.0
DAC_COUNTS_PER_VOLT = 3276.8
VOLTS_PER_DAC_COUNT = 10.0 / 32768.0
ROUNDING_SHIFT = 6755399441055744.0
STANDSTILL_CPS = 1e-9
FAULT_TAKEN_BACK = 1
FAULT_REPORTED = 2


def drive_ready(I: I32, i: int) -> int:
    """1 while the drive is enabled and has no fault, and its motor is connected."""
    if I[i + at.PLI_FAULT_MASK] != 0:
        level: int = 0
        if (I[I[i + at.PLI_FAULT_WORD]] & I[i + at.PLI_FAULT_MASK]) != 0:
            level = 1
        I[i + at.PLI_DRIVE_FAULT] = level ^ I[i + at.PLI_FAULT_CLOSED]
    elif I[i + at.PLI_FAULT_REPORT] != 0:
        I[i + at.PLI_DRIVE_FAULT] = 1 if I[i + at.PLI_FAULT_REPORT] == FAULT_REPORTED else 0
    ready: int = 0
    if I[i + at.PLI_DRIVE_ENABLED] != 0 and I[i + at.PLI_DRIVE_FAULT] == 0:
        ready = 1 if I[i + at.PLI_CABLE_CUT] == 0 else 0
    I[i + at.PLI_DRIVE_READY] = ready
    return ready


def drive_volts(F: F64, I: I32, S: F32, f: int, i: int) -> None:
    """Put the output of the card on the drive, with the offset of the drive's own input."""
    F[f + at.PLF_VOLTS] = (
        converter_volts(S, I[i + at.PLI_DAC], F[f + at.PLF_DAC_STEP]) + F[f + at.PLF_OFFSET_V]
    )


def converter_volts(S: F32, dac: int, step: float) -> float:
    """What the card puts out: as many volts as the converter has steps for.

    DAC OUTPUT is what the card wants at its terminals, DAC GAIN and OFFSET included. A value
    that is no number gives 0 V.
    """
    output: float = S[at.DAC_BASE + dac * at.DAC_STRIDE + at.DAC_DAC_OUTPUT]
    wanted: float = output * DAC_COUNTS_PER_VOLT
    counts: float = 0.0
    if fabs(wanted) <= FULL_SCALE_DAC:
        counts = wanted
    elif wanted > 0.0:
        counts = FULL_SCALE_DAC
    elif wanted < 0.0:
        counts = -FULL_SCALE_DAC
    if step != 1.0:
        counts = _coarse_dac(counts, step)
    # Adding 1.5 * 2**52 pushes the fraction out of a double: rint() without a call.
    counts = (counts + ROUNDING_SHIFT) - ROUNDING_SHIFT
    return counts * VOLTS_PER_DAC_COUNT


def _coarse_dac(counts: float, step: float) -> float:
    """Round a 16-bit value as a converter with fewer bits does."""
    rounded: float = rint(counts / step) * step
    if rounded > FULL_SCALE_DAC:
        return rounded - step
    return rounded


def torque_drive(F: F64, f: int, ready: int, dt: float) -> None:
    """Volts make current, current makes torque; without a ready drive the motor coasts.

    Near its highest speed a motor gets only the current that the supply can press against
    its back-EMF: the torque of full voltage less a part that grows with speed. That part
    acts exactly like viscous friction, so the same solution serves with a larger rate.
    """
    push: float = 0.0
    if ready != 0:
        push = clamp_accel(
            F[f + at.PLF_VOLTS] * F[f + at.PLF_ACCEL_PER_VOLT], F[f + at.PLF_PEAK_ACCEL]
        )
        supply: float = F[f + at.PLF_SUPPLY_ACCEL]
        if supply > 0.0:
            back_emf: float = F[f + at.PLF_BACK_EMF_PER_S] * F[f + at.PLF_VELOCITY_CPS]
            if push > supply - back_emf and push > 0.0:
                _friction_glide(
                    F, f, supply, F[f + at.PLF_VISCOUS_PER_S] + F[f + at.PLF_BACK_EMF_PER_S], dt
                )
                return
            if push < -supply - back_emf and push < 0.0:
                _friction_glide(
                    F, f, -supply, F[f + at.PLF_VISCOUS_PER_S] + F[f + at.PLF_BACK_EMF_PER_S], dt
                )
                return
    if F[f + at.PLF_VELOCITY_CPS] == 0.0 and fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        return
    _friction_move(
        F,
        f,
        push,
        F[f + at.PLF_VISCOUS_PER_S],
        dt,
        F[f + at.PLF_DECAY],
        F[f + at.PLF_GLIDE_S],
        F[f + at.PLF_PUSH_S2],
    )


def clamp_accel(value: float, limit: float) -> float:
    """Keep a value between -limit and +limit."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


def _friction_glide(F: F64, f: int, push: float, rate: float, dt: float) -> None:
    """Move for `dt` under constant drive with a viscous rate other than the axis' own."""
    if F[f + at.PLF_VELOCITY_CPS] == 0.0 and fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        return
    z: float = rate * dt
    p2: float = _phi2(z)
    p1: float = 1.0 - z * p2
    _friction_move(F, f, push, rate, dt, 1.0 - z * p1, dt * p1, dt * dt * p2)


def _friction_move(
    F: F64,
    f: int,
    push: float,
    rate: float,
    dt: float,
    decay: float,
    glide_s: float,
    push_s2: float,
) -> None:
    """Solve one tick; `decay`, `glide_s`, `push_s2` are exp(-z), t phi1 and t^2 phi2."""
    v0: float = F[f + at.PLF_VELOCITY_CPS]
    friction: float = F[f + at.PLF_COULOMB_ACCEL]
    net: float = push - friction
    if v0 < 0.0 or (v0 == 0.0 and push < 0.0):
        net = push + friction
    v1: float = v0 * decay + net * glide_s
    if (v0 > 0.0 and v1 <= 0.0) or (v0 < 0.0 and v1 >= 0.0):
        _through_standstill(F, f, push, net, rate, dt)
        return
    if fabs(v1) < STANDSTILL_CPS and fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        v1 = 0.0
    F[f + at.PLF_POSITION_CNT] += v0 * glide_s + net * push_s2
    F[f + at.PLF_VELOCITY_CPS] = v1


def _through_standstill(F: F64, f: int, push: float, net: float, rate: float, dt: float) -> None:
    """Come to rest within the tick, then stick or leave in the other direction."""
    v0: float = F[f + at.PLF_VELOCITY_CPS]
    t: float = dt
    if net != 0.0:
        ratio: float = -v0 / net
        t = ratio * _log1p_ratio(rate * ratio)
        if not (t < dt):
            t = dt
    z: float = rate * t
    p2: float = _phi2(z)
    F[f + at.PLF_POSITION_CNT] += v0 * t * (1.0 - z * p2) + net * t * t * p2
    F[f + at.PLF_VELOCITY_CPS] = 0.0
    if fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        return
    friction: float = F[f + at.PLF_COULOMB_ACCEL]
    net = push - friction
    if push < 0.0:
        net = push + friction
    t = dt - t
    z = rate * t
    p2 = _phi2(z)
    F[f + at.PLF_POSITION_CNT] += net * t * t * p2
    F[f + at.PLF_VELOCITY_CPS] = net * t * (1.0 - z * p2)


def _phi2(z: float) -> float:
    """(1 - phi1(z)) / z with phi1(z) = (1 - exp(-z)) / z; a series where that cancels."""
    if z < 0.05:
        return 0.5 - z * (
            1.0 / 6.0
            - z
            * (
                1.0 / 24.0
                - z * (1.0 / 120.0 - z * (1.0 / 720.0 - z * (1.0 / 5040.0 - z / 40320.0)))
            )
        )
    return (1.0 - (1.0 - exp(-z)) / z) / z


def _log1p_ratio(y: float) -> float:
    """ln(1 + y) / y for y >= 0; for small y by ln(1 + y) = 2 artanh(y / (2 + y))."""
    if y < 0.05:
        u2: float = y / (2.0 + y)
        u2 = u2 * u2
        return (
            2.0
            / (2.0 + y)
            * (1.0 + u2 * (1.0 / 3.0 + u2 * (1.0 / 5.0 + u2 * (1.0 / 7.0 + u2 / 9.0))))
        )
    return log(1.0 + y) / y


def velocity_drive(F: F64, f: int, volts: float, limit: float, dt: float) -> None:
    """Bring the speed to volts * speed per volt with a first-order lag, as the drive's loop does.

    v' = (target - v) / lag, but never more than the peak torque allows: far from the target
    the speed is a ramp, and the lag takes over where it asks for less than that.
    """
    target: float = volts * F[f + at.PLF_SPEED_PER_VOLT_CPS]
    v0: float = F[f + at.PLF_VELOCITY_CPS]
    lag: float = F[f + at.PLF_LAG_S]
    gap: float = target - v0
    excess: float = fabs(gap) - limit * lag
    if excess <= 0.0:
        _lag_approach(F, f, target, dt, F[f + at.PLF_LAG_DECAY])
        return
    ramp_s: float = excess / limit
    rate: float = limit
    if gap < 0.0:
        rate = -limit
    if ramp_s > dt:
        ramp_s = dt
    F[f + at.PLF_POSITION_CNT] += v0 * ramp_s + 0.5 * rate * ramp_s * ramp_s
    F[f + at.PLF_VELOCITY_CPS] = v0 + rate * ramp_s
    if ramp_s < dt:
        _lag_approach(F, f, target, dt - ramp_s, _lag_decay(dt - ramp_s, lag))


def _lag_approach(F: F64, f: int, target: float, t: float, decay: float) -> None:
    gap: float = target - F[f + at.PLF_VELOCITY_CPS]
    F[f + at.PLF_POSITION_CNT] += target * t - gap * F[f + at.PLF_LAG_S] * (1.0 - decay)
    gap = gap * decay
    if fabs(gap) < STANDSTILL_CPS:
        gap = 0.0
    F[f + at.PLF_VELOCITY_CPS] = target - gap


def _lag_decay(t: float, lag: float) -> float:
    if lag <= 0.0:
        return 0.0
    return exp(-t / lag)


def cache_motion_factors(F: F64, f: int, dt: float) -> None:
    """Factors of one step; they change only with the length of the tick."""
    z: float = F[f + at.PLF_VISCOUS_PER_S] * dt
    p2: float = _phi2(z)
    p1: float = 1.0 - z * p2
    F[f + at.PLF_DECAY] = 1.0 - z * p1
    F[f + at.PLF_GLIDE_S] = dt * p1
    F[f + at.PLF_PUSH_S2] = dt * dt * p2
    F[f + at.PLF_LAG_DECAY] = _lag_decay(dt, F[f + at.PLF_LAG_S])
    F[f + at.PLF_CACHED_DT_S] = dt
