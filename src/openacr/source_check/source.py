"""Read controller files as the card would, without a card: every line, every error.

The reader keeps what later lines depend on: the level (SYS, PROG n, PLC n), the text being
entered with PROGRAM, the axis names of each program and the aliases. Nothing is executed.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from msgspec import Struct

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.channels.entry import split_at_level
from openacr.basic.commands.card_setup import CONFIG_NOTICE
from openacr.basic.commands.operating_system import Definition
from openacr.basic.language.aliases import check_name, numbered_names
from openacr.basic.language.loader import FileLine, FileText, file_lines, long_lived_objects
from openacr.basic.language.nodes import Block, Expr, Move, Number, Statement, String
from openacr.basic.language.parser import Parser
from openacr.basic.language.plc_names import PlcNames
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope, join_names
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import line_number, opens_capture
from openacr.basic.memory.setup import DEFAULT_CONFIG, wrong_module
from openacr.basic.vm.outline import Outline, outline
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind, tokens
from openacr.lang.source import Span
from openacr.messages import INVALID_ARGUMENT, NOT_SUPPORTED, UNKNOWN_COMMAND
from openacr.models import ACR8020, Model
from openacr.plc.compile import PlcCompileError, compile_plc
from openacr.plc.reader import read_line
from openacr.project import PROGRAM_COUNT, Place, SourceFile
from openacr.source_check import numbers
from openacr.source_check.advice import Advice, after_moves, is_noted
from openacr.source_check.cutoffs import Cutoffs, statements
from openacr.source_check.faults import Fault, place_of
from openacr.source_check.hints import hint_for
from openacr.source_check.room import Room, owners
from openacr.source_check.sizes import Sizes, undimensioned, variable
from openacr.source_check.structure import Structure
from openacr.source_check.tables import Tables
from openacr.source_check.texts import Finding, Text, TextLine, label_of

EXTENSION_WARNING = "an extension of openacr: real cards refuse it"
TOLERANCE_HINT = (
    "it limits corners between straight moves, not the turn of arcs, TARC, SINE and TRJ"
)
NOT_ATTACHED = (
    'no axis is attached: ATTACH MASTER0 : ATTACH SLAVE0 AXIS0 "X" at its program, or --axes X for'
    " a part of a program; further moves are not listed"
)
EMPTY_HINT = (
    "the card says nothing; files of programs are loaded after setup.8k (PBOOT starts them)"
)
_MOVES = re.compile(r"\s*(?:\d+\s+)?[A-Z]\s*[-+/.(\d]", re.IGNORECASE)
_LEVEL_WORDS = {"SYS": Level.SYS, "PROG": Level.PROG, "PLC": Level.PLC}


class Immediate(Struct, frozen=True):
    """A line executed at once, or what follows the level in it."""

    line: FileLine
    tokens: tuple[Token, ...]


@dataclass(slots=True)
class Reader:
    """Reads files one after the other."""

    faults: list[Fault] = field(default_factory=list)
    aliases: dict[str, Expr] = field(default_factory=dict)
    axes: dict[int, dict[str, int | None]] = field(default_factory=dict)  # numbers, of each program
    sizes: Sizes = field(default_factory=Sizes)
    room: Room = field(default_factory=Room)
    tables: Tables = field(default_factory=Tables)
    cutoffs: Cutoffs = field(default_factory=Cutoffs)
    advice: Advice = field(default_factory=Advice)
    texts: dict[tuple[Level, int], Text] = field(default_factory=dict)
    parts: list[Text | Immediate] = field(default_factory=list)  # in the order of a listing
    level: Level = Level.SYS
    number: int = 0
    is_capturing: bool = False
    _is_hinted: bool = False  # that axes are not attached
    model: Model = ACR8020  # of the card; this one has the most axes
    _file: FileText = field(default_factory=lambda: FileText("", []))  # being read
    _order: dict[str, int] = field(default_factory=dict)  # of the files
    _checked: dict[tuple[Level, int], set[Fault]] = field(default_factory=dict)  # of texts
    _captured: Text = field(default_factory=Text)
    _begun: dict[tuple[Level, int], None] = field(default_factory=dict)  # texts with lines here
    _known: dict[str, Outline] = field(default_factory=dict)  # by shape, what may be captured
    _stored_scope: Scope = field(default_factory=Scope)
    _kinds: dict[str, str] = field(default_factory=dict)  # of the variables that have aliases

    def read(self, source: SourceFile) -> None:
        """Read one file; program and PLC files begin at the level their name says."""
        lines = source.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        self._file = FileText(str(source.path), lines)
        self._order.setdefault(self._file.path, len(self._order))
        levels = {Place.SETUP: Level.SYS, Place.PROGRAM: Level.PROG, Place.PLC: Level.PLC}
        self.level, self.number = levels[source.place], source.number
        self.is_capturing = False
        self._scope_changed()
        self._begun = {}
        with long_lived_objects():
            for line in file_lines(source.text):
                known = self._known.get(line.shape)
                if known is None or not self._put_known(line, known):
                    self._take(line)
            for key in self._begun:
                self._check(*key)
        for finding in self.cutoffs.findings():
            self._report(finding)
        programs = [number for level, number in self.texts if level is Level.PROG]
        for finding in self.advice.findings(programs):
            self._report(finding)
        self.faults.sort(key=lambda fault: (self._order[fault.path], fault.line, fault.column))

    def _put_known(self, line: FileLine, known: Outline) -> bool:
        """Store a captured line of a shape that was accepted before."""
        if known.has_label and label_of(line.text) is None:
            return False
        text = self._captured
        line.file = self._file
        text.put(TextLine(text.next_number(), line, known, self._stored_scope))
        return True

    def _take(self, line: FileLine) -> None:
        try:
            self._line(line)
        except CardError as error:
            self._fault(line, error)
            is_numbered = self.level is Level.PROG and line.text[:1].isdigit()
            if self.is_capturing or is_numbered or self.level is Level.PLC:
                self._text().lost.update(_words(line.text))

    def _scope_changed(self) -> None:
        """Begin anew with known lines: level, axes or aliases may have changed."""
        self._known = {}
        self._stored_scope = self._scope(stored=True)
        named = ((name, variable(node)) for name, node in self.aliases.items())
        self._kinds = {name: item[0] for name, item in named if item}

    def _line(self, line: FileLine) -> None:
        found = tokens(line.text, 1)
        word = next((t.text.upper() for t in found if t.value != ":"), "")
        if self.is_capturing and word not in _LEVEL_WORDS:
            self._store(line, found)
            if word == "ENDP":
                self.is_capturing, self._known = False, {}
        elif found[0].kind is TokenKind.NUMBER:
            self._store(line, found)
        elif (rest := opens_capture(line.text)) is not None:
            self._open(line, rest)
        else:
            self.is_capturing = False
            self._immediate(line, found)

    def _open(self, line: FileLine, rest: str) -> None:
        """PROGRAM: everything up to ENDP is stored."""
        self._captured = self._text()
        self._captured.clear()
        self._checked.pop((self.level, self.number), None)
        self.is_capturing = True
        self._store(line, tokens("PROGRAM", 1))
        if rest.startswith("_"):
            self._store(line, tokens(rest, 1))

    def _text(self) -> Text:
        """The text that lines of the present level belong to."""
        if self.level is Level.SYS:
            raise CardError(UNKNOWN_COMMAND)
        key = (self.level, self.number)
        if key not in self.texts:
            self.texts[key] = Text()
            self.parts.append(self.texts[key])
        self._begun[key] = None
        return self.texts[key]

    def _forget(self, level: Level, number: int) -> None:
        """NEW: what was stored has been a text of its own."""
        if (level, number) in self._begun:
            self._check(level, number)
            self.room.forget(level, number)
            del self._begun[level, number]
        self.texts.pop((level, number), None)
        self._checked.pop((level, number), None)

    def _axes(self) -> dict[str, int | None]:
        """The axes that have names at the present level."""
        return self.axes.get(self.number, {}) if self.level is Level.PROG else {}

    def _scope(self, *, stored: bool) -> Scope:
        axes = frozenset(self._axes())
        numbered = numbered_names(self.aliases)
        return Scope(self.level, stored, axes, self.aliases, numbered, self.model.lacks)

    def _store(self, line: FileLine, found: list[Token]) -> None:
        text = self._text()
        line.file = self._file
        number, start = text.next_number(), 0
        if found[0].kind is TokenKind.NUMBER:
            number, start = line_number(found[0]), found[0].column + len(found[0].text) - 1
            found = found[1:]
        if found[0].kind is TokenKind.END:
            text.lines.pop(number, None)
            return
        if self.level is Level.PLC:
            join_names(found, self._stored_scope.numbered)
            rung = read_line(found, PlcNames(self.aliases))
            text.put(TextLine(number, line, Outline(), self._stored_scope, start, rung))
            return
        tree = Parser(found, self._stored_scope).line()
        known = outline(found, tree, self._kinds)
        text.put(TextLine(number, line, known, self._stored_scope, start))
        if self.is_capturing and not start and line.shape and not self._stored_scope.numbered:
            self._known[line.shape] = known
        if known.dimensions:
            self.sizes.note(self.number, tree.blocks)

    def _immediate(self, line: FileLine, found: list[Token]) -> None:
        """A line that is executed at once: take note of what later lines depend on."""
        found, rest = split_at_level(found)
        tree = Parser(found, self._scope(stored=False)).line()
        if not tree.is_empty:
            self.parts.append(Immediate(line, tuple(found)))
        self.sizes.note(self.number, tree.blocks)
        self._judge(line, found, tree.blocks)
        self._advise(line, self.level, self.number, tree.blocks)
        axes = self._axes()
        for refused in (
            self.room.note(self.level, self.number, tree.blocks),
            self.tables.note(tree.blocks, axes),
        ):
            if refused is not None:
                self._fault(line, refused)
        try:
            for block in tree.blocks:
                for statement in block:
                    if not isinstance(statement, Move):
                        self._note(line, statement)
        finally:
            self._scope_changed()
        if rest:
            self._immediate(line, rest)

    def _needs_text(self, line: FileLine, statement: Statement) -> None:
        """Warn of a program that is started and has no text so far: nothing runs, silently."""
        target = statement.arguments[1]
        if isinstance(target, tuple) and target[0] == "ALL":
            return
        for owner in owners(self.level, self.number, target):
            is_plc = owner >= PROGRAMS
            key = (Level.PLC, owner - PROGRAMS) if is_plc else (Level.PROG, owner)
            if key not in self.texts or not self.texts[key].lines:
                text = f"{key[0].name}{key[1]} is empty here: nothing is started"
                span = Span(1, statement.column, len(statement.command.name))
                self._report(Finding(line, None, span, text, EMPTY_HINT))

    def _note(self, line: FileLine, statement: Statement) -> None:
        words, arguments = statement.command.words, statement.arguments
        if words[0] in _LEVEL_WORDS and len(words) == 1:
            self.level = _LEVEL_WORDS[words[0]]
            self.number = _integer(arguments[0]) if arguments else 0
        elif words[:2] == ("ATTACH", "SLAVE"):
            self.axes.setdefault(self.number, {}).update(_attached(*arguments))
        elif words == ("NEW",):
            for owner in owners(self.level, self.number, arguments[0]):
                is_plc = owner >= PROGRAMS
                level = Level.PLC if is_plc else Level.PROG
                self._forget(level, owner - PROGRAMS if is_plc else owner)
        elif words in (("RUN",), ("LRUN",)) and self.room.is_complete:
            self._needs_text(line, statement)
        for item in arguments:
            if isinstance(item, Definition) and item.target is not None:
                check_name(item.name, has_digits=self.model.has_digits_in_names)
                self.aliases = self.aliases | {item.name: item.target}
                self.room.define(item.name)

    def _check(self, level: Level, number: int) -> None:
        """Tie the lines of a program or PLC together, those of earlier files included."""
        gone = self._checked.pop((level, number), set())
        self.faults[:] = [fault for fault in self.faults if fault not in gone]
        known_faults = len(self.faults)
        self._check_text(level, number)
        self._checked[level, number] = set(self.faults[known_faults:])

    def _check_text(self, level: Level, number: int) -> None:
        text = self.texts[level, number]
        for finding in self.room.store(level, number, text):
            self._report(finding)
        if level is Level.PROG:
            for finding in Structure(text).check():
                self._report(finding)
            for finding in undimensioned(text, number, self.sizes, self.aliases):
                self._report(finding)
            trees: dict[int, tuple[Block, ...]] = {}  # several questions need the same one

            def tree_of(line: TextLine) -> tuple[Block, ...]:
                if line.number not in trees:
                    trees[line.number] = Parser(list(line.tokens), line.scope).line().blocks
                return trees[line.number]

            for finding in after_moves(text.in_order(), tree_of):
                self._report(finding)
            for line in text.in_order():
                if is_noted(line.outline.words, number):
                    self._advise(line.place, level, number, tree_of(line))
                place = line.place
                is_doubtful = numbers.is_doubtful(place.text, place.shape, self.model)
                if line.outline.is_judged or is_doubtful:
                    self._judge(line.place, line.tokens, tree_of(line))
        elif not text.lost:
            self._check_rungs(text)

    def _check_rungs(self, text: Text) -> None:
        """Check a PLC as RUN would."""
        try:
            compile_plc(text.rungs())
        except PlcCompileError as error:
            self._fault(text.lines[error.line].place, error)
        except CardError as error:
            self._fault(text.lines[max(text.lines)].place, error)

    def _judge(self, line: FileLine, found: Iterable[Token], blocks: tuple[Block, ...]) -> None:
        """What is wrong with a line that can be read."""
        if line.file is None or line.file is self._file:  # those of others have been judged
            self.cutoffs.note(line, tuple(found), blocks)
        for finding in numbers.missing(line, found, blocks, self.model):
            self._report(finding)
        self._warn(line, blocks)

    def _advise(self, line: FileLine, level: Level, number: int, blocks: tuple[Block, ...]) -> None:
        axes = self.axes.get(number, {}) if level is Level.PROG else {}
        for finding in self.advice.note(line, level, number, blocks, axes):
            self._report(finding)

    def _warn(self, line: FileLine, blocks: tuple[Block, ...]) -> None:
        """Warn of what a real card would refuse, and of what no modelled card can do."""
        for statement in statements(blocks):
            command = statement.command
            warning = EXTENSION_WARNING if command.is_extension else command.lacks
            modules = statement.arguments[0] if command.name == "CONFIG" else None
            if isinstance(modules, tuple) and modules != DEFAULT_CONFIG:
                warning = CONFIG_NOTICE
                if hint := wrong_module(modules):
                    self._fault(line, CardError(INVALID_ARGUMENT), hint)
                    continue
            if warning:
                span = Span(1, statement.column, len(command.name))
                hint = TOLERANCE_HINT if command.words == ("LOOK", "TOL") else ""
                self._report(Finding(line, None, span, warning, hint))

    def _report(self, finding: Finding) -> None:
        if finding.error is not None:
            self._fault(finding.line, finding.error, finding.hint)
        else:
            self._add(finding.line, finding.span, finding.warning, finding.hint, "warning")

    def _fault(self, line: FileLine, error: CardError, hint: str = "") -> None:
        span: Span | None = getattr(error, "span", None)
        names = {*self.axes.get(self.number, ()), *self.aliases}
        if error.message is NOT_SUPPORTED and not hint:
            hint = f"the {self.model.name} has {self.model.lacks}"
        if error.message is UNKNOWN_COMMAND and not self.axes and _MOVES.match(line.text):
            if self._is_hinted:
                return  # one finding says it for all
            self._is_hinted, hint = True, NOT_ATTACHED
        hint = hint or hint_for(error.message, line.text, span, self.level, names)
        self._add(line, span, error.text, hint, "error")

    def _add(self, line: FileLine, span: Span | None, text: str, hint: str, severity: str) -> None:
        file = line.file or self._file
        place = place_of(line, span, file.lines)
        original = file.lines[place[0] - 1].rstrip()
        self.faults.append(Fault(file.path, *place, text, hint, original, severity))


def _words(text: str) -> set[str]:
    """The words of a line that cannot be read, and its number."""
    return {word.upper() for word in re.findall(r"\w+", text)}


def _attached(axis: Any, name: Any) -> dict[str, int | None]:
    """The name of an axis that is attached, and its number unless it is computed."""
    return {name.text.upper(): numbers.literal(axis[1])} if isinstance(name, String) else {}


def _integer(argument: object) -> int:
    value = argument.value if isinstance(argument, Number) else argument
    return int(value) % PROGRAM_COUNT if isinstance(value, (int, float)) else 0
