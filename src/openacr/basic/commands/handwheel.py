"""Setpoint control: hand wheels, and the time base of jogs."""

from __future__ import annotations

from functools import partial

from openacr.basic.commands.follower_forms import AxisSources, choose_sources
from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Axes, Axis, ObjectRef
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run
from openacr.kernel.sources.source_cy import USE_JOG, USE_WHEEL
from openacr.map.rows import hand_wheels
from openacr.motion.axis.settings import fp64, not_negative, not_zero
from openacr.motion.followers import gear, objects

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)

axis_values(
    (
        Value("HDW PPU", fp64(hand_wheels.ppu, not_zero),
              "Set the source pulses per turn unit of a hand wheel.", "pulses", "1"),
        Value("HDW RATIO", fp64(hand_wheels.ratio),
              "Set the travel of an axis per turn unit of its hand wheel.", "units", "1"),
        Value("HDW VEL", fp64(hand_wheels.vel_ups, not_negative),
              "Set the highest speed of axes moved by a hand wheel; 0 is JOG VEL.", "units/s"),
        Value("HDW ACC", fp64(hand_wheels.acc_ups2, not_negative),
              "Set the ramps of axes moved by a hand wheel; 0 is JOG ACC and JOG DEC.", "units/s2"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


@command("HDW SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="NONE", saved=True)
def hdw_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose the hand wheel of an axis."""
    choose_sources(run, axes, USE_WHEEL)


@command("HDW", levels=BY_OBJECT, grammar=(Axes(),))
def hdw_report(run: Run, axes: tuple[Axis, ...]) -> None:
    """Report whether hand wheels are on."""
    for axis in axes:
        on = run.card.memory.I[hand_wheels.on[axis.number]]
        run.print("ON" if on else "OFF")


@command("HDW ON", levels=BY_OBJECT, grammar=(Axes(),))
def hdw_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Let hand wheels jog axes."""
    for axis in axes:
        gear.permit(run.card, axis.number)
    for axis in axes:
        objects.wheel_on(run.card, axis.number, True)


@command("HDW OFF", levels=BY_OBJECT, grammar=(Axes(),))
def hdw_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Disconnect hand wheels; the distance already turned is still travelled."""
    for axis in axes:
        objects.wheel_on(run.card, axis.number, False)


@command("JOG SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="CLK", saved=True)
def jog_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose the time base of jogs: 1000 source pulses are one second."""
    choose_sources(run, axes, USE_JOG)
