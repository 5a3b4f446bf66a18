"""Setpoint control: jogging."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis, AxisList, AxisValue, AxisValues, Int, Num
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run, whole
from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis.settings import fp32, fp64, not_negative
from openacr.motion.jog import jog

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)


def jog_value(words: str, row: tuple[int, ...], doc: str, units: str, default: str = "0") -> Value:
    """A row whose value is a jog parameter."""
    return Value(words, fp32(row, not_negative), doc, units, default, bare=True)


axis_values(
    (
        jog_value("JOG VEL", axis_rows.jog_veloc_setting,
                  "Set the speed of jogs, also of one under way.", "units/s"),
        jog_value("JOG ACC", axis_rows.jog_accel_setting,
                  "Set the acceleration of jogs; 0 is no ramp.", "units/s2", "10"),
        jog_value("JOG DEC", axis_rows.jog_decel_setting,
                  "Set the deceleration of jogs; 0 is no ramp.", "units/s2", "10"),
        jog_value("JOG JRK", axis_rows.jog_jerk_setting,
                  "Set the jerk of the ramps of jogs; 0 makes them straight.", "units/s3"),
        Value("JOG HOMVF", fp64(axis_rows.homvf_ups, not_negative),
              "Set the speed of the last approach of homing; 0 is a tenth of JOG VEL.",
              "units/s", bare=True),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("JOG FWD", levels=BY_OBJECT, grammar=(Axes(),))
def jog_fwd(run: Run, axes: tuple[Axis, ...]) -> None:
    """Jog axes in the positive direction until JOG OFF."""
    _continuous(run, axes, 1)


@command("JOG REV", levels=BY_OBJECT, grammar=(Axes(),))
def jog_rev(run: Run, axes: tuple[Axis, ...]) -> None:
    """Jog axes in the negative direction until JOG OFF."""
    _continuous(run, axes, -1)


def _continuous(run: Run, axes: tuple[Axis, ...], direction: int) -> None:
    """Start all axes or, if one may not move, none."""
    for axis in axes:
        jog.permit(run.card, axis.number, direction)
    for axis in axes:
        jog.continuous(run.card, axis.number, direction)


@command("JOG OFF", levels=BY_OBJECT, grammar=(Axes(),))
def jog_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Ramp jogging axes down to rest."""
    for axis in axes:
        jog.off(run.card, axis.number)


@command("JOG ABS", levels=BY_OBJECT, grammar=(AxisList(Num("offset")),), units="units")
def jog_abs(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Jog axes until their jog offset has a value."""
    for item in axes:
        jog.permit(run.card, item.axis.number, item.value - jog.offset(run.card, item.axis.number))
    for item in axes:
        jog.absolute(run.card, item.axis.number, item.value)


@command("JOG INC", levels=BY_OBJECT, grammar=(AxisList(Num("distance")),), units="units")
def jog_inc(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Jog axes by a distance from their jog offset, or from the target of a running jog."""
    for item in axes:
        jog.permit(run.card, item.axis.number, item.value)
    for item in axes:
        jog.incremental(run.card, item.axis.number, item.value)


@command("JOG HOME", levels=BY_OBJECT, grammar=(AxisList(Int("direction", -1, 1, optional=True)),))
def jog_home(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Look for the home input of axes, in the direction 1 (as without) or -1."""
    found = [(item.axis.number, 1 if item.is_query else whole(item.value)) for item in axes]
    for axis, direction in found:
        if direction == 0:
            raise CardError(INVALID_ARGUMENT)
        jog.permit_home(run.card, axis)
    for axis, direction in found:
        jog.home(run.card, axis, direction)


@command("JOG REN", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def jog_ren(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make the coordinated position of axes a value (0); the jog offset takes the rest."""
    for item in axes:
        jog.needs_no_moves(run.card, item.axis.number)
    for item in axes:
        jog.renew(run.card, item.axis.number, 0.0 if item.is_query else item.value)


@command("JOG RES", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def jog_res(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make the jog offset of axes a value (0); the coordinated position takes the rest."""
    for item in axes:
        jog.needs_no_jog(run.card, item.axis.number)
    for item in axes:
        jog.reset(run.card, item.axis.number, 0.0 if item.is_query else item.value)
