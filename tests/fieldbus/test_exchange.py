"""The frame of a bus in the real-time loop, function by function, in both builds."""

import socket
import sys
from collections.abc import Iterator

import pytest

from openacr.compiled import pick
from openacr.controller import Controller
from openacr.csystem import now_ns
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.map.memory import flag_place
from openacr.map.rows import axes, bus_motors, dacs, encoders, input_words, motors
from openacr.map.words import af4

bus_exchange, bus_take, bus_give = pick(at.bus_exchange), pick(at.bus_take), pick(at.bus_give)
clock_steer = pick(at.clock_steer)
MS = 1_000_000
IMAGE, COUNTER, STATUS, SIZE = 26, 60, 74, 80
IN_OPERATION, OP, ENABLE = 0x27, 8, 15
KILLED = af4.DRIVE_FAULT | af4.KILL_ALL_MOTION_REQUEST
D, F = at.FIRST_DRIVE, at.FIRST_NUMBERS
linux = pytest.mark.skipif(sys.platform != "linux", reason="the loop is for Linux")


class Frames:
    """A frame of two datagrams that comes back as it was sent, or does not."""

    def __init__(self, echo: socket.socket, silent: socket.socket) -> None:
        self._echo, self._silent = echo, silent
        self.memory = ExchangeMemory()
        self.now = now_ns()
        b, n, x = self.memory.rows, self.memory.numbers, self.memory.out
        b[at.ACTIVE], b[at.FRAME_SIZE] = 1, SIZE
        b[at.IMAGE_AT], b[at.COUNTER_AT], b[at.STATUS_AT] = IMAGE, COUNTER, STATUS
        b[at.COUNTER], b[at.OPERATING], b[at.FORBIDDEN] = 3, OP, 0x17
        b[at.DATAGRAMS], b[at.INDEX_AT], b[at.INDEX_AT + 1] = 2, 17, 63
        b[at.CYCLE_TK], b[at.LOST_FRAMES] = 1, 2
        n[at.LATE_NS] = 1e9
        x[COUNTER], x[STATUS] = 3, OP

    def exchange(self, *, comes_back: bool = True) -> None:
        """A period."""
        m = self.memory
        m.rows[at.SOCKET] = (self._echo if comes_back else self._silent).fileno()
        m.numbers[at.RETURN_NS] = 60e9 if comes_back else 1.0
        bus_exchange(m.rows, m.numbers, m.out, m.back, now_ns())


@pytest.fixture
def frames() -> Iterator[Frames]:
    echo = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    echo.bind(("127.0.0.1", 0))
    echo.connect(echo.getsockname())
    silent, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    with echo, silent, far:
        yield Frames(echo, silent)


@linux
def test_a_frame_that_comes_back_is_counted_and_each_has_the_next_index(frames: Frames) -> None:
    b, n = frames.memory.rows, frames.memory.numbers
    indexes = []
    for k in range(1, 258):
        frames.exchange()
        assert (b[at.GOOD], b[at.FRESH], b[at.BAD], b[at.ALARM]) == (k, 1, 0, 0)
        indexes.append((frames.memory.back[17], frames.memory.back[63]))
    assert indexes == [((k - 1) % 255 + 1,) * 2 for k in range(1, 258)]
    assert (n[at.SENT_FRAMES], n[at.MISSING_FRAMES], n[at.WRONG_FRAMES]) == (257.0, 0.0, 0.0)


@linux
def test_more_lost_frames_in_a_row_than_may_be_are_an_alarm(frames: Frames) -> None:
    b = frames.memory.rows
    for comes_back, bad in ((False, 1), (False, 2), (True, 0), (False, 1), (False, 2)):
        frames.exchange(comes_back=comes_back)
        assert (b[at.BAD], b[at.ALARM], b[at.FRESH]) == (bad, 0, int(comes_back))
    frames.exchange(comes_back=False)
    assert b[at.ALARM] == at.ALARM_LOST
    n = frames.memory.numbers
    assert (n[at.SENT_FRAMES], n[at.MISSING_FRAMES], n[at.WRONG_FRAMES]) == (6.0, 5.0, 0.0)


@linux
def test_a_wrong_working_counter_is_as_bad_as_a_lost_frame(frames: Frames) -> None:
    b = frames.memory.rows
    frames.memory.out[COUNTER] = 2
    for _ in range(2):
        frames.exchange()
        assert (b[at.FRESH], b[at.ALARM]) == (0, 0)
    frames.exchange()
    assert b[at.ALARM] == at.ALARM_COUNTER
    n = frames.memory.numbers
    assert (n[at.SENT_FRAMES], n[at.MISSING_FRAMES], n[at.WRONG_FRAMES]) == (3.0, 0.0, 3.0)


@linux
def test_the_first_reason_of_an_alarm_stays_and_a_lost_frame_steers_nothing(frames: Frames) -> None:
    for _ in range(3):
        frames.memory.numbers[at.STEER_NS] = 500.0
        frames.exchange(comes_back=False)
        assert frames.memory.numbers[at.STEER_NS] == 0.0
    frames.memory.out[COUNTER] = 2
    for _ in range(3):
        frames.exchange()
    assert frames.memory.rows[at.ALARM] == at.ALARM_LOST


@linux
def test_a_frame_goes_out_once_in_the_periods_of_a_cycle(frames: Frames) -> None:
    b = frames.memory.rows
    b[at.CYCLE_TK] = 3
    fresh = []
    for _ in range(7):
        frames.exchange()
        fresh.append(b[at.FRESH])
    assert fresh == [1, 0, 0, 1, 0, 0, 1]


@linux
def test_no_exchange_for_too_long_is_an_alarm(frames: Frames) -> None:
    b, n = frames.memory.rows, frames.memory.numbers
    frames.exchange()
    assert b[at.ALARM] == 0
    n[at.LATEST_NS] = now_ns() - 0.5e9
    frames.exchange()
    assert b[at.ALARM] == 0
    n[at.LATEST_NS] = now_ns() - 1.1e9
    frames.exchange()
    assert b[at.ALARM] == at.ALARM_LATE


@linux
def test_a_frame_more_than_half_a_cycle_late_is_counted(frames: Frames) -> None:
    n = frames.memory.numbers
    n[at.CYCLE_NS] = 1e12
    for passed, late in ((0.0, 0.0), (1.4e12, 0.0), (1.6e12, 1.0), (1.6e12, 2.0)):
        n[at.LATEST_NS] = now_ns() - passed if passed else 0.0
        frames.exchange()
        assert n[at.LATE_FRAMES] == late


@linux
def test_each_frame_asks_the_next_device_for_its_state(frames: Frames) -> None:
    b, x = frames.memory.rows, frames.memory.out
    ask_at = 90
    b[at.FRAME_SIZE], b[at.ASK_AT], b[at.STATION], b[at.DEVICES] = 120, ask_at, 0x1000, 3
    x[ask_at + 10 : ask_at + 16] = bytes([0x14, 0x01, 0, 0, 0x1B, 0x02])
    x[ask_at + 16] = 1
    seen = []
    for _ in range(4):
        frames.exchange()
        seen.append(int.from_bytes(frames.memory.back[ask_at + 2 : ask_at + 4], "little"))
    assert seen == [0x1001, 0x1002, 0x1000, 0x1001]
    shown = list(b[at.FIRST_DEVICE : at.FIRST_DEVICE + 8])
    assert shown == [0x114, 0x21B, 0x114, 0x21B, 0x114, 0x21B, 0, 0]
    x[ask_at + 16] = 0  # no device has answered
    frames.exchange()
    assert list(b[at.FIRST_DEVICE + 2 : at.FIRST_DEVICE + 6]) == [0x114, 0x21B, 0, 0]
    x[ask_at + 16] = 1
    frames.exchange(comes_back=False)
    assert list(b[at.FIRST_DEVICE : at.FIRST_DEVICE + 4]) == [0, 0, 0x114, 0x21B]


@linux
def test_counters_begin_at_0_and_nothing_else_changes(frames: Frames) -> None:
    n = frames.memory.numbers
    frames.exchange(comes_back=False)
    n[at.PHASE_NS], n[at.LATE_FRAMES], n[at.WRONG_FRAMES] = 7.0, 4.0, 5.0
    kept = list(n[at.WORST_RETURN_NS + 1 :]), list(n[: at.SENT_FRAMES])
    assert n[at.WORST_RETURN_NS] > 0.0
    pick(at.counters_begin)(n)
    assert list(n[at.SENT_FRAMES : at.WORST_RETURN_NS + 1]) == [0.0] * 5
    assert (list(n[at.WORST_RETURN_NS + 1 :]), list(n[: at.SENT_FRAMES])) == kept


class OneDrive:
    """A drive of motor 0 and axis 0, eight counts for each raw count of the card."""

    def __init__(self) -> None:
        self.made = Controller()
        for line in ("SYS", "ATTACH AXIS0 ENC0 DAC0 ENC0"):
            self.made.ask(line + "\r")
        self.memory = ExchangeMemory()
        b, n = self.memory.rows, self.memory.numbers
        b[at.ACTIVE], b[at.IMAGE_AT], b[at.OUTPUTS_SIZE] = 1, IMAGE, 6
        b[at.STATUS_AT], b[at.OPERATING], b[at.FORBIDDEN] = STATUS, OP, 0x17
        b[at.DRIVES] = 1
        b[D + at.CONTROL_AT], b[D + at.TARGET_AT], b[D + at.TARGET_SIZE] = 0, 2, 4
        b[D + at.STATE_AT], b[D + at.ACTUAL_AT], b[D + at.IS_POSITION] = 6, 8, 1
        n[F + at.ZERO], n[F + at.SCALE], n[F + at.FASTEST_CPS] = float("nan"), 8.0, 1e6
        self.memory.out[at.BASES] = ENABLE
        self.now = 0

    def take(self, position: int, *, status: int = IN_OPERATION, bus: int = OP) -> None:
        """A millisecond later a frame has come back."""
        m, memory = self.memory, self.made.memory
        self.now += MS
        m.rows[at.FRESH] = 1
        m.back[IMAGE + 6 : IMAGE + 8] = status.to_bytes(2, "little")
        m.back[IMAGE + 8 : IMAGE + 12] = (position % 2**32).to_bytes(4, "little")
        m.back[STATUS] = bus
        bus_take(memory.F, memory.I, m.rows, m.numbers, m.back, self.now)

    def give(self) -> tuple[int, int]:
        """Control word and target of the next frame."""
        m, memory = self.memory, self.made.memory
        bus_give(memory.F, memory.I, memory.S, m.rows, m.numbers, m.out)
        control = int.from_bytes(m.out[IMAGE : IMAGE + 2], "little")
        return control, int.from_bytes(m.out[IMAGE + 2 : IMAGE + 6], "little", signed=True)

    def make_ready(self) -> None:
        """Python lets it follow, and the card has enabled the axis."""
        self.memory.rows[D + at.READY] = 1
        self.made.memory.I[af4.word[0]] |= af4.DRIVE_ENABLED

    @property
    def reported(self) -> float:
        return self.made.memory.F[bus_motors.reported_cnt[0]]

    def is_killed(self) -> bool:
        return self.made.memory.I[af4.word[0]] & KILLED == KILLED


def test_the_first_position_is_zero_and_later_ones_pass_the_ends_of_32_bits() -> None:
    one = OneDrive()
    one.take(2**31 - 8)
    assert one.reported == 0.5
    one.take(2**31 + 8)
    assert one.reported == 2.5
    one.take(2**31 - 80)
    assert one.reported == -8.5


def test_a_bus_that_is_brought_up_again_keeps_its_zero() -> None:
    one = OneDrive()
    one.take(1000)
    one.memory.rows[D + at.IS_KNOWN] = 0
    one.take(1800)
    assert one.reported == 100.5


def test_python_names_the_image_that_is_valid() -> None:
    one = OneDrive()
    one.take(0)
    one.memory.out[at.BASES + at.FRAME_ROOM] = 7
    one.memory.rows[at.BASE] = 1
    assert one.give()[0] == 7


def test_bits_beside_the_state_are_no_state() -> None:
    one = OneDrive()
    one.take(0)
    one.make_ready()
    one.take(0, status=IN_OPERATION | 0x1690)
    assert not one.is_killed()


def test_a_target_is_where_the_drive_is_until_it_is_ready_and_the_axis_is_enabled() -> None:
    one = OneDrive()
    rows, numbers = one.made.memory.I, one.made.memory.F
    rows[encoders.mult[0]] = 4
    one.take(1000)
    rows[axes.actual_position[0]] = 0
    numbers[axes.ssp_cnt[0]] = 50.0
    numbers[motors.raw_count[0]] = 0.0
    assert one.give() == (ENABLE, 1000)
    one.memory.rows[D + at.READY] = 1
    assert one.give() == (ENABLE, 1000)
    one.make_ready()
    assert one.give() == (ENABLE, 1000 + 50 * 8)
    rows[af4.word[0]] &= ~af4.DRIVE_ENABLED
    assert one.give() == (0, 1000)  # the card has switched it off: no voltage
    one.memory.rows[D + at.READY] = 0
    assert one.give() == (ENABLE, 1000)  # what Python says


@pytest.mark.parametrize(("by", "fails"), [(2016, False), (2017, True)])
def test_a_drive_may_travel_for_a_cycle_between_two_frames_however_near_they_are(
    by: int, fails: bool
) -> None:
    """A frame on time soon after a late one: its target is that of a whole cycle later."""
    one = OneDrive()
    one.memory.numbers[at.CYCLE_NS] = 2.0 * MS
    one.take(0)
    one.make_ready()
    one.take(by)
    assert one.is_killed() == fails


@pytest.mark.parametrize(
    ("by", "fails"), [(1016, False), (1017, True), (-1016, False), (-1017, True)]
)
def test_a_position_that_moves_faster_than_may_be_stops_its_axis(by: int, fails: bool) -> None:
    one = OneDrive()
    one.take(0)
    one.make_ready()
    one.take(by)
    assert one.is_killed() == fails
    assert one.memory.rows[D + at.FAILED] == (at.FAILED_JUMP if fails else 0)
    if fails:
        assert one.memory.rows[D + at.JUMP_CNT] == by
        assert one.give()[0] == at.QUICK_STOP
        one.take(0)
        assert one.memory.rows[D + at.JUMP_CNT] == by


@pytest.mark.parametrize("is_ready", [False, True])
def test_a_drive_that_leaves_operation_stops_its_axis_if_it_was_to_follow(is_ready: bool) -> None:
    one = OneDrive()
    one.take(0)
    if is_ready:
        one.make_ready()
    one.take(0, status=0x08)
    assert one.is_killed() == is_ready
    assert one.memory.rows[D + at.FAILED] == (at.FAILED_STATE if is_ready else 0)


@pytest.mark.parametrize(
    ("bus", "alarm"), [(OP, 0), (OP | 0x10, at.ALARM_LEFT), (4, at.ALARM_LEFT)]
)
def test_a_device_that_leaves_op_stops_all(bus: int, alarm: int) -> None:
    one = OneDrive()
    one.take(0)
    one.make_ready()
    one.take(0, bus=bus)
    assert one.memory.rows[at.ALARM] == alarm
    assert one.is_killed() == (alarm != 0)
    assert one.give()[0] == (at.QUICK_STOP if alarm else ENABLE)


def test_an_alarm_kills_no_axis_whose_drive_does_not_follow() -> None:
    one = OneDrive()
    one.take(0, bus=4)
    assert one.memory.rows[at.ALARM] == at.ALARM_LEFT
    assert not one.is_killed()


@pytest.mark.parametrize(
    ("volts", "size", "target"), [(2.0, 4, 6000), (-2.0, 2, -6000), (10.0, 2, 30000)]
)
def test_the_target_of_a_speed_or_torque_is_the_output_of_the_converter(
    volts: float, size: int, target: int
) -> None:
    one = OneDrive()
    b, n = one.memory.rows, one.memory.numbers
    b[D + at.IS_POSITION], b[D + at.TARGET_SIZE] = 0, size
    n[F + at.PER_VOLT] = 3000.0
    one.take(0)
    memory = one.made.memory
    memory.S[dacs.dac_output[0]] = volts
    memory.F[motors.dac_step[0]] = 1.0
    assert one.give()[1] == 0
    one.make_ready()
    assert one.give()[1] & 0xFFFF == pytest.approx(target & 0xFFFF, abs=1)


@pytest.mark.parametrize("is_forced", [False, True])
def test_contacts_of_the_image_are_inputs_and_outputs_of_the_card(is_forced: bool) -> None:
    made = Controller(world="examples/gantry/machine.toml")
    rows = made.memory.I
    memory = ExchangeMemory()
    b = memory.rows
    b[at.ACTIVE], b[at.IMAGE_AT], b[at.OUTPUTS_SIZE] = 1, 26, 2
    b[at.OPERATING], b[at.FRESH], b[at.STATUS_AT] = 8, 1, 40
    b[at.INPUTS], b[at.OUTPUTS] = 2, 2
    slot, stuck_mask = 0, 1 << 4
    word = input_words.level[slot] + 0
    flag_word, _ = flag_place(0)
    output_word, output_mask = flag_place(33)
    contacts = [
        (2, 3, flag_word, 1 << 4, slot),
        (3, 0, flag_word, 1 << 5, slot),
        (0, 7, output_word, output_mask, 0),
        (1, 0, output_word, output_mask << 1, 0),
    ]
    for number, contact in enumerate(contacts):
        first = at.FIRST_CONTACT + at.CONTACT_ROWS * number
        for offset, value in enumerate(contact):
            b[first + offset] = value
    rows[input_words.stuck[slot]] = stuck_mask if is_forced else 0
    rows[flag_word] = 1 << 5
    memory.back[28], memory.back[29], memory.back[40] = 1 << 3, 0, 8
    bus_take(made.memory.F, rows, b, memory.numbers, memory.back, 1)
    assert rows[word] & 0x30 == 1 << 4
    assert rows[flag_word] & 0x30 == (0 if is_forced else 1 << 4)
    assert b[at.ALARM] == 0
    rows[output_word] = output_mask
    memory.out[at.BASES], memory.out[at.BASES + 1] = 1, 1
    bus_give(made.memory.F, rows, made.memory.S, b, memory.numbers, memory.out)
    assert bytes(memory.out[26:28]) == bytes([0x81, 0])
    memory.back[40] = 2
    bus_take(made.memory.F, rows, b, memory.numbers, memory.back, 2)
    assert b[at.ALARM] == at.ALARM_LEFT


def test_periods_follow_the_clock_of_the_first_device() -> None:
    """From any phase, and with a clock that gains 50 us a second, to the middle of a cycle."""
    numbers = ExchangeMemory().numbers
    cycle, start = 1_000_000, 800_000_000_000_000_123
    for first in (0, 1, cycle // 2, cycle - 1):
        due, shifts = float(first), []
        for _ in range(2000):
            clock_steer(numbers, start + int(due * 1.00005), cycle)
            shifts.append(numbers[at.STEER_NS])
            due += cycle + numbers[at.STEER_NS]
        assert max(abs(shift) for shift in shifts) <= cycle / 1000
        assert abs(numbers[at.PHASE_NS]) < 1000.0
        assert abs(numbers[at.STEER_NS] + 50.0) < 2.0


@pytest.mark.parametrize("reference", [5_000_000, 5_000_001, 5_999_999, 5_500_000])
def test_the_phase_of_a_frame_is_counted_from_the_middle_between_two_sync0(reference: int) -> None:
    numbers = ExchangeMemory().numbers
    clock_steer(numbers, reference, 1_000_000)
    phase = reference - 5_500_000
    assert numbers[at.PHASE_NS] == phase
    assert numbers[at.STEER_NS] == max(-1000.0, min(1000.0, -phase / 16))
