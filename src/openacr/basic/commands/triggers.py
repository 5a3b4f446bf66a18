"""Moves that wait for a flag or a capture, and moves that a capture leads elsewhere."""

from __future__ import annotations

from openacr.basic.commands.feedback_control import LAST_MODE, check_copy
from openacr.basic.commands.interpolation import flag_state, room
from openacr.basic.grammar import AxisGroups, AxisValue, Bit, BitState, Either
from openacr.basic.registry import PROG, command
from openacr.basic.run import Run, Wait, whole
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT
from openacr.motion import moves, triggers
from openacr.motion.orders import Target

NO_FLAG = -1


@command(
    "TRG",
    group="Logic Function",
    levels=PROG,
    grammar=(Either(AxisGroups("mode", "cap", fewest=1), Bit(signed=True)),),
    ref="PG Logic Function",
)
def trg(run: Run, given: BitState | tuple[AxisValue, ...]) -> None:
    """Let the next move wait for a flag, or for a capture of an axis."""
    master = moves.needed_master(run.card, run.needed_program())
    if isinstance(given, BitState):
        triggers.on_flag(run.card, master, flag_state(run, given))
        return
    (item,) = given if len(given) == 1 else _refused()
    mode, copy = (*item.values, 0.0)[:2]
    if not 0 <= mode <= LAST_MODE:
        raise CardError(INVALID_ARGUMENT)
    check_copy(run, whole(copy) or None)
    triggers.on_capture(run.card, master, item.axis.number, int(mode), whole(copy))


def _refused() -> tuple[AxisValue, ...]:
    raise CardError(INVALID_ARGUMENT)


@command("TRG OFF", group="Logic Function", levels=PROG, ref="PG Logic Function")
def trg_off(run: Run) -> None:
    """Let the next move start without waiting."""
    triggers.off(run.card, moves.needed_master(run.card, run.needed_program()))


@command(
    "HSINT",
    group="Feedback Control",
    levels=PROG,
    grammar=(AxisGroups("mode", "target", "incmove", "window", "wstart", "abortbit", fewest=3),),
    ref="PG Feedback Control",
    units="units",
)
def hsint(run: Run, axes: tuple[AxisValue, ...]) -> Wait | None:
    """Move to a target; a capture in the window leads to a way behind it instead."""
    program = run.needed_program()
    master = moves.needed_master(run.card, program)
    (item,) = axes if len(axes) == 1 else _refused()
    left_out = (0.0, 0.0, float(NO_FLAG))
    mode, target, way, window, start, abort = item.values + left_out[len(item.values) - 3 :]
    if not 0 <= mode <= LAST_MODE or window < 0 or start < 0:
        raise CardError(INVALID_ARGUMENT)
    if not moves.has_room(run.card, master):
        return room(run, master)
    moves.high_speed_interrupt(
        run.card,
        program,
        Target(item.axis.number, target),
        int(mode),
        way,
        (window, start),
        None if abort == NO_FLAG else flag_state(run, BitState(whole(abort))),
    )
    return None
