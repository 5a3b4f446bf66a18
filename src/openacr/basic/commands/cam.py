"""Setpoint control: electronic cams."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from openacr.basic.commands.follower_forms import (
    AxisSources,
    Captured,
    CapturedForm,
    Passing,
    PassingForm,
    Segment,
    SegmentForm,
    choose_sources,
)
from openacr.basic.commands.value_commands import Value, axis_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import (
    Axes,
    Axis,
    AxisList,
    AxisValue,
    AxisValues,
    Num,
    ObjectRef,
)
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import BY_OBJECT
from openacr.basic.vm.run import Run, whole
from openacr.kernel.sources.source_cy import USE_CAM
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import tables
from openacr.map.words import af2
from openacr.motion.axis.settings import fp64, long, not_negative
from openacr.motion.followers import cam, gear
from openacr.motion.jog import jog
from openacr.motion.sources import sources

GROUP = "Setpoint Control"
REF = "PG Setpoint Control"
command = partial(registry.command, group=GROUP, ref=REF)


axis_values(
    (
        Value("CAM SCALE", fp64(tables.scale), "Multiply the output of a cam.", "", "1"),
        Value("CAM OFFSET", fp64(tables.offset_u), "Add to the output of a cam.", "units"),
        Value("CAM FLZ", fp64(tables.flz_cnt), "Shift the index of a cam.", "source pulses"),
        Value("CAM CYCLES", long(axis_rows.cam_cycles, not_negative),
              "Set after how many cycles a cam ends; 0 is never."),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


def permit_all(run: Run, axes: tuple[Axis, ...], table: Callable[[int], int]) -> None:
    """Refuse a statement if one of its axes may not move or has no table."""
    for axis in axes:
        gear.permit(run.card, axis.number)
        cam.needs_segments(run.card, table(axis.number))


def _own(axis: int) -> int:
    return axis


@command("CAM", levels=BY_OBJECT, grammar=(Axes(),))
def cam_report(run: Run, axes: tuple[Axis, ...]) -> None:
    """Report whether cams are on."""
    for axis in axes:
        run.print("ON" if cam.is_on(run.card, axis.number) else "OFF")


@command("CAM CLEAR", levels=BY_OBJECT, grammar=(Axes(),))
def cam_clear(run: Run, axes: tuple[Axis, ...]) -> None:
    """Switch cams off and forget their segments and settings."""
    for axis in axes:
        cam.off(run.card, axis.number)
        cam.clear(run.card.memory, axis.number)
        choose_sources(run, ((axis, ObjectRef("CLK")),), USE_CAM)


@command("CAM DIM", levels=BY_OBJECT, grammar=(AxisValues(),))
def cam_dim(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Set how many segments the cam of an axis has, or report it."""
    dimension(run, axes, _own)


def dimension(run: Run, axes: tuple[AxisValue, ...], table: Callable[[int], int]) -> None:
    """DIM of a table."""
    for item in axes:
        number = table(item.axis.number)
        if item.is_query:
            run.print(str(cam.segments(run.card.memory, number)))
        else:
            cam.dimension(run.card.memory, number, whole(item.value))


@command("CAM SEG", levels=BY_OBJECT, grammar=(AxisList(SegmentForm()),))
def cam_seg(run: Run, axes: tuple[tuple[Axis, Segment], ...]) -> None:
    """Give a segment of a cam its length in source pulses and its array of points."""
    set_segments(run, axes, _own)


def set_segments(
    run: Run, axes: tuple[tuple[Axis, Segment], ...], table: Callable[[int], int]
) -> None:
    """SEG of a table; the array is that of the program."""
    program = run.needed_program()
    for axis, segment in axes:
        number = table(axis.number)
        cam.set_segment(
            run.card, number, segment.number, segment.length_cnt, program, segment.array
        )


@command("CAM SRC", levels=BY_OBJECT, grammar=(AxisSources(),), default="CLK", saved=True)
def cam_src(run: Run, axes: tuple[tuple[Axis, ObjectRef | None], ...]) -> None:
    """Choose what drives the index of a cam."""
    choose_sources(run, axes, USE_CAM)


@command("CAM ON", levels=BY_OBJECT, grammar=(Axes(),))
def cam_on(run: Run, axes: tuple[Axis, ...]) -> None:
    """Start cams at index 0."""
    permit_all(run, axes, _own)
    for axis in axes:
        cam.on(run.card, axis.number)


@command("CAM ON IHPOS", levels=BY_OBJECT, grammar=(AxisList(PassingForm()),))
def cam_on_ihpos(run: Run, axes: tuple[tuple[Axis, Passing], ...]) -> None:
    """Start cams when a parameter passes a setpoint."""
    permit_all(run, tuple(axis for axis, _ in axes), _own)
    for axis, passing in axes:
        _arm(run, axis)
        sources.arm_passing(
            run.card,
            cam.trigger(axis.number),
            passing.parameter,
            passing.setpoint,
            below=passing.below,
            timeout_s=passing.timeout_s,
        )


@command("CAM ON TRG", levels=BY_OBJECT, grammar=(AxisList(CapturedForm()),))
def cam_on_trg(run: Run, axes: tuple[tuple[Axis, Captured], ...]) -> None:
    """Start cams at a captured source position."""
    permit_all(run, tuple(axis for axis, _ in axes), _own)
    for axis, captured in axes:
        _arm(run, axis)
        trigger = cam.trigger(axis.number)
        sources.arm_capture(run.card, trigger, captured.mode, captured.copy_to, captured.register)


def _arm(run: Run, axis: Axis) -> None:
    cam.off(run.card, axis.number)
    sources.go_live(run.card, axis.number)
    run.card.memory.I[af2.word[axis.number]] |= af2.CAM_TRIGGER_MODE


@command("CAM OFF", levels=BY_OBJECT, grammar=(Axes(),))
def cam_off(run: Run, axes: tuple[Axis, ...]) -> None:
    """Stop cams at once; their offset stays."""
    for axis in axes:
        cam.off(run.card, axis.number)


@command("CAM PON", levels=BY_OBJECT, grammar=(AxisList(Num("position")),), units="source pulses")
def cam_pon(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Start cams when their source passes a position within the cycle."""
    permit_all(run, tuple(item.axis for item in axes), _own)
    for item in axes:
        cam.off(run.card, item.axis.number)
        cam.engage_at(run.card, item.axis.number, item.value)


@command("CAM POFF", levels=BY_OBJECT, grammar=(AxisList(Num("position")),), units="source pulses")
def cam_poff(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Stop cams when their index passes a position within the cycle."""
    for item in axes:
        cam.disengage_at(run.card, item.axis.number, item.value)


@command("CAM SHIFT", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def cam_shift(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Preload the shift an incremental cam has built up, or report it."""
    set_shifts(run, axes, _own)


def set_shifts(run: Run, axes: tuple[AxisValue, ...], table: Callable[[int], int]) -> None:
    """SHIFT of a table."""
    for item in axes:
        axis = item.axis.number
        if item.is_query:
            run.print(number_text(cam.shift(run.card, axis, table(axis)), NumberKind.DOUBLE))
        else:
            cam.set_shift(run.card, axis, table(axis), item.value)


@command("CAM RES", levels=BY_OBJECT, grammar=(AxisValues(),), units="units")
def cam_res(run: Run, axes: tuple[AxisValue, ...]) -> None:
    """Make the cam offset of axes a value (0); the coordinated position takes the rest."""
    for item in axes:
        jog.needs_no_moves(run.card, item.axis.number)
    for item in axes:
        cam.reset(run.card, item.axis.number, 0.0 if item.is_query else item.value)
