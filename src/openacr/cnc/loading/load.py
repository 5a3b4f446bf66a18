"""Load a program: read every line once, report all errors, collect labels and included texts.

A program with an error cannot be started. Errors of computed jumps, values of expressions
and geometry are found when it runs.
"""

from __future__ import annotations

from itertools import islice
from pathlib import Path

from msgspec import Struct

from openacr.cnc.canonical import AXIS_LETTERS
from openacr.cnc.codes.block_plan import BlockPlanner, Plan
from openacr.cnc.codes.ngc.owords import missing, note, note_title
from openacr.cnc.codes.table import DIALECTS, Dialect, Group
from openacr.cnc.loading.checks import Checks, Report
from openacr.cnc.loading.skimming import Skimmer
from openacr.cnc.loading.supplied import custom_numbers, cycle_part, found_in, supplied_cycles
from openacr.cnc.loading.targets import Targets, double_labels, labels_of_cycles
from openacr.cnc.program.labels import Part, Place
from openacr.cnc.program.program import CYCLES_FILE, Program
from openacr.cnc.reading.blocks import Block, Gosub, Goto, If, Include, OWord, Word
from openacr.cnc.reading.findings import MOST, CodeError
from openacr.cnc.reading.formulas import Number
from openacr.cnc.reading.parser import parse
from openacr.cnc.reading.text import Text, decoded
from openacr.cnc.state.cells import M30_ENDS
from openacr.cnc.state.hosts import Cells
from openacr.sysvar.tabs import AXIS, COMPATIBILITY, TOOL

DEEPEST_INCLUDE = 8


class Folders(Struct, frozen=True):
    """Folders searched for included texts, after the folder of the program."""

    library: Path | None = None
    customs: Path | None = None  # Mnnn.TXT


def axes_of(cells: Cells) -> dict[str, int]:
    """Axis numbers by letter, of the configured axes."""
    found: dict[str, int] = {}
    for axis in range(len(AXIS_LETTERS)):
        if cells.read(AXIS.configured[axis]):
            found[cells.read_text(AXIS.name[axis]).strip().upper()] = axis
    return found


def load(
    source: Path | str | bytes,
    cells: Cells,
    dialect: str = "acromill",
    folders: Folders | None = None,
    name: str = "PROGRAM",
    folder: Path | None = None,
) -> Program:
    """Load a program from a file or from text; a text includes files of `folder`."""
    if isinstance(source, Path):
        text, folder = Text.file(source), source.parent
    else:
        text = Text.of(source, name)
    return Loader(cells, DIALECTS[dialect], folders or Folders()).load(text, folder)


def load_blank(
    cells: Cells, dialect: str = "acromill", folders: Folders | None = None, name: str = "PROGRAM"
) -> Program:
    """Load a program without lines, for single blocks; all M codes of files are known."""
    return Loader(cells, DIALECTS[dialect], folders or Folders()).load_blank(Text.of(b"", name))


def planner_of(cells: Cells, dialect: Dialect, program: Program | None = None) -> BlockPlanner:
    """Make the planner for the axes of a store and the M codes of a program."""
    planner = BlockPlanner(dialect, axes_of(cells), dialect.table.letters.get("CUSTOM"))
    if program is not None:
        planner.customs.update(program.customs)
    if cells.read(M30_ENDS) and dialect.has_custom:
        planner.replaced["M", 30.0] = dialect.table.mcodes[2.0]
    return planner


class Loader:
    """One pass over all lines of a program."""

    def __init__(self, cells: Cells, dialect: Dialect, folders: Folders) -> None:
        self._cells = cells
        self._dialect = dialect
        self._folders = folders
        self._planner = planner_of(cells, dialect)
        self._end = dialect.table.mcodes[2.0].act
        self._cycle_off = dialect.table.gcodes[80.0].act
        self._skimmer = Skimmer(self._planner.axes, dialect.grammar.brackets[0])
        self._report = Report()
        self._findings = self._report.findings
        self._checks = Checks(self._report, cells, dialect)
        self._seen = self._checks.seen
        self._targets = Targets(self._report)

    def load(self, text: Text, folder: Path | None) -> Program:
        """Load the program in a text."""
        program = Program(Part(text), folder)
        self._program = program
        self._read(program.main, depth=0)
        self._add_subroutines()
        if self._dialect.has_own_cycles:
            program.own_cycles = cycle_part()
        elif self._cells.read(COMPATIBILITY.auto_include_cycles) and not program.has_cycles:
            self._add_cycles(program.main)
        has_cycles = program.has_cycles or self._seen.asks_for_cycles
        self._checks.end(text.name, has_cycles=has_cycles)
        self._findings.extend(islice(self._targets.missed(), MOST))
        self._findings.extend(islice(double_labels(program.parts), MOST))
        self._findings.sort(key=lambda f: (f.file != text.name, f.line, f.column))
        program.findings = self._findings[:MOST]
        return program

    def load_blank(self, text: Text) -> Program:
        """Load an empty text, with all M codes of the files in their folder."""
        program = self.load(text, None)
        for number in custom_numbers(self._custom_folder()) if self._dialect.has_custom else ():
            self._read_custom(number)
        return program

    # --- lines ------------------------------------------------------------------------

    def _read(self, part: Part, depth: int) -> None:
        self._program.parts.append(part)
        offset, line = part.text.begin, 0
        while len(self._findings) < MOST:
            taken = part.text.line(offset)
            if taken is None:
                break
            line += 1
            known = len(self._findings)
            self._line(Place(part, offset, line), decoded(taken[0]), taken[1], depth)
            offset = taken[1]
            # After a finding the next line is read: doubts that wait for it are at its place.
            while len(self._findings) == known and self._may_skim():
                skimmed, offset = self._skim(part, offset, line)
                line += skimmed
                if not skimmed:
                    break
        part.line_cnt = line

    def _may_skim(self) -> bool:
        """Whether the doubt of moves without a feed is settled."""
        return self._seen.has_feed or "W218" in self._report.warned

    def _skim(self, part: Part, offset: int, line: int) -> tuple[int, int]:
        """Skip lines like those read before: they can have no error except in their labels."""
        count, after = self._skimmer.skim(part.text, offset)
        if not count:
            return 0, offset
        labels = self._skimmer.labels if self._dialect.labels else None
        if labels is not None:
            self._seen.is_over = False
            labels += (0, line + 1, offset)
            self._targets.make_room(part, len(labels), line + 1)
            part.labels.add_rows(part, labels)
        if self._skimmer.has_words:
            self._seen.last = None
        if self._skimmer.motion >= 0:
            self._seen.motion = self._skimmer.motion
        return count, after

    def _line(self, place: Place, raw: str, after: int, depth: int) -> None:
        """Read a line; the skimmer learns whether lines like it have to be read as well."""
        self._report.where = (place.part.text.name, place.line, raw)
        asked, settled = self._skimmer.take(), None
        try:
            block = self._parsed(place, raw)
            if block.is_percent:
                self._percent(place)
                return
            self._label(block, place)
            if block.title_number and self._dialect.grammar.has_o_words:
                note_title(self._program, block.title_number, place)
            plan = self._planner_plan(block, place)
            self._statement(block, place, after, depth)
            self._calls(plan, place)
            is_doubtful = self._checks.values(block, plan)
            for code, column in block.warnings:
                self._report.warn(code, column)
            if not place.part.is_cycles:
                self._checks.doubts(plan)
                is_settled = not (block.warnings or block.statement or block.title or is_doubtful)
                settled = plan if is_settled and not plan.is_computed else None
        except CodeError as fault:
            self._findings.append(fault.at(*self._report.where))
        self._skimmer.learn(asked, settled)

    def _parsed(self, place: Place, raw: str) -> Block:
        """The block of a line; a line that can be none is a remark after the end of the program."""
        seen = self._seen
        try:
            block = parse(raw, self._dialect.grammar)
        except CodeError as fault:
            if not seen.is_over or place.part is not self._program.main:
                raise
            self._report.warn_once("W222", fault.column)
            return Block()
        has_label = block.label is not None and self._dialect.labels
        if has_label or block.statement is not None or block.title:
            seen.is_over = False  # what follows may be called
        return block

    def _percent(self, place: Place) -> None:
        self._seen.percent_cnt += 1
        if self._seen.percent_cnt == 2 and place.part is self._program.main:
            place.part.text.end = place.offset

    def _label(self, block: Block, place: Place) -> None:
        if block.label is None or not self._dialect.labels:
            return
        is_own = self._program.has_cycles and not place.part.is_cycles
        self._targets.add_label(block.label, place, is_barred=is_own)

    def _planner_plan(self, block: Block, place: Place) -> Plan:
        """Plan a block, after loading the files of its user M codes."""
        for word in block.words:
            if word.letter == "M" and self._dialect.has_custom:
                self._custom(word)
        plan = self._planner.plan(block)
        names = {code.name for code in plan.codes}
        self._seen.codes |= names
        if place.part is self._program.main:
            is_end = any(code.act is self._end for code in plan.codes)
            self._seen.has_end |= is_end
            self._seen.is_over |= is_end and not block.is_skippable
            if not block.is_empty and not self._seen.has_end:
                self._seen.last, self._seen.last_place = plan, (place.line, self._report.where[2])
        return plan

    def _custom(self, word: Word) -> None:
        if isinstance(word.value, Number):
            self._read_custom(word.value.number)

    def _read_custom(self, code: float) -> None:
        """Load the file of an M code, unless the dialect has the code or it is already loaded."""
        number, folder = int(code), self._custom_folder()
        if code in self._dialect.table.mcodes or number in self._program.customs or folder is None:
            return
        path = found_in(folder, f"M{number}.TXT")
        if path is not None:
            part = Part(Text.file(path))
            self._program.customs[number] = part
            self._planner.customs.add(number)
            where = self._report.where
            self._read(part, depth=1)
            self._report.where = where

    def _custom_folder(self) -> Path | None:
        if self._folders.customs is not None:
            return self._folders.customs
        named = self._cells.read_text(TOOL.custom_m_folder)
        return Path(named) if named else None

    # --- added texts ------------------------------------------------------------------

    def _statement(self, block: Block, place: Place, after: int, depth: int) -> None:
        statement = block.statement
        if isinstance(statement, If):
            statement = statement.then
        if isinstance(statement, Goto | Gosub):
            if isinstance(statement.label, Number):
                self._targets.jump(place, statement.column, round(statement.label.number))
        elif isinstance(statement, OWord):
            if statement.number is None:
                note(self._program, statement, place)
        elif isinstance(statement, Include):
            self._include(statement, place, after, depth)

    def _calls(self, plan: Plan, place: Place) -> None:
        """Note the labels and texts that the codes of a block need."""
        for code in plan.codes:
            label = plan.words.get("P")
            is_call = code.letter == "G" and code.takes_all
            if is_call and label is not None and isinstance(label.value, Number):
                self._targets.jump(place, label.column, round(label.value.number))
            elif code.group is Group.CYCLE and code.act is not self._cycle_off:
                self._seen.cycle = self._seen.cycle or self._report.where

    def _include(self, statement: Include, place: Place, after: int, depth: int) -> None:
        is_cycles = Path(statement.name).name.upper() == CYCLES_FILE
        self._seen.asks_for_cycles |= is_cycles
        is_main = place.part is self._program.main
        if is_main and not self._seen.has_end:
            raise CodeError("E262", statement.column, "it has to come after M2")
        if depth >= DEEPEST_INCLUDE:
            raise CodeError("E262", statement.column, "nested deeper than 8")
        text = self._text_named(statement.name)
        if text is None:
            raise CodeError("E262", statement.column, f"{statement.name} does not exist")
        part = Part(text, place.part.labels, continues_at=Place(place.part, after, place.line + 1))
        part.is_cycles = is_cycles
        self._program.has_cycles |= part.is_cycles
        self._program.includes[place.part.text.name, place.line] = part
        if part.is_cycles:
            self._findings.extend(labels_of_cycles(place.part.labels))
        self._read(part, depth + 1)

    def _text_named(self, name: str) -> Text | None:
        for folder in (self._program.folder, self._folders.library):
            path = found_in(folder, name) if folder else None
            if path is not None:
                return Text.file(path)
        return supplied_cycles() if Path(name).name.upper() == CYCLES_FILE else None

    def _add_subroutines(self) -> None:
        """Load subroutines that are called and have files of their own, `name.ngc`."""
        asked: set[str] = set()
        while names := set(missing(self._program)) - asked:
            asked |= names
            for name in sorted(names):
                text = self._text_named(f"{name}.NGC")
                if text is not None:
                    self._read(Part(text), depth=1)

    def _add_cycles(self, main: Part) -> None:
        part = Part(supplied_cycles(), main.labels, is_cycles=True)
        self._program.has_cycles = True
        self._read(part, depth=1)
