"""M codes the rs274ngc dialect has for itself."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, Output, Pause, SetCell, Stop, WaitBit
from openacr.cnc.codes import mcodes as _acromill  # noqa: F401  fills the other table
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.mcodes import stops
from openacr.cnc.codes.table import Limit, Step
from openacr.cnc.codes.tables import ACROMILL, RS274NGC
from openacr.cnc.state.cells import TOOL_IN_SPINDLE
from openacr.cnc.state.parameters import INPUTS_INVERTED, is_inverted

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = RS274NGC.mcode
FIRST_OUTPUT = 32
# L of M66: the state to wait for, and whether it has to change to it.
WAITS = {1: (True, True), 2: (False, True), 3: (True, False), 4: (False, False)}
RS274NGC.include(ACROMILL, mcodes=(0, 1, 2, 3, 4, 5, 6, 7, 8, 9))
_NUMBER = Limit("P", 0, 31, "E222", is_needed=True, is_whole=True)
_TOOL = Limit("Q", 0, 999, "E222", is_needed=True, is_whole=True)
_WAIT = (_NUMBER, Limit("L", 0, 4, "E222", is_whole=True), Limit("Q", 0, 1e6, "E222"))

mcode(30, step=Step.STOP)(stops.end)


@mcode(60, step=Step.STOP, acts_dry=False)
def stop(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Stop, as M0."""
    run.tell(Stop(b.source, Pause.STOP))
    yield from run.sync(b.source)


@mcode(48, 49, step=Step.SWITCHES)
def overrides(run: Run, b: BlockContext) -> None:
    """Feed override acts (M48) or not (M49)."""
    _lock(run, b.number == 49)


@mcode(50, step=Step.SWITCHES, takes="P")
def feed_override(run: Run, b: BlockContext) -> None:
    """Feed override acts (P1) or not (P0)."""
    _lock(run, b.get("P", 1.0) == 0.0)


def _lock(run: Run, is_locked: bool) -> None:
    run.modal.is_feed_locked = is_locked
    run.path.change_pace()


@mcode(51, 52, 53, step=Step.SWITCHES, takes="P", fast=Does.NOTHING)
def other_overrides(run: Run, b: BlockContext) -> None:
    """Spindle override, adaptive feed and feed stop are the operator's: accepted."""


@mcode(
    62,
    63,
    64,
    65,
    step=Step.SWITCHES,
    takes="P",
    limits=(_NUMBER,),
    acts_dry=False,
    fast=Does.SHOWS,
)
def output(run: Run, b: BlockContext) -> None:
    """Output P on (M62, M64) or off (M63, M65)."""
    run.tell(Output(b.source, FIRST_OUTPUT + b.whole("P"), b.number in (62, 64)))


@mcode(61, step=Step.TOOL_CHANGE, takes="Q", limits=(_TOOL,), fast=Does.SHOWS)
def set_tool(run: Run, b: BlockContext) -> None:
    """Tool Q is in the spindle; nothing is changed."""
    run.modal.tool_in_spindle = b.whole("Q")
    if not run.options.is_dry:
        run.tell(SetCell(b.source, TOOL_IN_SPINDLE, run.modal.tool_in_spindle))


@mcode(66, step=Step.SWITCHES, takes="PLQ", limits=_WAIT, acts_dry=False)
def wait_input(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Input P into #5399; first wait until it goes on (L1) or off (L2), is on (L3) or off (L4).

    Q is the longest wait in seconds, after which #5399 is -1.
    """
    n, kind = b.whole("P"), b.whole("L")
    if kind in WAITS:
        wanted, is_edge = WAITS[kind]
        limit_s = b.get("Q", math.inf)
        if limit_s == 0.0:
            raise b.fault("E222", "Q", "Q0", "Q above 0, or L0")
        reason = f"input {n} {'on' if wanted else 'off'}"
        is_on = wanted != is_inverted(run.cells, INPUTS_INVERTED, n)
        run.tell(WaitBit(b.source, n, is_on, reason, is_edge, limit_s))
    yield from run.sync(b.source)
    found = run.parameters.read_input(n)
    is_late = kind in WAITS and found != WAITS[kind][0]
    run.parameters.set_waited(-1.0 if is_late else found)


@mcode(98, step=Step.STOP, takes="PL")
def call(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Call O-subroutine P, L times."""
    for _ in range(b.whole("L", 1)):
        yield from run.o_words.call(str(b.whole("P")), b.plan.column("P"), [])


@mcode(99, step=Step.STOP)
def back(run: Run, b: BlockContext) -> None:
    """Return from an O-subroutine."""
    if not run.flow.frames:
        raise b.fault("E261", hint="M99 ends a subroutine; M30 ends a program")
    run.flow.go_back(b.plan.column(""))
