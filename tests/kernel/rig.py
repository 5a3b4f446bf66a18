"""A card moved tick by tick: Python commands, the compiled (or pure) servo interrupt."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from openacr import compiled
from openacr.kernel.tick_cy import tick
from openacr.map import numbers as at
from openacr.map.names import every_name
from openacr.models import ACR8020
from openacr.motion import row_index
from openacr.motion.axis import attach
from openacr.motion.card import Card
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target
from openacr.plant.apply import apply_world
from openacr.plant.load import parse_world
from openacr.plant.step_cy import plant_step

Reals = NDArray[np.float64]
TICK: Callable[..., None] = compiled.pick(tick)
PLANT: Callable[..., None] = compiled.pick(plant_step)
T = 0.0005
NAMES = "XYZABCUV"


class Rig:
    """`axes` axes on master 0 of program 0; with a `world` motors move, else feedback is ideal."""

    def __init__(
        self, axes: int = 1, ppu: Sequence[float] = (), world: str = "", pure: bool = False
    ) -> None:
        self.card = Card(ACR8020)
        self.memory = self.card.memory
        self.F, self.I, self.S = self.memory.F, self.memory.I, self.memory.S
        self.axes = axes
        self.step = tick if pure else TICK
        self.plant = plant_step if pure else PLANT
        self.modelled = bool(world)
        if world:
            apply_world(parse_world(world), self.memory)
        attach.master(self.card, 0, 0)
        for n in range(axes):
            attach.slave(self.card, 0, n, n, NAMES[n])
        for n, scale in enumerate(ppu):
            self.S[row_index.axis_parameter(n) + at.AX_PPU] = scale
        self.I[at.KRI_BASE + at.KRI_AXES] = axes
        self.I[at.KRI_BASE + at.KRI_MASTERS] = 1

    # settings

    def master(self, **settings: float) -> Rig:
        """Set ACC, DEC, STP, JRK, FVEL, IVEL, VEL, FOV or ROV of master 0."""
        for name, value in settings.items():
            if name == "vel":
                self.S[at.MA_BASE + at.MA_USER_VELOCITY] = value
            elif name == "fov":
                self.S[at.MA_BASE + at.MA_FEEDRATE_OVERRIDE] = value
            elif name == "rov":
                self.S[at.MA_BASE + at.MA_RAPID_FEEDRATE_OVERRIDE] = value
            else:
                self.F[at.MSF_BASE + MASTER_ROWS[name]] = value
        return self

    def jog(self, axis: int = 0, **settings: float) -> Rig:
        """Set VEL, ACC, DEC or JRK of the jog profiler of an axis."""
        for name, value in settings.items():
            self.S[row_index.axis_parameter(axis) + JOG_ROWS[name]] = value
        return self

    def axis(self, axis: int = 0, **settings: float) -> Rig:
        """Set public rows of an axis by their name in lower case."""
        for name, value in settings.items():
            self.memory.write(row_index.axis_parameter(axis) + row_of("AX", name), value)
        return self

    def bit(self, number: int, on: bool | None = None) -> bool:
        """State of a flag, or set it."""
        if on is not None:
            self.memory.set_bit(number, on)
        return self.memory.bit(number)

    def move(self, *targets: float, rapid: bool = False, incremental: bool = False) -> None:
        """Issue one coordinated move of the first axes."""
        wanted = [Target(n, value, incremental) for n, value in enumerate(targets)]
        moves.issue(self.card, 0, wanted, rapid=rapid)

    def depth(self, moves_waiting: int) -> None:
        """Let master 0 buffer this count of moves."""
        self.I[at.MSI_BASE + at.MSI_DEPTH] = moves_waiting

    # time

    def ticks(self, count: int = 1) -> Rig:
        """Run servo periods."""
        F, I, S = self.F, self.I, self.S
        for _ in range(count):
            if self.modelled:
                self.plant(F, I, S, self.axes, T)
            self.step(F, I, S)
        return self

    def seconds(self, time_s: float) -> Rig:
        """Run seconds of card time."""
        return self.ticks(round(time_s / T))

    def record(self, axis: int = 0, limit: int = 60_000, while_: int = 516, then: int = 1) -> Reals:
        """Primary setpoint [pulses] now and after every tick while a flag is on, and `then` more.

        The first value is the position before the first tick.
        """
        F, I, S = self.F, self.I, self.S
        psp = at.AXF_BASE + axis * at.AXF_STRIDE + at.AXF_PSP_CNT
        word, mask = 4096 + while_ // 32, 1 << while_ % 32
        values = [F[psp]]
        step, modelled = self.step, self.modelled
        for _ in range(limit):
            if not I[word] & mask:
                break
            if modelled:
                self.plant(F, I, S, self.axes, T)
            step(F, I, S)
            values.append(F[psp])
        else:
            raise AssertionError(f"flag {while_} is still on after {limit} ticks")
        for _ in range(then):
            self.ticks()
            values.append(F[psp])
        return np.array(values)

    # reading

    def real(self, name: str, axis: int = 0) -> float:
        """A hidden float64 row of an axis."""
        return self.F[row_index.axis_reals(axis) + row_of("AXF", name)]

    def long(self, name: str, axis: int = 0) -> int:
        """A public LONG row of an axis."""
        return self.I[row_index.axis_parameter(axis) + row_of("AX", name)]

    def fp32(self, name: str, axis: int = 0) -> float:
        """A public FP32 row of an axis."""
        return self.S[row_index.axis_parameter(axis) + row_of("AX", name)]

    @property
    def path_velocity(self) -> float:
        """Vector velocity of master 0, unrounded."""
        return self.F[at.PRF_BASE + at.PRF_VELOCITY]


def row_of(prefix: str, name: str) -> int:
    """Offset of a row by its name in lower case."""
    return every_name()[f"{prefix}_{name.upper()}"]


MASTER_ROWS = {
    "acc": at.MSF_ACC_UPS2,
    "dec": at.MSF_DEC_UPS2,
    "stp": at.MSF_STP_UPS2,
    "jrk": at.MSF_JRK_UPS3,
    "fvel": at.MSF_FVEL_UPS,
    "ivel": at.MSF_IVEL_UPS,
}
JOG_ROWS = {
    "vel": at.AX_JOG_VELOC_SETTING,
    "acc": at.AX_JOG_ACCEL_SETTING,
    "dec": at.AX_JOG_DECEL_SETTING,
    "jrk": at.AX_JOG_JERK_SETTING,
}


def velocity(positions: Reals) -> Reals:
    """Mean velocity of every tick [pulses/s]."""
    return np.diff(positions) / T


def acceleration(positions: Reals) -> Reals:
    """Second differences per second squared, from rest before the first position."""
    return np.diff(np.concatenate(([0.0], velocity(positions)))) / T


def jerk(positions: Reals) -> Reals:
    """Third differences per second cubed, from rest."""
    return np.diff(np.concatenate(([0.0], acceleration(positions)))) / T


def noise(positions: Reals, order: int) -> float:
    """What rounding of float64 positions can do to differences of an order."""
    return float(np.max(np.abs(positions), initial=1.0)) * 2.0**-52 * 2.0 ** (order + 1) / T**order
