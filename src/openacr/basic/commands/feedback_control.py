"""Feedback control: scale, registers, capture and rotary form of an axis."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct

from openacr.basic.commands.follower_forms import LAST_CAPTURE_MODE, needs_long
from openacr.basic.commands.interpolation import room
from openacr.basic.commands.value_commands import Value, axis_values, report_all, value_elsewhere
from openacr.basic.language import registry
from openacr.basic.language.grammar import (
    Axes,
    Axis,
    AxisGroups,
    AxisList,
    AxisValue,
    AxisValues,
    Form,
    Int,
    ParameterName,
    Word,
)
from openacr.basic.language.nodes import Expr
from openacr.basic.language.registry import BY_OBJECT, PROG
from openacr.basic.vm.run import Run, Wait, whole
from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.messages import INVALID_ARGUMENT
from openacr.motion import interlocks
from openacr.motion.axis import registers
from openacr.motion.axis.settings import (
    fp32,
    fp64,
    multiplier_of,
    not_negative,
    not_zero,
)
from openacr.motion.path import moves

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Feedback Control"
REF = "PG Feedback Control"
command = partial(registry.command, group=GROUP, ref=REF)

axis_values(
    (
        Value("PPU", fp32(axis_rows.ppu, not_zero), "Set the pulses per unit.", "pulses/unit", "1"),
        Value("ROTARY", fp64(axis_rows.rotary_u, not_negative),
              "Set the length of a turn: absolute moves take the shorter direction; 0 is linear.",
              "units"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


value_elsewhere(
    "MULT",
    multiplier_of,
    "Set edges counted and direction of the position encoder of an axis: 0, 1, 2, 4, -1, ...",
    default="1",
    group=GROUP,
    ref=REF,
)


@command("RES", levels=BY_OBJECT, grammar=(AxisValues(optional=True),))
def res(run: Run, axes: tuple[AxisValue, ...] | None) -> None:
    """Make the present position of axes this one (0), commanded and actual; offsets become 0."""
    given = tuple(AxisValue(axis) for axis in run.axes()) if axes is None else axes
    _need_rest(run, (item.axis for item in given))
    for item in given:
        registers.res(run.card, item.axis.number, 0.0 if item.is_query else item.value)


@command("REN", levels=BY_OBJECT, grammar=(Axes(optional=True),))
def ren(run: Run, axes: tuple[Axis, ...] | None) -> None:
    """Take the actual position of axes as setpoint: the following error becomes 0."""
    given = run.axes() if axes is None else axes
    _need_rest(run, given)
    for axis in given:
        registers.ren(run.card, axis.number)


@command("NORM", levels=BY_OBJECT, grammar=(Axes(),))
def norm(run: Run, axes: tuple[Axis, ...]) -> None:
    """Bring the position of rotary axes into their first turn, without motion."""
    _need_rest(run, axes)
    for axis in axes:
        registers.norm(run.card, axis.number)


def _need_rest(run: Run, axes: Iterable[Axis]) -> None:
    for axis in axes:
        interlocks.needs_rest(run.card, axis.number)


# capture


class Capture(Struct, frozen=True):
    """`mode {Pnnnn}` as written; no mode is OFF."""

    mode: Expr | None = None
    copy: tuple[Expr, bool] | None = None


CaptureGiven: TypeAlias = tuple[int | None, int | None] | None


class CaptureForm(Form):
    """`mode {Pnnnn}` or `OFF`; the handler gets mode (None: off) and the parameter."""

    def __init__(self) -> None:
        super().__init__("mode {Pnnnn}|OFF", optional=True)
        self.mode = Int("mode", 0, LAST_CAPTURE_MODE)
        self.off = Word("OFF")
        self.copy = ParameterName()

    def starts(self, p: Parser) -> bool:
        """Whether a mode or OFF stands here."""
        return self.off.starts(p) or self.mode.starts(p)

    def parse(self, p: Parser) -> Capture:
        """Read mode and parameter, or OFF."""
        if self.off.starts(p):
            self.off.parse(p)
            return Capture()
        mode = self.mode.parse(p)
        return Capture(mode, self.copy.parse(p) if self.copy.starts(p) else None)

    def evaluate(self, run: Run, read: Capture | None) -> CaptureGiven:
        """Mode and number of the parameter."""
        if read is None:
            return None
        copy = self.copy.evaluate(run, read.copy)
        return self.mode.evaluate(run, read.mode), None if copy is None else copy.number


@command(
    "INTCAP", levels=BY_OBJECT, grammar=(AxisList(CaptureForm(), optional=True),), default="OFF"
)
def intcap(run: Run, axes: tuple[tuple[Axis, CaptureGiven], ...] | None) -> None:
    """Arm the position capture of an axis, switch it off, or report its mode."""
    if axes is None:
        report_all(run, lambda axis: _capture_text(run, axis))
        return
    for axis, given in axes:
        if given is None:
            run.print(_capture_text(run, axis))
        elif given[0] is None:
            registers.disarm_capture(run.card, axis.number)
        else:
            if given[1] is not None:
                needs_long(run, given[1])
            registers.arm_capture(run.card, axis.number, given[0], given[1] or 0)


def _capture_text(run: Run, axis: Axis) -> str:
    mode = registers.capture_mode(run.card, axis.number)
    return "OFF" if mode is None else str(mode)


@command("MSEEK", levels=PROG, grammar=(AxisGroups("incmove", "mode"),), units="units")
def mseek(run: Run, axes: tuple[AxisValue, ...]) -> Wait | None:
    """Move by a distance looking for a capture, go back to it and make it position 0."""
    program = run.needed_program()
    master = moves.needed_master(run.card, program)
    for item in axes:
        if not 0 <= item.values[1] <= LAST_CAPTURE_MODE:
            raise CardError(INVALID_ARGUMENT)
    if len(axes) > moves.capacity(run.card, master):
        raise CardError(INVALID_ARGUMENT)
    if not moves.has_room(run.card, master, len(axes)):
        return room(run, master, len(axes))
    for item in axes:
        distance_u, mode = item.values
        moves.seek(run.card, program, item.axis.number, distance_u, whole(mode))
    return None
