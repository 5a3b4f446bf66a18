"""M12 to M37: the 13 discrete outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Output
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.sysvar.tabs import IO

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = ACROMILL.mcode
FIRST_ON, FIRST_OFF, COUNT = 12, 25, 13


@mcode(*range(FIRST_ON, FIRST_ON + 2 * COUNT), step=Step.SWITCHES, acts_dry=False, fast=Does.SHOWS)
def discrete(run: Run, b: BlockContext) -> None:
    """M12 to M24 turn discrete output 1 to 13 on, M25 to M37 off."""
    k = int(b.number) - FIRST_ON
    number = int(run.cells.read(IO.discrete_output[k % COUNT]))
    run.tell(Output(b.source, number, b.number < FIRST_OFF))
