"""Setpoint control: locked pairs of axes."""

from __future__ import annotations

from functools import partial

from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import SYNTAX_ERROR
from openacr.motion.followers import objects

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)
PAIR = 2


@command("LOCK", levels=BY_OBJECT, grammar=(Axes(optional=True),))
def lock(run: Run, axes: tuple[Axis, ...] | None) -> None:
    """Lock the second axis to the first, which it follows unit for unit; alone, list pairs."""
    if axes is None:
        for first, second in objects.locked_pairs(run.card):
            run.print(f"LOCK {_name(run, first)} {_name(run, second)}")
        return
    if len(axes) != PAIR:
        raise CardError(SYNTAX_ERROR)
    objects.lock(run.card, axes[0].number, axes[1].number)


@command("UNLOCK", levels=BY_OBJECT, grammar=(Axes(),))
def unlock(run: Run, axes: tuple[Axis, ...]) -> None:
    """Let the axes of locked pairs move on their own again."""
    for axis in axes:
        objects.unlock(run.card, axis.number)


def _name(run: Run, number: int) -> str:
    named = {axis.number: axis.name for axis in run.axes()}
    return named.get(number, f"AXIS{number}")
