"""JOG HOME with a modelled motor and switches: every path of the sequence, exact at any speed."""

import numpy as np
import pytest
from tests.kernel.rig import Rig, T

from openacr.kernel.path.seek_cy import SEEK_RETURNING
from openacr.map.rows import axes, encoders, masters, motors
from openacr.motion.axis import registers
from openacr.motion.jog import jog
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target
from openacr.plant.describe.counts import count_of
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import World

ACTIVE, CAPTURED, KAMR = 792, 777, 8467
FOUND, FAILED, HOMING = 16134, 16135, 16131
BACKUP, NEGATIVE_EDGE, NEGATIVE_FINAL, INVERT = 16152, 16153, 16154, 16146
COUNTS = 4000


def world_text(start: float, extra: str = "") -> str:
    """An axis of 4000 counts per unit with a home zone 5..6 and limits at -2 and 12."""
    return f"""
[[axis]]
number = 0
counts_per_rev = {COUNTS}
initial = {start}
marker = 0.3
drive = {{ mode = "ideal", revs_per_s_per_volt = 25.0, lag_s = 0.001 }}
home = {{ between = [5.0, 6.0] }}
positive_limit = {{ at = 12.0 }}
negative_limit = {{ at = -2.0 }}
{extra}
"""


class Home(Rig):
    """A card with that axis, moved by JOG VEL 10, ACC and DEC 100."""

    def __init__(self, start: float = 0.0, extra: str = "", **jogging: float) -> None:
        text = world_text(start, extra) if "number" not in extra else extra
        super().__init__(1, ppu=[COUNTS], world=text)
        self.world: World = parse_world(text)
        self.jog(0, **{"vel": 10.0, "acc": 100.0, "dec": 100.0, **jogging})
        self.I[encoders.mult[0]] = 4
        self.F[axes.homvf_ups[0]] = 1.0
        self.F[axes.hldec_ups2[0]] = 200.0
        self.ticks(4)

    def count(self, position_u: float) -> float:
        """Raw count of a machine position."""
        return count_of(self.world.axis[0], position_u)

    @property
    def raw(self) -> float:
        return self.F[motors.raw_count[0]]

    @property
    def zero_raw(self) -> float:
        """Raw count at which the card reads 0."""
        return self.raw - self.long("actual_position")

    @property
    def machine_u(self) -> float:
        """Where the motor stands."""
        return (self.raw - self.count(0.0)) / COUNTS

    def home(self, direction: int, limit: int = 40_000) -> "Home":
        """Home and settle."""
        jog.home(self.card, 0, direction)
        for _ in range(limit):
            if not self.bit(ACTIVE):
                break
            self.ticks()
        assert not self.bit(ACTIVE)
        self.seconds(0.1)
        return self

    def speeds(self, direction: int) -> list[tuple[int, float]]:
        """Homing as its phases: direction and speed [units/s] reached in each."""
        jog.home(self.card, 0, direction)
        phases: list[tuple[int, float]] = []
        while self.bit(ACTIVE):
            speed = self.ticks().real("psp_velocity_cps") / COUNTS
            sign = (speed > 0) - (speed < 0)
            if not phases or sign not in (0, phases[-1][0]):
                phases.append((sign, 0.0))
            phases[-1] = (phases[-1][0], max(phases[-1][1], abs(speed)))
            if self.bit(FOUND):
                break
        return [(sign, round(top, 2)) for sign, top in phases if sign]


FIGURES = [
    # figure, direction, backup, edge, final, start, edge position, motions
    ("C", 1, False, False, 0.0, 6.0, [(1, 10.0), (-1, 1.0), (1, 1.0)]),
    ("D", 1, True, False, 0.0, 5.0, [(1, 10.0), (-1, 1.0), (1, 1.0)]),
    ("E", 1, False, True, 0.0, 6.0, [(1, 10.0), (-1, 1.0)]),
    ("F", 1, True, True, 0.0, 5.0, [(1, 10.0), (-1, 1.0)]),
    ("G", -1, True, True, 10.0, 5.0, [(-1, 10.0), (1, 1.0), (-1, 1.0)]),
    ("H", -1, False, True, 10.0, 6.0, [(-1, 10.0), (1, 1.0), (-1, 1.0)]),
    ("I", -1, True, False, 10.0, 5.0, [(-1, 10.0), (1, 1.0)]),
    ("J", -1, False, False, 10.0, 6.0, [(-1, 10.0), (1, 1.0)]),
]


def options(rig: Home, negative_edge: bool, negative_final: bool, backup: bool = True) -> Home:
    rig.bit(BACKUP, backup)
    rig.bit(NEGATIVE_EDGE, negative_edge)
    rig.bit(NEGATIVE_FINAL, negative_final)
    return rig


@pytest.mark.req(
    "ACR-HOME-FIG-C", "ACR-HOME-FIG-D", "ACR-HOME-FIG-E", "ACR-HOME-FIG-F",
    "ACR-HOME-FIG-G", "ACR-HOME-FIG-H", "ACR-HOME-FIG-I", "ACR-HOME-FIG-J",
    "ACR-HOME-01", "ACR-HOME-08", "ACR-HOME-10", "ACR-HOME-12", "ACR-HOME-13",
)  # fmt: skip
@pytest.mark.parametrize(
    ("figure", "direction", "edge", "final", "start", "at_u", "motions"),
    FIGURES,
    ids=lambda v: str(v),
)
def test_the_figures_with_backup(
    figure: str,
    direction: int,
    edge: bool,
    final: bool,
    start: float,
    at_u: float,
    motions: list[tuple[int, float]],
) -> None:
    rig = options(Home(start), edge, final)
    assert rig.speeds(direction) == motions
    rig.seconds(0.1)
    assert (rig.bit(FOUND), rig.bit(FAILED), rig.bit(HOMING)) == (True, False, False)
    assert abs(rig.zero_raw - rig.count(at_u)) <= 1
    assert rig.real("psp_cnt") == 0.0
    assert abs(rig.long("actual_position")) <= 1
    assert rig.machine_u == pytest.approx(at_u, abs=1 / COUNTS)


def test_a_soft_limit_turns_the_search_round_too() -> None:
    rig = options(Home(8.0), False, False)
    rig.F[axes.slm_plus_u[0]] = 2.0
    rig.F[axes.slm_minus_u[0]] = -30.0
    rig.F[axes.sldec_ups2[0]] = 300.0
    rig.bit(16150, True)
    rig.bit(16151, True)
    rig.home(1)
    assert rig.bit(FOUND)
    assert abs(rig.zero_raw - rig.count(6.0)) <= 1


def test_jog_off_and_a_kill_abort_homing() -> None:
    for kill in (False, True):
        rig = options(Home(0.0), False, False)
        jog.home(rig.card, 0, 1)
        rig.seconds(0.2)
        assert rig.bit(HOMING)
        if kill:
            rig.bit(KAMR, True)
        else:
            jog.off(rig.card, 0)
        rig.seconds(0.5)
        assert (rig.bit(FOUND), rig.bit(FAILED), rig.bit(HOMING), rig.bit(ACTIVE)) == (0, 1, 0, 0)
        assert rig.real("psp_velocity_cps") == 0.0


@pytest.mark.parametrize("vel", [1.0, 7.0, 83.0, 400.0])
@pytest.mark.parametrize("contact", ["open", "closed"])
@pytest.mark.req("ACR-HOME-03", "ACR-CMD-JOG-HOMVF")
def test_the_edge_is_exact_at_any_approach_speed(vel: float, contact: str) -> None:
    """An inverted level turns the edges of the input round, not those of the switch."""
    text = world_text(0.0).replace("[5.0, 6.0]", f'[5.0, 6.0], contact = "{contact}"')
    rig = Home(extra=text, vel=20.0, acc=20_000.0, dec=20_000.0)
    rig.bit(INVERT, contact == "closed")
    rig.F[axes.homvf_ups[0]] = vel
    rig.ticks(4)
    options(rig, False, True).home(1)
    assert rig.bit(FOUND)
    assert abs(rig.zero_raw - rig.count(6.0)) <= 1


@pytest.mark.parametrize("vel", [0.37, 5.0, 90.0, 900.0])
@pytest.mark.parametrize("direction", [1, -1])
def test_an_input_capture_is_exact_at_any_speed(vel: float, direction: int) -> None:
    rig = Home(5.5 - 1.5 * direction, extra=world_text(5.5 - 1.5 * direction).replace(
        "[5.0, 6.0]", "[5.0, 6.0], input = 24"))  # fmt: skip
    rig.jog(vel=vel, acc=1e6, dec=1e6)
    registers.arm_capture(rig.card, 0, 2)
    offset = rig.zero_raw
    jog.continuous(rig.card, 0, direction)
    for _ in range(40_000):
        if rig.ticks().bit(CAPTURED):
            break
    edge = rig.count(5.0 if direction > 0 else 6.0)
    assert rig.bit(CAPTURED)
    assert abs(rig.long("hardware_capture") + offset - edge) <= 1


@pytest.mark.req("ACR-CMD-INTCAP")
def test_a_switch_crossed_and_left_within_one_tick_is_captured() -> None:
    text = world_text(4.0).replace("[5.0, 6.0]", "[5.0, 5.01], input = 24")
    for mode, edge_u in ((2, 5.0), (6, 5.01)):
        rig = Home(4.0, extra=text, vel=100.0, acc=1e5, dec=1e5)
        registers.arm_capture(rig.card, 0, mode)
        offset = rig.zero_raw
        jog.continuous(rig.card, 0, 1)
        rig.seconds(0.1)
        assert rig.bit(CAPTURED)
        assert abs(rig.long("hardware_capture") + offset - rig.count(edge_u)) <= 1


@pytest.mark.req("ACR-CMD-INTCAP")
@pytest.mark.parametrize("mult", [1, 2, -4, 4])
@pytest.mark.parametrize("mode", [0, 4])
def test_a_marker_capture_is_exact_to_the_count(mult: int, mode: int) -> None:
    rig = Home(0.0)
    rig.I[encoders.mult[0]] = mult
    if mult < 0:
        rig.axis(proportional_gain=-0.002441)
    registers.res(rig.card, 0, 0.0)
    rig.ticks(2)
    start = rig.raw
    rig.jog(vel=20.0, acc=1e4, dec=1e4)
    registers.arm_capture(rig.card, 0, mode)
    jog.continuous(rig.card, 0, 1)
    rig.seconds(0.3)
    assert rig.bit(CAPTURED)
    direction = 1 if mult > 0 else -1
    marker = rig.count(0.3) // 1
    passed = [k * COUNTS + marker for k in range(-3, 4)]
    rise = min((m for m in passed if (m - start) * direction > 0), key=lambda m: abs(m - start))
    fall = rise + direction
    edge = (rise if mode == 0 else fall) - start
    assert rig.long("hardware_capture") == pytest.approx(edge * mult / 4, abs=1.01)


@pytest.mark.req("ACR-CMD-MSEEK", "ACR-HOME-17")
@pytest.mark.parametrize("stp", [0.0, 500.0])
@pytest.mark.parametrize("jrk", [0.0, 20_000.0])
@pytest.mark.parametrize("vel", [2.0, 30.0])
def test_a_marker_seek_returns_to_the_marker_and_calls_it_zero(
    stp: float, jrk: float, vel: float
) -> None:
    rig = Home(0.0)
    rig.master(vel=vel, acc=500, dec=500, stp=stp, jrk=jrk)
    moves.seek(rig.card, 0, 0, 10.0, 0)
    assert not rig.bit(CAPTURED)
    rig.record()
    rig.seconds(0.1)
    assert rig.bit(CAPTURED)
    assert rig.real("psp_cnt") == 0.0
    assert abs(rig.zero_raw - rig.count(0.3)) <= 1
    assert abs(rig.long("actual_position")) <= 1


def test_a_marker_seek_without_a_marker_ends_as_a_move() -> None:
    rig = Home(0.4)
    rig.master(vel=5, acc=500, dec=500, stp=500)
    start = rig.real("position_cnt")
    moves.seek(rig.card, 0, 0, 0.5, 0)
    rig.record()
    assert not rig.bit(CAPTURED)
    assert rig.real("position_cnt") == start + 2000
    assert registers.capture_mode(rig.card, 0) is None


@pytest.mark.parametrize("tick", [30, 120, 141, 160, 200])
def test_a_held_marker_seek_goes_on_with_cycle_start(tick: int) -> None:
    rig = Home(0.0)
    rig.master(vel=5, acc=100, dec=100, stp=100)
    moves.seek(rig.card, 0, 0, 10.0, 0)
    rig.ticks(tick)
    moves.hold(rig.card, 0)
    rig.seconds(0.3)
    if rig.bit(516):
        assert rig.bit(519)
        moves.release(rig.card, 0)
        rig.record()
    rig.seconds(0.1)
    assert rig.bit(CAPTURED)
    assert abs(rig.zero_raw - rig.count(0.3)) <= 1
    assert abs(rig.machine_u - 0.3) < 2 / COUNTS


def test_a_marker_seek_that_is_cut_on_its_return_leaves_the_zero_where_it_was() -> None:
    """TRJ that turns back: the axis rests beside the marker, and there nothing becomes 0."""
    rig = Home(0.0)
    rig.depth(4)
    rig.master(vel=5, acc=20, dec=20, stp=20)
    moves.seek(rig.card, 0, 0, 10.0, 0)
    while rig.I[masters.seek_phase[0]] != SEEK_RETURNING:
        rig.ticks()
    places = [rig.real("psp_cnt")]
    for _ in range(100):
        rig.ticks()
        places.append(rig.real("psp_cnt"))
    zero = rig.zero_raw
    moves.issue(rig.card, 0, [Target(0, 9.0)], replace=True)
    for _ in range(5000):
        rig.ticks()
        places.append(rig.real("psp_cnt"))
    assert abs(np.diff(places, n=2)).max() <= 20 * COUNTS * T**2 + 1e-6
    assert rig.zero_raw == zero
    assert places[-1] == 9.0 * COUNTS


NARROW = """
[[axis]]
number = 0
counts_per_rev = 4000
initial = {start}
marker = 0.3
drive = {{ mode = "ideal", revs_per_s_per_volt = 25.0, lag_s = 0.001 }}
home = {{ between = [5.0, 5.002] }}
positive_limit = {{ at = 12.0 }}
negative_limit = {{ at = -2.0 }}
"""


@pytest.mark.parametrize("negative_edge", [False, True])
@pytest.mark.parametrize("negative_final", [False, True])
@pytest.mark.parametrize(("direction", "start"), [(1, 0.0), (-1, 9.0)])
def test_a_switch_narrower_than_a_servo_period_is_found_to_the_count(
    direction: int, start: float, negative_edge: bool, negative_final: bool
) -> None:
    """At 40 units/s a period is 0.02 units: the switch of 0.002 is never seen closed."""
    rig = Home(start, NARROW.format(start=start), vel=40.0, acc=400.0, dec=400.0)
    rig.F[axes.homvf_ups[0]] = 10.0
    options(rig, negative_edge, negative_final).home(direction)
    assert (rig.bit(FOUND), rig.bit(FAILED)) == (True, False)
    edge = 5.0 if negative_edge else 5.002
    assert rig.zero_raw - rig.count(0.0) == pytest.approx(edge * COUNTS, abs=1.0)


def test_without_backup_a_switch_crossed_within_a_period_stops_the_search() -> None:
    rig = Home(0.0, NARROW.format(start=0.0), vel=40.0, acc=400.0, dec=400.0)
    rig.home(1)
    assert rig.bit(FOUND)
    assert rig.machine_u == pytest.approx(5.0 + 40.0**2 / 800, abs=0.2)  # and its lag
