"""M12 to M37: the 13 discrete outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Output
from openacr.cnc.codes import Step
from openacr.cnc.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.interpreter import Interpreter
    from openacr.cnc.turn import Turn

mcode = ACROMILL.mcode
FIRST_ON, FIRST_OFF, COUNT = 12, 25, 13
OUTPUT_CELLS = 400_101


@mcode(*range(FIRST_ON, FIRST_ON + 2 * COUNT), step=Step.SWITCHES, acts_dry=False)
def discrete(run: Interpreter, b: Turn) -> None:
    """M12 to M24 turn discrete output 1 to 13 on, M25 to M37 off."""
    k = int(b.number) - FIRST_ON
    number = int(run.cells.read(OUTPUT_CELLS + k % COUNT))
    run.tell(Output(b.source, number, b.number < FIRST_OFF))
