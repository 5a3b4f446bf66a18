"""Drive control: DRIVE ON, OFF, RES and the report."""

from __future__ import annotations

from functools import partial

from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis
from openacr.basic.language.registry import BY_OBJECT, SYS
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import SYNTAX_ERROR
from openacr.motion import interlocks
from openacr.motion.axis import drive

GROUP = "Drive Control"
REF = "PG Drive Control"
command = partial(registry.command, group=GROUP, ref=REF)


@command("DRIVE ON", levels=BY_OBJECT, grammar=(Axes(),))
def drive_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Enable drives; kills and latched limits that bar the axis from moving are lifted."""
    _need_rest(run, axes)
    for axis in axes:
        drive.on(run.card, axis.number)


@command("DRIVE OFF", levels=BY_OBJECT, grammar=(Axes(),))
def drive_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Disable drives: the axes put out nothing, their motors are free. No kill is set."""
    _need_rest(run, axes)
    for axis in axes:
        drive.off(run.card, axis.number)


def _need_rest(run: Run, axes: tuple[Axis, ...]) -> None:
    for axis in axes:
        interlocks.needs_rest(run.card, axis.number)


@command("DRIVE RES", levels=BY_OBJECT, grammar=(Axes(),))
def drive_res(run: Run, axes: tuple[Axis, ...]) -> None:
    """Reset drives: their reset outputs pulse for 50 ms, latched drive faults clear."""
    for axis in axes:
        drive.reset(run.card, axis.number)


@command("DRIVE", levels=BY_OBJECT | SYS, grammar=(Axes(optional=True),))
def drive_report(run: Run, axes: tuple[Axis, ...] | None) -> None:
    """Report which drives are enabled, have a fault, or are DRIVEN without being enabled."""
    if axes is None and run.level is SYS:
        raise CardError(SYNTAX_ERROR)
    for axis in run.axes() if axes is None else axes:
        state = "ON" if drive.is_enabled(run.card, axis.number) else "OFF"
        fault = " FAULT" if drive.has_fault(run.card, axis.number) else ""
        is_live = state == "OFF" and drive.is_driven(run.card, axis.number)
        run.print(f"DRIVE {state} {axis.name}{fault}{' DRIVEN' if is_live else ''}")
