"""PM: a stepper axis that loses steps finds back to its place."""

import pytest
from tests.basic.motion_bench import PERIOD_S, Bench

from openacr.map.rows import axes, motors, steppers

IN_MOTION = 516
STEPS = steppers.stepper_count[0]
RAW = motors.raw_count[0]
ERROR = 12288 + 3


class Stepper:
    """X drives stepper 0 and sees encoder 0, which misses the steps that were lost."""

    def __init__(self, *lines: str) -> None:
        self.bench = Bench("X").all(
            "AXIS0 OFF", "ATTACH AXIS0 ENC0 STEPPER0", "AXIS0 ON", "PPU X100",
            "ACC 100 DEC 100 STP 100 VEL 10", "JOG VEL X5", "JOG ACC X50", *lines,
        )  # fmt: skip
        self.bench.memory.I[motors.kind[0]] = 1  # a motor that the test moves
        self.bench.all("MULT X4")
        self.lost_cnt = 0

    def ticks(self, count: int) -> "Stepper":
        for _ in range(count):
            self.bench.memory.F[RAW] = self.bench.memory.I[STEPS] - self.lost_cnt
            self.bench.ticks(1)
        return self

    def move(self, line: str) -> "Stepper":
        self.bench.all(line)
        while self.bench.bit(IN_MOTION):
            self.ticks(1)
        return self.ticks(3)

    @property
    def error_cnt(self) -> float:
        return self.bench.p(ERROR)


def stalled(*lines: str, lost_cnt: int = 50) -> Stepper:
    """Has made a move and lost steps, or gained some."""
    made = Stepper(*lines).move("X10")
    made.lost_cnt = lost_cnt
    return made.ticks(3)


def test_it_waits_for_its_time_and_keeps_its_ramps() -> None:
    made = stalled("PM ON X", "PM TIME X0.2", "PM VEL X1", "PM ACC X10")
    steps = [made.ticks(1).bench.memory.I[STEPS] for _ in range(2000)]
    begins = next(k for k, value in enumerate(steps) if value != 1000) * PERIOD_S
    half_step_s = (2 * 0.005 / 10) ** 0.5  # at the ends of the ramps
    assert begins == pytest.approx(0.2 + half_step_s, abs=0.01)
    ends = steps.index(1050) * PERIOD_S
    assert ends - 0.2 == pytest.approx(0.5 / 1 + 1 / 10 - half_step_s, abs=0.01)
    assert max(b - a for a, b in zip(steps, steps[10:], strict=False)) == 1  # 100 steps/s


def test_short_errors_are_left() -> None:
    made = stalled("PM ON X", "PM DB X0.6").ticks(2000)
    made.bench.all("PM DB X0.1")
    made.ticks(150)
    made.lost_cnt = 0
    assert made.ticks(2000).bench.memory.I[STEPS] == 1000


def test_moves_go_on_from_the_corrected_place() -> None:
    made = stalled("PM ON X").ticks(1000).move("X20")
    assert made.ticks(5).error_cnt == 0
    assert made.bench.memory.I[STEPS] == 2050


def test_nothing_is_corrected_during_a_move() -> None:
    made = Stepper("PM ON X", "PM TIME X0")
    made.bench.all("X100")
    made.lost_cnt = 50
    made.ticks(500)
    assert made.bench.memory.F[axes.pm_cnt[0]] == 0


def test_a_kill_ends_a_correction() -> None:
    made = stalled("PM ON X", "PM VEL X0.5").ticks(300)
    before = made.bench.memory.I[STEPS]
    made.bench.all("SET 8467")
    made.ticks(2)
    assert 1000 < made.ticks(1000).bench.memory.I[STEPS] < before + 5


def test_queries() -> None:
    made = Stepper("PM ON X", "PM VEL X3").bench
    words = ("PM", "PM DB X", "PM VEL X", "PM ACC X", "PM TIME X")
    assert [made.type(word) for word in words] == ["X ON", "0", "3", "0", "0.1"]
    made.all("AXIS0 PM OFF", "AXIS0 PM DB 2")
    assert (made.type("PM"), made.type("PM DB X")) == ("X OFF", "2")
