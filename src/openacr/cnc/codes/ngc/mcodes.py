"""M codes the rs274ngc dialect has for itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, Output, Pause, Stop, WaitBit
from openacr.cnc.codes import mcodes as _acromill  # noqa: F401  fills the other table
from openacr.cnc.codes.mcodes import stops
from openacr.cnc.codes.table import Limit, Step
from openacr.cnc.codes.tables import ACROMILL, RS274NGC
from openacr.cnc.state.parameters import INPUTS_INVERTED, is_inverted

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = RS274NGC.mcode
FIRST_OUTPUT = 32
WAITS = {3: True, 4: False}  # L of M66: until on, until off
RS274NGC.include(ACROMILL, mcodes=(0, 1, 2, 3, 4, 5, 6, 7, 8, 9))
_NUMBER = Limit("P", 0, 31, "E222", is_needed=True, is_whole=True)

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


@mcode(50, step=Step.SWITCHES, words="P", takes="P")
def feed_override(run: Run, b: BlockContext) -> None:
    """Feed override acts (P1) or not (P0)."""
    _lock(run, b.get("P", 1.0) == 0.0)


def _lock(run: Run, is_locked: bool) -> None:
    run.modal.is_feed_locked = is_locked
    run.path.change_pace()


@mcode(51, 52, 53, step=Step.SWITCHES, words="P", takes="P")
def other_overrides(run: Run, b: BlockContext) -> None:
    """Spindle override, adaptive feed and feed stop are the operator's: accepted."""


@mcode(62, 63, 64, 65, step=Step.SWITCHES, takes="P", limits=(_NUMBER,), acts_dry=False)
def output(run: Run, b: BlockContext) -> None:
    """Output P on (M62, M64) or off (M63, M65)."""
    run.tell(Output(b.source, FIRST_OUTPUT + b.whole("P"), b.number in (62, 64)))


@mcode(66, step=Step.SWITCHES, takes="PLQ", words="PLQ", limits=(_NUMBER,), acts_dry=False)
def wait_input(run: Run, b: BlockContext) -> None:
    """Wait until input P is on (L3) or off (L4)."""
    wanted = WAITS.get(b.whole("L"))
    if wanted is not None:
        n, state = b.whole("P"), "on" if wanted else "off"
        is_on = wanted != is_inverted(run.cells, INPUTS_INVERTED, n)
        run.tell(WaitBit(b.source, n, is_on, f"input {n} {state}"))


@mcode(98, step=Step.STOP, takes="PL", words="PL")
def call(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Call O-subroutine P, L times."""
    for _ in range(b.whole("L", 1)):
        yield from run.o_words.call(str(b.whole("P")), b.plan.column("P"), [])


@mcode(99, step=Step.STOP)
def back(run: Run, b: BlockContext) -> None:
    """Return from an O-subroutine."""
    run.flow.go_back(b.plan.column(""))
