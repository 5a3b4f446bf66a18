"""A card moved tick by tick: Python commands, the compiled (or pure) servo interrupt."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from openacr import compiled
from openacr.kernel.tick_cy import tick
from openacr.map.names import every_name
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import kernel, masters, profiles
from openacr.models import ACR8020
from openacr.motion.axis import attach
from openacr.motion.card import Card
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.load import parse_world
from openacr.plant.physics.step_cy import plant_step

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
            self.S[axis_rows.ppu[n]] = scale
        self.I[kernel.axes] = axes
        self.I[kernel.masters] = 1

    # settings

    def master(self, **settings: float) -> Rig:
        """Set ACC, DEC, STP, JRK, FVEL, IVEL, VEL, FOV or ROV of master 0."""
        for name, value in settings.items():
            if name == "vel":
                self.S[masters.user_velocity[0]] = value
            elif name == "fov":
                self.S[masters.feedrate_override[0]] = value
            elif name == "rov":
                self.S[masters.rapid_feedrate_override[0]] = value
            else:
                self.F[MASTER_ROWS[name][0]] = value
        return self

    def jog(self, axis: int = 0, **settings: float) -> Rig:
        """Set VEL, ACC, DEC or JRK of the jog profiler of an axis."""
        for name, value in settings.items():
            self.S[JOG_ROWS[name][axis]] = value
        return self

    def axis(self, axis: int = 0, **settings: float) -> Rig:
        """Set public rows of an axis by their name in lower case."""
        for name, value in settings.items():
            self.memory.write(axis_rows.parameters[axis] + row_of("AX", name), value)
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
        self.I[masters.depth[0]] = moves_waiting

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
        psp = axis_rows.psp_cnt[axis]
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
        return self.F[axis_rows.reals[axis] + row_of("AXF", name)]

    def long(self, name: str, axis: int = 0) -> int:
        """A public LONG row of an axis."""
        return self.I[axis_rows.parameters[axis] + row_of("AX", name)]

    def fp32(self, name: str, axis: int = 0) -> float:
        """A public FP32 row of an axis."""
        return self.S[axis_rows.parameters[axis] + row_of("AX", name)]

    @property
    def path_velocity(self) -> float:
        """Vector velocity of master 0, unrounded."""
        return self.F[profiles.velocity[0]]


def row_of(prefix: str, name: str) -> int:
    """Offset of a row by its name in lower case."""
    return every_name()[f"{prefix}_{name.upper()}"]


MASTER_ROWS = {
    "acc": masters.acc_ups2,
    "dec": masters.dec_ups2,
    "stp": masters.stp_ups2,
    "jrk": masters.jrk_ups3,
    "fvel": masters.fvel_ups,
    "ivel": masters.ivel_ups,
}
JOG_ROWS = {
    "vel": axis_rows.jog_veloc_setting,
    "acc": axis_rows.jog_accel_setting,
    "dec": axis_rows.jog_decel_setting,
    "jrk": axis_rows.jog_jerk_setting,
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
