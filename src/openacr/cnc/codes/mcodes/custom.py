"""M codes of the user: a part program Mnnn.TXT each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry
from openacr.cnc.codes.gcodes.macros import arguments
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.program.flow import Frame, Level

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext


@ACROMILL.letter("CUSTOM", step=Step.SWITCHES)
def custom(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Run the file of an M code with the words of the block as #1 to #22."""
    for letter in "PL":
        if letter in b.words:
            raise b.fault("E206", letter, letter)
    part = run.program.customs[int(b.number)]
    start = run.flow.at(part.start)
    if start is not None:
        yield from run.execution.call(Frame(Level.CUSTOM), start, list(arguments(b.words)))
