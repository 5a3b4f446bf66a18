"""Servo control: filtered following."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.follower_forms import AxisSources, choose_sources, needs_parameter
from openacr.basic.language import registry
from openacr.basic.language.grammar import (
    Axes,
    Axis,
    AxisList,
    AxisValue,
    Int,
    ObjectRef,
    ParameterName,
    SignedParameter,
)
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run, whole
from openacr.kernel.sources.source_cy import USE_FILTER
from openacr.map.rows import filters
from openacr.motion.followers import gear, objects

GROUP = "Servo Control"
REF = "PG Servo Control"
command = partial(registry.command, group=GROUP, ref=REF)


@command("FLT SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="NONE")
def flt_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose what an axis follows through its filter."""
    choose_sources(run, axes, USE_FILTER)


@command(
    "FLT OUT",
    levels=BY_OBJECT,
    default="the gear offset",
    grammar=(AxisList(ParameterName(optional=True)),),
)
def flt_out(run: Run, axes: tuple[tuple[Axis, SignedParameter | None], ...]) -> None:
    """Let the filter of an axis move a parameter; without one, the gear offset."""
    for _, parameter in axes:
        if parameter is not None:
            needs_parameter(run, parameter.number)
    for axis, parameter in axes:
        number = None if parameter is None else parameter.number
        objects.set_filter_out(run.card, axis.number, number)


@command(
    "FLT COEF",
    levels=BY_OBJECT,
    grammar=(AxisList(Int("ticks", 1, filters.WINDOW_CNT_SIZE, optional=True)),),
    units="servo periods",
    default="10",
)
def flt_coef(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Set over how many servo periods a filter averages, or report it."""
    for item in axes:
        if item.is_query:
            size = run.card.memory.I[filters.size[item.axis.number]]
            run.print(str(size))
        else:
            objects.set_filter_size(run.card, item.axis.number, whole(item.value))


@command("FLT ON", levels=BY_OBJECT, grammar=(Axes(),))
def flt_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Let axes follow their sources, averaged."""
    for axis in axes:
        gear.permit(run.card, axis.number)
    for axis in axes:
        objects.filter_on(run.card, axis.number)


@command("FLT OFF", levels=BY_OBJECT, grammar=(Axes(),))
def flt_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Stop filtered following at once."""
    for axis in axes:
        objects.filter_off(run.card, axis.number)
