"""G codes the rs274ngc dialect has for itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXES, TOOL_AXIS, Dwell, Entry
from openacr.cnc.codes import gcodes as _acromill  # noqa: F401  fills the other table
from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.codes.gcodes import cycles, motion
from openacr.cnc.codes.gcodes.offsets import taught
from openacr.cnc.codes.gcodes.probe import TRIPPED, probed
from openacr.cnc.codes.gcodes.work import (
    FLOATING_BEFORE,
    SYSTEMS,
    clear_zero,
    length_of,
    select,
    show_zero,
)
from openacr.cnc.codes.ngc.splines import no_open_curve
from openacr.cnc.codes.table import Axes, Group, Limit, Step
from openacr.cnc.codes.tables import ACROMILL, RS274NGC
from openacr.cnc.codes.words import select_length, select_radius
from openacr.cnc.geometry.coordinates import ORIGIN, TURN, system_base
from openacr.cnc.state.cells import (
    COMMON,
    FLOATING,
    LAST_RADIUS,
    LENGTH_WEARS,
    LENGTHS,
    RADII,
    RADIUS,
    RADIUS_WEAR,
)
from openacr.cnc.state.modal import INCH, INVERSE_TIME, METRIC
from openacr.sysvar.tabs import CELLS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode, sets = RS274NGC.gcode, RS274NGC.sets
INCREMENTAL = 91
TABLE, FIXTURE = 1, 11  # L of G10: as given; read in G59.3 without G92
LAST_OF_ALL = 9  # work systems
FEED_UNITS = {INCH: "inches/min", METRIC: "mm/min"}
_SECONDS = Limit("P", 0, 1e6, "E222", is_needed=True)
_LENGTH_NUMBER = Limit("H", 0, 999, "E222", is_whole=True)
_ENDS_CYCLE = (Does.ENDS_CYCLE, Sets("motion", motion.NO_MOTION))
REFERENCE_CELLS = {28: CELLS.reference_point_1, 30: CELLS.reference_point_2}
RS274NGC.include(
    ACROMILL,
    gcodes=(17, 18, 19, 40, 90, 91, 92, 98, 99, 0, 1, 2, 3),
    letters="F S T D MOTION CUSTOM",
)


@gcode(4, step=Step.DWELL, takes="P", limits=(_SECONDS,), fast=Does.RESTS)
def dwell(run: Run, b: BlockContext) -> None:
    """Rest for P seconds, then move if there are axis words."""
    run.tell(Dwell(b.source, b.words["P"]))


@gcode(80, step=Step.CYCLE_OFF, group=Group.CYCLE, fast=_ENDS_CYCLE)
def no_motion(run: Run, b: BlockContext) -> None:
    """No motion is active: axis words have no meaning until one is chosen, here or later."""
    run.modal.cycle = cycles.NONE
    run.modal.motion = motion.NO_MOTION
    run.drilling = None


@gcode(
    *(73, 74, *range(81, 87), 89),
    step=Step.MOTION,
    group=Group.MOTION,
    takes="RQPL",
    axes=Axes.MOVE,
    is_polar=True,
    limits=(Limit("L", 1, 9999, "E250", is_whole=True),),
    fast=Does.DRILLS,
)
def cycle(run: Run, b: BlockContext) -> Iterator[Entry]:
    """A canned cycle; it ends at the higher of R and where it began (G98) or at R (G99)."""
    no_open_curve(run, b)
    yield from cycles.cycle(run, b) or ()


@gcode(53, step=Step.MOTION, axes=Axes.MOVE)
def in_machine(run: Run, b: BlockContext) -> None:
    """The straight move of this block is in machine coordinates."""
    no_open_curve(run, b)
    run.offset_path.refuse(b, "E310")
    if run.modal.motion not in (0, 1):
        raise b.fault("E206", hint="G53 goes with G0 or G1")
    if run.modal.distance == INCREMENTAL:
        raise b.fault("E206", hint="machine positions are absolute: G90")
    target = list(run.path.target)
    for axis, letter, value in b.axes:
        target[axis] = length_of(run, letter, value)
    pace = run.path.pace(b) if run.modal.motion == 1 else None
    run.path.go_machine(b, tuple(target), pace)


@gcode(*SYSTEMS, step=Step.WORK, group=Group.WORK, fast=Does.SHIFTS)
def work_system(run: Run, b: BlockContext) -> None:
    """Work system 1 to 9."""
    select(run, SYSTEMS[b.number])


@gcode(28, 30, step=Step.MOTION, axes=Axes.MOVE)
def to_reference(run: Run, b: BlockContext) -> None:
    """Through the words of the block to the stored point."""
    no_open_curve(run, b)
    run.offset_path.refuse(b, "E312")
    point = [run.cells.read(REFERENCE_CELLS[int(b.number)][axis]) for axis in range(AXES)]
    if b.plan.axes:
        run.path.rapid(b, run.path.end(b))
    target = list(run.path.target)
    for axis in [axis for axis, _ in b.plan.axes] or range(AXES):
        target[axis] = point[axis]
    run.path.go_machine(b, tuple(target))


@gcode(28.1, 30.1, step=Step.DATA)
def store_reference(run: Run, b: BlockContext) -> None:
    """The present position becomes the stored point."""
    with run.cells.transaction():
        for axis, value in enumerate(run.path.target):
            run.cells.write(REFERENCE_CELLS[int(b.number)][axis], value)


PROBES = (38.2, 38.3, 38.4, 38.5)


@gcode(*PROBES, step=Step.MOTION, group=Group.MOTION, axes=Axes.MOVE, is_polar=True)
def probe(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Probe toward (.2 .3) or away (.4 .5); .2 and .4 have to trip."""
    no_open_curve(run, b)
    run.modal.motion = b.number
    run.modal.cycle = motion.NO_CYCLE
    yield from probe_again(run, b)


def probe_again(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Probe as the G38 that is active does."""
    motion.check_words(run, b, "")
    run.offset_path.refuse(b, "E243")
    if not (b.plan.axes or b.plan.is_polar):
        raise b.fault("E206", hint="axis words are needed")
    yield from run.sync(b.source)
    code = run.modal.motion
    yield from probed(run, b, is_away=code > 38.35)
    is_needed = code in (38.2, 38.4)
    if is_needed and not run.cells.read(TRIPPED) and not run.options.collects_errors:
        raise b.fault("A36")


motion.MOTIONS.update(dict.fromkeys(PROBES, probe_again))


@gcode(41, 42, step=Step.COMPENSATION, group=Group.COMPENSATION)
def compensation(run: Run, b: BlockContext) -> None:
    """Cutter radius compensation left or right, with the radius of D or of the tool."""
    tool = run.modal.tool_in_spindle
    if "D" not in b.words and tool:
        select_radius(run, tool)
    run.offset_path.switch(b, int(b.number))


@gcode(
    *(41.1, 42.1),
    step=Step.COMPENSATION,
    group=Group.COMPENSATION,
    takes="D",
    limits=(Limit("D", 0, 1e6, "E222", is_needed=True),),
)
def compensation_by_diameter(run: Run, b: BlockContext) -> None:
    """Cutter radius compensation left or right; D is the diameter itself."""
    run.modal.radius_number = 0
    run.parameters.store(RADIUS, run.path.length(b.words["D"]) / 2.0)
    run.parameters.store(RADIUS_WEAR, 0.0)
    run.offset_path.switch(b, int(b.number))


@gcode(
    43,
    step=Step.LENGTH,
    group=Group.LENGTH,
    takes="H",
    limits=(_LENGTH_NUMBER,),
    fast=Does.SHIFTS,
)
def length(run: Run, b: BlockContext) -> None:
    """The length of H, or of the tool, is added to Z."""
    run.path.coordinates.added = ORIGIN
    run.modal.length = 43
    select_length(run, b.whole("H", run.modal.tool_in_spindle))
    run.path.refresh()


@gcode(43.1, step=Step.LENGTH, group=Group.LENGTH, axes=Axes.DATA)
def length_of_words(run: Run, b: BlockContext) -> None:
    """The axis words are the offset of their axes; that of the others stays."""
    added = list(run.path.coordinates.offsets(run.modal))
    if not b.plan.axes:
        raise b.fault("E206", hint="the offset is given by axis words")
    for axis, letter, value in b.axes:
        added[axis] = length_of(run, letter, value)
    run.modal.length = 49
    run.path.coordinates.added = tuple(added)
    run.path.refresh()


@gcode(
    43.2,
    step=Step.LENGTH,
    group=Group.LENGTH,
    takes="H",
    axes=Axes.DATA,
    limits=(_LENGTH_NUMBER,),
)
def more_length(run: Run, b: BlockContext) -> None:
    """The length of H, or the axis words, are added to the offset there is."""
    if ("H" in b.words) == bool(b.plan.axes):
        raise b.fault("E222", "H", hint="H or axis words, not both")
    more = {axis: length_of(run, letter, value) for axis, letter, value in b.axes}
    if "H" in b.words:
        more[run.planner.axes.get("Z", TOOL_AXIS)] = run.cells.read(LENGTHS + b.whole("H"))
    added = enumerate(run.path.coordinates.added)
    run.path.coordinates.added = tuple(value + more.get(axis, 0.0) for axis, value in added)
    run.path.refresh()


@gcode(49, step=Step.LENGTH, group=Group.LENGTH, fast=Does.SHIFTS)
def no_length(run: Run, b: BlockContext) -> None:
    """No tool length."""
    run.modal.length = 49
    run.path.coordinates.added = ORIGIN
    select_length(run, 0)
    run.path.refresh()


@gcode(61, step=Step.PATH, group=Group.PATH)
def exact_path(run: Run, b: BlockContext) -> None:
    """Every move ends at rest."""
    _path(run, 60)


@gcode(61.1, step=Step.PATH, group=Group.PATH)
def exact_stop(run: Run, b: BlockContext) -> None:
    """Every move ends at rest and in position."""
    _path(run, 61)


@gcode(64, step=Step.PATH, group=Group.PATH, takes="PQ", limits=(Limit("P", 0, 1e6, "E222"),))
def blended(run: Run, b: BlockContext) -> None:
    """No slowing at corners; with P they are rounded within it, where the machine can."""
    _path(run, 64, run.path.length(b.get("P")))


@gcode(20, step=Step.UNIT, group=Group.UNIT, fast=Sets("unit", INCH, is_alone=True))
def inch(run: Run, b: BlockContext) -> None:
    """Words are inches, feeds of later blocks inches per minute."""
    _unit(run, b, INCH)


@gcode(21, step=Step.UNIT, group=Group.UNIT, fast=Sets("unit", METRIC, is_alone=True))
def metric(run: Run, b: BlockContext) -> None:
    """Words are millimetres, feeds of later blocks millimetres per minute."""
    _unit(run, b, METRIC)


def _unit(run: Run, b: BlockContext, unit: int) -> None:
    modal, before = run.modal, run.modal.unit
    modal.unit = unit
    run.path.set_unit()
    if unit != before and "F" in b.words and modal.feed_mode != INVERSE_TIME:
        is_now = f"{run.path.shown(modal.feed):.6g} {FEED_UNITS[unit]}"
        read = f"F{b.words['F']:g} is read in {FEED_UNITS[before]}, as before G{unit}: {is_now}"
        run.warn(b, "W221", "F", read, "give F in a block of its own")


def _path(run: Run, mode: int, tolerance_u: float = 0.0) -> None:
    run.modal.path = mode
    run.modal.tolerance = tolerance_u
    run.path.change_pace()


sets(
    "I, J, K are absolute (G90.1) or count from the start (G91.1).",
    *(90.1, 91.1),
    forms={90.1: Sets("centres", 2), 91.1: Sets("centres", 1)},
)


@gcode(93, 94, step=Step.FEED_MODE, group=Group.FEED_MODE, fast={94: Does.NOTHING})
def feed_mode(run: Run, b: BlockContext) -> None:
    """F is moves per minute (G93) or units per minute (G94)."""
    run.modal.feed_mode = int(b.number)
    run.path.change_pace()


@gcode(97, step=Step.SPEED, fast=Does.NOTHING)
def turns_per_minute(run: Run, b: BlockContext) -> None:
    """S is turns per minute, as it always is."""


@gcode(52, step=Step.ZERO, axes=Axes.DATA)
def local_shift(run: Run, b: BlockContext) -> None:
    """Shift the zero by the axis words; the offset of G92 is replaced, as both are one."""
    if not b.plan.axes:
        raise b.fault("E206", hint="G52 X0 Y0 Z0 ends the shift")
    with run.cells.transaction(is_durable=False):
        for axis, letter, value in b.axes:
            run.cells.write(FLOATING_BEFORE + axis, run.cells.read(FLOATING + axis))
            run.cells.write(FLOATING + axis, length_of(run, letter, value))
        show_zero(run)


@gcode(92.1, 92.2, 92.3, step=Step.ZERO)
def zero_offset(run: Run, b: BlockContext) -> None:
    """The offset of G92 cleared (.1), set aside (.2), taken again (.3)."""
    read, write = run.cells.read, run.cells.write
    with run.cells.transaction(is_durable=False):
        for axis in range(AXES):
            if b.number == 92.2:
                write(FLOATING_BEFORE + axis, read(FLOATING + axis))
            elif b.number == 92.1:
                write(FLOATING_BEFORE + axis, 0.0)
            else:
                write(FLOATING + axis, read(FLOATING_BEFORE + axis))
        if b.number == 92.3:
            show_zero(run)
        else:
            clear_zero(run)


@gcode(10, step=Step.DATA, takes="LPR", axes=Axes.DATA)
def offsets(run: Run, b: BlockContext) -> Iterator[Entry]:
    """L2 (R turns it about Z) and L20 write work systems, L1, L10 and L11 the tool table."""
    table = b.whole("L", code="E241")
    last = {2: 9, 20: 9, 1: LAST_RADIUS, 10: LAST_RADIUS, 11: LAST_RADIUS}.get(table)
    if last is None or "P" not in b.words:
        raise b.fault("E241", "L", hint="L 1, 2, 10, 11 or 20 with P")
    n = b.whole("P", code="E241")
    if not (0 if last == 9 else 1) <= n <= last:
        raise b.fault("E241", "P")
    if table == 20 and "R" in b.words:
        raise b.fault("E241", "R", "R", "R turns a work system with L2")
    yield from run.sync(b.source)
    with run.cells.transaction():
        if last == 9:
            _write_system(run, b, n or run.modal.work, is_taught=table == 20)
        else:
            _write_tool(run, b, n, table)
    run.reload_offsets()


def _write_system(run: Run, b: BlockContext, n: int, *, is_taught: bool) -> None:
    values = [(axis, letter, length_of(run, letter, value)) for axis, letter, value in b.axes]
    if is_taught:
        for cell, value in taught(run, n, values):
            run.cells.write(cell, value)
        return
    for axis, _, value in values:
        run.cells.write(system_base(n) + axis, value)
    if "R" in b.words:
        run.cells.write(system_base(n) + TURN, b.words["R"])


def _write_tool(run: Run, b: BlockContext, n: int, table: int) -> None:
    for axis, letter, value in b.axes:
        value = length_of(run, letter, value)
        if letter != "Z":
            raise b.fault("E241", letter, hint="Z is the length, R the radius")
        if table != TABLE:
            value = _measured(run, axis, table) - run.cells.read(LENGTH_WEARS + n) - value
        run.cells.write(LENGTHS + n, value)
    if "R" in b.words:
        run.cells.write(RADII + n, run.path.length(b.words["R"]))


def _measured(run: Run, axis: int, table: int) -> float:
    """Where an axis is without any tool length: in the system in use, or in G59.3 alone (L11)."""
    read, path = run.cells.read, run.path
    if table == FIXTURE:
        return path.target[axis] - read(COMMON + axis) - read(system_base(LAST_OF_ALL) + axis)
    return path.placed[axis] + path.coordinates.offsets(run.modal)[axis]
