"""A card without motion: real memory, and a world of the test's own making."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from openacr.cli.plots import AxisCurves, Curves
from openacr.cli.plots.curves import Array
from openacr.cli.results import AxisReport, Event, Watched
from openacr.map.memory import Memory
from openacr.map.rows import storage
from openacr.map.words import pf
from openacr.scenario import Condition
from openacr.scenario.played import Failure

PERIOD_S = 0.0005


@dataclass
class FakeSurroundings:
    """Inputs are flags; whatever else is done has no effect."""

    memory: Memory

    def set_input(self, bit: int, on: bool) -> None:
        self.memory.set_bit(bit, on)

    def release_input(self, bit: int) -> None:
        self.memory.set_bit(bit, False)

    def fault(self, axis: int, kind: str, value: float) -> None:
        return None

    def mend(self, axis: int, kind: str | None) -> None:
        return None

    def command(self, device: str, name: str, value: float) -> None:
        return None

    def drag(self, axis: int, by_u: float) -> None:
        return None

    def set_analog(self, parameter: int, value: float) -> None:
        return None


@dataclass
class FakeMachine:
    """Lives tick by tick; `world` is called after every tick."""

    world: Callable[["FakeMachine"], None] = lambda machine: None
    memory: Memory = field(default_factory=Memory)
    tick: int = 0
    period_s: float = PERIOD_S
    typed: list[tuple[int, str, str | None]] = field(default_factory=list)
    recorded_every_tk: int = 0
    keeps_peaks: bool = False
    reports: tuple[AxisReport, ...] = ()
    hear: Callable[[str], None] = lambda text: None
    overhear: Callable[[str], None] = lambda text: None

    @property
    def clock(self) -> "FakeMachine":
        return self

    @property
    def lived_tk(self) -> int:
        return self.tick

    def ticks(self, time_s: float) -> int:
        return max(1, round(time_s / self.period_s))

    @property
    def lived_s(self) -> float:
        return self.tick * self.period_s

    def closed_switches(self) -> dict[int, list[int]]:
        return {}

    def digest(self) -> str:
        return self.memory.digest()

    def watch(self, conditions: Sequence[Condition]) -> bool:
        return not conditions

    def has_new_events(self) -> bool:
        return False

    def events(self) -> tuple[Event, ...]:
        return ()

    def advance(self, ticks: int) -> None:
        for _ in range(ticks):
            self.tick += 1
            self.world(self)

    def advance_until(self, bit: int, is_on: bool, ticks: int) -> bool:
        for _ in range(ticks):
            if self.memory.bit(bit) is is_on:
                return True
            self.advance(1)
        return self.memory.bit(bit) is is_on

    def listen(self, hear: Callable[[str], None], overhear: Callable[[str], None]) -> None:
        self.hear, self.overhear = hear, overhear

    def type_text(self, text: str, stream: str | None) -> None:
        self.typed.append((self.tick, text, stream))

    def start_all(self) -> None:
        self.typed.append((self.tick, "RUN ALL", None))

    def failure(self, program: int) -> Failure:
        return Failure("Divide by zero", "P1 = 1/0")

    @property
    def surroundings(self) -> FakeSurroundings:
        return FakeSurroundings(self.memory)

    def axis_reports(self) -> tuple[AxisReport, ...]:
        return self.reports

    def record(self, every_tk: int, *, keep_peaks: bool, watched: Sequence[Watched] = ()) -> None:
        self.recorded_every_tk, self.keeps_peaks = every_tk, keep_peaks

    def curves(self, title: str) -> Curves:
        time_s: Array = np.arange(5, dtype=np.float64) * self.period_s * self.recorded_every_tk
        values = np.array([0.0, 1.0, 2.0, 3.0, 3.0])
        axis = AxisCurves(2, values, values, values, values / 1000)
        return Curves(time_s, (axis,), (), title)

    def store_program(self, program: int) -> None:
        self.memory.I[storage.code_bytes[program]] = 100

    def set_running(self, program: int, on: bool) -> None:
        self.memory.I[pf.word[program]] = pf.PROGRAM_RUNNING if on else 0
