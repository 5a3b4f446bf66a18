"""G40 to G44, G49 and G100 to G199: radius, length and fixture offsets switched."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.codes.table import Group, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.codes.words import select_length

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
FIRST_FIXTURE = 100


@gcode(
    40, 41, 42, step=Step.COMPENSATION, group=Group.COMPENSATION, fast={40: Sets("compensation")}
)
def compensation(run: Run, b: BlockContext) -> None:
    """Cutter radius compensation off, left or right of the path."""
    run.offset_path.switch(b, int(b.number))


@gcode(43, 44, step=Step.LENGTH, group=Group.LENGTH, fast=Does.SHIFTS)
def length(run: Run, b: BlockContext) -> None:
    """The length of H is added to Z (G43) or taken away (G44)."""
    run.modal.length = int(b.number)
    run.path.refresh()


@gcode(49, step=Step.LENGTH, group=Group.LENGTH, fast=Does.SHIFTS)
def no_length(run: Run, b: BlockContext) -> None:
    """No tool length."""
    run.modal.length = 49
    select_length(run, 0)
    run.path.refresh()


@gcode(*range(100, 200), step=Step.FIXTURE, group=Group.LENGTH, fast=Does.SHIFTS)
def fixture(run: Run, b: BlockContext) -> None:
    """G101 to G199: fixture 1 to 99, its Z part is length H; G100: none."""
    n = run.modal.fixture = int(b.number) - FIRST_FIXTURE
    run.modal.length = 43 if n else 49
    select_length(run, n)
    run.path.refresh()
