"""The card as the slow side sees it: its memory, its model and who is attached to what."""

from __future__ import annotations

from dataclasses import dataclass, field

from openacr.compiled import pick
from openacr.kernel import calls_cy
from openacr.kernel.axis import axis_cy
from openacr.kernel.status import slow_cy
from openacr.map.hidden.path import MOVES_PER_MASTER
from openacr.map.memory import Memory
from openacr.map.rows import axes, encoders, kernel, masters, system
from openacr.models import DEFAULT_MODEL, Model
from openacr.motion.attachments import Attachments
from openacr.motion.clock import Clock
from openacr.motion.follower_defaults import set_follower_defaults

AXES = 16
MASTERS = 16
SLAVES = 16
ENCODERS = 24
DEFAULT_PERIOD_S = 0.0005
SLOW_SCAN_S = 0.05
SCANNED_ADCS = 8
DEFAULT_RAMP_UPS2 = 20000.0
DEFAULT_VEL_UPS = 10000.0
DEFAULT_LOOK_TO_DEG = 90.0
DEFAULT_PM_TIME_S = 0.1

_axis_show = pick(axis_cy.axis_show)
_axis_take_written = pick(axis_cy.axis_take_written)
_kernel_call = pick(calls_cy.kernel_call)
_slow_scan = pick(slow_cy.slow_scan)


@dataclass(slots=True)
class Card:
    """One card: all numbers are in `memory`, names of attached axes in `attachments`."""

    model: Model = DEFAULT_MODEL
    memory: Memory = field(default_factory=Memory)
    attachments: Attachments = field(default_factory=Attachments)
    clock: Clock = field(init=False)

    def __post_init__(self) -> None:
        self.clock = Clock(self.memory)
        self.power_up()

    def set_period(self, period_s: float) -> None:
        """Set the servo period and what follows from it."""
        self.memory.F[system.period_s] = period_s
        self.memory.I[kernel.slow_ticks] = self.clock.ticks(SLOW_SCAN_S)

    def power_up(self) -> None:
        """Return to the state after switching on; the world outside is not part of it."""
        self.memory.power_up()
        self.attachments.clear()
        rows = self.memory.I
        rows[kernel.axes] = self.model.axes
        rows[kernel.masters] = self.model.masters
        rows[kernel.adc_channels] = SCANNED_ADCS
        rows[kernel.adc_mode] = int(self.model.has_fixed_adc_mode)
        self.set_period(DEFAULT_PERIOD_S)
        for axis in range(AXES):
            self._default_axis(axis)
        for master in range(MASTERS):
            self._default_master(master)
        for encoder in range(ENCODERS):
            rows[encoders.mult[encoder]] = 1
        memory = self.memory
        set_follower_defaults(memory)
        _slow_scan(memory.F, memory.I, memory.S, self.model.axes, self.model.masters)

    def _default_axis(self, axis: int) -> None:
        rows = self.memory.I
        rows[axes.on[axis]] = int(axis < self.model.axes)
        rows[axes.master[axis]] = -1
        rows[axes.position_index[axis]] = axis
        rows[axes.signal_index[axis]] = axis
        rows[axes.velocity_index[axis]] = axis
        rows[axes.hlbit[axis]] = 3 * axis
        rows[axes.capture_mode[axis]] = -1
        rows[axes.drive_wired[axis]] = -1
        for bypass in (axes.filter0_a0, axes.filter1_a0):
            self.memory.S[bypass[axis]] = 1.0
        self.memory.F[axes.scale[axis]] = 1.0
        self.memory.F[axes.pm_time_s[axis]] = DEFAULT_PM_TIME_S

    def _default_master(self, master: int) -> None:
        for row in (masters.acc_ups2, masters.dec_ups2, masters.stp_ups2):
            self.memory.F[row[master]] = DEFAULT_RAMP_UPS2
        self.memory.F[masters.look_to_deg[master]] = DEFAULT_LOOK_TO_DEG
        self.memory.S[masters.user_velocity[master]] = DEFAULT_VEL_UPS
        self.memory.I[masters.program[master]] = -1
        self.memory.I[masters.depth[master]] = 1
        self.memory.I[masters.first[master]] = master * MOVES_PER_MASTER
        self.memory.I[masters.size[master]] = MOVES_PER_MASTER
        for slave in range(SLAVES):
            self.memory.F[masters.vecdef[master] + slave] = 1.0
            self.memory.I[masters.slave_axis[master] + slave] = -1
        self.memory.I[masters.rotate_slave[master] + 1] = 1

    def call(self, call: int, number: int, whole: int = 0, value: float = 0.0) -> None:
        """Let the kernel change what the loop changes, too (`kernel/calls_cy.py`).

        Where ticks go on meanwhile the loop makes the same call once more, when it takes over what
        the command has done.
        """
        memory = self.memory
        with memory.calling(call, number, whole, value):
            _kernel_call(memory.F, memory.I, memory.S, call, number, whole, value)

    def take_written(self, axis: int) -> None:
        """Take over what was written into the shown positions of an axis."""
        _axis_take_written(self.memory.F, self.memory.I, axis)

    def show(self, axis: int) -> None:
        """Show the positions of an axis at once, ahead of the next tick."""
        _axis_show(self.memory.F, self.memory.I, axis)
