"""Moves along circles, arcs in space and sine waves."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from openacr.basic.commands.interpolation import GROUP, REF, Given
from openacr.basic.language import registry
from openacr.basic.language.grammar import AxisTarget, AxisTargets, Group, TargetItem
from openacr.basic.language.registry import PROG
from openacr.basic.vm.run import Run
from openacr.map.words import mf2
from openacr.messages import SYNTAX_ERROR
from openacr.motion.path.move_request import Circle, Direction, Sine, SpaceArc

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
command = partial(registry.command, group=GROUP, ref=REF)


class CurveTargets(AxisTargets):
    """`axis(a, b, ...)...`: exactly `count` axes, or as many as have parentheses."""

    def __init__(self, *names: str, count: int = 0) -> None:
        super().__init__(Group(*names))
        self.count = count

    def parse(self, p: Parser) -> tuple[TargetItem, ...]:
        """Read the axes of the curve; axes after them belong to the straight part of the block."""
        found = [self._target(p)]
        while len(found) < self.count or (not self.count and self._goes_on(p)):
            if not self.starts(p):
                raise p.cursor.error(SYNTAX_ERROR)
            found.append(self._target(p))
        return tuple(found)

    def _goes_on(self, p: Parser) -> bool:
        return self.starts(p) and p.cursor.ahead(1).value == "("


def _circle(targets: tuple[AxisTarget, ...], direction: Direction) -> tuple[Given, ...]:
    first, second = targets
    return (
        Circle(
            (first.axis.number, second.axis.number),
            (first.values[0], second.values[0]),
            (first.values[1], second.values[1]),
            direction,
        ),
    )


@command(
    "CIRCW",
    levels=PROG,
    grammar=(CurveTargets("target", "center", count=2),),
    units="units",
    move=True,
)
def circw(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move two axes clockwise round a centre; other axes of the block go straight (helix)."""
    return _circle(targets, Direction.CLOCKWISE)


@command(
    "CIRCCW",
    levels=PROG,
    grammar=(CurveTargets("target", "center", count=2),),
    units="units",
    move=True,
)
def circcw(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move two axes counter-clockwise round a centre; the same place again is a full circle."""
    return _circle(targets, Direction.COUNTER_CLOCKWISE)


@command(
    "TARC", levels=PROG, grammar=(CurveTargets("target", "mid", count=3),), units="units", move=True
)
def tarc(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move three axes on the circular arc through a mid point to a target.

    VEL, ACC and JRK hold along the arc. As on circles in a plane nothing limits its turn: at speed
    v on a radius r the axes are accelerated by v^2/r as well.
    """
    first, second, third = targets
    return (
        SpaceArc(
            (first.axis.number, second.axis.number, third.axis.number),
            (first.values[0], second.values[0], third.values[0]),
            (first.values[1], second.values[1], third.values[1]),
        ),
    )


@command("TARC ON", levels=PROG)
def tarc_on(run: Run) -> None:
    """Set TARC Mode."""
    run.card.memory.I[mf2.word[run.master()]] |= mf2.TARC_MODE


@command("TARC OFF", levels=PROG)
def tarc_off(run: Run) -> None:
    """Clear TARC Mode."""
    run.card.memory.I[mf2.word[run.master()]] &= ~mf2.TARC_MODE


@command(
    "SINE",
    levels=PROG,
    grammar=(CurveTargets("target", "phase", "sweep", "amplitude"),),
    units="units, degrees",
    move=True,
)
def sine(run: Run, targets: tuple[AxisTarget, ...]) -> tuple[Given, ...]:
    """Move axes on a part of a sine wave, alone or beside straight moves of other axes.

    Alone the path is the sweep, so VEL is in degrees/s and ACC in degrees/s^2; beside straight
    moves only these count, in units. Nothing limits the axis of the wave itself.
    """
    return tuple(Sine(target.axis.number, *target.values) for target in targets)
