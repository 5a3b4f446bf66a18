"""M3 to M5 and M7 to M9: spindle and coolant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Coolant, Spin, Spindle
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = ACROMILL.mcode


@mcode(3, 4, step=Step.SPINDLE, acts_dry=False, fast=Does.TURNS)
def spindle_on(run: Run, b: BlockContext) -> None:
    """Spindle clockwise (M3) or counter-clockwise (M4) at speed S."""
    run.modal.spin = Spin(int(b.number))
    run.tell(Spindle(b.source, run.modal.spin, run.modal.speed))


@mcode(5, step=Step.SPINDLE_OFF, acts_dry=False, fast=Does.TURNS)
def spindle_off(run: Run, b: BlockContext) -> None:
    """Spindle off, after the motion of the block."""
    run.modal.spin = Spin.OFF
    run.tell(Spindle(b.source, Spin.OFF, run.modal.speed))


@mcode(7, step=Step.COOLANT, acts_dry=False, fast=Does.SHOWS)
def mist_on(run: Run, b: BlockContext) -> None:
    """Mist coolant on."""
    run.modal.mist = True
    _coolant(run, b)


@mcode(8, step=Step.COOLANT, acts_dry=False, fast=Does.SHOWS)
def flood_on(run: Run, b: BlockContext) -> None:
    """Flood coolant on."""
    run.modal.flood = True
    _coolant(run, b)


@mcode(9, step=Step.COOLANT_OFF, acts_dry=False, fast=Does.SHOWS)
def coolant_off(run: Run, b: BlockContext) -> None:
    """All coolant off, after the motion of the block."""
    run.modal.mist = run.modal.flood = False
    _coolant(run, b)


def _coolant(run: Run, b: BlockContext) -> None:
    run.tell(Coolant(b.source, run.modal.mist, run.modal.flood))
