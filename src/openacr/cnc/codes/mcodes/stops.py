"""M0, M1, M2: stops and the end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, Pause, Stop
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = ACROMILL.mcode


@mcode(0, step=Step.STOP, acts_dry=False)
def stop(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Stop at rest until the program is started again."""
    run.tell(Stop(b.source, Pause.STOP))
    yield from run.sync(b.source)


@mcode(1, step=Step.STOP, acts_dry=False)
def optional_stop(run: Run, b: BlockContext) -> Iterator[Entry]:
    """As M0 while Optional Stop is on."""
    run.tell(Stop(b.source, Pause.OPTIONAL))
    yield from run.sync(b.source)


@mcode(2, step=Step.STOP)
def end(run: Run, b: BlockContext) -> Iterator[Entry]:
    """End of the program; spindle and coolant go off."""
    run.finish(b.source, is_by_code=True)
    yield from run.flush()
