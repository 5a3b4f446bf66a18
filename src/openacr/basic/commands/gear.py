"""Setpoint control: electronic gearing."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.follower_forms import (
    AxisSources,
    Captured,
    CapturedForm,
    Passing,
    PassingForm,
    choose_sources,
)
from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis, AxisList, AxisValue, AxisValues, ObjectRef
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run
from openacr.kernel.sources.source_cy import USE_GEAR
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import gears
from openacr.map.words import af2
from openacr.motion.axis.settings import fp64, not_negative, not_zero
from openacr.motion.followers import gear
from openacr.motion.interlocks import scale_of
from openacr.motion.jog import jog
from openacr.motion.sources import sources

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)


axis_values(
    (
        Value("GEAR PPU", fp64(gears.ppu, not_zero),
              "Set the source pulses per source unit of a gear.", "pulses/unit", "1"),
        Value("GEAR RATIO", fp64(gears.ratio),
              "Set the units an axis moves per source unit, also while geared.", "", "1"),
        Value("GEAR ACC", fp64(gears.acc_rps, not_negative),
              "Set the rate at which the ratio of a gear ramps up; 0 is at once.", "1/s"),
        Value("GEAR DEC", fp64(gears.dec_rps, not_negative),
              "Set the rate at which the ratio of a gear ramps down; 0 is at once.", "1/s"),
        Value("GEAR MAX", fp64(gears.max_u),
              "Set the highest gear offset; acts while it is above GEAR MIN.", "units"),
        Value("GEAR MIN", fp64(gears.min_u),
              "Set the lowest gear offset; acts while it is below GEAR MAX.", "units"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("GEAR SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="NONE", saved=True)
def gear_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose what a gear follows."""
    choose_sources(run, axes, USE_GEAR)


@command("GEAR", levels=BY_OBJECT, grammar=(Axes(),))
def gear_report(run: Run, axes: tuple[Axis, ...]) -> None:
    """Report whether gears are on."""
    for axis in axes:
        run.print("ON" if gear.is_on(run.card, axis.number) else "OFF")


@command("GEAR ON", levels=BY_OBJECT, grammar=(Axes(),))
def gear_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Let axes follow their sources."""
    for axis in axes:
        gear.permit(run.card, axis.number)
    for axis in axes:
        gear.on(run.card, axis.number)


@command("GEAR OFF", levels=BY_OBJECT, grammar=(Axes(),))
def gear_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Ramp the ratio of gears down to 0."""
    for axis in axes:
        gear.off(run.card, axis.number)


@command("GEAR ON IHPOS", levels=BY_OBJECT, grammar=(AxisList(PassingForm()),))
def gear_on_ihpos(run: Run, axes: tuple[tuple[Axis, Passing], ...]) -> None:
    """Switch gears on when a parameter passes a setpoint."""
    for axis, _ in axes:
        gear.permit(run.card, axis.number)
    for axis, passing in axes:
        gear.disarm_on(run.card, axis.number)
        _arm_passing(run, axis, gear.on_trigger(axis.number), passing, af2.GEAR_ON_POSITION)


@command("GEAR OFF IHPOS", levels=BY_OBJECT, grammar=(AxisList(PassingForm()),))
def gear_off_ihpos(run: Run, axes: tuple[tuple[Axis, Passing], ...]) -> None:
    """Switch gears off when a parameter passes a setpoint."""
    for axis, passing in axes:
        gear.disarm_off(run.card, axis.number)
        _arm_passing(run, axis, gear.off_trigger(axis.number), passing, af2.GEAR_OFF_POSITION)


def _arm_passing(run: Run, axis: Axis, trigger: int, passing: Passing, flag: int) -> None:
    sources.go_live(run.card, axis.number)
    sources.arm_passing(
        run.card,
        trigger,
        passing.parameter,
        passing.setpoint,
        below=passing.below,
        timeout_s=passing.timeout_s,
    )
    run.card.memory.I[af2.word[axis.number]] |= flag


@command("GEAR ON TRG", levels=BY_OBJECT, grammar=(AxisList(CapturedForm()),))
def gear_on_trg(run: Run, axes: tuple[tuple[Axis, Captured], ...]) -> None:
    """Switch gears on at a captured source position plus Gear Trigger On Offset."""
    for axis, _ in axes:
        gear.permit(run.card, axis.number)
    for axis, captured in axes:
        gear.disarm_on(run.card, axis.number)
        _arm_capture(run, axis, gear.on_trigger(axis.number), captured, af2.GEAR_ON_TRIG_ARMED)


@command("GEAR OFF TRG", levels=BY_OBJECT, grammar=(AxisList(CapturedForm()),))
def gear_off_trg(run: Run, axes: tuple[tuple[Axis, Captured], ...]) -> None:
    """Switch gears off at a captured source position plus Gear Trigger Off Offset."""
    for axis, captured in axes:
        gear.disarm_off(run.card, axis.number)
        _arm_capture(run, axis, gear.off_trigger(axis.number), captured, af2.GEAR_OFF_ARMED)


def _arm_capture(run: Run, axis: Axis, trigger: int, captured: Captured, flag: int) -> None:
    sources.go_live(run.card, axis.number)
    sources.arm_capture(run.card, trigger, captured.mode, captured.copy_to, captured.register)
    run.card.memory.I[af2.word[axis.number]] |= flag


@command("GEAR OFFSET", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def gear_offset(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Set the gear offset of axes, which move by the difference, or report it."""
    for item in axes:
        if item.is_query:
            run.print(offset_text(run, item.axis.number, axis_rows.gear_cnt))
        else:
            gear.set_offset(run.card, item.axis.number, item.value)


def offset_text(run: Run, axis: int, part: tuple[int, ...]) -> str:
    """One part of the setpoint of an axis in units."""
    cnt = run.card.memory.F[part[axis]]
    return number_text(cnt / scale_of(run.card, axis), NumberKind.DOUBLE)


@command("GEAR RES", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def gear_res(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make the gear offset of axes a value (0); the coordinated position takes the rest."""
    for item in axes:
        jog.needs_no_moves(run.card, item.axis.number)
    for item in axes:
        gear.reset(run.card, item.axis.number, 0.0 if item.is_query else item.value)


@command("GEAR CLEAR", levels=BY_OBJECT, grammar=(Axes(),))
def gear_clear(run: Run, axes: tuple[Axis, ...]) -> None:
    """Switch gears off and forget their settings; the offset stays."""
    for axis in axes:
        gear.clear(run.card, axis.number)
        choose_sources(run, ((axis, ObjectRef("NONE")),), USE_GEAR)
