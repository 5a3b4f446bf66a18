"""Interpolation: linear moves, and the start of the move of a block."""

from __future__ import annotations

from openacr.basic import registry
from openacr.basic.grammar import AxisTarget, AxisTargets
from openacr.basic.registry import PROG, command
from openacr.basic.run import Run, Show, Wait, WaitKind
from openacr.motion import moves
from openacr.motion.moves import Target

GROUP = "Interpolation"
REF = "PG Interpolation"


@command("MOV", group=GROUP, levels=PROG, grammar=(AxisTargets(),), ref=REF, move=True)
def mov(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[AxisTarget, ...]:
    """Move axes in a straight line to targets, or with a slash by distances."""
    return targets


@registry.issues_moves
def issue(run: Run, targets: tuple[AxisTarget, ...]) -> Wait | None:
    """Start the move of a block, or buffer it; wait while the buffer is full."""
    program = run.needed_program()
    master = moves.needed_master(run.card, program)
    if not moves.has_room(run.card, master):
        return room(run, master)
    last = {target.axis.number: target for target in targets}
    moves.issue(run.card, program, [_target(target) for target in last.values()])
    return None


def room(run: Run, master: int, count: int = 1) -> Wait:
    """Wait until `count` moves find room in the buffer, then try again."""
    row, limit = moves.room_row(run.card, master)
    value = limit - (count - 1)
    return Wait(WaitKind.ROW_BELOW, row, value, retry=True, show=Show.MOVE_PENDING)


def _target(given: AxisTarget) -> Target:
    return Target(given.axis.number, given.value, given.incremental)
