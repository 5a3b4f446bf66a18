"""Jogs: commands on the fly, flags at each phase, and no jump whatever is commanded when."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.kernel import oracle
from tests.kernel.rig import Reals, Rig, T, acceleration, velocity
from tests.search import search

from openacr.errors import CardError
from openacr.map.rows import axes
from openacr.motion.axis import drive
from openacr.motion.jog import jog
from openacr.motion.path import moves

pytestmark = pytest.mark.evidence("oracle", "closed forms of the profiles")

settings.register_profile("kernel", deadline=None, derandomize=True, database=None)
settings.load_profile("kernel")

ACTIVE, DIRECTION, AT_SPEED, STOPPING, FORWARD, REVERSE, CHECK, LOCKOUT = range(792, 800)
KAMR = 8467


def flags(rig: Rig) -> str:
    """The jog flags that are on, by letter."""
    return "".join(name for n, name in enumerate("ADMSFRCL") if rig.bit(792 + n))


def jogging(**settings_: float) -> Rig:
    """An axis of 1000 pulses per unit with VEL 10, ACC 100, DEC 50."""
    rig = Rig(ppu=[1000.0])
    return rig.jog(0, **{"vel": 10.0, "acc": 100.0, "dec": 50.0, **settings_})


def jogged(rig: Rig) -> float:
    return rig.real("jog_cnt") / 1000


def test_a_changed_acceleration_waits_for_the_next_ramp() -> None:
    rig = jogging()
    jog.continuous(rig.card, 0, 1)
    rig.seconds(0.05)
    rig.jog(acc=1000)
    rig.seconds(0.025)
    assert rig.fp32("current_jog_veloc") == pytest.approx(7.5)
    rig.jog(vel=20)  # a new ramp
    rig.seconds(0.0125)
    assert rig.fp32("current_jog_veloc") == pytest.approx(20.0)


@pytest.mark.parametrize("jerk_", [0.0, 1000.0])
def test_a_jog_turns_round_through_zero(jerk_: float) -> None:
    rig = jogging(jrk=jerk_)
    jog.continuous(rig.card, 0, 1)
    start = rig.real("psp_cnt")
    positions = [start]
    for tick in range(2000):
        if tick == 500:
            jog.continuous(rig.card, 0, -1)
        positions.append(rig.ticks().real("psp_cnt"))
    path = np.array(positions) / 1000
    assert velocity(path).max() == pytest.approx(10.0)
    assert velocity(path).min() == pytest.approx(-10.0)
    assert np.abs(acceleration(path)).max() <= 100 * (1 + 1e-6)
    assert flags(rig) == "ADMR"


def test_a_target_passed_or_too_near_is_reached_by_coming_back() -> None:
    rig = jogging()
    jog.absolute(rig.card, 0, 50.0)
    rig.seconds(0.5)
    jog.absolute(rig.card, 0, jogged(rig) + 0.5)  # stopping takes 1 unit
    target = rig.real("jog_target_cnt")
    positions = rig.record(while_=ACTIVE)
    assert positions.max() == pytest.approx(target + 500, rel=1e-3)
    assert positions[-1] == target


def test_speed_zero_waits_for_a_speed() -> None:
    rig = jogging(vel=0.0)
    jog.incremental(rig.card, 0, 1.0)
    assert (flags(rig.seconds(0.1)), jogged(rig)) == ("A", 0.0)
    rig.jog(vel=10)
    rig.record(while_=ACTIVE)
    assert jogged(rig) == 1.0


def test_the_jog_limit_ends_a_continuous_jog_and_bars_another() -> None:
    rig = jogging()
    rig.axis(plus_jog_limit=2.0, minus_jog_limit=-1.0).bit(CHECK, True)
    jog.continuous(rig.card, 0, 1)
    rig.seconds(1.0)
    assert rig.real("jog_cnt") == 2000.0
    jog.off(rig.card, 0)
    rig.ticks(2)
    assert flags(rig) == "C"
    jog.continuous(rig.card, 0, 1)
    rig.seconds(0.1)
    assert rig.real("jog_cnt") == 2000.0
    jog.continuous(rig.card, 0, -1)
    rig.seconds(1.0)
    assert rig.real("jog_cnt") == -1000.0
    jog.off(rig.card, 0)
    jog.absolute(rig.card, 0, 5.0)  # targets are not limited
    rig.record(while_=ACTIVE)
    assert jogged(rig) == 5.0


def test_a_jog_that_does_not_start_is_not_active() -> None:
    rig = jogging()
    rig.axis(plus_jog_limit=0.0).bit(CHECK, True)
    jog.continuous(rig.card, 0, 1)
    assert flags(rig.ticks()) == "FC"


def test_flags_do_not_start_a_jog_under_a_kill_nor_after_it() -> None:
    rig = jogging()
    rig.bit(KAMR, True)
    rig.ticks(2).bit(FORWARD, True)
    rig.seconds(0.05)
    drive.clear_kills(rig.card)
    assert (flags(rig.seconds(0.1)), jogged(rig)) == ("", 0.0)
    with pytest.raises(CardError):
        rig.bit(KAMR, True)
        jog.continuous(rig.card, 0, 1)


def test_a_written_jog_offset_moves_the_running_jog_along() -> None:
    rig = jogging()
    jog.absolute(rig.card, 0, 5.0)
    rig.seconds(0.2)
    rig.axis(jog_offset=0)
    rig.ticks()
    assert abs(jogged(rig)) < 0.01
    places = [jogged(rig)]
    while rig.bit(ACTIVE):
        rig.ticks()
        places.append(jogged(rig))
    assert places[-1] == 5.0
    assert np.abs(np.diff(places, 2)).max() <= 100.0 * T**2 * 1.01  # no jump to the target


@search(200)
@given(
    st.floats(-3, 3).map(lambda x: 10**x),
    st.floats(0.002, 0.5),
    st.floats(0.002, 0.5),
    st.floats(0.002, 0.5),
    st.booleans(),
)
def test_a_jog_takes_the_time_of_the_closed_form(
    length: float, cruise_s: float, rise_s: float, fall_s: float, smooth: bool
) -> None:
    rig = Rig(ppu=[100.0])
    vel = float(np.float32(length / cruise_s))
    acc, dec = float(np.float32(vel / rise_s)), float(np.float32(vel / fall_s))
    jrk = float(np.float32(acc / rise_s)) if smooth else 0.0
    rig.jog(vel=vel, acc=acc, dec=dec, jrk=jrk)
    jog.incremental(rig.card, 0, length)
    positions = rig.record(while_=ACTIVE)
    leg = oracle.move(length, vel, acc, dec, dec, jerk=jrk)
    assert positions[-1] == length * 100
    assert abs(len(positions) - 2 - leg.time / T) <= 1 + 1e-6 * leg.time / T


# No sequence of commands makes the setpoint jump.

COMMANDS = [
    "fwd", "rev", "off", "abs", "inc", "vel", "acc", "dec", "jrk", "move", "hold", "go", "halt",
    "kamr", "clear", "soft", "hard", "fov", "wait", "lock", "slow",
]  # fmt: skip
LIMIT_VEL, LIMIT_ACC = 40.0, 400.0


def obey(rig: Rig, what: str, value: float) -> None:
    """Do one thing to the card; refusals are fine."""
    card, magnitude = rig.card, abs(value)
    if what in ("fwd", "rev"):
        jog.continuous(card, 0, 1 if what == "fwd" else -1)
    elif what == "abs":
        jog.absolute(card, 0, value)
    elif what == "inc":
        jog.incremental(card, 0, value)
    elif what == "off":
        jog.off(card, 0)
    elif what in ("vel", "acc", "dec"):
        rig.jog(0, **{what: 1 + magnitude * (10 if what != "vel" else 1)})
    elif what == "jrk":
        rig.jog(jrk=0.0 if value < 0 else 500 + 1000 * value)
    elif what == "move":
        rig.master(vel=1 + magnitude).move(value)
    elif what in ("hold", "go", "halt"):
        {"hold": moves.hold, "go": moves.release, "halt": moves.halt}[what](card, 0)
    elif what == "fov":
        rig.master(fov=magnitude / 10)
    elif what in ("kamr", "clear"):
        rig.bit(KAMR, what == "kamr")
        rig.bit(522, rig.bit(522) and what == "kamr")
    elif what in ("soft", "hard"):
        rig.bit(16150 if what == "soft" else 16148, value > 0)
        rig.bit(0, what == "hard" and value > 0)
        rig.bit(16132, False)
    elif what == "lock":
        rig.bit(LOCKOUT, value > 0)


def lived(commands: list[tuple[str, float, int]]) -> Reals:
    """Setpoints [units] while the commands come one after the other."""
    rig = Rig(ppu=[1000.0]).jog(vel=5, acc=100, dec=100)
    rig.master(acc=100, dec=100, stp=100, vel=5)
    rig.F[axes.hldec_ups2[0]] = 200.0
    rig.F[axes.sldec_ups2[0]] = 150.0
    rig.F[axes.slm_plus_u[0]] = 3.0
    rig.F[axes.slm_minus_u[0]] = -3.0
    positions = [0.0]
    for what, value, wait in commands:
        try:
            obey(rig, what, value)
        except CardError:
            pass
        for _ in range(wait):
            positions.append(rig.ticks().real("psp_cnt"))
    return np.array(positions) / 1000


@search(400)
@given(
    st.lists(
        st.tuples(st.sampled_from(COMMANDS), st.floats(-10, 10), st.integers(1, 120)),
        min_size=3,
        max_size=14,
    )
)
def test_the_setpoint_never_jumps(commands: list[tuple[str, float, int]]) -> None:
    path = lived(commands)
    assert np.all(np.isfinite(path))
    # jog and move add: two profilers of at most 11 units/s and 200 (a kill: 200) units/s^2
    assert np.abs(velocity(path)).max() <= LIMIT_VEL
    assert np.abs(acceleration(path)).max() <= LIMIT_ACC
