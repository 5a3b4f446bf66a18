"""Transformation: the programmed path shifted, turned and scaled."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import Value, axis_values, check_all, value_text
from openacr.basic.language import registry
from openacr.basic.language.grammar import AxisGroups, AxisList, AxisValue, AxisValues, Num
from openacr.basic.language.registry import BY_OBJECT, PROG
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis.settings import fp64, not_zero
from openacr.motion.path import transform

GROUP = "Transformation"
REF = "PG Transformation"
command = partial(registry.command, group=GROUP, ref=REF)
SHIFT = fp64(axis_rows.flz_u)
FACTOR = fp64(axis_rows.scale, not_zero)
CENTER = fp64(axis_rows.scale_center_u)
PLANE_AXES = 2

axis_values(
    (
        Value("OFFSET", fp64(axis_rows.offset_u),
              "Shift the programmed path of axes from the machine's zero.",
              "units", saved=False),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("FLZ", levels=PROG, grammar=(AxisValues(),), units="units")
def flz(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Let the present target positions of axes have programmed values, or show the shifts."""
    check_all(axes, SHIFT)
    program = run.needed_program()
    for item in axes:
        if item.is_query:
            run.print(value_text(SHIFT, SHIFT.read(run.card, item.axis.number)))
        else:
            transform.float_zero(run.card, program, item.axis.number, item.value)


@command("FLZ OFF", levels=PROG)
def flz_off(run: Run) -> None:
    """Clear the shifts that FLZ has made for the axes of the program."""
    for axis in run.axes():
        transform.clear_float_zero(run.card, axis.number)


@command(
    "ROTATE",
    levels=PROG,
    grammar=(Num("degrees", optional=True), AxisList(Num("center"), optional=True)),
    units="degrees",
    default="0",
)
def rotate(run: Run, degrees: float | None, axes: tuple[AxisValue, ...] | None) -> None:
    """Turn the programmed path counter-clockwise in the plane of two axes about a centre."""
    program = run.needed_program()
    if degrees is None:
        run.print(value_text(SHIFT, transform.angle_deg(run.card, program)))
        return
    SHIFT.check(degrees)
    if axes is not None:
        if len(axes) != PLANE_AXES:
            raise CardError(INVALID_ARGUMENT)
        check_all(axes, SHIFT)
        first, second = axes
        plane = first.axis.number, second.axis.number
        transform.rotate_about(run.card, program, plane, (first.value, second.value))
    transform.rotate(run.card, program, degrees)


@command(
    "SCALE",
    levels=BY_OBJECT,
    grammar=(AxisGroups("factor", "center", fewest=1, single=True, values_optional=True),),
    default="1",
)
def scale(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Multiply the programmed path of axes about a centre; a negative factor mirrors it."""
    for item in axes:
        for setting, value in zip((FACTOR, CENTER), item.values, strict=False):
            setting.check(value)
    for item in axes:
        number = item.axis.number
        if item.is_query:
            run.print(value_text(FACTOR, FACTOR.read(run.card, number)))
            continue
        FACTOR.write(run.card, number, item.values[0])
        if len(item.values) > 1:
            CENTER.write(run.card, number, item.values[1])
