"""What a caller does to the machine around a card: forced inputs, faults, and nonsense refused."""

import json
from collections.abc import Callable
from math import inf, nan

import pytest

from openacr.controller import Controller
from openacr.errors import CardError, UserError
from openacr.journal.entries import JournalEntry, entry_of, record_of
from openacr.map import numbers as at
from openacr.map.rows import motors, plant
from openacr.plant.describe.load import parse_world
from openacr.protocol.events import ControlKey

MACHINE = """
[[axis]]
number = 1
name = "X"
units = "mm"
counts_per_rev = 4000
units_per_rev = 4.0
travel = [-50.0, 50.0]
marker = 0.0
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.1 }
load = { viscous_nms = 1e-4, coulomb_nm = 0.01 }
positive_limit = { at = 20.0, input = 3 }
negative_limit = { at = -20.0, input = 4, contact = "closed" }

[axis.drive]
mode = "velocity"
revs_per_s_per_volt = 25.0
peak_amps = 20.0

[[wire]]
input = 256
output = 33
[inputs]
on = [24]
"""
SETUP = (
    "ATTACH AXIS1 ENC1 DAC1",
    "ENC1 MULT 4",
    "PROG0",
    "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS1 "X"',
    "PPU X1000",
    "VEL 10",
    "ACC 1000",
    "DEC 1000",
    "STP 1000",
)
KAMR, ENABLED = 8467 + 32, 8465 + 32
FAULT, LOST = 2560 + 32, 2561 + 32  # of encoder 1


def card(text: str = MACHINE, *lines: str) -> Controller:
    made = Controller(world=parse_world(text))
    made.send("".join(f"{line}\r" for line in (*SETUP, *lines)))
    made.advance(20)
    return made


def enabled(text: str = MACHINE) -> Controller:
    """A card that switches the drive of its axis itself, and has done so."""
    made = card(text, "SET 8500", "DRIVE ON X")
    made.advance(100)
    assert made.bit[ENABLED]
    return made


def actual_mm(made: Controller) -> float:
    return made.p[12290 + 256] / 1000


# -- inputs


@pytest.mark.parametrize(("bit", "level"), [(3, False), (4, True), (24, True), (256, False)])
def test_an_input_that_the_machine_drives_is_forced_until_it_is_released(
    bit: int, level: bool
) -> None:
    made = card()
    assert made.bit[bit] is level
    made.set_input(bit, not level)
    for _ in range(3):
        assert made.bit[bit] is not level
        made.advance(1)
    made.release_input(bit)
    for _ in range(3):
        assert made.bit[bit] is level
        made.advance(1)


@pytest.mark.parametrize("stuck", [False, True])
def test_a_stuck_limit_switch_does_not_follow_the_axis(stuck: bool) -> None:
    made = card()
    made.set_input(3, stuck)
    made.drag(1, 30.0)
    made.advance(10)
    assert made.bit[3] is stuck
    made.release_input(3)
    assert made.bit[3]
    made.drag(1, -30.0)
    made.advance(10)
    assert not made.bit[3]


def test_inputs_beside_a_forced_one_keep_their_wires() -> None:
    made = card()
    made.set_input(3, True)
    made.set_input(4, False)
    made.release_input(3)
    made.advance(10)
    assert (made.bit[3], made.bit[4], made.bit[24]) == (False, False, True)


def test_a_forced_input_has_no_edges_when_its_switch_is_passed() -> None:
    made = card()
    made.set_input(3, False)
    made.drag(1, 30.0)
    made.advance(1)
    assert not made.memory.I[plant.rises] & 1 << 3
    made.drag(1, -30.0)
    made.advance(1)
    made.release_input(3)
    made.drag(1, 30.0)
    made.advance(1)
    assert made.memory.I[plant.rises] & 1 << 3


def test_an_input_that_nothing_drives_takes_any_level_and_is_off_when_released() -> None:
    made = card()
    made.set_input(5, True)
    made.advance(10)
    assert made.bit[5]
    made.release_input(5)
    made.advance(10)
    assert not made.bit[5]


def test_a_forced_input_outlives_a_restart_of_the_card() -> None:
    made = card()
    made.set_input(3, True)
    made.send("REBOOT\r")
    made.advance(10)
    assert made.bit[3]
    made.release_input(3)
    made.advance(1)
    assert not made.bit[3]


# -- faults


@pytest.mark.parametrize(
    ("kind", "flag", "other"), [("encoder-lost", LOST, FAULT), ("encoder-noise", FAULT, LOST)]
)
def test_an_encoder_fault_disables_the_axis_until_enc_res_clears_it(
    kind: str, flag: int, other: int
) -> None:
    made = enabled()
    made.fault(1, kind)
    made.advance(1)
    assert (made.bit[flag], made.bit[other]) == (True, False)
    assert (made.bit[KAMR], made.bit[ENABLED]) == (True, False)
    made.send("ENC1 RES\rCLR 8499\rDRIVE ON X\r")  # the fault is still there
    made.advance(100)
    assert (made.bit[flag], made.bit[ENABLED]) == (True, False)
    made.mend(1, kind)
    made.advance(100)
    assert made.bit[flag]  # latched
    made.send("ENC1 RES\rDRIVE ON X\r")
    made.advance(100)
    assert (made.bit[flag], made.bit[KAMR], made.bit[ENABLED]) == (False, False, True)


def test_a_fault_of_an_encoder_kills_only_the_axes_that_close_their_loop_with_it() -> None:
    made = card()
    made.fault(1, "encoder-lost")
    made.advance(2)
    assert [made.bit[8467 + 32 * axis] for axis in range(8)] == [axis == 1 for axis in range(8)]


def test_the_encoder_of_the_velocity_loop_counts_too() -> None:
    made = card(MACHINE, "ATTACH AXIS2 ENC2 DAC2 ENC1")
    made.fault(1, "encoder-lost")
    made.advance(2)
    assert made.bit[8467 + 64]


def test_a_cut_encoder_line_counts_nothing_and_goes_on_from_there() -> None:
    made = card()
    made.send("AXIS1 OFF\r")
    before = made.p[6160]
    made.drag(1, 2.0)
    made.advance(1)
    assert made.p[6160] == before + 2000
    made.fault(1, "encoder-lost")
    made.drag(1, 3.0)
    made.advance(1)
    assert (made.p[6160], made.p[6161]) == (before + 2000, 0)
    made.mend(1)
    made.drag(1, -1.0)
    made.advance(1)
    assert made.p[6160] == before + 1000


@pytest.mark.parametrize(("travel", "counted"), [(2000, 1999), (-2000, -1999), (1, 0), (0, 0)])
def test_a_disturbed_encoder_loses_an_edge_in_every_period_it_turns(
    travel: int, counted: int
) -> None:
    made = Controller()
    made.send("AXIS1 OFF\rENC1 MULT 4\r")
    made.fault(1, "encoder-noise")
    for passes in (1, 2):
        made.drag(1, travel)
        made.advance(1)
        assert made.p[6160] == passes * counted
        made.advance(3)
        assert made.p[6160] == passes * counted


def test_a_drive_fault_kills_the_axis_and_a_reset_after_it_lets_it_go_on() -> None:
    made = enabled()
    made.fault(1, "drive")
    made.advance(3)
    assert (made.bit[8477 + 32], made.bit[KAMR], made.bit[ENABLED]) == (True, True, False)
    made.mend(1, "drive")
    made.advance(3)
    made.send("DRIVE RES X\r")
    made.advance(200)
    made.send("CLR 8499\rDRIVE ON X\r")
    made.advance(100)
    assert (made.bit[8477 + 32], made.bit[ENABLED]) == (False, True)


@pytest.mark.parametrize(("contact", "quiet"), [("open", False), ("closed", True)])
@pytest.mark.parametrize("wired", [False, True])
def test_a_drive_fault_shows_at_the_fault_input_of_the_drive(
    contact: str, quiet: bool, wired: bool
) -> None:
    text = MACHINE.replace(
        'mode = "velocity"', f'mode = "velocity"\nfault_input = 9\nfault_contact = "{contact}"'
    )
    made = card(text.replace("on = [24]", f"{'on' if quiet else 'off'} = [{'9' if wired else ''}]"))
    made.set_input(9, quiet)
    if wired:
        made.release_input(9)
    made.advance(3)
    motor = motors.ints[0] + motors.INTS_SIZE
    assert (made.bit[9], made.memory.I[motor + at.PLI_DRIVE_FAULT]) == (quiet, 0)
    made.fault(1, "drive")
    made.advance(3)
    assert (made.bit[9], made.memory.I[motor + at.PLI_DRIVE_FAULT]) == (not quiet, 1)
    made.mend(1)
    made.advance(3)
    assert (made.bit[9], made.memory.I[motor + at.PLI_DRIVE_FAULT]) == (quiet, 0)


def test_mending_a_drive_that_works_leaves_its_input_alone() -> None:
    made = card(MACHINE.replace('mode = "velocity"', 'mode = "velocity"\nfault_input = 9'))
    made.set_input(9, True)
    made.mend(1)
    made.advance(3)
    assert made.bit[9]


def test_a_cut_motor_cable_takes_the_torque_and_reports_nothing() -> None:
    made = enabled()
    made.fault(1, "motor-cable")
    made.send("X5\r")
    made.advance(seconds=0.4)
    assert actual_mm(made) == pytest.approx(0.0, abs=0.002)
    assert not made.bit[8477 + 32]
    made.mend(1, "motor-cable")
    made.advance(seconds=1)
    assert actual_mm(made) == pytest.approx(5.0, abs=0.002)


def test_a_jammed_axis_stands_still_until_it_is_free() -> None:
    made = card()
    made.send("X5\r")
    made.advance(seconds=0.3)
    stuck_mm = actual_mm(made)
    assert 1.0 < stuck_mm < 4.0
    made.fault(1, "jam")
    made.advance(seconds=0.5)
    assert actual_mm(made) == pytest.approx(stuck_mm, abs=0.001)
    made.mend(1, "jam")
    made.advance(seconds=1)
    assert actual_mm(made) == pytest.approx(5.0, abs=0.002)


@pytest.mark.parametrize("direction", ["up", "down"])
@pytest.mark.parametrize("at_mm", [3.0, -3.0])
def test_an_obstacle_stops_the_axis_on_its_side_alone(at_mm: float, direction: str) -> None:
    sign = 1 if direction == "up" else -1
    made = card(MACHINE.replace("marker", f'encoder_direction = "{direction}"\nmarker'))
    made.send("AXIS1 OFF\r")

    def pushed_mm(by_mm: float) -> float:
        made.drag(1, sign * by_mm)
        made.advance(2)
        return sign * made.p[6160] / 1000

    made.fault(1, "obstacle", at_mm)
    assert pushed_mm(10 * at_mm) == pytest.approx(at_mm, abs=0.002)
    assert pushed_mm(-2 * at_mm) == pytest.approx(-at_mm, abs=0.002)
    made.mend(1)
    assert pushed_mm(5 * at_mm) == pytest.approx(4 * at_mm, abs=0.002)


def test_friction_beyond_the_torque_of_the_drive_holds_the_axis() -> None:
    made = card(
        MACHINE.replace('"velocity"', '"torque"').replace(
            "revs_per_s_per_volt = 25.0", "amps_per_volt = 2.0"
        )
    )
    motor = motors.reals[0] + motors.REALS_SIZE
    own = made.memory.F[motor + at.PLF_COULOMB_ACCEL], made.memory.F[motor + at.PLF_STATIC_ACCEL]
    made.fault(1, "friction", 0.02)
    made.fault(1, "friction", 0.02)  # it replaces the one before
    now = made.memory.F[motor + at.PLF_COULOMB_ACCEL], made.memory.F[motor + at.PLF_STATIC_ACCEL]
    assert now == pytest.approx((3 * own[0], 3 * own[1]))
    made.mend(1, "friction")
    now = made.memory.F[motor + at.PLF_COULOMB_ACCEL], made.memory.F[motor + at.PLF_STATIC_ACCEL]
    assert now == own


# -- journals and snapshots


DEEDS: tuple[Callable[[Controller], None], ...] = (
    lambda made: made.set_input(3, True),
    lambda made: made.release_input(3),
    lambda made: made.fault(1, "obstacle", 2.5),
    lambda made: made.fault(1, "encoder-noise"),
    lambda made: made.mend(1, "encoder-noise"),
    lambda made: made.mend(1),
)


def test_a_snapshot_holds_forced_inputs_and_faults() -> None:
    made = card()
    made.set_input(3, True)
    made.fault(1, "obstacle", 2.5)
    kept = made.snapshot()
    made.release_input(3)
    made.mend(1)
    made.restore(kept)
    made.send("AXIS1 OFF\r")
    made.drag(1, 5.0)
    made.advance(2)
    assert made.bit[3]
    assert made.p[6160] == pytest.approx(2500, abs=2)


def test_forced_inputs_and_faults_are_in_the_journal_and_read_back_as_they_were() -> None:
    made = card()
    made.journal.clear()
    for deed in DEEDS:
        made.advance(10)
        deed(made)
    lines = [record_of(entry) for entry in made.journal]
    assert [json.loads(line)[1:] for line in lines] == [
        ["input", 3, 1.0],
        ["release", 3],
        ["fault", 1, "obstacle", 2.5],
        ["fault", 1, "encoder-noise", 0.0],
        ["mend", 1, "encoder-noise"],
        ["mend", 1, ""],
    ]
    assert [entry_of(json.loads(line)) for line in lines] == made.journal


# -- nonsense


NONSENSE: list[tuple[Callable[[Controller], object], str]] = [
    (lambda made: made.advance(-5), "advance by -5 ticks and 0.0 s: time only goes forward"),
    (lambda made: made.advance(seconds=-1.0), "advance by 0 ticks and -1.0 s: time only"),
    (lambda made: made.advance(seconds=nan), "advance by 0 ticks and nan s"),
    (lambda made: made.advance(seconds=inf), "advance by 0 ticks and inf s"),
    (lambda made: made.until(516, timeout_s=-1.0), "wait -1.0 s for flag 516"),
    (lambda made: made.until(516, ticks=-1), "wait -1 ticks for flag 516"),
    (lambda made: made.set_input(32, True), "input 32: inputs are 0-31, 64-95, 256-287,"),
    (lambda made: made.set_input(-1, True), "input -1: inputs are"),
    (lambda made: made.release_input(96), "input 96: inputs are"),
    (lambda made: made.set_input(11520, True), "input 11520: no CANopen node of"),
    (lambda made: made.set_analog(6400, 1.0), "P6400 shows no analog input"),
    (lambda made: made.set_analog(6408, nan), "P6408: nan is not a finite number"),
    (lambda made: made.drag(99, 1.0), "axis 99: the ACR9000 has axes 0-7"),
    (lambda made: made.drag(8, 1.0), "axis 8: the ACR9000 has axes 0-7"),
    (lambda made: made.drag(-1, 1.0), "axis -1: the ACR9000 has axes 0-7"),
    (lambda made: made.drag(1, inf), "axis 1: inf is not a finite number"),
    (lambda made: made.statistics(8), "axis 8: the ACR9000 has axes 0-7"),
    (lambda made: made.axis(8), "axis 8: the ACR9000 has axes 0-7"),
    (lambda made: made.fault(0, "jam"), r"axis 0: the machine has no such axis \(it has 1\)"),
    (lambda made: made.fault(1, "rust"), "fault 'rust': known are encoder-lost, encoder-noise,"),
    (lambda made: made.fault(1, "obstacle", nan), "axis 1: nan is not a finite number"),
    (lambda made: made.fault(1, "friction", -0.1), "axis X: friction of -0.1 Nm; it is 0 or more"),
    (lambda made: made.mend(2), "axis 2: the machine has no such axis"),
    (lambda made: made.record(0), "record every 0 ticks: the minimum is 1"),
    (lambda made: made.receive(99, b"X5\r"), "stream 99: no such stream is open"),
    (lambda made: made.accepts_input(99), "stream 99: no such stream is open"),
    (lambda made: made.replying(99), "stream 99: no such stream is open"),
    (lambda made: made.press(5), "key 5: known are CTRL_X, CTRL_Y, CTRL_Z"),  # type: ignore[arg-type]
]  # fmt: skip


@pytest.mark.parametrize(("act", "text"), NONSENSE, ids=[text for _, text in NONSENSE])
def test_nonsense_is_refused_in_words_and_changes_nothing(
    act: Callable[[Controller], object], text: str
) -> None:
    made = card()
    before, noted = made.digest(), list[JournalEntry](made.journal)
    with pytest.raises(UserError, match=text):
        act(made)
    assert (made.digest(), made.journal) == (before, noted)


def test_a_flag_that_does_not_exist_cannot_be_waited_for() -> None:
    with pytest.raises(CardError, match="Invalid bit"):
        card().until(99999)


def test_no_time_at_all_is_a_time() -> None:
    made = card()
    before = made.tick
    made.advance(0)
    made.advance(seconds=0.0)
    assert made.tick == before
    assert not made.until(516, ticks=0)


def test_friction_of_an_ideal_drive_is_refused() -> None:
    with pytest.raises(UserError, match="axis 0: friction has no effect"):
        Controller().fault(0, "friction", 1.0)


@pytest.mark.parametrize("key", list(ControlKey))
def test_the_three_keys_are_pressed(key: ControlKey) -> None:
    made = card()
    made.press(key)
    assert made.journal[-1].number == key
