"""Checks of lines while a program is loaded."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct, field

from openacr.cnc.codes.block_plan import Plan
from openacr.cnc.codes.table import Dialect
from openacr.cnc.codes.unwired import unwired
from openacr.cnc.reading.blocks import Block, Gosub, Goto, If, Input, Print
from openacr.cnc.reading.findings import CodeError, Finding, found
from openacr.cnc.reading.formulas import Call, Node, Number, Parameter, State
from openacr.cnc.state.cells import M30_ENDS, START_FEED
from openacr.cnc.state.hosts import Cells
from openacr.sysvar.tabs import TOOL


class Report:
    """Findings, each at the present line."""

    def __init__(self) -> None:
        self.findings: list[Finding] = []
        self.where: tuple[str, int, str] = ("", 0, "")
        self.warned: set[str] = set()

    def warn(self, code: str, column: int, detail: str = "") -> None:
        """Report a warning at the present line."""
        name, line, raw = self.where
        self.findings.append(found(code, name, line, column, detail, "", raw))

    def warn_once(self, code: str, column: int) -> None:
        """Report a warning only the first time."""
        if code not in self.warned:
            self.warned.add(code)
            self.warn(code, column)


class Seen(Struct):
    """What was found in the lines so far."""

    motion: float = 1
    has_feed: bool = False
    has_speed: bool = False
    codes: set[str] = field(default_factory=set)
    percent_cnt: int = 0
    has_end: bool = False
    is_over: bool = False  # nothing after the end can be called or jumped to so far
    last: Plan | None = None
    last_place: tuple[int, str] = (0, "")
    asks_for_cycles: bool = False  # by $I, even if the file is missing
    cycle: tuple[str, int, str] | None = None  # position of the first canned cycle


class Checks:
    """Checks of line after line; `seen` is what they found so far."""

    def __init__(self, report: Report, cells: Cells, dialect: Dialect) -> None:
        self._report = report
        self._cells = cells
        self._dialect = dialect
        self._m30_ends = cells.read(M30_ENDS) != 0.0
        self.seen = Seen(has_feed=cells.read(START_FEED) > 0.0)

    def values(self, block: Block, plan: Plan) -> bool:
        """Check that parameters given by number exist, and may be assigned where they are.

        Returns whether a line like this one, with other numbers, has to be checked as well.
        """
        if plan.numbers is not None and not (block.assignments or block.statement):
            return False
        before = len(self._report.findings)
        for node, column in _formulas(block):
            for parameter in _parameters(node):
                error = self._home_error(parameter)
                if error:
                    raise CodeError(error, column, _shown(parameter))
        for assignment in block.assignments:
            if assignment.kind in ("P", "#"):
                self._check_written(assignment.index, assignment.column)
        if isinstance(block.statement, Input):
            self._check_written(block.statement.parameter, block.statement.column)
        return len(self._report.findings) > before or self._has_other_numbers(block)

    def _has_other_numbers(self, block: Block) -> bool:
        """Whether a parameter has a number in brackets, `#(5)`: lines of a shape differ in it."""
        if self._dialect.parameters:
            return False
        indices = [one.index for one in block.assignments]
        for node, _ in _formulas(block):
            indices += [parameter.index for parameter in _parameters(node)]
        raw = self._report.where[2]
        return any(
            isinstance(index, Number) and raw[: index.at].rstrip()[-1:].upper() not in ("#", "P")
            for index in indices
        )

    def _home_error(self, parameter: Parameter) -> str | None:
        if not isinstance(parameter.index, Number) or self._dialect.parameters:
            return None
        return self._cells.home(int(parameter.index.number)).read_error

    def _check_written(self, index: Node | str, column: int) -> None:
        if not isinstance(index, Number) or self._dialect.parameters:
            return
        home = self._cells.home(int(index.number))
        error = home.write_error()
        if error:
            raise CodeError(error, column, f"P{index.number:.10g}")
        if home.write_warning:
            self._report.warn(home.write_warning, column, f"P{index.number:.10g}")

    def doubts(self, plan: Plan) -> None:
        """Warn of what may not be meant as written."""
        seen = self.seen
        seen.has_speed |= "S" in plan.words
        for act in plan.codes:
            self._check_code(act.name)
            if act.letter == "G" and act.number in (0, 1, 2, 3):
                seen.motion = act.number
        seen.has_feed |= "F" in plan.words and not {"G4", "G200"} & {c.name for c in plan.codes}
        if plan.axes and seen.motion and not seen.has_feed and _is_plain(plan):
            self._report.warn_once("W218", plan.column(plan.axes[0][1]))
        if {"G90", "G91"} <= seen.codes:
            self._report.warn_once("W212", 1)

    def _check_code(self, name: str) -> None:
        if name in ("M3", "M4") and not self.seen.has_speed:
            self._report.warn_once("W217", 1)
        missing = unwired(self._cells, name)
        if missing and name not in self._report.warned:
            self._report.warned.add(name)
            self._report.warn("W405", 1, missing)
        if name == "M6" and self._is_change_impossible():
            raise CodeError("E223", 1)

    def _is_change_impossible(self) -> bool:
        read = self._cells.read
        return read(TOOL.manual_tool_change) == 0.0 and read(TOOL.changed_input) < 0.0

    def end(self, name: str, *, has_cycles: bool) -> None:
        """Check the whole, after the last line of the main text."""
        if self.seen.cycle is not None and not has_cycles:
            file, line, raw = self.seen.cycle
            hint = "$I CYCLES.TXT after M2"
            self._report.findings.append(found("E251", file, line, 1, "", hint, raw))
        last = self.seen.last
        is_m30 = last is not None and any(code.name == "M30" for code in last.codes)
        codes = self._dialect.table.mcodes
        is_output = codes[30.0].act is not codes[2.0].act
        if is_m30 and not self._m30_ends and is_output:
            line, raw = self.seen.last_place
            self._report.where = (name, line, raw)
            self._report.warn("W216", 1)


def _is_plain(plan: Plan) -> bool:
    """Whether the axis words of a block belong to the active motion."""
    return any(act.letter == "MOTION" for act in plan.acts)


def _shown(parameter: Parameter) -> str:
    index = parameter.index
    digits = f"{index.number:.10g}" if isinstance(index, Number) else "()"
    return f"{'#' if parameter.is_hash else 'P'}{digits}"


def _formulas(block: Block) -> Iterator[tuple[Node, int]]:
    """Every expression of a block with the column of its word or statement."""
    for word in block.words:
        yield word.value, word.column
    for assignment in block.assignments:
        yield assignment.value, assignment.column
        if not isinstance(assignment.index, str):
            yield assignment.index, assignment.column
    statement = block.statement
    if isinstance(statement, If):
        yield statement.condition, statement.column
        statement = statement.then
    if isinstance(statement, Goto | Gosub):
        yield statement.label, statement.column
    if isinstance(statement, Print):
        for item in statement.items:
            if not isinstance(item, str):
                yield item, statement.column


def _parameters(node: Node) -> Iterator[Parameter]:
    """The parameters a formula reads."""
    waiting = [node]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Parameter):
            yield part
            waiting.append(part.index)
        elif isinstance(part, Call):
            waiting.extend(part.operands)
        elif isinstance(part, State):
            waiting.append(part.index)
