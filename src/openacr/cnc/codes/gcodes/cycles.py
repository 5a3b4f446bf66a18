"""G73 to G89: canned cycles, written in the part-program language (CYCLES.TXT).

A cycle block positions the hole and calls label code * 1000 of that file with its levels
in P249 to P270. In the file X and Y are the axes of the plane, Z is the drill axis, and
positions are those after scaling and rotation.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Entry, Plane, Point, Spin, Spindle
from openacr.cnc.codes.active import Drilling
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Axes, Group, Limit, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.program.flow import Frame, Level
from openacr.cnc.reading.formulas import LOCALS
from openacr.sysvar.tabs import CELLS, CONTROL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Motions, Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
CYCLE_WORDS = "RQPFL"
NONE = 80
LABELS = 1000  # label of code 81: N81000
PECKS, SHIFTS, TO_INITIAL = (73, 83), (76, 87), (87,)
TURNS = {74: Spin.COUNTER_CLOCKWISE, 84: Spin.CLOCKWISE}  # tapping starts like this
SHIFT_SIGNS = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))


@gcode(80, step=Step.CYCLE_OFF, group=Group.CYCLE, fast=Does.ENDS_CYCLE)
def no_cycle(run: Run, b: BlockContext) -> None:
    """End of the cycle."""
    run.modal.cycle = NONE
    run.drilling = None


@gcode(
    *(73, 74, 76, *range(81, 90)),
    step=Step.MOTION,
    group=Group.CYCLE,
    takes="RQPL",
    axes=Axes.MOVE,
    limits=(Limit("L", 0, 9999, "E250", is_whole=True), Limit("P", 0, 999.9, "E250")),
    fast=Does.DRILLS,
)
def cycle(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Drill, tap or bore at X Y from level R to Z; the cycle stays active until G80."""
    run.offset_path.refuse(b, "E312")
    if not (run.program.has_cycles or run.dialect.has_own_cycles):
        raise b.fault("E251", hint="$I CYCLES.TXT after M2")
    is_first = run.modal.cycle == NONE or run.drilling is None
    if run.drilling is None or is_first:
        run.drilling = Drilling()
    if is_first or not run.dialect.rises_first:
        run.drilling.initial = run.path.program[run.modal.plane_axes.drill]
    run.modal.cycle = int(b.number)
    yield from drill(run, b)


def drill(run: Run, b: BlockContext) -> Iterator[Entry]:
    """The holes of one block."""
    run.offset_path.refuse(b, "E312")
    drilling = run.drilling
    if drilling is None:
        raise b.fault("E250")
    plane, code = run.modal.plane_axes, run.modal.cycle
    turn = run.path.coordinates.turn
    if turn is not None and turn.plane is not plane:
        raise b.fault("E244", detail="the plane is turned out of itself")
    _take(run, b, drilling, plane)
    _check(b, drilling, code)
    r, bottom = drilling.levels
    if bottom > r:
        run.warn(b, "W214", "Z")
    _check_return(run, b, drilling, r)
    if run.dialect.rises_first and run.path.program[plane.drill] < r:
        up = list(run.path.program)
        up[plane.drill] = r
        run.path.rapid(b, tuple(up))
    repeat_cnt = b.whole("L", 1, "E250")
    for left in range(repeat_cnt, 0, -1):
        run.path.rapid(b, _hole(run, b, plane))
        yield from _one(run, b, drilling, left)
        if run.is_ended:
            return
    b.has_moved = False  # cycles do not call modal macros


def _take(run: Run, b: BlockContext, drilling: Drilling, plane: Plane) -> None:
    """The words of the block, kept for the blocks after it."""
    is_incremental = run.modal.distance == 91
    for axis, _, value in b.axes:
        if axis == plane.drill:
            drilling.bottom = run.path.length(value), is_incremental
    if "R" in b.words:
        drilling.level = run.path.length(b.words["R"]), is_incremental
    for letter in "QP":
        if letter in b.words:
            drilling.words[letter] = b.words[letter]


def _check(b: BlockContext, drilling: Drilling, code: int) -> None:
    if drilling.bottom is None or drilling.level is None:
        raise b.fault("E250", detail="Z" if drilling.bottom is None else "R")
    if code in PECKS and drilling.words.get("Q", 0.0) <= 0.0:
        raise b.fault("E250", "Q", "Q above 0")
    if code in SHIFTS and "Q" not in drilling.words:
        raise b.fault("E252")


def _check_return(run: Run, b: BlockContext, drilling: Drilling, r: float) -> None:
    """Doubt a G98 that ends below R: the path to the next hole is deeper than R."""
    if run.dialect.rises_first or run.modal.return_level != 98 or drilling.initial >= r:
        return
    levels = f"{run.path.shown(drilling.initial):.5g} of R {run.path.shown(r):.5g}"
    run.warn(b, "W219", detail=levels, hint="the cycle began below R")


def _hole(run: Run, b: BlockContext, plane: Plane) -> Point:
    """The plane position of the next hole, at the present level."""
    end = list(run.path.end(b))
    end[plane.drill] = run.path.program[plane.drill]
    return tuple(end)


def _one(run: Run, b: BlockContext, drilling: Drilling, left: int) -> Iterator[Entry]:
    """One hole: cells filled, spindle as it has to be, the text of the cycle called."""
    modal = run.modal
    wanted = TURNS.get(modal.cycle)
    if wanted is not None and modal.spin is not wanted and not run.options.is_dry:
        run.warn(b, "W215")
        modal.spin = wanted
        run.tell(Spindle(b.source, wanted, modal.speed))
    with run.cells.transaction(is_durable=False):
        for n, value in enumerate(_cells(run, drilling, left), CELLS.cycle_code):
            run.cells.write(n, value)
    kept = modal.cycle, modal.motion, modal.distance, modal.path, run.motions
    start = run.flow.find(label_of(run, kept[0]), run.program.cycles, b.plan.column(""))
    modal.cycle, modal.distance, run.motions = NONE, 90, IN_CYCLE
    yield from run.execution.call(Frame(Level.CYCLE, caller=b.source), start, [0.0] * (LOCALS + 1))
    run.motions = kept[4]
    if not run.is_ended:
        modal.cycle, modal.motion, modal.distance, modal.path, _ = kept
        run.path.change_pace()
        if run.options.has_block_ends and left > 1:
            run.end_block(b.source)


def label_of(run: Run, code: int) -> int:
    """The label of a cycle in the text of cycles."""
    return code * LABELS + run.dialect.cycle_labels.get(code, 0)


def _cells(run: Run, drilling: Drilling, left: int) -> list[float]:
    """P249 to P270, in active units."""
    modal, path = run.modal, run.path
    plane, code = modal.plane_axes, modal.cycle
    r, bottom = drilling.levels
    i = max(drilling.initial, r) if run.dialect.rises_first else drilling.initial
    first, second = path.placed[plane.first], path.placed[plane.second]
    is_to_r = modal.return_level == 99 and code not in TO_INITIAL
    placed = [_level(run, plane, z) for z in (bottom, r, i, r if is_to_r else i)]
    q = drilling.words.get("Q", 0.0)
    signs = shift_signs(run)
    return [
        float(code),
        *[path.shown(x) for x in (first, second, *placed)],
        q,
        drilling.words.get("P", 0.0),
        path.shown(modal.feed),
        float(left),
        *[path.shown(x) for x in clearances(run)],
        signs[0] * q,
        signs[1] * q,
        float(modal.spin.value),
        float(modal.return_level),
        float(modal.plane),
        float(modal.distance),
        0.0,
        0.0,
        1.0 if r >= bottom else -1.0,
    ]


def shift_signs(run: Run) -> tuple[float, float]:
    """Where the shift of fine boring goes along the first and second axis."""
    return SHIFT_SIGNS[int(run.cells.read(CONTROL.fine_bore_shift_direction))]


def clearances(run: Run) -> tuple[float, float]:
    """Retract of G73 and clearance of G83."""
    inch = run.dialect.clearance_inch
    if inch is not None:
        return run.path.inches(inch), run.path.inches(inch)
    return run.cells.read(CONTROL.g73_retract), run.cells.read(CONTROL.g83_clearance)


def _level(run: Run, plane: Plane, z: float) -> float:
    """A level after scaling and rotation."""
    point = list(run.path.program)
    point[plane.drill] = z
    return run.path.coordinates.forward(tuple(point))[plane.drill]


# --- moves of the cycle file ---------------------------------------------------------------


def _end(run: Run, b: BlockContext) -> Point:
    """X, Y, Z as the axes of the plane and the drill axis, after scaling and rotation."""
    plane, placed = run.modal.plane_axes, list(run.path.placed)
    axes = {"X": plane.first, "Y": plane.second, "Z": plane.drill}
    for _, letter, value in b.axes:
        if letter not in axes:
            raise b.fault("E206", letter, letter)
        placed[axes[letter]] = run.path.length(value)
    return tuple(placed)


def rapid_in_cycle(run: Run, b: BlockContext) -> None:
    """G0 in the cycle file."""
    run.path.place(b, _end(run, b), None)


def line_in_cycle(run: Run, b: BlockContext) -> None:
    """G1 in the cycle file."""
    run.path.place(b, _end(run, b), run.path.pace(b))


def no_arc_in_cycle(run: Run, b: BlockContext) -> None:
    """Cycles are straight."""
    raise b.fault("E206")


IN_CYCLE: Motions = {
    0: rapid_in_cycle,
    1: line_in_cycle,
    2: no_arc_in_cycle,
    3: no_arc_in_cycle,
}
