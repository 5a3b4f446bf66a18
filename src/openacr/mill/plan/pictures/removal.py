"""Stock removal of a part program: blank and cutters of the store, and what is left."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import axes_of
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.state.cells import CMP_RAD, RADIUS, RADIUS_WEAR
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.errors import UserError
from openacr.mill.config.tools import Tip, radius_u
from openacr.mill.plan.pictures.blank import blank_of, heights_of_zero
from openacr.mill.plan.pictures.stock import Array, Bytes, Cutter, Mark, Stock, Sweep
from openacr.mill.plan.pictures.tool_path import Drawing, Kind, ToolPath
from openacr.sysvar import Store
from openacr.sysvar.tabs import CONTROL, SPEEDS, TOOL

LETTERS = "XYZ"
CELLS = 500  # across the longer side of the blank: the most memory is some megabytes
Report = Callable[[float], None]


@dataclass(frozen=True, slots=True)
class Section:
    """Moves with one cutter: from the move `first` on."""

    first: int
    tool: int
    cutter: Cutter
    length: float  # of the tool, in the heights of the machine


@dataclass(frozen=True, slots=True)
class Removal:
    """What a program leaves of its blank; heights are those of the tips of the tools."""

    stock: Stock
    rapid_lines: tuple[int, ...]  # whose rapids touch material
    below_lines: tuple[int, ...]  # whose cuts go below the blank
    is_metric: bool


def removal(
    program: Program, cells: Store, dialect: str, report: Report = lambda _share: None
) -> Removal:
    """Cut a blank as a program does; `report` gets the share that is done.

    UserError for a program with errors, without cutting moves, or with a tool of unknown radius.
    """
    if program.errors:
        raise UserError(f"the program has errors: {program.errors[0]}")
    drawing, sections = _read(program, cells, dialect)
    parts = _parts(drawing, sections)
    zero, _ = heights_of_zero(program, cells, dialect)
    blank = blank_of(cells, *_cut_box(parts), zero)
    width, depth = (blank.high[k] - blank.low[k] for k in (0, 1))
    stock = Stock(blank, max(width, depth) / CELLS, cells.read(SPEEDS.chord_tolerance))
    marks = np.zeros(len(drawing.kinds), np.uint8)
    done = 0

    def note(count: int) -> None:
        nonlocal done
        done += count
        report(done / len(marks))

    for part in parts:
        marks[part.moves] = stock.remove(part.cutter, part.places, part.sweeps, note)
    return Removal(
        stock,
        _lines(drawing, marks, Mark.RAPID),
        _lines(drawing, marks, Mark.BELOW),
        bool(cells.read(CONTROL.default_units)),
    )


def _lines(drawing: Drawing, marks: Bytes, mark: Mark) -> tuple[int, ...]:
    return tuple(np.unique(drawing.lines[(marks & mark) != 0]).tolist())


# --- reading --------------------------------------------------------------------------


def _read(program: Program, cells: Store, dialect: str) -> tuple[Drawing, list[Section]]:
    """The path and its sections."""
    letters = axes_of(cells)
    if any(letter not in letters for letter in LETTERS):
        raise UserError("stock removal needs the axes X, Y and Z")
    path = ToolPath(
        tuple(letters[letter] for letter in LETTERS), cells.read(SPEEDS.chord_tolerance)
    )
    options = Options(collects_errors=True, has_batches=True, is_followed=True)
    run = Interpreter(program, Shadow(cells), VirtualMachine(is_probed=True), dialect, options)
    sections: list[Section] = []
    with suppress(BlockError):  # what comes before an error is shown
        for entry in run.entries():
            before = path.move_cnt
            path.add(entry)
            if path.move_cnt > before:
                section = _section(run, cells, before, letters["Z"])
                if not sections or _differs(sections[-1], section):
                    sections.append(section)
    return path.finished(), sections


def _differs(one: Section, other: Section) -> bool:
    return (one.cutter, one.length, one.tool) != (other.cutter, other.length, other.tool)


def _section(run: Interpreter, cells: Store, first: int, z: int) -> Section:
    """The cutter and its length as they are in force now."""
    tool, read = run.modal.tool_in_spindle, run.cells.read
    if run.modal.radius_number:
        radius = read(RADIUS) + read(RADIUS_WEAR)
    elif read(CMP_RAD) > 0.0:
        radius = read(CMP_RAD)
    else:
        radius = radius_u(read, tool)
    tip = Tip(int(cells.read(TOOL.tip[tool])))
    length = run.path.coordinates.offsets(run.modal)[z]
    return Section(first, tool, Cutter(radius, tip), length)


# --- moves of a section ---------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Part:
    """Moves of a section as arrays: places of the tip."""

    cutter: Cutter
    places: Array
    sweeps: Bytes
    moves: slice


def _parts(drawing: Drawing, sections: list[Section]) -> list[_Part]:
    sweeps = _sweeps(drawing)
    ends = [each.first for each in sections[1:]] + [len(sweeps)]
    found = []
    for section, end in zip(sections, ends, strict=True):
        moves = slice(section.first, end)
        if (sweeps[moves] == Sweep.CUTS).any() and section.cutter.radius <= 0.0:
            raise UserError(_unknown(section.tool))
        places = drawing.points[section.first : end + 1] - [0.0, 0.0, section.length]
        found.append(_Part(section.cutter, places, sweeps[moves], moves))
    return found


def _unknown(tool: int) -> str:
    if tool:
        return f"the radius of T{tool} is not known: D{tool} of the offsets is 0"
    return "the radius of the tool is not known: no D is in force, and CMP RAD is 0"


def _sweeps(drawing: Drawing) -> Bytes:
    """What each move does: a rapid counts from where the program has placed all axes."""
    points = drawing.points
    has_moved = np.maximum.accumulate(points != points[0], axis=0)
    is_placed = np.all(has_moved, axis=1)[:-1]
    crosses = np.where(is_placed, Sweep.CROSSES, Sweep.PASSES)
    return np.where(drawing.kinds == Kind.RAPID, crosses, Sweep.CUTS).astype(np.uint8)


def _cut_box(parts: list[_Part]) -> tuple[list[float], list[float]]:
    """The lowest and highest places that cutters reach at feed."""
    low, high = [np.inf] * 3, [-np.inf] * 3
    for part in parts:
        cuts = np.flatnonzero(part.sweeps == Sweep.CUTS)
        if not len(cuts):
            continue
        seen = np.vstack([part.places[cuts], part.places[cuts + 1]])
        reach = np.array([part.cutter.radius, part.cutter.radius, 0.0])
        low = np.minimum(low, seen.min(axis=0) - reach).tolist()
        high = np.maximum(high, seen.max(axis=0) + reach).tolist()
    if low[0] > high[0]:
        raise UserError("the program cuts nothing")
    return low, high
