"""Moves that wait for a flag or a capture, and moves that a capture leads elsewhere."""

from __future__ import annotations

from openacr.basic.commands.follower_forms import LAST_CAPTURE_MODE, Captured, CapturedForm
from openacr.basic.commands.interpolation import flag_state, room
from openacr.basic.language.grammar import (
    Axis,
    AxisGroups,
    AxisList,
    AxisValue,
    Bit,
    BitState,
    Either,
)
from openacr.basic.language.registry import PROG, command
from openacr.basic.vm.run import Run, Wait, whole
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.path import moves, triggers
from openacr.motion.path.move_request import Target

NO_FLAG = -1


@command(
    "TRG",
    group="Logic Function",
    levels=PROG,
    grammar=(Either(AxisList(CapturedForm(has_registers=False)), Bit(signed=True)),),
    ref="PG Logic Function",
)
def trg(run: Run, given: BitState | tuple[tuple[Axis, Captured], ...]) -> None:
    """Let the next move wait for a flag, or for a capture of an axis."""
    master = moves.needed_master(run.card, run.needed_program())
    if isinstance(given, BitState):
        triggers.on_flag(run.card, master, flag_state(run, given))
        return
    if len(given) != 1:
        raise CardError(INVALID_ARGUMENT)
    ((axis, captured),) = given
    triggers.on_capture(run.card, master, axis.number, captured.mode, captured.copy_to)


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
    """Move to a target; a capture in the window replaces it by a distance from the capture."""
    program = run.needed_program()
    master = moves.needed_master(run.card, program)
    if len(axes) != 1:
        raise CardError(INVALID_ARGUMENT)
    (item,) = axes
    left_out = (0.0, 0.0, float(NO_FLAG))
    mode, target, distance, window, start, abort = item.values + left_out[len(item.values) - 3 :]
    if not 0 <= mode <= LAST_CAPTURE_MODE or window < 0 or start < 0:
        raise CardError(INVALID_ARGUMENT)
    if not moves.has_room(run.card, master):
        return room(run, master)
    moves.high_speed_interrupt(
        run.card,
        program,
        Target(item.axis.number, target),
        int(mode),
        distance,
        (window, start),
        None if abort == NO_FLAG else flag_state(run, BitState(whole(abort))),
    )
    return None
