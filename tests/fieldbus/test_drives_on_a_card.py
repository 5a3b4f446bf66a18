"""A card whose axis has its drive on an emulated bus: enabling, motion, captures, faults."""

import logging
import math
import threading

import pytest
from tests.fieldbus.bus_rig import OnBus

from openacr.fieldbus.cia402.drive import Order
from openacr.fieldbus.ethercat.emulated.terminals import Digital
from openacr.fieldbus.ethercat.master.port import BusError
from openacr.fieldbus.ethercat.wire.registers import Register, State
from openacr.kernel.axis.drive_cy import MEI_OPEN
from openacr.map.numbers import W_MISC_CONTROL_1
from openacr.map.rows import axes
from openacr.map.words import af4

BUS = """
[bus]
interface = "emulated"
"""
AXIS = """
[[axis]]
number = {n}
name = "{name}"
counts_per_rev = 4000
marker = 0.0
drive = {{ mode = "torque", amps_per_volt = 2.0, peak_amps = 18.0 }}
motor = {{ inertia_kgm2 = 2.0e-5, torque_nm_per_a = 0.1 }}
load = {{ inertia_kgm2 = 2.0e-5, viscous_nms = 5.0e-5, coulomb_nm = 0.01 }}

[axis.bus]
position = {n}
{bus}
"""
RAMP = ("ACC 400000", "DEC 400000", "STP 400000", "VEL 40000")  # pulses


def machine(bus: str = 'mode = "csp"', axes: int = 1, more: str = "") -> str:
    return BUS + more + "".join(AXIS.format(n=n, name="XY"[n], bus=bus) for n in range(axes))


def on_bus(
    bus: str = 'mode = "csp"',
    axes: int = 1,
    more: str = "",
    *,
    is_real: bool = True,
    digital: int = 0,
) -> OnBus:
    return OnBus(machine(bus, axes, more), is_real=is_real, digital=digital)


def moving() -> OnBus:
    """X on a long move at 40000 pulses/s."""
    made = on_bus()
    made.switch_on()
    made.send(*RAMP, "X100000")
    made.card.advance(600)
    assert made.position() > 5000
    return made


def counts_until_rest(made: OnBus) -> int:
    """Let the card run for a second; how far the motor went, which is at rest then."""
    motor = made.drive().motor
    start = motor.position_cnt
    made.card.advance(1900)
    before = motor.position_cnt
    made.card.advance(100)
    assert abs(motor.position_cnt - before) < 1.0
    return round(motor.position_cnt - start)


# --- enabling -------------------------------------------------------------------------


def test_nothing_is_enabled_by_the_start_of_the_card() -> None:
    made = on_bus(axes=2)
    made.card.advance(400)
    assert [made.drive(n).profile.state.name for n in (0, 1)] == ["DISABLED", "DISABLED"]


def test_drive_on_enables_and_the_flag_follows_the_drive() -> None:
    made = on_bus(axes=2)
    made.send("DRIVE ON Y")
    for _ in range(400):
        assert not made.is_enabled(1) or made.drive(1).profile.state.name == "ENABLED"
        made.card.advance(1)
    assert made.is_enabled(1)
    assert made.drive(0).profile.state.name == "DISABLED"
    assert not made.is_enabled(0)


@pytest.mark.parametrize("cycle", [2, 7, 100])
def test_between_two_frames_the_flag_does_not_run_ahead_of_the_drive(cycle: int) -> None:
    made = on_bus(more=f"cycle = {cycle}\nlate_s = 1.0\n")
    made.send("DRIVE ON X")
    for _ in range(10 * cycle):
        made.card.advance(1)
        if made.is_enabled():
            break
        assert not made.card.memory.I[af4.word[0]] & af4.MOTOR_ON
    assert made.is_enabled()
    assert made.drive().profile.state.name == "ENABLED"
    assert made.machine.drives[0]._is_ready


def test_a_set_flag_asks_the_drive_as_drive_on_does() -> None:
    made = on_bus(more="cycle = 4\n")
    made.card.memory.I[af4.word[0]] |= af4.DRIVE_ENABLED
    made.card.advance(2)
    assert not made.is_enabled()
    made.card.advance(50)
    assert made.is_enabled()
    assert made.drive().profile.state.name == "ENABLED"


def test_an_open_motion_enable_input_keeps_the_flag_clear_and_the_drive_off() -> None:
    made = on_bus()
    made.send("DRIVE ON X")
    made.card.advance(2)
    made.card.memory.I[W_MISC_CONTROL_1] |= MEI_OPEN
    made.card.advance(100)
    assert not made.is_enabled()
    assert made.drive().profile.state.name == "DISABLED"


def test_enabling_moves_nothing_whatever_the_setpoint_was_before() -> None:
    made = on_bus()
    made.send(*RAMP, "X3000")
    made.card.advance(2000)
    assert (made.position(), made.setpoint()) == (0, 3000)
    made.switch_on()
    made.card.advance(200)
    assert (made.position(), made.setpoint()) == (0, 0)
    assert math.floor(made.drive().motor.position_cnt) == 0


def test_a_motor_that_is_turned_while_its_drive_comes_up_stays_where_it_is_then() -> None:
    made = on_bus()
    made.send("DRIVE ON X")
    made.card.advance(2)
    made.drive().jump(300)
    made.card.advance(200)
    assert made.is_enabled()
    assert made.position() == made.setpoint() == 300
    assert math.floor(made.drive().motor.position_cnt) == 300


def test_a_move_that_begins_before_the_drive_is_ready_is_killed() -> None:
    made = on_bus()
    made.send(*RAMP, "DRIVE ON X", "X20000")
    made.card.advance(400)
    assert made.machine.drives[0].alarm == "motion was commanded before it was ready"
    assert not made.is_enabled()
    assert abs(counts_until_rest(made)) < 5


def test_drive_off_switches_the_drive_off_and_it_can_be_switched_on_again_at_once() -> None:
    made = on_bus()
    made.switch_on()
    made.send("DRIVE OFF X")
    made.card.advance(10)
    assert made.drive().profile.state.name == "DISABLED"
    made.switch_on()
    made.send("DRIVE OFF X")
    made.card.advance(1)  # the status word still shows operation
    made.send("DRIVE ON X")
    made.card.advance(100)
    assert made.is_enabled()
    assert made.machine.drives[0].alarm == ""


def test_without_real_a_drive_is_read_and_never_enabled(caplog: pytest.LogCaptureFixture) -> None:
    made = on_bus(is_real=False)
    with caplog.at_level(logging.WARNING):
        made.send("DRIVE ON X")
        made.card.advance(400)
    assert made.drive().profile.state.name == "DISABLED"
    assert not made.is_enabled()
    assert "serve --real" in caplog.text
    made.drive().motor.jumped_cnt += 12
    made.card.advance(3)
    assert made.position() == 12


def test_a_restart_of_the_card_switches_the_drives_off_and_keeps_the_bus() -> None:
    made = on_bus()
    made.switch_on()
    made.send("SYS", "REBOOT")
    made.card.advance(100)
    assert made.drive().profile.state.name == "DISABLED"
    assert made.machine.alarm == ""


def test_a_drive_that_does_not_come_up_is_given_up_after_a_time(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = on_bus(more="enable_s = 0.1\n")
    monkeypatch.setattr(made.drive().profile, "obey", lambda *_: None)
    made.send("DRIVE ON X")
    made.card.advance(190)
    assert made.machine.drives[0].drive.order is Order.ON
    made.card.advance(20)
    assert made.machine.drives[0].drive.order.value == "off"
    assert not made.is_enabled()
    assert "is not enabled: it is in switch on disabled after 0.1 s" in caplog.text


def test_a_drive_that_operates_in_another_mode_is_stopped() -> None:
    made = on_bus()
    made.drive().objects.mode.value = 9
    made.send("DRIVE ON X")
    made.card.advance(100)
    assert made.machine.drives[0].alarm == "it operates in mode 9, not in CSP"
    assert not made.is_enabled()


# --- motion ---------------------------------------------------------------------------


def test_a_cyclic_position_is_the_setpoint_and_the_axis_comes_to_its_target_to_the_count() -> None:
    made = on_bus()
    made.switch_on()
    made.send(*RAMP, "X4000")
    made.card.advance(3000)
    assert (made.position(), made.setpoint()) == (4000, 4000)
    assert made.drive().objects.target_position.number == 4000


def test_res_and_presets_move_nothing() -> None:
    made = on_bus()
    made.switch_on()
    made.send(*RAMP, "X4000")
    made.card.advance(3000)
    made.send("RES X100")
    made.card.advance(500)
    assert made.drive().objects.target_position.number == 4000
    made.send("X 0")
    made.card.advance(3000)
    assert math.floor(made.drive().motor.position_cnt) == 3900


@pytest.mark.parametrize(
    ("more", "at"),
    [
        ("counts_per_rev = 16000", 16000),
        ('counts_per_rev = 16000\ndirection = "down"', -16000),
        ("counts_per_rev = 1000", 1000),
    ],
)
def test_counts_of_the_drive_are_scaled_to_those_of_the_card(more: str, at: int) -> None:
    made = on_bus(f'mode = "csp"\n{more}')
    made.switch_on()
    made.send(*RAMP, "X4000")
    for _ in range(300):
        made.card.advance(10)
    # the emulated motor has 4000 counts a turn: where it is, is what the drive reports
    assert abs(made.drive().objects.target_position.number - at) <= abs(at) // 4000
    assert abs(made.position() - 4000) <= 4


@pytest.mark.parametrize("mult", [1, 2, -4])
def test_the_multiplier_of_the_encoder_is_taken_out_of_the_target(mult: int) -> None:
    made = on_bus()
    made.send(f"MULT X{mult}")
    made.switch_on()
    made.send(*RAMP, "X1000")
    made.card.advance(3000)
    assert made.position() == made.setpoint() == 1000
    assert abs(made.drive().objects.target_position.number - 1000 * 4 // mult) <= 1


@pytest.mark.parametrize(
    ("bus", "gains"),
    [
        ('mode = "csv"\nper_volt = 20000.0', ("PGAIN X0.005",)),
        ('mode = "csv"\nper_volt = -20000.0', ("DAC0 GAIN -3276.8", "PGAIN X0.005")),
        ('mode = "csv"\nper_volt = 20000.0\ndirection = "down"', ("PGAIN X0.005",)),
        ('mode = "cst"\nper_volt = 100.0', ("PGAIN X0.01", "DGAIN X0.0001")),
    ],
)
def test_the_card_closes_its_loop_over_speed_and_torque(bus: str, gains: tuple[str, ...]) -> None:
    made = on_bus(bus)
    made.send(*gains)
    made.switch_on()
    made.send(*RAMP, "X4000")
    made.card.advance(4000)
    assert abs(made.position() - 4000) <= 20
    assert made.drive().profile.state.name == "ENABLED"


def test_two_axes_on_the_bus_draw_a_line() -> None:
    made = on_bus(axes=2)
    made.switch_on(0)
    made.switch_on(1)
    made.send(*RAMP, "X4000 Y2000")
    for _ in range(30):
        made.card.advance(50)
        assert abs(made.position(0) - 2 * made.position(1)) <= 60
    made.card.advance(1500)
    assert (made.position(0), made.position(1)) == (4000, 2000)


# --- what goes wrong --------------------------------------------------------------------


def is_stopped(made: OnBus) -> bool:
    flags = made.card.memory.I[af4.word[0]]
    return bool(flags & af4.DRIVE_FAULT and flags & af4.KILL_ALL_MOTION_REQUEST)


RAMP_CNT = 40_000**2 / (2 * 400_000) + 400  # of a stop from full speed, and what is on its way


def test_a_fault_of_the_drive_kills_the_motion_and_needs_a_reset() -> None:
    made = moving()
    made.drive().fault()
    made.card.advance(20)
    assert is_stopped(made)
    assert "it reports fault 0xFF01" in made.machine.drives[0].alarm
    assert 0 <= counts_until_rest(made) < RAMP_CNT
    made.send("DRIVE ON X")
    made.card.advance(200)
    assert not made.is_enabled()
    assert made.machine.drives[0].drive.order is not Order.ON
    made.send("DRIVE RES X")
    made.card.advance(400)
    at = made.position()
    made.switch_on()
    made.card.advance(200)
    assert made.position() == at


def lose(made: OnBus, frames: int) -> None:
    left = [frames]

    def pass_on(back: bytes) -> bytes | None:
        left[0] -= 1
        return back if left[0] < 0 else None

    made.link.pass_on = pass_on


def test_as_many_lost_frames_as_allowed_are_made_good() -> None:
    made = moving()
    lose(made, 3)
    made.card.advance(5000)
    assert made.machine.alarm == ""
    assert made.machine.bad_cycles == 3
    made.card.advance(2000)
    assert made.position() == 100_000


def test_one_more_lost_frame_stops_all_axes() -> None:
    made = moving()
    lose(made, 4)
    made.card.advance(10)
    assert made.machine.alarm == "no frame comes back, 4 times in a row"
    assert is_stopped(made)
    assert 0 <= counts_until_rest(made) < RAMP_CNT
    assert made.drive().profile.state.name == "DISABLED"


def test_damaged_frames_count_as_lost() -> None:
    made = moving()
    made.link.pass_on = lambda back: back[:40]
    made.card.advance(10)
    assert "no frame comes back" in made.machine.alarm


def test_a_wrong_working_counter_stops_all_axes() -> None:
    made = on_bus(axes=2)
    made.switch_on(0)
    made.segment.power(1, False)
    made.card.advance(10)
    assert made.machine.alarm == "the working counter is wrong, 4 times in a row"
    assert is_stopped(made)
    assert not made.is_enabled(0)


def test_a_cable_pulled_out_stops_the_motor_and_a_reset_brings_the_bus_back() -> None:
    made = moving()
    made.segment.connect(0)
    assert -50 <= counts_until_rest(made) < RAMP_CNT
    assert is_stopped(made)
    made.segment.connect(None)
    made.send("DRIVE RES X")
    made.card.advance(600)
    assert made.machine.alarm == ""
    made.send("DRIVE RES X")  # the watchdog of the drive has left it with a fault
    made.card.advance(1200)
    at = made.position()
    made.switch_on()
    made.card.advance(200)
    assert made.position() == made.setpoint() == at
    made.send("X/100")
    made.card.advance(1000)
    assert made.position() == at + 100


def test_a_bus_is_brought_up_again_a_part_in_each_tick_while_the_card_runs() -> None:
    made = on_bus(axes=2)
    made.link.frame_ns = 50_000
    lose(made, 4)
    made.card.advance(10)
    made.link.pass_on = None
    made.send("DRIVE RES X")
    seen: list[int] = []
    while made.machine.alarm and len(seen) < 5000:
        before = made.link.frames
        made.card.advance(1)
        seen.append(made.link.frames - before)
    assert made.machine.alarm == ""
    assert max(seen) == 3  # an eighth of a millisecond, begun frames are ended
    assert len(seen) > 100
    made.switch_on(1)


def test_a_drive_that_is_asked_while_the_bus_comes_up_is_refused(
    caplog: pytest.LogCaptureFixture,
) -> None:
    made = on_bus()
    made.link.frame_ns = 50_000
    lose(made, 4)
    made.card.advance(10)
    made.link.pass_on = None
    made.send("DRIVE RES X")
    made.card.advance(10)
    made.send("DRIVE ON X")
    made.card.advance(3000)
    assert made.machine.alarm == ""
    assert "is not enabled: the bus is being brought up" in caplog.text
    assert made.drive().profile.state.name == "DISABLED"


def test_a_bus_that_cannot_be_brought_up_again_stays_stopped_and_is_tried_again() -> None:
    made = on_bus()
    made.segment.connect(0)
    made.card.advance(10)
    made.send("DRIVE RES X")
    made.card.advance(400)
    assert "no frame comes back" in made.machine.alarm
    assert is_stopped(made)
    made.segment.connect(None)
    made.send("DRIVE RES X")
    made.card.advance(2000)
    assert made.machine.alarm == ""


def test_a_card_that_ends_while_its_bus_comes_up_leaves_no_thread() -> None:
    made = on_bus()
    lose(made, 4)
    made.card.advance(10)
    made.link.pass_on = None
    made.link.frame_ns = 400_000
    made.send("DRIVE RES X")
    made.card.advance(3)
    names = [thread.name for thread in threading.enumerate()]
    assert "bus emulated" in names
    made.machine.close()
    assert "bus emulated" not in [thread.name for thread in threading.enumerate()]


def test_a_device_that_leaves_op_stops_all_axes() -> None:
    made = moving()
    made.machine._master.devices[0].request(State.SAFEOP)
    made.card.advance(10)
    assert "left OP" in made.machine.alarm or "working counter" in made.machine.alarm
    assert is_stopped(made)


def test_a_jump_of_the_encoder_stops_the_axis() -> None:
    made = moving()
    made.drive().jump(5000)
    made.card.advance(3)
    assert "its position jumped by" in made.machine.drives[0].alarm
    assert is_stopped(made)
    assert abs(counts_until_rest(made)) < RAMP_CNT


def test_an_axis_that_was_stopped_is_not_enabled_before_a_reset() -> None:
    made = on_bus()
    made.switch_on()
    made.drive().jump(5000)
    made.card.advance(100)
    made.send("DRIVE ON X")
    for _ in range(100):
        made.card.advance(2)
        assert made.drive().profile.state.name == "DISABLED"
    made.send("DRIVE RES X")
    made.card.advance(100)
    made.switch_on()
    assert made.position() == made.setpoint()


def test_a_bus_that_was_not_exchanged_for_long_stops_all_axes() -> None:
    made = moving()
    made.link.now_ns += 150_000_000
    made.card.advance(2)
    assert "no exchange for 0.15" in made.machine.alarm
    assert is_stopped(made)


def test_a_changed_servo_period_stops_all_axes() -> None:
    made = on_bus()
    made.switch_on()
    made.send("SYS", "PERIOD 0.001")
    made.card.advance(3)
    assert "servo period was changed" in made.machine.alarm


# --- who is on the bus ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bus", "text"),
    [
        ("position = 3", "the drive of axis X: no device is at position 3; the bus has device 0"),
        ("alias = 9", "no device is at alias 9"),
        ("position = 0\nvendor = 0x1", "machine.toml says 0x1: nothing is enabled"),
        ("position = 0\nproduct = 0x2", "has product"),
    ],
)
def test_another_device_than_the_file_says_is_refused(bus: str, text: str) -> None:
    with pytest.raises(BusError, match=text):
        OnBus(machine().replace("position = 0", bus))


def test_a_refused_bus_has_been_asked_only() -> None:
    text = machine().replace("position = 0", "position = 0\nproduct = 0x2")
    from tests.fieldbus.bus_rig import SegmentLink

    from openacr.fieldbus.ethercat.emulated.build import segment_of
    from openacr.fieldbus.machine.bringing_up import bring_up
    from openacr.plant.describe.load import parse_world

    world = parse_world(text)
    segment = segment_of(world)
    with pytest.raises(BusError):
        bring_up(SegmentLink(segment), world, 0.0005)
    assert segment.slaves[0].controller.get(Register.AL_STATUS, 2) == State.INIT


# --- captures and contacts ----------------------------------------------------------------


def test_a_capture_is_the_position_that_the_touch_probe_has_latched() -> None:
    made = on_bus('mode = "csp"\nprobe = true')
    made.switch_on()
    made.send(*RAMP, "INTCAP X2", "X8000")
    made.card.advance(300)
    assert made.card.memory.I[axes.capture_mode[0]] == 2
    made.drive().probe.touch(True)
    made.card.advance(10)
    assert made.card.memory.I[axes.capture_mode[0]] == -1
    latched = made.drive().objects.probed[0].number
    assert latched > 100
    assert made.card.memory.I[axes.hardware_capture[0]] == latched
    made.send("INTCAP X6")  # the falling edge, which has not come yet
    made.card.advance(20)
    assert made.card.memory.I[axes.capture_mode[0]] == 6
    made.drive().probe.touch(False)
    made.card.advance(10)
    assert made.card.memory.I[axes.hardware_capture[0]] == made.drive().objects.probed[1].number


def test_contacts_of_the_drive_and_of_a_terminal_are_inputs_of_the_card() -> None:
    more = "[[bus.terminal]]\nposition = 1\ninputs_from = 8\ninputs = 8\n"
    more += "outputs_from = 40\noutputs = 8\n"
    made = on_bus('mode = "csp"\ninputs = { home = 3 }', more=more, digital=1)
    terminal = made.segment.slaves[1]
    assert isinstance(terminal, Digital)
    made.card.bit[41] = True
    terminal.set_input(2, True)
    made.card.advance(3)
    assert [made.card.bit[8 + k] for k in range(8)] == [k == 2 for k in range(8)]
    assert terminal.outputs == [k == 1 for k in range(8)]
    terminal.set_input(2, False)
    made.card.bit[41] = False
    made.card.advance(3)
    assert not made.card.bit[10]
    assert not any(terminal.outputs)
