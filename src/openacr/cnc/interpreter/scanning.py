"""Runs of lines executed from the text, many at a time.

While nothing but a line and the values of its formulas decide what it does - no compensation,
scaling, rotation, cycle, modal macro - the compiled executor reads the bytes (`lines_cy`). For
readers of whole programs the moves of many blocks come out as `Moves`; where a machine runs the
program, runs of straight feed moves of one pace come out as a `Polyline`. The result is that of
the lines one by one.
"""

from __future__ import annotations

from array import array
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, cast

from openacr.cnc.canonical import AXES, Moves, Pace, Polyline, Source
from openacr.cnc.canonical.batches import CURVE, POINT, ROW
from openacr.cnc.codes.gcodes.motion import MOTIONS, NO_MOTION
from openacr.cnc.codes.radii import NEAR_INCH
from openacr.cnc.interpreter import blocks_cy as core
from openacr.cnc.interpreter import lines_cy, loops
from openacr.cnc.interpreter.fast_plans import FIELDS, fast_plan, rich_plan
from openacr.cnc.interpreter.formula_code import FormulaWriter
from openacr.cnc.interpreter.program_values import Jumps, ProgramValues
from openacr.cnc.interpreter.values_cy import X_SIZE
from openacr.cnc.program.labels import Place
from openacr.cnc.reading import scan_cy as scan
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.line_shapes import MOST_ROWS, LineShapes, doubles, integers
from openacr.cnc.reading.parser import parse
from openacr.cnc.reading.text import decoded
from openacr.cnc.state.cells import EPSILON
from openacr.cnc.state.modal import INCH, METRIC, PER_MINUTE
from openacr.compiled import pick

if TYPE_CHECKING:
    from openacr.cnc.interpreter.interpreter import Interpreter
    from openacr.cnc.program.program import Part
    from openacr.views import F64

MOST_SLOW = 20_000  # places of lines that are known to be left to the parser
LEAST_ROWS = 16  # a Polyline has more
MOST_NUMBERS = 32768  # of all plans
OFF, NO_CYCLE = 40, 80
FAST_MOTIONS = frozenset({0, 1, 2, 3, NO_MOTION})
_run_lines = pick(lines_cy.run_lines)


class Scanner:
    """Executes runs of lines for an interpreter."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        bracket = run.dialect.grammar.brackets[0]
        self._shapes = LineShapes(run.planner.axes, bracket, core.W_RUN_SIZE, core.K_RUN_SIZE)
        for letter, axis in run.planner.axes.items():
            self._shapes.K[core.K_LETTER + axis] = ord(letter) - ord("A")
        self._plans, self._plans_end = integers(MOST_NUMBERS), 0
        self._stack = doubles(X_SIZE)
        self._modal, self._arc = integers(core.M_SIZE), doubles(core.A_RUN_SIZE)
        self._ends, self._arcs = doubles(MOST_ROWS * POINT), doubles(MOST_ROWS * CURVE)
        self._rows, self._paces = integers(MOST_ROWS * ROW), doubles(MOST_ROWS + 1)
        self._values = ProgramValues(run)
        self._jumps = Jumps(run)
        self._slow: set[tuple[int, int]] = set()  # parts and places of lines
        self._bar: Place | None = None  # from its line to its offset there is no run of lines
        self._last: Place | None = None
        self.last: Place | None = None  # the last line that was executed, if it was here

    @property
    def is_free(self) -> bool:
        """Whether the words of a line alone decide what it does."""
        run = self._run
        modal, path = run.modal, run.path
        return (
            modal.cycle == NO_CYCLE
            and modal.motion in FAST_MOTIONS
            and modal.compensation == OFF
            and modal.feed_mode == PER_MINUTE
            and run.macro is None
            and path.elements is None
            and path.shape is None
            and path.coordinates.is_plain
            and run.motions is MOTIONS
            and not run.is_replaying
            and (run.options.has_batches or modal.motion == 1)
        )

    def read(self, start: Place) -> tuple[Moves | Polyline | None, Place]:
        """The moves of the lines from a position on, and the position after them.

        The position is `start` itself where no line was taken.
        """
        text = start.part.text
        if start.offset >= text.end or start.part.is_cycles or self._is_barred(start):
            return None, start
        self._jumps.arrived(start)
        data, place = self._shapes.bytes(text, start.offset)
        stop = min(len(data), text.end - start.offset + place)
        is_plain = not self._run.options.has_batches
        self._take_state(is_plain=is_plain)
        first = start.offset - place
        rows, after = self._execute(data, Place(start.part, place, start.line), stop, first)
        after = Place(start.part, first + after.offset, after.line)
        if self._cnt == 0 or (is_plain and rows < LEAST_ROWS):
            self._bar = Place(start.part, after.offset, start.line)
            self._note_slow(start)
            return None, start
        self._hand_back()
        self.last = self._last
        made = self._polyline if is_plain else self._moves
        return made(rows, start, data), after

    def _execute(self, data: memoryview, at: Place, stop: int, first: int) -> tuple[int, Place]:
        """The count of moves of the lines from a position in the data on, and the line after them.

        `first` is the offset of the data in the text.
        """
        shapes, rows = self._shapes, 0
        values, jumps = self._values, self._jumps
        self._cnt = 0
        jumps.begin(at.part, first, shapes.K)
        while True:
            self._modal[core.M_LINE] = at.line
            rows = _run_lines(
                data, at.offset, stop, shapes.W, shapes.K, shapes.L, shapes.T, self._plans,
                self._modal, self._arc, self._ends, self._arcs, self._rows, self._paces, rows,
                MOST_ROWS, shapes.N, shapes.Q, self._stack, values.locals, values.own,
                values.cells, values.states, values.access, jumps.rows, jumps.kept,
            )  # fmt: skip
            K = shapes.K
            if K[core.K_READ]:
                self._cnt += K[core.K_READ]
                self._last = Place(at.part, first + K[scan.K_LAST], K[core.K_LAST_LINE])
            at = Place(at.part, K[scan.K_NEXT], K[scan.K_LINES])
            if shapes.status == scan.SCAN_LEFT:
                jumps.left(at)
            if shapes.status != scan.SCAN_NEW or not self._learn(at.part, first + at.offset):
                jumps.end()
                return rows, at

    def _note_slow(self, start: Place) -> None:
        """Remember that a line is always left to the parser."""
        if self._shapes.status in (scan.SCAN_HARD, scan.SCAN_SLOW) and len(self._slow) < MOST_SLOW:
            self._slow.add((id(start.part), start.offset))

    def _is_barred(self, start: Place) -> bool:
        """Whether a run from here on has been found too short: it ends at the same line."""
        bar = self._bar
        if (id(start.part), start.offset) in self._slow:
            return True
        return (
            bar is not None
            and bar.part is start.part
            and bar.line <= start.line
            and (start.offset < bar.offset)
        )

    # --- shapes ---------------------------------------------------------------------------

    def _learn(self, part: Part, offset: int) -> bool:
        """Make the plan of the line at an offset, whose shape is new; False without room."""
        tokens = self._shapes.tokens()
        found = part.text.line(offset)
        numbers = self._planned(decoded(found[0]), part) if found else None
        if numbers is None or self._plans_end + len(numbers) > MOST_NUMBERS:
            return self._shapes.learn(tokens, scan.SHAPE_SLOW)
        first = self._plans_end
        self._plans_end += len(numbers)
        for k, number in enumerate(numbers, first):
            self._plans[k] = number
        return self._shapes.learn(tokens, first)

    def _planned(self, raw: str, part: Part) -> list[int] | None:
        run = self._run
        try:
            plan = run.planner.plan(parse(raw, run.dialect.grammar))
        except CodeError:
            return None
        if not self._shapes.is_rich:
            return fast_plan(plan, plan.acts)
        writer = FormulaWriter(run.parameters, self._shapes.numbers())
        branches = partial(run.o_words.is_plain, part=part)
        return rich_plan(plan, plan.acts, writer, branches, assigns_last=run.dialect.assigns_last)

    # --- the state of the interpreter -----------------------------------------------------

    def _take_state(self, *, is_plain: bool) -> None:
        run, W, M = self._run, self._shapes.W, self._modal
        modal, path = run.modal, run.path
        W[core.W_POSITION : core.W_POSITION + AXES] = _view(path.program)
        W[core.W_TARGET : core.W_TARGET + AXES] = _view(path.target)
        W[core.W_SHIFT : core.W_SHIFT + AXES] = _view(path.coordinates.shift)
        for k, factor in enumerate((*path.factors(INCH), *path.factors(METRIC))):
            W[core.W_UNITS + k] = factor
        W[core.W_TIMES], W[core.W_PER], W[core.W_FEED] = path.times, path.per, modal.feed
        W[core.W_NEAR], W[core.W_EPSILON] = path.inches(NEAR_INCH), run.cells.read(EPSILON)
        for row, field in enumerate(FIELDS):
            M[row] = int(getattr(modal, field))
        M[core.M_PACE], M[core.M_HAS_FEED] = 0, modal.has_feed
        M[core.M_IDLE] = run.execution.idle_cnt
        M[core.M_HAS_VALUES] = self._values.are_here and not is_plain
        M[core.M_MOST_PASSES] = loops.MOST_PASSES if run.loops is not None else 0
        M[core.M_IS_SHIFTED], M[core.M_IS_PLAIN] = path.coordinates.is_shifted, is_plain
        self._paces[0] = modal.feed

    def _hand_back(self) -> None:
        run, W, M = self._run, self._shapes.W, self._modal
        modal, path = run.modal, run.path
        for row, field in enumerate(FIELDS):
            if M[row] != getattr(modal, field):
                setattr(modal, field, M[row])
        modal.feed, modal.has_feed = W[core.W_FEED], bool(M[core.M_HAS_FEED])
        path.times, path.per = W[core.W_TIMES], W[core.W_PER]
        path.change_pace()
        path.jump(
            tuple(W[core.W_POSITION : core.W_POSITION + AXES]),
            tuple(W[core.W_TARGET : core.W_TARGET + AXES]),
        )
        run.execution.idle_cnt = M[core.M_IDLE]

    # --- what came out ----------------------------------------------------------------------

    def _paces_of(self, count: int) -> tuple[Pace, ...]:
        """The paces of the moves: they differ in the feed alone."""
        present = self._run.path.plain_pace()
        return tuple(_with_feed(present, feed) for feed in self._paces[:count])

    def _moves(self, rows: int, start: Place, data: memoryview) -> Moves | None:
        if not rows:
            return None
        kept = integers(rows * ROW)
        kept[:] = self._rows[: rows * ROW]
        ends, arcs = doubles(rows * POINT), doubles(rows * CURVE)
        ends[:], arcs[:] = self._ends[: rows * POINT], self._arcs[: rows * CURVE]
        paces = self._paces_of(self._modal[core.M_PACE] + 1)
        return Moves(start.part.text.name, kept, ends, arcs, paces, partial(_text, data))

    def _polyline(self, rows: int, start: Place, data: memoryview) -> Polyline:
        import numpy as np

        R = self._rows
        ends = np.array(self._ends[: rows * POINT]).reshape(rows, POINT)
        lines = np.array(R[core.R_LINE : rows * ROW : ROW], np.int64)
        text = _text(data, R[core.R_START], R[core.R_STOP])
        source = Source(start.part.text.name, int(lines[0]), text)
        return Polyline(source, ends, lines, self._paces_of(1)[0])


def _view(point: tuple[float, ...]) -> F64:
    return cast("F64", memoryview(array("d", point)))


def _with_feed(pace: Pace, feed: float) -> Pace:
    return pace if pace.feed_upm == feed else replace(pace, feed_upm=feed)


def _text(data: memoryview, begin: int, end: int) -> str:
    """The text of a line, without its end."""
    return decoded(bytes(data[begin:end]).rstrip(b"\r\n"))
