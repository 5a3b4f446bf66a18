"""The tangential axis: TANG."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.interpolation import GROUP, REF
from openacr.basic.commands.value_commands import Value, master_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis
from openacr.basic.language.registry import BY_OBJECT, PROG
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.rows import masters
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis.settings import anything, fp64
from openacr.motion.path import tangent

command = partial(registry.command, group=GROUP, ref=REF)


@command("TANG", levels=PROG)
def tang(run: Run) -> None:
    """Report the tangential axis."""
    axis = tangent.axis_of(run.card, run.master())
    names = {one.number: one.name for one in run.axes()}
    run.print("OFF" if axis is None else names.get(axis, f"AXIS{axis}"))


@command("TANG ON", levels=PROG, grammar=(Axes(),))
def tang_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Keep an axis in degrees tangential to the path of the first two slaves."""
    if len(axes) != 1:
        raise CardError(INVALID_ARGUMENT)
    tangent.switch_on(run.card, run.needed_program(), run.master(), axes[0].number)


@command("TANG OFF", levels=BY_OBJECT)
def tang_off(run: Run) -> None:
    """Leave the tangential axis alone again."""
    tangent.switch_off(run.card, run.master())


master_values(
    (
        Value("TANG ANG", fp64(masters.tang_deg, anything),
              "Set the angle between the path and the tangential axis.", "degrees"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip
