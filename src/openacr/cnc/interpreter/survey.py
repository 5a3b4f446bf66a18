"""A program read to its end without a machine: what it does and what is wrong with it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from msgspec import Struct, field

from openacr.cnc.canonical import (
    AXES,
    PLANES,
    Arc,
    Dwell,
    Entry,
    Line,
    Motion,
    Moves,
    Point,
    Polyline,
    Probe,
    Rapid,
    Tool,
)
from openacr.cnc.interpreter import survey_cy as core
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import MOST, BlockError, Finding
from openacr.cnc.rows import moves, surveys
from openacr.cnc.rows.moves import CURVE, ROW
from openacr.cnc.rows.room import Memory, doubles, integers
from openacr.cnc.state.hosts import Cells, Machine, VirtualMachine
from openacr.cnc.state.modal import METRIC
from openacr.cnc.state.shadow import Shadow
from openacr.compiled import pick

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

LINEAR = "XYZUV"
CODES = {plane: code for code, plane in PLANES.items()}
_add = pick(core.survey_moves)


class Survey(Struct):
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
            "errors": [finding.data() for finding in self.errors],
            "warnings": [finding.data() for finding in self.warnings],
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
        self._has_unit = False
        self._memory = Memory(surveys.SIZE)
        F, I = self._F, self._I = self._memory.F, self._memory.I
        self._row, self._end, self._arc = integers(ROW), doubles(AXES), doubles(CURVE)
        for axis in range(AXES):
            F[surveys.low_u[axis]], F[surveys.high_u[axis]] = math.inf, -math.inf
            F[surveys.at_u[axis]] = run.path.target[axis]
        for letter, axis in found.letters.items():
            I[surveys.axes] |= 1 << axis
            I[surveys.linear_axes] |= (letter in LINEAR) << axis
        I[surveys.unplaced_axes] = I[surveys.axes]

    def all(self, look: Callable[[Entry], None] | None) -> None:
        """The whole program."""
        found = self._found
        try:
            for entry in self._run.entries():
                if isinstance(entry, Motion) and not self._has_unit:
                    self._take_unit()
                self.add(entry)
                if look is not None:
                    look(entry)
        except BlockError as error:
            found.findings.append(error.finding)
        if not self._has_unit:
            self._take_unit()
        self._hand_over()

    def _take_unit(self) -> None:
        """The unit that is active now is that of the program."""
        self._has_unit = True
        self._found.unit = "mm" if self._run.modal.unit == METRIC else "inch"
        self._found.per = self._run.path.shown(1.0)

    def _hand_over(self) -> None:
        """The results; axes that did not move are where they are, if any other has moved."""
        found, F, I = self._found, self._F, self._I
        found.low = list(self._memory.reals(surveys.low_u))
        found.high = list(self._memory.reals(surveys.high_u))
        found.end = tuple(self._memory.reals(surveys.at_u))
        found.lengths = {"rapid": F[surveys.rapid_u], "feed": F[surveys.feed_u]}
        found.move_cnts["rapid"] = I[surveys.rapid_cnt]
        found.move_cnts["feed"] = I[surveys.feed_cnt]
        found.move_cnts["arc"] = I[surveys.arc_cnt]
        if any(found.low[axis] < math.inf for axis in found.letters.values()):
            for axis in found.letters.values():
                if I[surveys.unplaced_axes] & 1 << axis:
                    found.low[axis] = found.high[axis] = found.end[axis]

    def add(self, entry: Entry) -> None:
        """One entry."""
        match entry:
            case Moves():
                _add(self._F, self._I, entry.rows, entry.ends, entry.arcs, len(entry))
            case Rapid():
                self._one(moves.RAPID, entry.end)
            case Line() | Probe():
                self._one(moves.LINE, entry.end)
            case Arc():
                radii = entry.start_radius, entry.end_radius
                for k, number in enumerate((*entry.centre, entry.sweep_rad, *radii)):
                    self._arc[k] = number
                self._row[3] = CODES[entry.plane]
                self._one(moves.ARC, entry.end)
            case Polyline():
                for end in entry.ends.tolist():
                    self._one(moves.LINE, end)
            case Dwell():
                self._found.move_cnts["dwell"] += 1
            case Tool():
                self._found.tools.append(entry.number)
            case _:
                pass

    def _one(self, kind: int, end: Sequence[float]) -> None:
        self._row[0] = kind
        for axis in range(AXES):
            self._end[axis] = end[axis]
        _add(self._F, self._I, self._row, self._end, self._arc, 1)
