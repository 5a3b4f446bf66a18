"""G10: offsets from the program."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.canonical import Entry
from openacr.cnc.codes.gcodes.work import length_of
from openacr.cnc.codes.table import Axes, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.geometry.coordinates import HOLE, TURN, system_base
from openacr.cnc.state.cells import (
    COMMON,
    FIXTURES,
    LAST_LENGTH,
    LAST_RADIUS,
    LENGTH_WEARS,
    LENGTHS,
    RADII,
    RADIUS_WEARS,
)

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
ROTATED = 2  # L that takes R as a rotation
_TURNED = {0, 1}  # axes a rotation about Z mixes


class Form(Struct, frozen=True):
    """One L of G10: the range of P, and where R goes when it takes no axis words."""

    last: int
    cell: int | None = None


FORMS = {
    2: Form(6),
    20: Form(8),
    10: Form(LAST_LENGTH, LENGTHS),
    11: Form(LAST_LENGTH, LENGTH_WEARS),
    12: Form(LAST_RADIUS, RADII),
    13: Form(LAST_RADIUS, RADIUS_WEARS),
    14: Form(99),
}


@gcode(10, step=Step.DATA, takes="LPR", axes=Axes.DATA)
def offsets(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Write work offsets (L2 with R, L20), lengths (L10, L11), radii (L12, L13), fixtures (L14)."""
    form = FORMS.get(b.whole("L", code="E241"))
    if form is None:
        raise b.fault("E241", "L", "L", "L 2, 10, 11, 12, 13, 14 or 20")
    n = b.whole("P", code="E241")
    if not 1 <= n <= form.last:
        raise b.fault("E241", "P", "P", f"P 1 to {form.last}")
    has_turn = "R" in b.words and b.whole("L") == ROTATED
    if form.cell is None and not (b.plan.axes or has_turn):
        raise b.fault("E241", "L", "axis words missing")
    if form.cell is None and "R" in b.words and not has_turn:
        raise b.fault("E241", "R", "R", "R turns a work system with L2")
    if form.cell is not None and ("R" not in b.words or b.plan.axes):
        raise b.fault("E241", "L", "R missing" if "R" not in b.words else "no axis words")
    yield from run.sync(b.source)
    with run.cells.transaction():
        for cell, value, adds in _written(run, b, n, form):
            run.cells.write(cell, value + run.cells.read(cell) if adds else value)
    run.reload_offsets()


def _written(run: Run, b: BlockContext, n: int, form: Form) -> list[tuple[int, float, bool]]:
    """Cell, value and whether it is added."""
    adds = run.modal.distance == 91
    if form.cell is not None:
        return [(form.cell + n, run.path.length(b.words["R"]), adds)]
    values = [(axis, letter, length_of(run, letter, value)) for axis, letter, value in b.axes]
    which = b.whole("L")
    if which == ROTATED:
        turns = [(system_base(n) + TURN, b.words["R"], adds)] if "R" in b.words else []
        return [(COMMON + HOLE * n + axis, value, adds) for axis, _, value in values] + turns
    if which == 20:
        return [(cell, value, False) for cell, value in taught(run, n, values)]
    return [
        (LENGTHS + n if letter == "Z" else FIXTURES + HOLE * n + axis, value, adds)
        for axis, letter, value in values
    ]


def taught(run: Run, n: int, values: list[tuple[int, str, float]]) -> Iterator[tuple[int, float]]:
    """The cells of work system n with which the present point reads values, and what they get."""
    wanted = {axis: value for axis, _, value in values}
    origin = run.path.coordinates.origin_of(n, run.path.target, wanted, run.modal)
    is_turned = run.cells.read(system_base(n) + TURN) != 0.0
    changed = set(wanted) | (_TURNED if is_turned and _TURNED & set(wanted) else set())
    for axis in sorted(changed):
        yield system_base(n) + axis, origin[axis]
