"""A program read to its end without a machine: what it does and what is wrong with it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from openacr.cnc.canonical import (
    AXES,
    Arc,
    Dwell,
    Entry,
    Line,
    Motion,
    Moves,
    Plane,
    Point,
    Polyline,
    Probe,
    Rapid,
    Tool,
)
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import MOST, BlockError, Finding
from openacr.cnc.state.hosts import Cells, Machine, VirtualMachine
from openacr.cnc.state.modal import METRIC
from openacr.cnc.state.shadow import Shadow

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

LINEAR = "XYZUV"
_QUARTER = math.pi / 2.0


@dataclass(slots=True)
class Survey:
    """Counts, lengths, extents and findings of a program; lengths in default units.

    `unit` is that of the words of its first move, and `per` its length in it of a default unit.

    Extents are where the program brings the axes. Where an axis stands before its first move
    belongs to them only if that move cuts: a rapid comes from anywhere.
    """

    letters: dict[str, int]
    line_cnt: int = 0
    move_cnts: dict[str, int] = field(
        default_factory=lambda: {"rapid": 0, "feed": 0, "arc": 0, "dwell": 0}
    )
    lengths: dict[str, float] = field(default_factory=lambda: {"rapid": 0.0, "feed": 0.0})
    low: list[float] = field(default_factory=lambda: [math.inf] * AXES)
    high: list[float] = field(default_factory=lambda: [-math.inf] * AXES)
    end: Point = (0.0,) * AXES
    tools: list[int] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    unit: str = ""
    per: float = 1.0

    def shown(self, letter: str, value: float) -> float:
        """A place of an axis in the unit of the program, degrees for rotary ones."""
        return value * self.per if letter in LINEAR else value

    def unit_of(self, letter: str) -> str:
        """The unit `shown` gives."""
        return self.unit if letter in LINEAR else "deg"

    @property
    def shown_lengths(self) -> dict[str, float]:
        """The lengths in the unit of the program."""
        return {kind: length * self.per for kind, length in self.lengths.items()}

    @property
    def errors(self) -> list[Finding]:
        """Why the program cannot be run."""
        return [finding for finding in self.findings if finding.is_error]

    @property
    def warnings(self) -> list[Finding]:
        """What is doubtful."""
        return [finding for finding in self.findings if not finding.is_error]

    def add(self, findings: Iterable[Finding]) -> None:
        """Add findings from outside the survey."""
        self.findings += findings
        _sort(self.findings)

    def data(self) -> dict[str, Any]:
        """All of it for JSON, lengths in the unit of the program."""
        letters = self.letters.items()
        has_moved = any(self.low[a] < math.inf for _, a in letters)
        return {
            "lines": self.line_cnt,
            "errors": [_as_data(finding) for finding in self.errors],
            "warnings": [_as_data(finding) for finding in self.warnings],
            "moves": self.move_cnts,
            "unit": self.unit,
            "length": self.shown_lengths,
            "extents": {
                "min": [self.shown(n, self.low[a]) for n, a in letters] if has_moved else [],
                "max": [self.shown(n, self.high[a]) for n, a in letters] if has_moved else [],
            },
            "end": {letter: self.shown(letter, self.end[axis]) for letter, axis in letters},
            "tools": self.tools,
        }


def _as_data(finding: Finding) -> dict[str, Any]:
    return {
        "code": finding.code,
        "text": finding.text,
        "file": finding.file,
        "line": finding.line,
        "column": finding.column,
        "hint": finding.hint,
        "block": finding.block,
    }


def survey(
    program: Program,
    cells: Cells,
    dialect: str = "acromill",
    options: Options | None = None,
    machine: Machine | None = None,
    look: Callable[[Entry], None] | None = None,
) -> Survey:
    """Read a program to its end; `look` sees every entry. Nothing is written to the cells.

    The first error at run time ends the run, but all errors of the geometry are found. Of a
    program with errors at load only the findings in front of the first wrong line are added.
    """
    shadow = Shadow(cells)
    options = options or Options()
    options.collects_errors = options.has_batches = True
    run = Interpreter(program, shadow, machine or VirtualMachine(), dialect, options)
    found = Survey(run.planner.axes, program.line_cnt, findings=list(program.findings))
    if program.errors:
        found.findings += _found_before(program.errors, run)
    else:
        _Count(found, run).all(look)
    found.findings += [*run.errors, *run.warnings]
    _sort(found.findings)
    return found


def _found_before(errors: list[Finding], run: Interpreter) -> list[Finding]:
    """The error that ends the run, unless it is known from the load."""
    try:
        for _entry in run.entries():
            pass
    except BlockError as error:
        known = {(finding.file, finding.line) for finding in errors}
        found = error.finding
        return [] if (found.file, found.line) in known else [found]
    return []


def _sort(findings: list[Finding]) -> None:
    """By place; where there are too many, errors are kept before warnings."""
    findings.sort(key=lambda f: (not f.is_error, f.file, f.line, f.column))
    del findings[MOST:]
    findings.sort(key=lambda f: (f.file, f.line, f.column))


class _Count:
    """Adds entries up."""

    def __init__(self, found: Survey, run: Interpreter) -> None:
        self._found = found
        self._run = run
        self._at: Point = run.path.target
        self._has_unit = False
        self._linear = [axis for letter, axis in found.letters.items() if letter in LINEAR]
        self._unplaced = set(found.letters.values())  # axes that did not move yet

    def all(self, look: Callable[[Entry], None] | None) -> None:
        """The whole program."""
        found = self._found
        try:
            for entry in self._run.entries():
                if isinstance(entry, Motion | Polyline) and not self._has_unit:
                    self._take_unit()
                self.add(entry)
                if look is not None:
                    look(entry)
        except BlockError as error:
            found.findings.append(error.finding)
        if not self._has_unit:
            self._take_unit()
        found.end = self._at
        if any(found.low[axis] < math.inf for axis in found.letters.values()):
            for axis in self._unplaced:
                found.low[axis] = found.high[axis] = self._at[axis]

    def _take_unit(self) -> None:
        """The unit that is active now is that of the program."""
        self._has_unit = True
        self._found.unit = "mm" if self._run.modal.unit == METRIC else "inch"
        self._found.per = self._run.path.shown(1.0)

    def add(self, entry: Entry) -> None:
        """One entry."""
        found = self._found
        match entry:
            case Rapid():
                self._straight("rapid", entry.end)
            case Line() | Probe():
                self._straight("feed", entry.end)
            case Arc():
                self._arc(entry)
            case Polyline():
                self._many(entry)
            case Moves():
                for one in entry.entries():
                    self.add(one)
            case Dwell():
                found.move_cnts["dwell"] += 1
            case Tool():
                found.tools.append(entry.number)
            case _:
                pass

    def _straight(self, kind: str, end: Point) -> None:
        found = self._found
        found.move_cnts[kind] += 1
        found.lengths[kind] += math.sqrt(sum((end[a] - self._at[a]) ** 2 for a in self._linear))
        self._place(end, is_start_cut=kind != "rapid")
        self._reach(end)
        self._at = end

    def _place(self, end: Point, *, is_start_cut: bool) -> None:
        """Axes that move for the first time have a place from now on."""
        first = [axis for axis in self._unplaced if end[axis] != self._at[axis]]
        self._unplaced.difference_update(first)
        if is_start_cut:
            self._reach(self._at, first)

    def _reach(self, point: Point, axes: Iterable[int] | None = None) -> None:
        low, high = self._found.low, self._found.high
        for axis in self._found.letters.values() if axes is None else axes:
            if axis not in self._unplaced:
                low[axis] = min(low[axis], point[axis])
                high[axis] = max(high[axis], point[axis])

    def _many(self, entry: Polyline) -> None:
        import numpy as np

        found, ends = self._found, entry.ends
        found.move_cnts["feed"] += len(ends)
        all_points = np.vstack([np.asarray(self._at), ends])
        steps = np.diff(all_points[:, self._linear], axis=0)
        found.lengths["feed"] += float(np.sqrt((steps**2).sum(axis=1)).sum())
        moved = np.where(np.ptp(all_points, axis=0) > 0.0, np.inf, self._at)
        self._place(tuple(moved.tolist()), is_start_cut=True)
        self._reach(tuple(map(float, all_points.min(axis=0))))
        self._reach(tuple(map(float, all_points.max(axis=0))))
        self._at = tuple(map(float, ends[-1]))

    def _arc(self, arc: Arc) -> None:
        """The mean radius counts; axes beside the plane add as on a helix."""
        found, plane = self._found, arc.plane
        found.move_cnts["arc"] += 1
        bow = 0.5 * (arc.start_radius + arc.end_radius) * abs(arc.sweep_rad)
        rise = [arc.end[a] - self._at[a] for a in self._linear if a not in plane_axes(plane)]
        found.lengths["feed"] += math.sqrt(bow * bow + sum(d * d for d in rise))
        self._unplaced.difference_update(plane_axes(plane))
        self._reach(self._at, plane_axes(plane))
        self._place(arc.end, is_start_cut=True)
        for point in (*extremes(arc, self._at), arc.end):
            self._reach(point)
        self._at = arc.end


def plane_axes(plane: Plane) -> tuple[int, int]:
    """First and second axis."""
    return plane.first, plane.second


def extremes(arc: Arc, start: Point) -> Iterator[Point]:
    """Where an arc reaches farthest along the axes of its plane."""
    first, second = plane_axes(arc.plane)
    begin = math.atan2(start[second] - arc.centre[1], start[first] - arc.centre[0])
    low, high = sorted((begin, begin + arc.sweep_rad))
    for quarter in range(math.ceil(low / _QUARTER), math.floor(high / _QUARTER) + 1):
        share = (quarter * _QUARTER - begin) / arc.sweep_rad
        radius = arc.start_radius + (arc.end_radius - arc.start_radius) * share
        point = [a + (b - a) * share for a, b in zip(start, arc.end, strict=True)]
        point[first] = arc.centre[0] + radius * math.cos(quarter * _QUARTER)
        point[second] = arc.centre[1] + radius * math.sin(quarter * _QUARTER)
        yield tuple(point)
