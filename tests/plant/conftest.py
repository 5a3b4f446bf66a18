"""A card memory with motors on it, driven by hand instead of by the card."""

from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from openacr import compiled
from openacr.map.memory import Memory
from openacr.map.rows import dacs, motors
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.load import parse_world
from openacr.plant.physics.step_cy import plant_step

Build = Callable[..., "Rig"]
STEP: Callable[..., None] = compiled.pick(plant_step)
MOTOR = """
[[axis]]
number = 0
name = "X"
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5 }
"""
DRIVE = 'drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 20.0 }\n'


@dataclass
class Rig:
    """Motors and wiring; `turn` advances them with given volts on every DAC."""

    text: str
    period_s: float = 0.0005
    memory: Memory = field(default_factory=Memory)

    def __post_init__(self) -> None:
        apply_world(parse_world(self.text), self.memory)
        for n in range(16):
            self.enable(n)

    def enable(self, n: int, on: bool = True) -> None:
        self.memory.I[motors.drive_enabled[n]] = int(on)

    def turn(self, volts: float = 0.0, ticks: int = 1, axis: int = 0) -> None:
        m = self.memory
        m.S[dacs.dac_output[axis]] = volts
        for _ in range(ticks):
            STEP(m.F, m.I, m.S, 8, self.period_s)

    def get(self, row: tuple[int, ...], axis: int = 0) -> float:
        return self.memory.F[row[axis]]

    def put(self, row: tuple[int, ...], value: float, axis: int = 0) -> None:
        self.memory.F[row[axis]] = value

    def flag(self, row: tuple[int, ...], axis: int = 0) -> int:
        return self.memory.I[row[axis]]

    @property
    def position(self) -> float:
        return self.get(motors.position_cnt)

    @property
    def velocity(self) -> float:
        return self.get(motors.velocity_cps)

    def throw(self, velocity_cps: float, axis: int = 0) -> None:
        self.put(motors.velocity_cps, velocity_cps, axis)

    def general(self, row: int) -> int:
        return self.memory.I[row]


@pytest.fixture
def rig() -> type[Rig]:
    return Rig


@pytest.fixture
def motor() -> Build:
    """Build a rig with one torque-driven motor and more keys or tables."""

    def build(
        keys: str = "", tables: str = "", drive: str = DRIVE, period_s: float = 0.0005
    ) -> Rig:
        return Rig(MOTOR + drive + keys + "\n" + tables, period_s)

    return build
