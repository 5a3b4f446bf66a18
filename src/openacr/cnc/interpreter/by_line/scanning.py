"""Runs of lines executed from the text, many at a time.

While nothing but a line and the values of its formulas decide what it does - no scaling, rotation,
modal macro - the compiled executor reads the bytes (`lines_cy`). For
readers of whole programs the moves of many blocks come out as `Moves`; where a machine runs the
program, runs of straight feed moves of one pace come out as a `Polyline`. The result is that of
the lines one by one.
"""

from __future__ import annotations

from array import array
from functools import partial
from typing import TYPE_CHECKING, cast

from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.gcodes.motion import MOTIONS, NO_MOTION
from openacr.cnc.codes.radii import NEAR_INCH
from openacr.cnc.interpreter.by_block import loops
from openacr.cnc.interpreter.by_block.offset_path import OFF
from openacr.cnc.interpreter.by_block.ready import acting
from openacr.cnc.interpreter.by_line import lines_cy
from openacr.cnc.interpreter.by_line.drill_state import hand_back_drilling, take_drilling
from openacr.cnc.interpreter.by_line.fast_plans import FIELDS, Notes, fast_plan, jump, rich_plan
from openacr.cnc.interpreter.by_line.formula_code import FormulaWriter
from openacr.cnc.interpreter.by_line.program_values import Jumps, ProgramValues
from openacr.cnc.interpreter.by_line.scanned import Scanned, line_text
from openacr.cnc.interpreter.by_line.strokes import Strokes
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.program.labels import Place
from openacr.cnc.program.program import Node
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.line_shapes import LineShapes
from openacr.cnc.reading.parser import parse
from openacr.cnc.reading.text import decoded
from openacr.cnc.rows import holes, modes, plans, points, results, runs, scans
from openacr.cnc.state.cells import EPSILON
from openacr.cnc.state.modal import INCH, METRIC, PER_MINUTE
from openacr.compiled import pick

if TYPE_CHECKING:
    from openacr.cnc.codes.table import Limit
    from openacr.cnc.interpreter.by_block.inside import Inside
    from openacr.cnc.program.labels import Part
    from openacr.views import F64

MOST_SLOW = 20_000  # places of lines that are known to be left to the parser
LEAST_ROWS = 16  # a Polyline has more
FAST_MOTIONS = frozenset({0, 1, 2, 3, NO_MOTION})
_run_lines = pick(lines_cy.run_lines)


class Scanner:
    """Executes runs of lines for an interpreter."""

    def __init__(self, run: Inside) -> None:
        self._run = run
        bracket = run.dialect.grammar.brackets[0]
        self._F, self._I = run.memory.F, run.memory.I
        self._shapes = LineShapes(run.planner.axes, bracket, run.memory)
        for letter, axis in run.planner.axes.items():
            self._I[runs.letter_of[axis]] = ord(letter) - ord("A")
        self._plans_end = plans.number.start
        self._notes = Notes(self._limit)
        self._strokes = Strokes(run, self._notes, self._keep)
        self._scanned = Scanned(run, self._notes, self._strokes.nodes)
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
            modal.motion in FAST_MOTIONS
            and modal.feed_mode == PER_MINUTE
            and run.macro is None
            and self._is_following
            and path.shape is None
            and path.coordinates.is_plain
            and run.motions is MOTIONS
            and not run.is_replaying
            and (run.options.has_batches or (modal.motion == 1 and modal.cycle == modes.NO_CYCLE))
        )

    @property
    def _is_following(self) -> bool:
        """Whether compensation is off, or takes every move as an element of a contour."""
        run = self._run
        if run.path.elements is None:
            return run.modal.compensation == OFF
        return (
            run.offset_path.is_following
            and run.options.has_batches
            and run.modal.cycle == modes.NO_CYCLE
            and run.modal.compensation != OFF
        )

    def read(self, start: Place) -> Place:
        """Execute lines together; returns the position after them, `start` where none was taken."""
        text = start.part.text
        if start.offset >= text.end or start.part.is_cycles or self._is_barred(start):
            return start
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
            return start
        begin = self._run.path.target
        self._hand_back()
        if is_plain:
            self._scanned.polyline(rows, start.part, data)
        else:
            self._scanned.moves(rows, self._I[modes.pace] + 1, start.part, data, begin)
        self._run.execution.idle_cnt = self._I[modes.idle_cnt]
        self.last = self._last
        return after

    def _execute(self, data: memoryview, at: Place, stop: int, first: int) -> tuple[int, Place]:
        """The count of moves of the lines from a position in the data on, and the line after them.

        `first` is the offset of the data in the text.
        """
        shapes, values, jumps = self._shapes, self._values, self._jumps
        F, I = self._F, self._I
        self._cnt = 0
        jumps.begin(at.part, first)
        while True:
            I[runs.first_line] = at.line
            _run_lines(data, at.offset, stop, F, I, values.cells, values.states)
            if I[scans.line_cnt]:
                self._cnt += I[scans.line_cnt]
                self._last = Place(at.part, first + I[scans.last_at], I[scans.last_line])
            at = Place(at.part, I[scans.next_at], I[scans.next_line])
            if shapes.status == scans.CALLED and self._call(at, data):
                continue
            if shapes.status in (scans.LEFT, scans.CALLED):
                jumps.left(at)
            if shapes.status != scans.NEW or not self._learn(at.part, first + at.offset):
                jumps.end()
                return I[modes.move_cnt], at

    def _call(self, at: Place, data: memoryview) -> bool:
        """Call the handler of the line at a place; False where the whole line is left to handlers.

        What it shifts applies to the rest of its line and to what follows.
        """
        run, F, I = self._run, self._F, self._I
        if run.options.is_followed:
            return False
        plan, code = self._notes.codes[I[runs.call]]
        text = line_text(data, I[runs.line_start], I[runs.line_stop])
        words = {letter: F[scans.word[ord(letter) - ord("A")]] for letter in plan.words}
        b = BlockContext(Node(at.part, at.line, text, at.offset), plan, words)
        b.number = code.number
        self._hand_back_place()
        try:
            code.act(run, b)
            is_called = run.path.coordinates.is_plain
        except CodeError:
            is_called = False
        self._take_place()
        I[runs.called_cnt] += is_called
        return is_called

    def _note_slow(self, start: Place) -> None:
        """Remember that a line is always left to the parser."""
        if self._shapes.status in (scans.HARD, scans.SLOW) and len(self._slow) < MOST_SLOW:
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
        first = self._keep(numbers) if numbers else 0
        return self._shapes.learn(tokens, first or scans.SLOW_SHAPE)

    def _keep(self, numbers: list[int]) -> int:
        """The place of a plan among all; 0 without room."""
        first, end = self._plans_end, self._plans_end + len(numbers)
        if end > plans.number.stop:
            return 0
        self._plans_end = end
        for at, number in enumerate(numbers, first):
            self._I[at] = number
        return first

    def _limit(self, k: int, limit: Limit) -> None:
        """Keep a limit of words."""
        for at, number in enumerate((limit.low, limit.high, limit.is_whole), plans.LIMIT * k):
            self._F[plans.limit[at]] = number

    def _planned(self, raw: str, part: Part) -> list[int] | None:
        run = self._run
        try:
            plan = run.planner.plan(parse(raw, run.dialect.grammar))
        except CodeError:
            return None
        for code in plan.codes:
            if code.fast == (Does.DRILLS,):
                self._use_cycle(int(code.number))
        acts = acting(plan, run)
        if not self._shapes.is_rich:
            return fast_plan(plan, acts, self._notes)
        writer = FormulaWriter(run.parameters, self._shapes.numbers())
        jumps = partial(jump, branches=partial(run.o_words.is_plain, part=part))
        last = run.dialect.assigns_last
        return rich_plan(plan, acts, writer, self._notes, jumps, assigns_last=last)

    def _use_cycle(self, code: int) -> None:
        """Let the core know the text of a cycle."""
        self._I[holes.stroke[code - modes.FIRST_CYCLE]] = self._strokes.place(code)

    # --- the state of the interpreter -----------------------------------------------------

    def _take_state(self, *, is_plain: bool) -> None:
        run, F, I = self._run, self._F, self._I
        modal, path = run.modal, run.path
        self._take_place()
        self._put(points.factor, (*path.factors(INCH), *path.factors(METRIC)))
        F[points.times], F[points.per], F[points.feed_upm] = path.times, path.per, modal.feed
        F[points.near_u], F[points.epsilon_u] = path.inches(NEAR_INCH), run.cells.read(EPSILON)
        for row, field in enumerate(FIELDS):
            I[modes.state[row]] = int(getattr(modal, field))
        I[modes.pace], I[modes.has_feed] = 0, modal.has_feed
        I[modes.idle_cnt] = run.execution.idle_cnt
        I[modes.move_cnt] = I[runs.line_text] = I[runs.has_turned] = 0
        I[runs.has_values] = self._values.are_here and not is_plain
        I[runs.most_passes] = loops.MOST_PASSES if run.loops is not None else 0
        I[runs.is_plain], I[runs.called_cnt] = is_plain, 0
        F[results.feed_upm[0]] = modal.feed
        take_drilling(run)
        if modal.cycle != modes.NO_CYCLE:
            self._use_cycle(modal.cycle)

    def _take_place(self) -> None:
        path = self._run.path
        self._put(points.position_u, path.program)
        self._put(points.target_u, path.target)
        self._put(points.shift_u, path.coordinates.shift)
        self._I[runs.is_shifted] = path.coordinates.is_shifted

    def _put(self, row: range, numbers: tuple[float, ...]) -> None:
        self._F[row.start : row.stop] = cast("F64", memoryview(array("d", numbers)))

    def _hand_back(self) -> None:
        run, F, I = self._run, self._F, self._I
        modal, path = run.modal, run.path
        for row, field in enumerate(FIELDS):
            if I[modes.state[row]] != getattr(modal, field):
                setattr(modal, field, I[modes.state[row]])
        modal.feed, modal.has_feed = F[points.feed_upm], bool(I[modes.has_feed])
        path.times, path.per = F[points.times], F[points.per]
        path.change_pace()
        self._hand_back_place()
        hand_back_drilling(run)

    def _hand_back_place(self) -> None:
        reals = self._run.memory.reals
        self._run.path.jump(tuple(reals(points.position_u)), tuple(reals(points.target_u)))
