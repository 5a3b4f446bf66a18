"""Parse a line of a part program into words, assignments and a statement.

    block     = [ "/" [digit] ] [ "N" integer ] { item } [ comment ]
    item      = word | assignment | statement
    statement = IF | GOTO | GOSUB | RET | PRINT | INPUT | "$I" file     alone in its block

What words mean together is decided later, by `cnc.codes.block_plan`.
"""

import re

from openacr.cnc.reading.blocks import (
    Assignment,
    Block,
    OWord,
    Word,
)
from openacr.cnc.reading.expressions import ExpressionReader
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Node, Number, Parameter
from openacr.cnc.reading.grammar import Grammar
from openacr.cnc.reading.statements import end, remark, statement

LONGEST = 256
LAST_LABEL = 999_999
_FRACTION = re.compile(r"\.\d*")
_DIGITS = re.compile(r"\d+")
_TITLE = re.compile(r"O\s*\d+\s*(\(.*\)|;.*)?$")
_O_NAME = re.compile(r"O\s*(?:(\d+)|<([^<>]*)>)")
_KEYWORD = re.compile(r"(?:\s*[A-Z])+")  # blanks do not count: END IF
CALL = "CALL"
_GOES_ON = frozenset(".=0123456789")  # after a word that is more than its number
_PLAIN_WORD = r"([A-MP-Z])[ \t]*([+-]?)[ \t]*(\d+(?:\.\d*)?|\.\d+)[ \t]*"
_PLAIN_LINE = re.compile(rf"[ \t]*(?:N[ \t]*(\d+)(\.\d*)?[ \t]*)?((?:{_PLAIN_WORD})*)", re.I | re.A)
_PLAIN_WORDS = re.compile(_PLAIN_WORD, re.I | re.A)
_LETTERS = "ABCDEFGHIJKLMPQRSTUVWXYZ"  # all but N, O


def parse(raw: str, grammar: Grammar) -> Block:
    """The block of one line; CodeError with the column of the first wrong character.

    The hint explains forms of other controls that the dialect refuses.
    """
    if len(raw) > LONGEST:
        raise CodeError("E101", LONGEST + 1)
    try:
        return _plain(raw) or _Parser(raw, grammar).block()
    except CodeError as fault:
        fault.hint = grammar.refusals.of_form(raw, fault.column) or fault.hint
        raise


def _plain(raw: str) -> Block | None:
    """The block of a line with nothing but words and numbers; None for other lines."""
    found = _PLAIN_LINE.fullmatch(raw)
    if found is None:
        return None
    block = Block()
    if found[1]:
        block.label = _target(int(found[1]), has_fraction=found[2] is not None)
    for word in _PLAIN_WORDS.finditer(raw, found.start(3)):
        letter, sign, digits = word.groups()
        number = -float(digits) if sign == "-" else float(digits)
        value = Number(number, word.start(3))
        block.words.append(Word(letter.upper(), value, word.start() + 1))
    return block


def _target(number: int, *, has_fraction: bool) -> int | None:
    """The label of an N word; N0, N1.5 and numbers above the labels only count lines."""
    return number if 1 <= number <= LAST_LABEL and not has_fraction else None


class _Parser(ExpressionReader):
    """Reads one line."""

    def block(self) -> Block:
        block = Block(warnings=self.warnings)
        char = self.peek()
        if char == "%":
            block.is_percent = True
            return block
        if char == "/":
            self._skip_mark(block)
        if self.text.startswith("REM", self.pos) and not self.grammar.has_o_words:
            return block
        if self.peek() == "N":
            self._label(block)
        if self.peek() == "O" and self._o_word(block):
            return block
        while self._item(block):
            pass
        return block

    def _skip_mark(self, block: Block) -> None:
        self.pos += 1
        block.is_skippable = True
        if self.text[self.pos : self.pos + 1].isdecimal():
            self.pos += 1

    def _label(self, block: Block) -> None:
        self.pos += 1
        number = self.integer()
        fraction = _FRACTION.match(self.text, self.pos)
        if fraction:
            self.pos = fraction.end()
        block.label = _target(number, has_fraction=fraction is not None)

    def _o_word(self, block: Block) -> bool:
        rest = self.text[self.pos :]
        if _TITLE.match(rest):
            block.title = self.raw[self.pos :].strip()
            block.title_number = int(_DIGITS.findall(rest)[0])
            return True
        if not self.grammar.has_o_words:
            return False
        at = self.column
        name, number = self._o_name(rest)
        kind = _KEYWORD.match(self.text, self.pos)
        word = "".join(kind[0].split()) if kind else ""
        if kind is None or (number and word != CALL):
            raise self.fault("E108")
        self.pos = kind.end()
        values = []
        self.gap()
        while self.peek() == self.open:
            values.append(self.bracketed())
            self.gap()
        end(self, block)
        block.statement = OWord(name, word, tuple(values), at, number)
        return True

    def _o_name(self, rest: str) -> tuple[str, Node | None]:
        """The name of an O-word, or the formula that computes it."""
        found = _O_NAME.match(rest)
        if found:
            self.pos += found.end()
            return found[1].lstrip("0") or "0" if found[1] else found[2].replace(" ", ""), None
        self.pos += 1
        return "", self.value()

    def _item(self, block: Block) -> bool:
        """One item; False at the end of the line."""
        char = self.peek()
        if not char or char == ";":
            return False
        if self._plain_word(block):
            return True
        if char == "(":
            remark(self, block)
        elif char == "#":
            self._assignment(block, "#")
        elif not statement(self, block):
            self._word(block, char)
        return True

    def _plain_word(self, block: Block) -> bool:
        """Read a word with a number, if one comes next."""
        found = _PLAIN_WORDS.match(self.text, self.pos)
        if found is None or self.text[found.end() : found.end() + 1] in _GOES_ON:
            return False
        if not self.raw[found.start() : found.end()].isascii():
            return False  # a printed minus
        letter, sign, digits = found.groups()
        number = -float(digits) if sign == "-" else float(digits)
        block.words.append(Word(letter, Number(number, found.start(3)), found.start() + 1))
        self.pos = found.end()
        return True

    def _word(self, block: Block, char: str) -> None:
        at = self.column
        if char == "P" and "P" in self.grammar.parameters:
            self._p_word(block)
            return
        for kind in ("OUT", "BIT"):
            if kind in self.grammar.states and self.text.startswith(kind, self.pos):
                self._switch(block, kind)
                return
        if char not in _LETTERS and char not in self.grammar.polar:
            raise self.fault("E104")
        self.pos += 1
        start = self.pos
        value = self.value()
        bare = value.index if isinstance(value, Parameter) and char == "T" else None
        if self.pos == start:
            raise self.fault("E105")
        block.words.append(Word(char, value, at, bare))

    def _p_word(self, block: Block) -> None:
        """`P5 = ..` and `P(5) = ..` assign; any other P is a word."""
        at = self.column
        self.pos += 1
        value = self.value()
        self.gap()
        if self.match("="):
            block.assignments.append(Assignment("P", value, self.expression(), at))
        else:
            block.words.append(Word("P", value, at))

    def _assignment(self, block: Block, kind: str) -> None:
        at = self.column
        self.pos += 1
        index: Node | str
        if self.grammar.has_names and self.peek() == "<":
            kind, index = "<", self.name()
        else:
            index = self.index()
        self.gap()
        if not self.match("="):
            raise self.fault("E104")
        block.assignments.append(Assignment(kind, index, self.expression(), at))

    def _switch(self, block: Block, kind: str) -> None:
        at = self.column
        self.pos += len(kind)
        index = self.bracketed()
        if not self.match("="):
            raise self.fault("E108")
        block.assignments.append(Assignment(kind, index, self.expression(), at))
