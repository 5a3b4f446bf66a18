"""Faults of the bus in motion: whatever goes wrong, no axis moves further than its ramp."""

import random
import time
from collections.abc import Callable

import pytest
from tests.fieldbus.bus_rig import PERIOD_NS, OnBus
from tests.fieldbus.test_drives_on_a_card import RAMP, RAMP_CNT, is_stopped, moving, on_bus

from openacr.fieldbus.ethercat.emulated.faults import Line
from openacr.io.ethercat_link import RETURN_S

MS = 1_000_000
TARGET = 100_000
SPEED_CPS = 40_000


class Faulty:
    """A segment as it is seen through a line with faults."""

    def __init__(self, made: OnBus, *faults: str, seed: int = 1) -> None:
        self.made, self.line = made, Line(made.segment, seed)
        for fault in faults:
            self.line.command(fault)
        made.link.segment = self  # type: ignore[assignment]

    def process(self, frame: bytes, now: int) -> bytes:
        """The first frame that comes back in time; time passes as long as it takes."""
        for each in self.line.send(frame, now):
            self.made.link.now_ns += min(each.delay_ns, round(RETURN_S * 1e9))
            if each.delay_ns < RETURN_S * 1e9:
                return each.frame
        return b""


def place(made: OnBus) -> float:
    return made.drive().motor.position_cnt


def rest_of(made: OnBus, ticks: int = 4000) -> float:
    """Let the card run; how far the motor went at most, in either direction. It is at rest then."""
    start, far = place(made), 0.0
    for _ in range(ticks // 10):
        made.card.advance(10)
        far = max(far, abs(place(made) - start))
    before = place(made)
    made.card.advance(200)
    assert abs(place(made) - before) < 1.0
    return far


def stops_within_its_ramp(made: OnBus) -> None:
    assert rest_of(made) < RAMP_CNT
    assert is_stopped(made)
    assert not made.is_enabled()


@pytest.mark.parametrize("seed", range(4))
def test_one_frame_in_1000_lost_changes_nothing(seed: int) -> None:
    made = moving()
    faulty = Faulty(made, "lose 1000", seed=seed)
    made.card.advance(7000)
    assert made.machine.alarm == ""
    assert made.machine.counters["lost"] > 0
    faulty.line.command("lose 0")
    made.card.advance(10)
    assert made.position() == made.setpoint() == TARGET


@pytest.mark.parametrize("seed", range(4))
def test_a_burst_of_lost_frames_that_is_too_long_stops_all(seed: int) -> None:
    made = moving()
    Faulty(made, "burst 40", seed=seed)
    stops_within_its_ramp(made)
    assert "no frame comes back" in made.machine.alarm


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("miscount 1", "the working counter is wrong"),
        ("lose 1", "no frame comes back"),
        ("late 20000", "no frame comes back"),
        ("cable-out 0", "no frame comes back"),
    ],
)
def test_what_does_not_come_back_right_stops_all(fault: str, said: str) -> None:
    made = moving()
    Faulty(made, fault)
    stops_within_its_ramp(made)
    assert said in made.machine.alarm or "no exchange" in made.machine.alarm


@pytest.mark.parametrize("each", [1, 20, 300])
@pytest.mark.parametrize("seed", range(3))
def test_damage_that_no_checksum_has_found_moves_nothing_beyond_the_ramp(
    each: int, seed: int
) -> None:
    made = moving()
    Faulty(made, f"damage {each}", seed=seed)
    far = rest_of(made, 7000)
    if is_stopped(made):
        assert not made.is_enabled()
        assert place(made) < TARGET + 2
    else:
        assert far < TARGET + 2
        assert abs(place(made) - TARGET) < 2


def test_a_drive_without_power_coasts_and_is_not_moved_when_it_has_power_again() -> None:
    made = moving()
    made.segment.power(0, False)
    rest_of(made)
    assert is_stopped(made)
    made.segment.power(0, True)
    assert rest_of(made) < 1.0
    assert not made.is_enabled()


@pytest.mark.parametrize("fault", ["miscount 20", "duplicate 1", "late 300"])
def test_what_is_wrong_now_and_then_is_made_good(fault: str) -> None:
    made = moving()
    Faulty(made, fault, seed=3)
    made.card.advance(7000)
    assert made.machine.alarm == ""
    assert abs(place(made) - TARGET) < 2


def test_a_cable_that_is_out_and_in_again_at_once_stops_all_and_moves_nothing_later() -> None:
    made = moving()
    made.segment.connect(0)
    made.card.advance(20)
    made.segment.connect(None)
    stops_within_its_ramp(made)
    assert rest_of(made, 4000) < 1.0


def test_another_device_in_the_place_of_a_drive_is_found_by_the_reset() -> None:
    made = on_bus('mode = "csp"\nvendor = 0xAC2\nproduct = 0x402')
    made.switch_on()
    faulty = Faulty(made, "burst 40")
    made.card.advance(100)
    faulty.line.command("wrong 0")
    made.send("DRIVE RES X")
    made.card.advance(3000)
    assert "machine.toml says 0x" in made.machine.alarm
    made.send("DRIVE ON X")
    assert rest_of(made, 1000) < 1.0
    assert not made.is_enabled()


@pytest.mark.parametrize("stall_ms", [101, 250, 2000])
def test_a_card_that_was_stalled_moves_no_further_than_its_drives_let_it(stall_ms: int) -> None:
    made = moving()
    start = place(made)
    made.segment.advance(made.link.now_ns + stall_ms * MS)  # nothing is sent meanwhile
    made.link.now_ns += stall_ms * MS
    stalled = abs(place(made) - start)
    assert stalled < SPEED_CPS * 0.002 + RAMP_CNT  # the last target, then its watchdog
    stops_within_its_ramp(made)


def test_a_short_stall_is_made_good() -> None:
    made = moving()
    made.link.now_ns += 50 * MS
    made.card.advance(7000)
    assert made.machine.alarm == ""
    assert abs(place(made) - TARGET) < 2


def test_without_the_process_of_the_card_the_drives_stop_by_their_watchdogs() -> None:
    made = moving()
    start = place(made)
    for _ in range(4000):
        made.link.now_ns += PERIOD_NS
        made.segment.advance(made.link.now_ns)
    assert abs(place(made) - start) < SPEED_CPS * 0.002 + RAMP_CNT
    assert made.drive().profile.state.name == "FAULT"
    assert made.drive().objects.error.number == 0x7500


@pytest.mark.parametrize("seed", range(4))
def test_an_overloaded_computer_is_late_and_moves_nothing_beyond_the_target(seed: int) -> None:
    made, draw = moving(), random.Random(seed)
    far = 0.0
    for _ in range(800):
        made.link.now_ns += draw.choice([0, 0, 0, 1, 5, 30]) * MS
        made.card.advance(10)
        far = max(far, place(made))
    assert far < TARGET + SPEED_CPS * 0.0005
    if made.machine.alarm:
        assert is_stopped(made)
    else:
        assert abs(place(made) - TARGET) < 2


@pytest.mark.parametrize("step_s", [-3600.0, 3600.0])
def test_a_clock_that_is_stepped_is_not_that_of_the_bus(
    step_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = moving()
    usual: Callable[[], float] = time.time
    monkeypatch.setattr(time, "time", lambda: usual() + step_s)
    monkeypatch.setattr(time, "time_ns", lambda: round((usual() + step_s) * 1e9))
    made.card.advance(7000)
    assert made.machine.alarm == ""
    assert made.position() == TARGET


def test_an_encoder_that_jumps_in_motion_stops_its_axis_within_the_ramp() -> None:
    made = moving()
    made.drive().jump(5000)
    made.card.advance(3)
    start = place(made)
    assert rest_of(made) < RAMP_CNT
    assert abs(place(made) - start) < RAMP_CNT
    assert is_stopped(made)


def test_a_fault_of_one_drive_stops_the_path_of_both_axes() -> None:
    made = on_bus(axes=2)
    made.switch_on(0)
    made.switch_on(1)
    made.send(*RAMP, "X40000 Y40000")
    made.card.advance(600)
    starts = [made.drive(n).motor.position_cnt for n in (0, 1)]
    made.drive(1).fault()
    made.card.advance(3000)
    moved = [made.drive(n).motor.position_cnt - starts[n] for n in (0, 1)]
    assert all(0 <= each < RAMP_CNT for each in moved)
