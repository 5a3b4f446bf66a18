"""Axis limits: position maintenance of stepper axes."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.axis_limits import GROUP, REF
from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis
from openacr.basic.language.registry import BY_OBJECT, PROG
from openacr.basic.vm.run import Run
from openacr.map.rows import axes as axis_rows
from openacr.motion.axis import maintenance
from openacr.motion.axis.settings import fp64, not_negative

command = partial(registry.command, group=GROUP, ref=REF)


@command("PM", levels=PROG)
def pm(run: Run) -> None:
    """Report for which axes of the program position maintenance is on."""
    for axis in run.axes():
        run.print(f"{axis.name} {'ON' if maintenance.is_on(run.card, axis.number) else 'OFF'}")


@command("PM ON", levels=BY_OBJECT, grammar=(Axes(),), default="OFF", saved=True)
def pm_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Put out steps that stepper axes have lost, as their encoders say, when they rest."""
    for axis in axes:
        maintenance.switch(run.card, axis.number, on=True)


@command("PM OFF", levels=BY_OBJECT, grammar=(Axes(),))
def pm_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Leave lost steps lost; a correction under way ends at once."""
    for axis in axes:
        maintenance.switch(run.card, axis.number, on=False)


axis_values(
    (
        Value("PM DB", fp64(axis_rows.pm_band_u, not_negative),
              "Set the position error that needs no correction.", "units"),
        Value("PM VEL", fp64(axis_rows.pm_vel_ups, not_negative),
              "Set the speed of corrections; 0 is JOG VEL.", "units/s"),
        Value("PM ACC", fp64(axis_rows.pm_acc_ups2, not_negative),
              "Set the ramps of corrections; 0 is JOG ACC.", "units/s2"),
        Value("PM TIME", fp64(axis_rows.pm_time_s, not_negative),
              "Set for how long an error has to last before it is corrected.", "s", "0.1"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip
