"""The card as the slow side sees it: its memory, its model and who is attached to what."""

from __future__ import annotations

from dataclasses import dataclass, field

from openacr.compiled import pick
from openacr.kernel import axis_cy, slow_cy
from openacr.map.hidden.motion import MOVES_PER_MASTER
from openacr.map.memory import Memory
from openacr.map.numbers import (
    AX_BASE,
    AX_FILTER0_A0,
    AX_FILTER1_A0,
    AX_STRIDE,
    AXF_BASE,
    AXF_PM_TIME_S,
    AXF_SCALE,
    AXF_STRIDE,
    AXI_BASE,
    AXI_CAPTURE_MODE,
    AXI_DRIVE_WIRED,
    AXI_HLBIT,
    AXI_MASTER,
    AXI_ON,
    AXI_POSITION_INDEX,
    AXI_SIGNAL_INDEX,
    AXI_STRIDE,
    AXI_VELOCITY_INDEX,
    ENI_BASE,
    ENI_MULT,
    ENI_STRIDE,
    KRI_ADC_CHANNELS,
    KRI_ADC_MODE,
    KRI_AXES,
    KRI_BASE,
    KRI_MASTERS,
    KRI_SLOW_TICKS,
    MA_BASE,
    MA_STRIDE,
    MA_USER_VELOCITY,
    MSF_ACC_UPS2,
    MSF_BASE,
    MSF_DEC_UPS2,
    MSF_LOOK_TO_DEG,
    MSF_STP_UPS2,
    MSF_STRIDE,
    MSF_VECDEF,
    MSI_BASE,
    MSI_DEPTH,
    MSI_FIRST,
    MSI_PROGRAM,
    MSI_ROTATE_SLAVE,
    MSI_SIZE,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSI_BASE,
    SYSI_TICK_HIGH,
    SYSI_TICK_LOW,
)
from openacr.models import DEFAULT_MODEL, Model
from openacr.motion.attachments import Attachments
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
_slow_scan = pick(slow_cy.slow_scan)


@dataclass(slots=True)
class Card:
    """One card: all numbers are in `memory`, names of attached axes in `attachments`."""

    model: Model = DEFAULT_MODEL
    memory: Memory = field(default_factory=Memory)
    attachments: Attachments = field(default_factory=Attachments)

    def __post_init__(self) -> None:
        self.power_up()

    @property
    def period_s(self) -> float:
        """Servo period, the length of one tick [s]."""
        return self.memory.F[SYSF_BASE + SYSF_PERIOD_S]

    @property
    def tick(self) -> int:
        """Servo interrupts since power-up."""
        rows = self.memory.I
        return rows[SYSI_BASE + SYSI_TICK_HIGH] * 2**31 + rows[SYSI_BASE + SYSI_TICK_LOW]

    def ticks(self, time_s: float) -> int:
        """The number of ticks nearest to a time, at least 1."""
        return max(1, round(time_s / self.period_s))

    def set_period(self, period_s: float) -> None:
        """Set the servo period and what follows from it."""
        self.memory.F[SYSF_BASE + SYSF_PERIOD_S] = period_s
        self.memory.I[KRI_BASE + KRI_SLOW_TICKS] = self.ticks(SLOW_SCAN_S)

    def power_up(self) -> None:
        """Return to the state after switching on; the world outside is not part of it."""
        self.memory.power_up()
        self.attachments.clear()
        rows = self.memory.I
        rows[KRI_BASE + KRI_AXES] = self.model.axes
        rows[KRI_BASE + KRI_MASTERS] = self.model.masters
        rows[KRI_BASE + KRI_ADC_CHANNELS] = SCANNED_ADCS
        rows[KRI_BASE + KRI_ADC_MODE] = int(self.model.has_fixed_adc_mode)
        self.set_period(DEFAULT_PERIOD_S)
        for axis in range(AXES):
            self._default_axis(AXI_BASE + axis * AXI_STRIDE, axis)
        for master in range(MASTERS):
            self._default_master(master)
        for encoder in range(ENCODERS):
            rows[ENI_BASE + encoder * ENI_STRIDE + ENI_MULT] = 1
        memory = self.memory
        set_follower_defaults(memory)
        _slow_scan(memory.F, memory.I, memory.S, self.model.axes, self.model.masters)

    def _default_axis(self, row: int, axis: int) -> None:
        rows = self.memory.I
        rows[row + AXI_ON] = int(axis < self.model.axes)
        rows[row + AXI_MASTER] = -1
        rows[row + AXI_POSITION_INDEX] = axis
        rows[row + AXI_SIGNAL_INDEX] = axis
        rows[row + AXI_VELOCITY_INDEX] = axis
        rows[row + AXI_HLBIT] = 3 * axis
        rows[row + AXI_CAPTURE_MODE] = -1
        rows[row + AXI_DRIVE_WIRED] = -1
        for bypass in (AX_FILTER0_A0, AX_FILTER1_A0):
            self.memory.S[AX_BASE + axis * AX_STRIDE + bypass] = 1.0
        self.memory.F[AXF_BASE + axis * AXF_STRIDE + AXF_SCALE] = 1.0
        self.memory.F[AXF_BASE + axis * AXF_STRIDE + AXF_PM_TIME_S] = DEFAULT_PM_TIME_S

    def _default_master(self, master: int) -> None:
        reals = MSF_BASE + master * MSF_STRIDE
        for row in (MSF_ACC_UPS2, MSF_DEC_UPS2, MSF_STP_UPS2):
            self.memory.F[reals + row] = DEFAULT_RAMP_UPS2
        self.memory.F[reals + MSF_LOOK_TO_DEG] = DEFAULT_LOOK_TO_DEG
        self.memory.S[MA_BASE + master * MA_STRIDE + MA_USER_VELOCITY] = DEFAULT_VEL_UPS
        rows = MSI_BASE + master * MSI_STRIDE
        self.memory.I[rows + MSI_PROGRAM] = -1
        self.memory.I[rows + MSI_DEPTH] = 1
        self.memory.I[rows + MSI_FIRST] = master * MOVES_PER_MASTER
        self.memory.I[rows + MSI_SIZE] = MOVES_PER_MASTER
        for slave in range(SLAVES):
            self.memory.F[reals + MSF_VECDEF + slave] = 1.0
            self.memory.I[rows + MSI_SLAVE_AXIS + slave] = -1
        self.memory.I[rows + MSI_ROTATE_SLAVE + 1] = 1

    def take_written(self, axis: int) -> None:
        """Take over what was written into the shown positions of an axis."""
        _axis_take_written(self.memory.F, self.memory.I, axis)

    def show(self, axis: int) -> None:
        """Show the positions of an axis at once, ahead of the next tick."""
        _axis_show(self.memory.F, self.memory.I, axis)
