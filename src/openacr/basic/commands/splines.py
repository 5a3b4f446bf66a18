"""Curves through points and by control points: SPLINE and NURB.

Knots and weights have two spellings: K and W, as generators of part programs write them, and
SK, NK and NW, which are words also where axes are named K and W.
"""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.interpolation import GROUP, REF, Given, MoveOptions, room_for_pieces
from openacr.basic.language import registry
from openacr.basic.language.grammar import Int, Num
from openacr.basic.language.registry import BY_OBJECT, PROG
from openacr.basic.vm.run import Run, Wait
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT
from openacr.models import Feature
from openacr.motion.path import curve_modes, curve_moves, curve_points
from openacr.motion.path.curve_modes import Family

command = partial(registry.command, group=GROUP, ref=REF)

HIGHEST_RANK = 6


@command("SPLINE", levels=BY_OBJECT)
def spline(run: Run) -> None:
    """Report the mode of splines."""
    _report(run, Family.SPLINE)


@command("SPLINE MODE", levels=BY_OBJECT, grammar=(Int("mode"),))
def spline_mode(run: Run, mode: int) -> None:
    """Let moves be points of a smooth curve: in their times (0) or with the profile (1)."""
    curve_modes.begin(run.card, run.master(), Family.SPLINE, mode)


@command("SPLINE END", levels=PROG)
def spline_end(run: Run) -> Wait | None:
    """End the spline at its last point; moves are moves again."""
    return _end(run, Family.SPLINE)


@command("SK", levels=PROG, grammar=(Num("seconds"),), units="s", move=True)
def sk(run: Run, knot: float) -> tuple[Given, ...]:
    """Set the time of the segment to this point of a spline; a negative one ends it."""
    return (MoveOptions(knot=knot, family=Family.SPLINE),)


@command("NURB", levels=BY_OBJECT, needs=Feature.NURBS)
def nurb(run: Run) -> None:
    """Report the mode of NURBs."""
    _report(run, Family.NURB)


@command("NURB MODE", levels=BY_OBJECT, grammar=(Int("mode"),), needs=Feature.NURBS)
def nurb_mode(run: Run, mode: int) -> None:
    """Let moves be control points: by time (0), with the profile (1), slower in bends (4)."""
    curve_modes.begin(run.card, run.master(), Family.NURB, mode)


@command(
    "NURB RANK",
    levels=BY_OBJECT,
    grammar=(Int("order", low=2, high=HIGHEST_RANK, optional=True),),
    default="4",
    needs=Feature.NURBS,
)
def nurb_rank(run: Run, order: int | None) -> None:
    """Set the order of NURBs: how many control points act on a place of the curve."""
    master = run.master()
    if order is None:
        run.print(str(curve_points.rank(run.card, master)))
        return
    if curve_points.load(run.card, master).points:
        raise CardError(INVALID_ARGUMENT)
    curve_points.set_rank(run.card, master, order)


@command("NURB END", levels=PROG, needs=Feature.NURBS)
def nurb_end(run: Run) -> Wait | None:
    """Repeat the last knot and end the NURB; moves are moves again."""
    return _end(run, Family.NURB)


@command("NK", levels=PROG, grammar=(Num("knot"),), move=True, needs=Feature.NURBS)
def nk(run: Run, knot: float) -> tuple[Given, ...]:
    """Set the knot of this control point or, alone, give a further one; a negative one ends."""
    return (MoveOptions(knot=knot, family=Family.NURB),)


@command("NW", levels=PROG, grammar=(Num("weight"),), default="1", move=True, needs=Feature.NURBS)
def nw(run: Run, weight: float) -> tuple[Given, ...]:
    """Set the weight of this control point."""
    return (MoveOptions(weight=weight),)


@command("K", levels=PROG, grammar=(Num("knot"),), move=True, typed=False)
def k(run: Run, knot: float) -> tuple[Given, ...]:
    """Set the knot of a point of the SPLINE or NURB: `K 0.5 X1 Y2`; `K -1` ends the curve."""
    return (MoveOptions(knot=knot),)


@command("W", levels=PROG, grammar=(Num("weight"),), default="1", move=True, typed=False)
def w(run: Run, weight: float) -> tuple[Given, ...]:
    """Set the weight of a control point with a knot: `K 0.5 W 2 X1 Y2`."""
    return (MoveOptions(weight=weight),)


def _report(run: Run, family: Family) -> None:
    mode = curve_modes.mode(run.card, run.master(), family)
    run.print("OFF" if mode is None else str(mode))


def _end(run: Run, family: Family) -> Wait | None:
    master = run.master()
    if not curve_moves.has_room(run.card, master, curve_moves.MOST):
        return room_for_pieces(run, master)
    curve_modes.end(run.card, run.needed_program(), master, family)
    return None
