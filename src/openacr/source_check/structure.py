"""Labels, jumps and levels of a whole program, tied together as RUN would."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from openacr.basic.language.cursor import StatementError
from openacr.basic.language.loader import FileLine
from openacr.basic.vm import flow_cy as flow
from openacr.basic.vm.levels import CompileError, Level, Levels, unclosed
from openacr.basic.vm.outline import KINDS, FlowEvent, OpenLevel, follow
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.messages import DUPLICATE_LABEL, LABEL_NOT_FOUND, LINE_NOT_FOUND
from openacr.source_check.hints import lines_near, names_like
from openacr.source_check.texts import Finding, Text, TextLine, label_of

_JUMPS = frozenset(("GOTO", "GOSUB"))
_LEVEL_WORDS = frozenset((*KINDS, "ELSE", "ELSEIF"))
_NAMES = {flow.FLOW_IF: "IF", flow.FLOW_FOR: "FOR", flow.FLOW_WHILE: "WHILE"}
_EXIT_HINTS = {
    flow.FLOW_IF: "let ENDIF close the block and jump past it",
    flow.FLOW_FOR: "BREAK leaves a loop",
    flow.FLOW_WHILE: "BREAK leaves a loop",
}


class _Jump(NamedTuple):
    """A jump with its target and the level around it."""

    word: str
    target: Token
    line: TextLine
    level: Level | None


class Structure:
    """Finds what does not fit together; levels are left alone where a line is lost."""

    def __init__(self, text: Text) -> None:
        self.text = text
        self.findings: list[Finding] = []
        self._levels = Levels[OpenLevel]()
        self._places: dict[str, Level | None] = {}  # of labels
        self._label_lines: dict[str, FileLine] = {}
        self._jumps: list[_Jump] = []
        self._has_all_levels = not text.lost & _LEVEL_WORDS

    def check(self) -> list[Finding]:
        """Everything that is wrong."""
        for line in self.text.in_order():
            if line.outline.has_structure:
                self._line(line)
            if line.outline.fault is not None:
                self.findings.append(Finding(line.place, line.outline.fault))
        for level in self._levels.open if self._has_all_levels else ():
            self._unclosed(level, "still open at the end")
        for jump in self._jumps:
            self._check_jump(jump)
        return self.findings

    def _line(self, line: TextLine) -> None:
        level = self._levels.innermost
        if line.outline.has_label and (label := label_of(line.place.text, line.start)):
            if label in self._places:
                hint = f"the first is in line {_seen(self._label_lines[label], line)}"
                error = CardError(DUPLICATE_LABEL, label)
                self.findings.append(Finding(line.place, error, hint=hint))
            self._places[label] = level
            self._label_lines.setdefault(label, line.place)
        if self._has_all_levels:
            for event in line.outline.events:
                self._follow(line, event)
        if line.outline.jumps:
            level = self._levels.innermost or level
            found = _jumps(line.tokens)
            self._jumps += [_Jump(word, target, line, level) for word, target in found]

    def _follow(self, line: TextLine, event: FlowEvent) -> None:
        """Let a word act on the levels; one without its end is skipped."""
        try:
            follow(self._levels, event, line.number)
        except CompileError as error:
            inner = self._levels.innermost
            if inner is not None and error.message is unclosed(inner).message:
                opened = self.text.lines[inner.line]
                hint = f"still open at the {event.word} of line {_seen(line.place, opened)}"
                self._unclosed(self._levels.open.pop(), hint)
                self._follow(line, event)
            else:
                self._add(line, event.token, error, self._open_here(inner, line))

    def _open_here(self, inner: OpenLevel | None, line: TextLine) -> str:
        if inner is None:
            return "no block is open here"
        return f"open here is the {_NAMES[inner.kind]} of line {self._place_of(inner, line)}"

    def _place_of(self, level: Level, seen_from: TextLine) -> str:
        return _seen(self.text.lines[level.line].place, seen_from)

    def _unclosed(self, level: OpenLevel, hint: str) -> None:
        self._add(self.text.lines[level.line], level.token, unclosed(level), hint)

    def _add(self, line: TextLine, place: int, error: CardError, hint: str) -> None:
        span = line.tokens[place].span
        self.findings.append(Finding(line.place, StatementError(error.message, span), hint=hint))

    def _check_jump(self, jump: _Jump) -> None:
        target = jump.target
        is_label = target.kind is TokenKind.LABEL
        lost = f"_{target.value}".upper() if is_label else str(target.value)
        known = self._places if is_label else self.text.lines
        if target.value not in known and lost not in self.text.lost:
            self._add_lost_target(jump)
        elif jump.word == "GOTO" and is_label and jump.level and not self._is_inside(jump):
            self._warn(jump, jump.level)

    def _add_lost_target(self, jump: _Jump) -> None:
        target = jump.target
        if isinstance(target.value, int):
            message, hint = LINE_NOT_FOUND, lines_near(target.value, self.text.lines)
        else:
            message = LABEL_NOT_FOUND
            hint = names_like(str(target.value), self._places, "labels")
        error = StatementError(message, target.span, target.value)
        self.findings.append(Finding(jump.line.place, error, hint=hint))

    def _is_inside(self, jump: _Jump) -> bool:
        """Whether the level around a jump is also around its target."""
        around = self._places.get(str(jump.target.value))
        while around is not None and around is not jump.level:
            around = around.outer
        return around is not None

    def _warn(self, jump: _Jump, level: Level) -> None:
        text = f"GOTO out of the {_NAMES[level.kind]} of line {self._place_of(level, jump.line)}"
        self.findings.append(
            Finding(jump.line.place, None, jump.target.span, text, _EXIT_HINTS[level.kind])
        )


def _seen(line: FileLine, seen_from: TextLine) -> str:
    """The number of a line in its file, which is named in a message about another one."""
    if line.file is None or line.file is seen_from.place.file:
        return str(line.number)
    return f"{line.number} of {Path(line.file.path).name}"


def _jumps(found: tuple[Token, ...]) -> Iterator[tuple[str, Token]]:
    """Find the targets of GOTO and GOSUB, except computed ones."""
    for word, target, following in zip(found, found[1:], (*found[2:], found[-1]), strict=False):
        if word.kind is TokenKind.WORD and word.value in _JUMPS:
            is_whole = following.kind in (TokenKind.END, TokenKind.REMARK) or following.value == ":"
            if target.kind is TokenKind.LABEL or (target.kind is TokenKind.NUMBER and is_whole):
                yield str(word.value), target
