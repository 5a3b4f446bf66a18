"""Setpoint control: ballscrew tables."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.cam import (
    dimension,
    permit_all,
    set_segments,
    set_shifts,
)
from openacr.basic.commands.follower_forms import AxisSources, Segment, SegmentForm, choose_sources
from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis, AxisList, AxisValue, AxisValues, ObjectRef
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run
from openacr.kernel.followers.cam_cy import BALLSCREW_TABLES
from openacr.kernel.sources.source_cy import FROM_SELF, USE_BALLSCREW
from openacr.map.rows import tables
from openacr.motion.axis.settings import fp64
from openacr.motion.follower_defaults import set_source
from openacr.motion.followers import cam
from openacr.motion.sources import sources

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)

axis_values(
    (
        Value("BSC SCALE", fp64(tables.scale[BALLSCREW_TABLES:]),
              "Multiply the output of a ballscrew table.", "", "1"),
        Value("BSC OFFSET", fp64(tables.offset_u[BALLSCREW_TABLES:]),
              "Add to the output of a ballscrew table.", "units"),
        Value("BSC FLZ", fp64(tables.flz_cnt[BALLSCREW_TABLES:]),
              "Shift the index of a ballscrew table.", "pulses"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("BSC", levels=BY_OBJECT, grammar=(Axes(),))
def bsc_report(run: Run, axes: tuple[Axis, ...]) -> None:
    """Report whether ballscrew tables are on."""
    for axis in axes:
        run.print("ON" if cam.ballscrew_is_on(run.card, axis.number) else "OFF")


@command("BSC DIM", levels=BY_OBJECT, grammar=(AxisValues(),))
def bsc_dim(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Set how many segments the ballscrew table of an axis has, or report it."""
    dimension(run, axes, cam.ballscrew)


@command("BSC SEG", levels=BY_OBJECT, grammar=(AxisList(SegmentForm()),))
def bsc_seg(run: Run, axes: tuple[tuple[Axis, Segment], ...]) -> None:
    """Give a segment of a ballscrew table its length in pulses and its array of points."""
    set_segments(run, axes, cam.ballscrew)


@command(
    "BSC SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="PSP of the axis", saved=True
)
def bsc_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose the index of a ballscrew table."""
    choose_sources(run, axes, USE_BALLSCREW)


@command("BSC ON", levels=BY_OBJECT, grammar=(Axes(),))
def bsc_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Add the output of ballscrew tables at once."""
    permit_all(run, axes, cam.ballscrew)
    for axis in axes:
        cam.ballscrew_on(run.card, axis.number)


@command("BSC OFF", levels=BY_OBJECT, grammar=(Axes(),))
def bsc_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Take the output of ballscrew tables away at once."""
    for axis in axes:
        cam.ballscrew_off(run.card, axis.number)


@command("BSC SHIFT", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def bsc_shift(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Set the second term added to a ballscrew table, or report it."""
    set_shifts(run, axes, cam.ballscrew)


@command("BSC RES", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def bsc_res(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make the ballscrew offset of axes a value (0); the difference goes to BSC SHIFT."""
    for item in axes:
        cam.reset_ballscrew(run.card, item.axis.number, 0.0 if item.is_query else item.value)


@command("BSC CLEAR", levels=BY_OBJECT, grammar=(Axes(),))
def bsc_clear(run: Run, axes: tuple[Axis, ...]) -> None:
    """Switch ballscrew tables off and forget their segments and settings."""
    for axis in axes:
        cam.ballscrew_off(run.card, axis.number)
        cam.clear(run.card.memory, cam.ballscrew(axis.number))
        set_source(run.card.memory, sources.axis_tap(axis.number, USE_BALLSCREW), FROM_SELF)
