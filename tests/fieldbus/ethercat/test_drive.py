"""The emulated drive of CiA 402: states, modes, stops, faults, touch probe."""

import pytest
from tests.fieldbus.ethercat.rig import INPUT, MS, Bus

from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.emulated.drive import BUS_ERROR, CSP, CST, CSV, HOMING
from openacr.fieldbus.ethercat.emulated.drive_objects import RECEIVED, TRANSMITTED
from openacr.fieldbus.ethercat.wire import coe
from openacr.fieldbus.ethercat.wire.registers import ERROR, Register, State
from openacr.plant.describe.load import parse_world

AXIS = """
[[axis]]
number = 0
name = "X"
counts_per_rev = 4000
units = "mm"
units_per_rev = 4.0
marker = 0.0
positive_limit = {{ at = 50.0 }}
negative_limit = {{ at = -50.0, contact = "closed" }}
home = {{ between = [2.0, 3.0] }}
motor = {{ inertia_kgm2 = 2e-5, torque_nm_per_a = 0.1 }}
{load}
drive = {{ {drive} }}
"""
TORQUE = 'mode = "torque", amps_per_volt = 2.0, peak_amps = 18.0'
LOAD = "load = { inertia_kgm2 = 2e-5, viscous_nms = 5e-5, coulomb_nm = 0.01 }"
KINDS = {
    "torque": (TORQUE, LOAD, ""),
    "velocity": ('mode = "velocity", revs_per_s_per_volt = 5.0, peak_amps = 18.0', LOAD, ""),
    "ideal": ('mode = "ideal", revs_per_s_per_volt = 5.0', "", ""),
    "exact": ('mode = "exact"', "", ""),
    "down": (TORQUE, LOAD, 'encoder_direction = "down"'),
    "elastic": (TORQUE, LOAD.replace("}", ", resonance_hz = 180.0 }"), ""),
}


def bus_of(kind: str = "torque") -> Bus:
    drive, load, more = KINDS[kind]
    text = AXIS.format(drive=drive, load=load) + more + "\n"
    if kind in ("ideal", "exact"):
        text = "\n".join(line for line in text.splitlines() if not line.startswith("motor"))
    bus = Bus(segment_of(parse_world(text)))
    bus.op(0, 16, 34)
    bus.cycle()
    return bus


@pytest.fixture
def bus() -> Bus:
    return bus_of()


def shown(bus: Bus) -> int:
    return bus.status() & 0x6F


def download(bus: Bus, index: int, value: int, size: int) -> None:
    reply = bus.download(0, index, 0, value.to_bytes(size, "little", signed=value < 0))
    assert isinstance(reply, coe.Downloaded), reply


def test_the_process_data_are_those_of_the_page() -> None:
    assert sum(kind.bits for _, kind in RECEIVED) + 8 == 16 * 8
    assert sum(kind.bits for _, kind in TRANSMITTED) + 8 == INPUT.size * 8 == 34 * 8


# Control words in a row, and the state the status word shows after each (CiA 402).
@pytest.mark.parametrize(
    "steps",
    [
        [(0x00, 0x40), (0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)],
        [(0x0F, 0x40), (0x07, 0x40), (0x02, 0x40)],
        [(0x06, 0x21), (0x0F, 0x27), (0x07, 0x23), (0x06, 0x21), (0x00, 0x40)],
        [(0x06, 0x21), (0x02, 0x40)],
        [(0x06, 0x21), (0x07, 0x23), (0x00, 0x40)],
        [(0x06, 0x21), (0x07, 0x23), (0x02, 0x40)],
        [(0x06, 0x21), (0x0F, 0x27), (0x06, 0x21)],
        [(0x06, 0x21), (0x0F, 0x27), (0x00, 0x40), (0x0F, 0x40)],
        [(0x06, 0x21), (0x0F, 0x27), (0x02, 0x40)],  # at rest a quick stop is over at once
    ],
)
def test_control_words_lead_through_the_states(bus: Bus, steps: list[tuple[int, int]]) -> None:
    for control, state in steps:
        bus.command(control=control)
        bus.cycle(4)
        assert shown(bus) == state, f"after {control:#x}"


@pytest.mark.parametrize("kind", list(KINDS))
def test_every_kind_of_motor_follows_positions_to_the_count(kind: str) -> None:
    bus = bus_of(kind)
    bus.enable()
    worst = 0
    for position in range(0, 4001, 10):  # 10 counts a ms: 2.5 revolutions a second
        bus.command(position=position)
        bus.cycle()
        worst = max(worst, abs(int(INPUT.unpack(bus.inputs[0])[4])))
    bus.cycle(2000 if kind == "elastic" else 300)
    assert bus.position() == 4000
    assert shown(bus) == 0x27
    assert worst <= 80


def test_a_speed_is_reached_and_a_torque_accelerates(bus: Bus) -> None:
    bus.enable(mode=CSV)
    bus.command(velocity=8000, mode=CSV)
    bus.cycle(300)
    assert INPUT.unpack(bus.inputs[0])[2] == pytest.approx(8000, abs=40)
    bus.command(velocity=0, mode=CSV)
    bus.cycle(300)
    bus.command(torque=200, mode=CST)
    bus.cycle(2)
    before = INPUT.unpack(bus.inputs[0])
    bus.cycle(10)
    after = INPUT.unpack(bus.inputs[0])
    # 200/1000 of a third of 1.8 Nm, less friction, on 4e-5 kgm2
    accel = (0.2 * 0.6 - 0.01) / 4e-5 * 4000 / 6.2831853
    assert after[3] == 200
    assert after[2] - before[2] == pytest.approx(accel * 0.010, rel=0.02)


def test_a_motor_without_torque_has_no_torque_mode() -> None:
    bus = bus_of("ideal")
    assert bus.upload(0, 0x6502) == (0x1A0).to_bytes(4, "little")
    bus.enable()
    bus.command(torque=500, mode=CST)
    bus.cycle(20)
    assert INPUT.unpack(bus.inputs[0])[-1] == CSP
    assert bus_of().upload(0, 0x6502) == (0x3A0).to_bytes(4, "little")


def test_enabling_moves_nothing(bus: Bus) -> None:
    bus.drive(0).motor._memory.F[bus.drive(0).motor._position] = 1234.5
    bus.cycle(3)
    assert bus.position() == 1234
    bus.enable()
    bus.command(position=1234)
    bus.cycle(50)
    assert bus.position() == 1234


def test_a_target_far_away_is_a_following_error_that_is_reset_by_an_edge(bus: Bus) -> None:
    bus.enable()
    bus.command(position=20_000)
    bus.cycle(60)
    assert shown(bus) in (0x08, 0x0F)
    bus.cycle(300)
    assert shown(bus) == 0x08
    assert INPUT.unpack(bus.inputs[0])[9] == 0x8611
    bus.answer_emergencies()
    assert [each.code for each in bus.emergencies] == [0x8611]
    bus.command(control=0x80, position=bus.position())
    bus.cycle(2)
    assert shown(bus) == 0x40
    assert INPUT.unpack(bus.inputs[0])[9] == 0


def test_a_following_window_of_all_ones_is_off(bus: Bus) -> None:
    download(bus, 0x6065, 0xFFFFFFFF, 4)
    bus.enable()
    bus.command(position=20_000)
    bus.cycle(1500)
    assert (bus.position(), shown(bus)) == (20_000, 0x27)


def moving(bus: Bus, speed: int = 20) -> int:
    """Bring the axis to a speed in counts a ms; the position."""
    bus.enable()
    for step in range(100):
        bus.command(position=step * speed)
        bus.cycle()
    return 99 * speed


@pytest.mark.parametrize(("option", "state"), [(2, 0x40), (5, 0x07), (6, 0x07)])
def test_a_quick_stop_takes_the_ramp_and_then_its_option(bus: Bus, option: int, state: int) -> None:
    download(bus, 0x605A, option, 2)
    download(bus, 0x6085, 200_000, 4)
    moving(bus)
    begun = bus.position()
    bus.command(control=0x0B, position=99 * 20)
    bus.cycle(2)
    assert shown(bus) == 0x07
    bus.cycle(200)
    assert shown(bus) == state
    assert bus.position() - begun == pytest.approx(20_000**2 / (2 * 200_000), abs=45)
    bus.command(position=bus.position())
    bus.cycle(5)
    assert shown(bus) == (0x27 if option >= 5 else 0x40)


def test_a_quick_stop_that_switches_off_cannot_be_taken_back(bus: Bus) -> None:
    download(bus, 0x6085, 50_000, 4)
    moving(bus)
    bus.command(control=0x0B, position=99 * 20)
    bus.cycle(2)
    bus.command(control=0x0F, position=99 * 20)
    bus.cycle(5)
    assert shown(bus) == 0x07


def test_halt_stops_by_the_ramp_and_stays_enabled(bus: Bus) -> None:
    moving(bus)
    bus.command(control=0x10F, position=99 * 20)
    bus.cycle(100)
    stopped = bus.position()
    bus.cycle(50)
    assert (bus.position(), shown(bus)) == (stopped, 0x27)


def test_a_drive_that_fails_in_motion_stops_and_needs_its_cause_mended(bus: Bus) -> None:
    moving(bus)
    bus.drive(0).fault(0x7305, held=True)
    bus.cycle(100)
    stopped = bus.position()
    assert shown(bus) == 0x08
    for control, state in ((0x00, 0x08), (0x80, 0x08)):
        bus.command(control=control)
        bus.cycle(2)
        assert shown(bus) == state
    bus.drive(0).mend()
    bus.cycle(2)
    assert shown(bus) == 0x08  # an edge is wanted
    bus.command(control=0x00)
    bus.cycle(2)
    bus.command(control=0x80)
    bus.cycle(2)
    assert shown(bus) == 0x40
    assert bus.position() == stopped


def test_without_a_master_a_moving_drive_stops_with_a_fault(bus: Bus) -> None:
    moving(bus)
    begun = bus.position()
    bus.now += 500 * MS
    assert bus.number(0, Register.AL_STATUS) == State.SAFEOP | ERROR
    bus.cycle()
    assert shown(bus) == 0x08
    assert INPUT.unpack(bus.inputs[0])[9] == BUS_ERROR
    at_rest = bus.position()
    assert abs(at_rest - begun) < 300  # the demand ends with the cycle, the ramp is short
    bus.cycle(20)
    assert bus.position() == at_rest


def test_an_encoder_that_jumps_is_a_following_error(bus: Bus) -> None:
    bus.enable()
    bus.cycle(10)
    bus.drive(0).jump(50_000)
    bus.cycle()
    assert bus.position() == pytest.approx(50_000, abs=60)
    bus.cycle(300)
    assert shown(bus) == 0x08
    assert INPUT.unpack(bus.inputs[0])[9] == 0x8611


def test_switches_are_digital_inputs(bus: Bus) -> None:
    drive = bus.drive(0)
    for position, inputs in ((0, 0), (2500, 4), (50_001, 2), (-50_001, 1), (3100, 0)):
        drive.motor._memory.F[drive.motor._position] = position + 0.5
        bus.cycle(2)
        assert INPUT.unpack(bus.inputs[0])[8] == inputs


def test_homing_takes_the_present_position(bus: Bus) -> None:
    download(bus, 0x607C, 100, 4)
    bus.enable()
    for step in range(0, 501, 10):
        bus.command(position=step)
        bus.cycle()
    bus.cycle(200)
    assert bus.position() == 500
    bus.command(control=0x1F, position=500, mode=HOMING)
    bus.cycle(5)
    assert bus.status() & 0x1400 == 0x1400
    assert bus.position() == 100
    bus.command(position=100)
    bus.cycle(100)
    assert (bus.position(), shown(bus)) == (100, 0x27)


# -- touch probe -----------------------------------------------------------------------------


def swept(bus: Bus, probe: int, last: int = 3500) -> tuple[int, ...]:
    bus.enable()
    for step in [*range(0, last + 1, 7), *range(last, -1, -7)]:
        bus.command(position=step, probe=probe)
        bus.cycle()
    bus.command(position=0, probe=probe)
    bus.cycle(100)
    return INPUT.unpack(bus.inputs[0])


def test_a_probe_latches_both_edges_of_the_home_switch_to_the_count(bus: Bus) -> None:
    data = swept(bus, 0x31)
    assert data[5] == 0x07
    assert (data[6], data[7]) == (2000, 3000)


def test_a_single_probe_keeps_its_first_edge_and_a_continuous_one_the_last(bus: Bus) -> None:
    assert swept(bus, 0x11)[6] == 2000
    assert swept(bus_of(), 0x13)[6] == 3000  # entered from above on the return


def test_the_second_probe_latches_the_marker(bus: Bus) -> None:
    data = swept(bus, 0x1500, last=4500)
    assert data[5] == 0x0300
    assert int.from_bytes(bus.upload(0, 0x60BC), "little") == 4000


def test_a_probe_that_is_off_latches_nothing(bus: Bus) -> None:
    assert swept(bus, 0x30)[5:8] == (0, 0, 0)


def test_a_probe_input_that_is_touched_latches_where_the_motor_is(bus: Bus) -> None:
    bus.enable()
    bus.command(probe=0x11)
    bus.cycle(3)
    bus.drive(0).probe.touch(True)
    bus.cycle(2)
    assert INPUT.unpack(bus.inputs[0])[5:7] == (3, 0)


def test_a_stepper_has_no_bus_drive() -> None:
    drive = 'mode = "stepper", output = 0, steps_per_rev = 2000, torque_nm = [[0.0, 0.5]]'
    text = AXIS.format(drive=drive, load="").replace(", torque_nm_per_a = 0.1", "")
    with pytest.raises(UserError, match=r'axis X: its drive has no counterpart.*"torque"'):
        segment_of(parse_world(text))


@pytest.mark.parametrize("count", [-1, 17])
def test_a_segment_has_at_most_sixteen_drives(count: int) -> None:
    with pytest.raises(UserError, match="0 to 16"):
        drives_world(count)
