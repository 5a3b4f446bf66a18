"""M580 to M585: steps of the canned cycles."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, Orient, Pause, Spin, Spindle, Stop, Tapping
from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.sysvar.tabs import CELLS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = ACROMILL.mcode
SPIN_AT_CALL = CELLS.cycle_spindle_at_call
BY_HAND = "retract by hand, then start"


@mcode(580, step=Step.SWITCHES, acts_dry=False)
def orient(run: Run, b: BlockContext) -> None:
    """Stop the spindle at its angle."""
    run.tell(Orient(b.source, True))


@mcode(581, step=Step.SWITCHES, acts_dry=False)
def release(run: Run, b: BlockContext) -> None:
    """Let the spindle go and turn as before the cycle."""
    run.tell(Orient(b.source, False))
    run.modal.spin = Spin(int(run.cells.read(SPIN_AT_CALL)))
    run.tell(Spindle(b.source, run.modal.spin, run.modal.speed))


@mcode(582, step=Step.SWITCHES, acts_dry=False)
def halt(run: Run, b: BlockContext) -> None:
    """Spindle off and at rest."""
    run.modal.spin = Spin.OFF
    run.tell(Spindle(b.source, Spin.OFF, run.modal.speed))


@mcode(583, 584, step=Step.SWITCHES)
def lock_feed(run: Run, b: BlockContext) -> None:
    """M583 holds the feed override at 100 %, M584 lets it act again."""
    run.modal.is_feed_locked = b.number == 583
    run.tell(Tapping(b.source, run.modal.is_feed_locked))
    run.path.change_pace()


@mcode(585, step=Step.STOP, acts_dry=False)
def hold(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Stop for a retract by hand; the program goes on from where the axes are then."""
    run.tell(Stop(b.source, Pause.HAND_RETRACT, BY_HAND))
    yield from run.sync(b.source)
    where = run.machine.position()
    if where is not None:
        run.path.stand(where)
