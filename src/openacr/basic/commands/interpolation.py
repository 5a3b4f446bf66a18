"""Interpolation: linear moves, and the start of the move of a block."""

from __future__ import annotations

from functools import partial
from typing import TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from openacr.basic.language import registry
from openacr.basic.language.grammar import AxisTarget, AxisTargets, Bit, BitState
from openacr.basic.language.registry import PROG
from openacr.basic.vm.run import Run, Show, Wait, WaitKind
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT, NOT_VALID_AT_THIS_LEVEL
from openacr.motion.path import curve_modes, curve_moves, curve_points, moves, tangent, transform
from openacr.motion.path.move_request import Circle, FlagState, Part, Sine, SpaceArc, Target

GROUP = "Interpolation"
REF = "PG Interpolation"
command = partial(registry.command, group=GROUP, ref=REF)


class MoveOptions(Struct, frozen=True):
    """Options of the move of a block: ended by a flag (INT), replacing the current move (TRJ).

    `knot` and `weight` belong to a point of a curve, `family` is the curve type of a knot if
    given.
    """

    interrupt: FlagState | None = None
    replace: bool = False
    knot: float | None = None
    weight: float | None = None
    family: curve_modes.Family | None = None


Given: TypeAlias = AxisTarget | Circle | Sine | SpaceArc | MoveOptions


@command("MOV", levels=PROG, grammar=(AxisTargets(),), move=True)
def mov(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move axes in a straight line to targets, or with a slash by distances."""
    return targets


@command("INT", levels=PROG, grammar=(Bit(signed=True), AxisTargets()), move=True)
def int_(run: Run, bit: BitState, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move in a straight line that ends early when a flag is set (with a minus: clear)."""
    return (MoveOptions(interrupt=flag_state(run, bit)), *targets)


@command("TRJ", levels=PROG, grammar=(AxisTargets(),), move=True)
def trj(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Start a new trajectory at once, in place of the moves under way and waiting.

    It keeps the speed of the path where it turns by up to 90 degrees: a step of each axis, which
    nothing limits.
    """
    return (MoveOptions(replace=True), *targets)


@registry.issues_moves
def issue(run: Run, given: tuple[Given, ...]) -> Wait | None:
    """Start the move of a block, or buffer it; wait while the buffer is full."""
    program = run.needed_program()
    master = moves.needed_master(run.card, program)
    options = _move_options(given)
    if curve_points.is_given(run.card, master):
        return _point(run, master, options, given)
    if options.knot is not None or options.weight is not None:
        raise CardError(NOT_VALID_AT_THIS_LEVEL)
    count = tangent.moves_of(run.card, master)
    if not options.replace and not moves.has_room(run.card, master, count):
        return room(run, master, count)
    programmed = [_part(item) for item in given if not isinstance(item, MoveOptions)]
    parts = transform.apply(run.card, program, programmed)
    moves.issue(run.card, program, parts, interrupt=options.interrupt, replace=options.replace)
    return None


def _point(run: Run, master: int, options: MoveOptions, given: tuple[Given, ...]) -> Wait | None:
    """Take a point of SPLINE or NURB; wait until all pieces it may complete find room."""
    program = run.needed_program()
    is_other = options.family not in (None, curve_modes.family(run.card, master))
    if options.interrupt or options.replace or is_other:
        raise CardError(INVALID_ARGUMENT)
    if not curve_moves.has_room(run.card, master, curve_moves.MOST):
        return room_for_pieces(run, master)
    programmed = [_part(item) for item in given if not isinstance(item, MoveOptions)]
    parts = transform.apply(run.card, program, programmed)
    targets = [part for part in parts if isinstance(part, Target)]
    if len(targets) < len(parts):
        raise CardError(INVALID_ARGUMENT)
    moves.point(run.card, program, targets, options.knot, options.weight)
    return None


def room_for_pieces(run: Run, master: int) -> Wait:
    """Wait until the pieces of a curve find room, then try again."""
    row, limit = curve_moves.room_row(run.card, master, curve_moves.MOST)
    return Wait(WaitKind.ROW_BELOW, row, limit, retry=True, show=Show.MOVE_PENDING)


def room(run: Run, master: int, count: int = 1) -> Wait:
    """Wait until `count` moves find room in the buffer, then try again."""
    row, limit = moves.room_row(run.card, master)
    value = limit - (count - 1)
    return Wait(WaitKind.ROW_BELOW, row, value, retry=True, show=Show.MOVE_PENDING)


def flag_state(run: Run, bit: BitState) -> FlagState:
    """A flag as written; `Invalid bit` if there is no such flag."""
    run.card.memory.bit(bit.number)
    return FlagState(bit.number, bit.clear)


def _move_options(given: tuple[Given, ...]) -> MoveOptions:
    found = MoveOptions()
    for item in given:
        if isinstance(item, MoveOptions):
            found = replace(
                found,
                interrupt=item.interrupt or found.interrupt,
                replace=item.replace or found.replace,
                knot=found.knot if item.knot is None else item.knot,
                weight=found.weight if item.weight is None else item.weight,
                family=item.family or found.family,
            )
    return found


def _part(given: Given) -> Part:
    if isinstance(given, AxisTarget):
        return Target(given.axis.number, given.value, given.incremental)
    if isinstance(given, MoveOptions):
        raise TypeError(given)
    return given
