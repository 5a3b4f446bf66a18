"""Flags and waiting: SET, CLR, MASK, DWL, INH, IHPOS."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from openacr.basic.language import registry
from openacr.basic.language.grammar import Bit, BitItem, Bits, Group, Num, ParameterName
from openacr.basic.language.nodes import Flag, Statement
from openacr.basic.language.registry import ANY
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.run import Run

if TYPE_CHECKING:
    from openacr.basic.vm.compiler import Emitter

GROUP = "Logic Function"
REF = "PG Logic Function"
command = partial(registry.command, group=GROUP, ref=REF)


def emit_bits(value: float) -> Any:
    """The code of SET and CLR: store `value` in each flag."""

    def emit(e: Emitter, statement: Statement) -> None:
        (items,) = statement.arguments
        for item in items:  # type: ignore[attr-defined]
            e.store(Flag(item.number), lambda: e.push(value))

    return emit


def emit_dwell(e: Emitter, statement: Statement) -> None:
    """The code of DWL."""
    (seconds,) = statement.arguments
    e.expression(seconds)  # type: ignore[arg-type]
    e.op(vm.DO_DWELL)
    e.drop(1)


def emit_inhibit(e: Emitter, statement: Statement) -> None:
    """The code of INH."""
    bit, timeout = statement.arguments
    if not isinstance(bit, BitItem):
        raise TypeError(bit)
    e.expression(bit.number)
    _expression_or_zero(e, timeout, 0)
    e.op(vm.DO_INHIBIT, int(bit.clear))
    e.drop(2)


def emit_inhibit_position(e: Emitter, statement: Statement) -> None:
    """The code of IHPOS."""
    parameter, limits = statement.arguments
    if not isinstance(parameter, tuple):
        raise TypeError(parameter)
    e.expression(parameter[0])
    _expression_or_zero(e, limits, 0)
    _expression_or_zero(e, limits, 1)
    e.op(vm.DO_INHIBIT_POSITION, int(parameter[1]))
    e.drop(3)


def emit_mask(e: Emitter, statement: Statement) -> None:
    """The code of MASK."""
    parameter, masks = statement.arguments
    e.expression(parameter[0])  # type: ignore[index]
    _expression_or_zero(e, masks, 0)
    _expression_or_zero(e, masks, 1)
    e.op(vm.DO_MASK)
    e.drop(3)


def _expression_or_zero(e: Emitter, values: Any, index: int) -> None:
    if values is None or index >= len(values):
        e.push(0)
    else:
        e.expression(values[index])


@command("SET", levels=ANY, grammar=(Bits(),), emit=emit_bits(1.0))
def set_(run: Run, *_: object) -> None:
    """Set one or more flags."""


@command("CLR", levels=ANY, grammar=(Bits(),), emit=emit_bits(0.0))
def clr(run: Run, *_: object) -> None:
    """Clear one or more flags."""


@command("MASK", levels=ANY, grammar=(ParameterName(), Group("nandmask", "ormask")), emit=emit_mask)
def mask(run: Run, *_: object) -> None:
    """Clear the bits of `nandmask` and set those of `ormask` in a LONG parameter, in one step."""


@command("DWL", levels=ANY, grammar=(Num("seconds"),), units="s", emit=emit_dwell)
def dwl(run: Run, *_: object) -> None:
    """Hold this program for some seconds; motion and other programs go on."""


@command(
    "INH",
    levels=ANY,
    grammar=(Bit(signed=True), Group("timeout", optional=True)),
    emit=emit_inhibit,
)
def inh(run: Run, *_: object) -> None:
    """Wait until a flag is set (with a minus: clear) or a timeout in seconds has passed."""


@command(
    "IHPOS",
    levels=ANY,
    grammar=(ParameterName(signed=True), Group("setpoint", "timeout", fewest=1)),
    emit=emit_inhibit_position,
)
def ihpos(run: Run, *_: object) -> None:
    """Wait until a parameter is above (with a minus: below) a setpoint, or a timeout."""
