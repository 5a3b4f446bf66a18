"""Read controller files as the card would, without a card: every line, every error.

The reader keeps what later lines depend on: the level (SYS, PROG n, PLC n), the text being
entered with PROGRAM, the axis names of each program and the aliases. Nothing is executed.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic import registry
from openacr.basic.commands.operating_system import Definition
from openacr.basic.compiler import CompileError, compile_program
from openacr.basic.expressions import StatementError
from openacr.basic.lister import Lister
from openacr.basic.loader import FileLine, file_lines
from openacr.basic.memory_cost import line_bytes
from openacr.basic.nodes import Expr, Line, Move, Number, Statement, String
from openacr.basic.parser import Parser, Scope
from openacr.basic.plc_names import PlcNames
from openacr.basic.program_store import StoredLine, opens_capture
from openacr.basic.registry import Level
from openacr.errors import CardError
from openacr.lang.lexer import Kind, Token, tokens
from openacr.lang.source import Span
from openacr.messages import (
    LABEL_NOT_FOUND,
    LINE_NOT_FOUND,
    SYNTAX_ERROR,
    UNDEFINED_SYMBOL,
    UNDEFINED_VARIABLE,
    UNKNOWN_COMMAND,
    Message,
)
from openacr.plc.compile import PlcCompileError, compile_plc
from openacr.plc.ladder import draw
from openacr.plc.reader import PlcLine, read_line
from openacr.project import PROGRAM_COUNT, Place, SourceFile

HIDDEN_STEP = 10
_JUMPS = frozenset(("GOTO", "GOSUB"))
_LEVELS = frozenset("IF ELSE ELSEIF ENDIF FOR NEXT WHILE WEND".split())
_LEVEL_WORDS = {"SYS": Level.SYS, "PROG": Level.PROG, "PLC": Level.PLC}


@dataclass(frozen=True, slots=True)
class Fault:
    """One error of a file: where, what the card would say, and what may help."""

    path: str
    line: int
    column: int
    length: int
    message: str
    hint: str
    text: str

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.path}:{self.line}:{self.column}: {self.message}{hint}"

    @property
    def marker(self) -> str:
        """The line with carets below the place."""
        width = max(1, min(self.length, len(self.text) - self.column + 1))
        blanks = "".join("\t" if c == "\t" else " " for c in self.text[: self.column - 1])
        return f"{self.text}\n{blanks}{'^' * width}"


@dataclass(slots=True)
class Text:
    """The text of one program or PLC as it is stored, and where its lines stand."""

    lines: dict[int, StoredLine] = field(default_factory=dict)
    places: dict[int, FileLine] = field(default_factory=dict)
    lost: set[str] = field(default_factory=set)  # the words of lines that could not be read

    def next_number(self) -> int:
        """The hidden number of the next line of free-form text."""
        last = max(self.lines, default=0)
        return last - last % HIDDEN_STEP + HIDDEN_STEP

    def in_order(self) -> list[StoredLine]:
        """The lines by their numbers."""
        return [self.lines[number] for number in sorted(self.lines)]

    def rungs(self) -> list[tuple[int, PlcLine]]:
        """The lines of a PLC with their numbers."""
        return [(line.number, line.tree) for line in self.in_order()]


@dataclass(frozen=True, slots=True)
class Part:
    """A piece of a listing: the text of a program or PLC, or one line executed at once."""

    text: Text | None = None
    tokens: tuple[Token, ...] = ()


@dataclass(slots=True)
class Reader:
    """Reads files one after the other."""

    faults: list[Fault] = field(default_factory=list)
    aliases: dict[str, Expr] = field(default_factory=dict)
    axes: dict[int, set[str]] = field(default_factory=dict)
    texts: dict[tuple[Level, int], Text] = field(default_factory=dict)
    parts: list[Part] = field(default_factory=list)
    level: Level = Level.SYS
    number: int = 0
    is_capturing: bool = False
    _path: str = ""
    _originals: list[str] = field(default_factory=list)

    def read(self, source: SourceFile) -> None:
        """Read one file; program and PLC files begin at the level their name says."""
        self._path = str(source.path)
        self._originals = source.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        levels = {Place.SETUP: Level.SYS, Place.PROGRAM: Level.PROG, Place.PLC: Level.PLC}
        self.level, self.number = levels[source.place], source.number
        self.is_capturing = False
        read_before, known_faults = set(self.texts), len(self.faults)
        for line in file_lines(source.text):
            self._take(line)
        for key in [key for key in self.texts if key not in read_before]:
            if key[0] is Level.PROG:
                self._check_structure(self.texts[key])
                self._check_jumps(self.texts[key])
            elif not self.texts[key].lost:
                self._check_rungs(self.texts[key])
        self.faults[known_faults:] = sorted(
            self.faults[known_faults:], key=lambda fault: (fault.line, fault.column)
        )

    def _take(self, line: FileLine) -> None:
        try:
            self._line(line)
        except CardError as error:
            self._fault(line, error)
            is_numbered = self.level is Level.PROG and line.text[:1].isdigit()
            if self.is_capturing or is_numbered or self.level is Level.PLC:
                self._text().lost.update(_words(line.text))

    def _line(self, line: FileLine) -> None:
        found = tokens(line.text, 1)
        word = next((t.text.upper() for t in found if t.value != ":"), "")
        if self.is_capturing and word not in _LEVEL_WORDS:
            self._store(line, found)
            self.is_capturing = word != "ENDP"
        elif found[0].kind is Kind.NUMBER:
            self._store(line, found)
        elif (behind := opens_capture(line.text)) is not None:
            self._open(line, behind)
        else:
            self.is_capturing = False
            self._immediate(line, found)

    def _open(self, line: FileLine, behind: str) -> None:
        """PROGRAM: everything up to ENDP is stored."""
        text = self._text()
        text.lines.clear()
        self.is_capturing = True
        self._store(line, tokens("PROGRAM", 1))
        if behind.startswith("_"):
            self._store(line, tokens(behind, 1))

    def _text(self) -> Text:
        """The text that lines of the present level belong to."""
        if self.level is Level.SYS:
            raise CardError(UNKNOWN_COMMAND)
        key = (self.level, self.number)
        if key not in self.texts:
            self.texts[key] = Text()
            self.parts.append(Part(text=self.texts[key]))
        return self.texts[key]

    def _scope(self, *, stored: bool) -> Scope:
        axes = frozenset(self.axes.get(self.number, ()) if self.level is Level.PROG else ())
        return Scope(self.level, stored, axes, self.aliases)

    def _store(self, line: FileLine, found: list[Token]) -> None:
        text = self._text()
        number = text.next_number()
        if found[0].kind is Kind.NUMBER:
            number, found = int(found[0].value), found[1:]
        if found[0].kind is Kind.END:
            text.lines.pop(number, None)
            return
        tree: Line | PlcLine | None
        if self.level is Level.PROG:
            tree = Parser(found, self._scope(stored=True)).line()
        else:
            tree = read_line(found, PlcNames(self.aliases))
        text.lines[number] = StoredLine(number, tuple(found), tree, line_bytes(found))
        text.places[number] = line

    def _immediate(self, line: FileLine, found: list[Token]) -> None:
        """A line that is executed at once: take note of what later lines depend on."""
        tree = Parser(found, self._scope(stored=False)).line()
        if not tree.is_empty:
            self.parts.append(Part(tokens=tuple(found)))
        for block in tree.blocks:
            for statement in block:
                if not isinstance(statement, Move):
                    self._note(statement)

    def _note(self, statement: Statement) -> None:
        words, arguments = statement.command.words, statement.arguments
        if words[0] in _LEVEL_WORDS and len(words) == 1:
            self.level = _LEVEL_WORDS[words[0]]
            self.number = _integer(arguments[0]) if arguments else 0
        elif words[:2] == ("ATTACH", "SLAVE"):
            names = [item.text for item in arguments if isinstance(item, String)]
            self.axes.setdefault(self.number, set()).update(name.upper() for name in names)
        for item in arguments:
            if isinstance(item, Definition) and item.target is not None:
                self.aliases[item.name] = item.target

    def _check_structure(self, text: Text) -> None:
        """Tie levels together as RUN would, unless a line that could belong to one is lost."""
        if text.lost & _LEVELS:
            return
        try:
            compile_program((line.number, line.tree) for line in text.in_order())
        except CompileError as error:
            self._fault(text.places[error.line], error)

    def _check_jumps(self, text: Text) -> None:
        """Find jumps to labels and lines that are not there, not even in a lost line."""
        labels = {line.tree.label for line in text.lines.values()}
        for line in text.in_order():
            for target in _jumps(line.tokens):
                is_label = target.kind is Kind.LABEL
                lost = f"_{target.value}".upper() if is_label else str(target.value)
                known = labels if is_label else text.lines
                if target.value not in known and lost not in text.lost:
                    message = LABEL_NOT_FOUND if target.kind is Kind.LABEL else LINE_NOT_FOUND
                    error_here = StatementError(message, target.span, target.value)
                    self._fault(text.places[line.number], error_here)

    def _check_rungs(self, text: Text) -> None:
        """Check a PLC as RUN would."""
        try:
            compile_plc(text.rungs())
        except PlcCompileError as error:
            self._fault(text.places[error.line], error)
        except CardError as error:
            self._fault(text.places[max(text.places)], error)

    def _fault(self, line: FileLine, error: CardError) -> None:
        original = self._originals[line.number - 1].rstrip()
        span: Span | None = getattr(error, "span", None)
        begin = len(original) - len(original.lstrip()) + 1
        # A prompt in front of the line was taken away before it was read.
        shift = len(original) - len(line.text) if original.endswith(line.text) else 0
        column = max(begin, span.column + shift) if span else begin
        length = span.length if span else len(original)
        words = line.text.split()
        word = line.text[span.column - 1 :][: span.length] if span else words[0]
        hint = self._hint(error.message, word, words[0])
        # Behind the end of the line stands what was joined to it.
        place = (line.number, min(column, len(original) + 1), length)
        self.faults.append(Fault(self._path, *place, error.text, hint, original))

    def _hint(self, message: Message, word: str, first: str) -> str:
        is_word_of_language = {word.upper(), first.upper()} & {*registry.keywords(), "PROGRAM"}
        if message is UNKNOWN_COMMAND and self.level is Level.SYS and is_word_of_language:
            return "not valid at the system level; `PROG n` goes to a program"
        if message in (UNKNOWN_COMMAND, SYNTAX_ERROR, UNDEFINED_SYMBOL, UNDEFINED_VARIABLE):
            names = {*self.axes.get(self.number, ()), *self.aliases}
            close = get_close_matches(word, sorted(names), n=1)
            close = close or get_close_matches(word.upper(), registry.keywords(), n=1)
            if close and close[0] != word.upper():
                return f"did you mean {close[0]}?"
        if message in (UNKNOWN_COMMAND, UNDEFINED_SYMBOL) and self.level is Level.PROG:
            return "no command, alias or axis of this program has this name"
        return ""


def listing(reader: Reader) -> Iterator[str]:
    """Write everything that was read as LIST shows it."""
    lister = Lister(reader.aliases)
    for part in reader.parts:
        if part.text is not None:
            yield from lister.program(part.text.in_order())
        else:
            yield lister.line(part.tokens)


def ladders(reader: Reader) -> Iterator[str]:
    """Draw the PLCs that were read."""
    for (level, number), text in reader.texts.items():
        if level is Level.PLC:
            yield f"PLC{number}"
            yield from draw(text.rungs())


def _words(text: str) -> set[str]:
    """The words of a line that cannot be read, and its number."""
    return {word.upper() for word in re.findall(r"\w+", text)}


def _jumps(found: tuple[Token, ...]) -> Iterator[Token]:
    """Find what stands behind GOTO and GOSUB, computed jumps left out."""
    for word, target, behind in zip(found, found[1:], (*found[2:], found[-1]), strict=False):
        if word.kind is Kind.WORD and word.value in _JUMPS:
            is_whole = behind.kind in (Kind.END, Kind.REMARK) or behind.value == ":"
            if target.kind is Kind.LABEL or (target.kind is Kind.NUMBER and is_whole):
                yield target


def _integer(argument: object) -> int:
    value = argument.value if isinstance(argument, Number) else argument
    return int(value) % PROGRAM_COUNT if isinstance(value, (int, float)) else 0
