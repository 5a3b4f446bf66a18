"""G65, G66, G67: macro calls with arguments."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry
from openacr.cnc.codes.active import ModalMacro
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Axes, Group, Limit, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.program.flow import Frame, Level
from openacr.cnc.reading.formulas import LOCALS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode, letter = ACROMILL.gcode, ACROMILL.letter
ARGUMENTS = "XYZABCDEFGHIJKMQRSTUVW"  # of #1, #2, ...
LIMITS = (
    Limit("P", 1, 999_999, "E222", is_needed=True, is_whole=True),
    Limit("L", 1, 9999, "E222", is_whole=True),
)


@gcode(65, step=Step.MOTION, takes_all=True, axes=Axes.DATA, limits=LIMITS)
def call(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Call label P, L times; the other words become #1 to #22."""
    yield from _calls(run, _macro(run, b), Level.MACRO)


@gcode(66, step=Step.MOTION, takes_all=True, axes=Axes.DATA, limits=LIMITS)
def call_after_moves(run: Run, b: BlockContext) -> None:
    """Call label P after every block that moves, until G67."""
    run.macro = _macro(run, b)


@gcode(67, step=Step.MACRO_OFF, group=Group.MACRO)
def no_macro(run: Run, b: BlockContext) -> None:
    """End of G66."""
    run.macro = None


@letter("MACRO", step=Step.MACRO_CALL, fast=Does.NOTHING)
def modal_call(run: Run, b: BlockContext) -> Iterator[Entry] | None:
    """The call after a block that has moved."""
    macro = run.macro
    if macro is None or not b.has_moved or run.flow.is_within(Level.MODAL_MACRO):
        return None
    return _calls(run, macro, Level.MODAL_MACRO)


def arguments(words: dict[str, float]) -> tuple[float, ...]:
    """The locals of a call: #0 is not used."""
    values = [0.0] * (LOCALS + 1)
    for n, name in enumerate(ARGUMENTS, 1):
        values[n] = words.get(name, 0.0)
    return tuple(values)


def _macro(run: Run, b: BlockContext) -> ModalMacro:
    start = run.flow.labelled(b.whole("P"), b.node, b.plan.column("P"))
    return ModalMacro(start, arguments(b.words), b.whole("L", 1))


def _calls(run: Run, macro: ModalMacro, level: Level) -> Iterator[Entry]:
    for _ in range(macro.repeat_cnt):
        yield from run.execution.call(Frame(level), macro.start, list(macro.values))
        if run.is_ended:
            return
