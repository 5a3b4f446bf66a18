"""M codes of the user: a part program Mnnn.TXT each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry
from openacr.cnc.codes import Step
from openacr.cnc.flow import Frame, Level
from openacr.cnc.gcodes.macros import arguments
from openacr.cnc.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.interpreter import Interpreter
    from openacr.cnc.turn import Turn


@ACROMILL.letter("CUSTOM", step=Step.SWITCHES)
def custom(run: Interpreter, b: Turn) -> Iterator[Entry]:
    """Run the file of an M code with the words of the block as #1 to #22."""
    for letter in "PL":
        if letter in b.words:
            raise b.fault("E206", letter, letter)
    part = run.program.customs[int(b.number)]
    start = run.flow.at(part.start)
    if start is not None:
        yield from run.execution.call(Frame(Level.CUSTOM), start, list(arguments(b.words)))
