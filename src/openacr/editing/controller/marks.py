"""The parts of a line of AcroBASIC or of a PLC, also of one that cannot be read."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, lru_cache

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language import grammar, registry
from openacr.basic.language.aliases import numbered_names
from openacr.basic.language.registry import INDEX, Command
from openacr.basic.language.scope import join_names
from openacr.editing.marks import Kind, Mark
from openacr.lang.lexer import LexError, Token, TokenKind, column_in, plain, tokens
from openacr.map.numbers import USER_COUNT
from openacr.plc.instructions import BY_WORDS, LONGEST, OBJECT_WORDS, Instruction, Operand

REM_LENGTH = 3
AXIS_AND_NUMBER = 2  # tokens that name an axis, before any command for it
SLAVE = ("ATTACH", "SLAVE")
JUMPS = frozenset(("GOTO", "GOSUB"))
_PARAMETER, _FLAG = "P", "BIT"
_PLAIN = {TokenKind.STRING: Kind.STRING, TokenKind.NUMBER: Kind.NUMBER}


@lru_cache(maxsize=1 << 16)
def marks_of(
    text: str, aliases: frozenset[str], axes: frozenset[str], *, is_plc: bool
) -> tuple[Mark, ...]:
    """The parts of a line; what cannot be read at all is left out."""
    found = _tokens(text)
    join_names(found, numbered_names(aliases))
    reader = _PlcMarks if is_plc else _BasicMarks
    marks = tuple(reader(found, aliases, axes).marks())
    if not text.isascii():
        marks = tuple(_in_characters(text, mark) for mark in marks)
    comment = column_in(text, found[-1].column if found else 1)
    if comment <= len(text):
        marks += (Mark(comment - 1, len(text), Kind.REMARK),)
    return marks


def tokens_before(text: str, column: int) -> list[Token]:
    """The tokens that begin before a column, from 0; END excluded."""
    found = _tokens(text[:column])
    return [token for token in found if token.kind is not TokenKind.END]


def _tokens(text: str) -> list[Token]:
    """The tokens of a line, or those before the first character that cannot be read."""
    try:
        return tokens(text)
    except LexError as error:
        begin = text[: column_in(text, error.span.column) - 1]
        found = _tokens(begin) if begin and len(begin) < len(text) else []
        if found:
            found[-1] = found[-1]._replace(column=len(plain(text)) + 1)
        return found


def _in_characters(text: str, mark: Mark) -> Mark:
    def column(plain: int) -> int:
        return min(column_in(text, plain + 1) - 1, len(text))

    place = (column(mark.own[0]), column(mark.own[1]))
    return Mark(
        column(mark.start), column(mark.end), mark.kind, mark.name, mark.number, mark.row,
        mark.is_definition, place,
    )  # fmt: skip


def _mark(token: Token, kind: Kind, **more: object) -> Mark:
    start = token.column - 1
    return Mark(start, start + len(token.text), kind, **more)  # type: ignore[arg-type]


class _BasicMarks:
    """Goes through the tokens of a line of AcroBASIC."""

    def __init__(self, found: list[Token], aliases: frozenset[str], axes: frozenset[str]) -> None:
        self.found = [token for token in found if token.kind is not TokenKind.END]
        self.aliases, self.axes = aliases, axes
        self.at = 0
        self.row: Command | None = None  # whose arguments come
        self._found_row: Command | None = None
        self.depth = 0

    def marks(self) -> Iterator[Mark]:
        if self.found and self.found[0].kind is TokenKind.NUMBER:
            token = self.found[0]
            yield _mark(token, Kind.LABEL, name=str(token.value), is_definition=True)
            self.at = 1
        first = self.at
        while self.at < len(self.found):
            token = self.found[self.at]
            if token.kind is TokenKind.LABEL:
                yield self._label(token, is_definition=self.at == first)
            elif token.kind is TokenKind.REMARK:
                end = token.column - 1 + REM_LENGTH + len(str(token.value))
                yield Mark(token.column - 1, end, Kind.REMARK)
            elif token.kind is TokenKind.OPERATOR:
                yield from self._operator(token)
                continue
            elif token.kind is TokenKind.WORD:
                yield from self._word(token)
                continue
            else:
                yield self._value(token)
            self.at += 1

    def _label(self, token: Token, *, is_definition: bool) -> Mark:
        start = token.column - 1
        end = start + len(token.text)
        place = (end - len(str(token.value)), end)
        return Mark(
            start, end, Kind.LABEL, str(token.value), is_definition=is_definition, place=place
        )

    def _operator(self, token: Token) -> Iterator[Mark]:
        self.depth += (token.value == "(") - (token.value == ")")
        if token.value == ":":
            self.row, self.depth = None, 0
        if token.value == "#" and self._ahead(1).value == "DEFINE":
            yield from self._definition(token)
            return
        if token.value == "?" and (row := registry.root.children["?"].command):
            self.row = row
            yield _mark(token, Kind.COMMAND, name=row.name, row=row)
        self.at += 1

    def _definition(self, token: Token) -> Iterator[Mark]:
        """`#DEFINE name`: the name ends at the first blank."""
        row = registry.find("#DEFINE")
        word = self._ahead(1)
        end = word.column - 1 + len(word.text)
        yield Mark(token.column - 1, end, Kind.COMMAND, row.name, row=row)
        self.row, self.at = row, self.at + 2
        if self.at >= len(self.found):
            return
        first = self.found[self.at]
        name, end = "", first.column
        while self.at < len(self.found) and self.found[self.at].column == end:
            name += self.found[self.at].text
            end += len(self.found[self.at].text)
            self.at += 1
        yield Mark(first.column - 1, end - 1, Kind.ALIAS, name, is_definition=True)

    def _ahead(self, count: int) -> Token:
        place = self.at + count
        return self.found[place] if place < len(self.found) else _NOTHING

    def _word(self, token: Token) -> Iterator[Mark]:
        word = str(token.value)
        if token.text in self.aliases:
            yield _mark(token, Kind.ALIAS, name=token.text)
        elif word in (_PARAMETER, _FLAG) or word in registry.VARIABLES:
            yield self._variable(token, word)
            return
        elif self._is_argument(word):
            yield _mark(token, Kind.KEYWORD, name=word, row=self.row)
        elif self._command() > AXIS_AND_NUMBER * (word == "AXIS") and not self._is_function(word):
            yield from self._command_words(self._command())
            return
        elif word == "AXIS" or (word in self.axes and word not in registry.root.children):
            yield self._axis(token, word)
            return
        elif word in registry.functions:
            yield _mark(token, Kind.FUNCTION, name=word, row=registry.functions[word])
        elif word in registry.OPERATORS:
            yield _mark(token, Kind.OPERATOR, name=word)
        elif word in registry.CLAUSES or (self.row and word in words_of(self.row)):
            yield _mark(token, Kind.KEYWORD, name=word, row=self.row)
            if word == "THEN":
                self.row = None
        else:
            yield _mark(token, Kind.UNKNOWN, name=token.text)
        self.at += 1

    def _is_argument(self, word: str) -> bool:
        """Whether an object with its number belongs to the command: `ATTACH AXIS0 ENC1`."""
        is_numbered = self._ahead(1).kind is TokenKind.NUMBER
        return (
            word != "AXIS" and is_numbered and self.row is not None and word in words_of(self.row)
        )

    def _is_function(self, word: str) -> bool:
        """Whether a word that is also a command stands for the function here."""
        if word not in registry.functions:
            return False
        before = self.found[self.at - 1] if self.at else _NOTHING
        return self.depth > 0 or (before.kind is TokenKind.OPERATOR and before.value != ":")

    def _variable(self, token: Token, word: str) -> Mark:
        """`P12288`, `BIT 516`, `LV3`: with its number, if it is written."""
        number, last = self._number_after()
        self.at = last + 1
        end = self.found[last].column - 1 + len(self.found[last].text)
        start = token.column - 1
        if word == _FLAG:
            return Mark(start, end, Kind.FLAG, f"BIT{number}", number)
        if word == _PARAMETER and number >= USER_COUNT:
            return Mark(start, end, Kind.PARAMETER, f"P{number}", number)
        return Mark(start, end, Kind.VARIABLE, f"{word}{number if number >= 0 else ''}", number)

    def _number_after(self) -> tuple[int, int]:
        """The whole number after the word at hand, and the place of the last token of both."""
        one, two, three = (self._ahead(count) for count in (1, 2, 3))
        if one.kind is TokenKind.NUMBER and isinstance(one.value, int):
            return one.value, self.at + 1
        is_call = one.value == "(" and three.value == ")"
        if is_call and two.kind is TokenKind.NUMBER and isinstance(two.value, int):
            return two.value, self.at + 3
        return -1, self.at

    def _axis(self, token: Token, word: str) -> Mark:
        number, last = self._number_after() if word == "AXIS" else (-1, self.at)
        self.at = last + 1
        end = self.found[last].column - 1 + len(self.found[last].text)
        name = f"AXIS{number}" if word == "AXIS" else word
        return Mark(token.column - 1, end, Kind.AXIS, name, number)

    def _command(self) -> int:
        """How many tokens the longest command that begins here has; 0: there is none."""
        node, count = registry.root, 0
        for ahead, token in enumerate(self.found[self.at :], start=1):
            key = str(token.value) if token.kind is not TokenKind.NUMBER else INDEX
            if key not in node.children or (key == INDEX and token.kind is not TokenKind.NUMBER):
                break
            node = node.children[key]
            if node.command is not None:
                count, self._found_row = ahead, node.command
        return count

    def _command_words(self, count: int) -> Iterator[Mark]:
        self.row = row = self._found_row
        for token in self.found[self.at : self.at + count]:
            kind = Kind.NUMBER if token.kind is TokenKind.NUMBER else Kind.COMMAND
            yield _mark(token, kind, name=row.name if row else "", row=row)
        self.at += count

    def _value(self, token: Token) -> Mark:
        if token.kind is TokenKind.STRING and self.row is not None and self.row.words[:2] == SLAVE:
            return self._axis_name(token)
        if token.kind is TokenKind.NUMBER and isinstance(token.value, int):
            number = token.value
            if self.row is not None and self.row.name in JUMPS:
                return _mark(token, Kind.LABEL, name=str(number))
            if self.depth == 0 and names_flags(self.row):
                return _mark(token, Kind.FLAG, name=f"BIT{number}", number=number)
        return _mark(token, _PLAIN.get(token.kind, Kind.NUMBER))

    @staticmethod
    def _axis_name(token: Token) -> Mark:
        """The name that ATTACH SLAVE gives to an axis."""
        start, name = token.column - 1, str(token.value)
        place = (start + 1, start + 1 + len(name))
        end = start + len(token.text)
        return Mark(start, end, Kind.AXIS, name.upper(), is_definition=True, place=place)


_NOTHING = Token(TokenKind.END, "", "", 0, 0)


@cache
def words_of(row: Command) -> frozenset[str]:
    """The words that may stand among the arguments of a command."""
    found: set[str] = set()
    waiting: list[object] = list(row.grammar)
    while waiting:
        form = waiting.pop()
        if isinstance(form, grammar.Object):
            found |= form.words | form.singles
        elif isinstance(form, grammar.Word):
            found |= form.words
        elif isinstance(form, grammar.Mark) and form.name.isalpha():
            found.add(form.name)
        waiting += [*getattr(form, "forms", ()), *filter(None, [getattr(form, "each", None)])]
    return frozenset(found)


@cache
def names_flags(row: Command | None) -> bool:
    """Whether bare numbers among the arguments of a command are flags."""
    return row is not None and any(
        isinstance(form, grammar.Bit | grammar.Bits) for form in row.grammar[:1]
    )


class _PlcMarks(_BasicMarks):
    """Goes through the tokens of a line of a PLC; a frame of AcroBASIC may stand there too."""

    instruction: Instruction | None = None

    def _word(self, token: Token) -> Iterator[Mark]:
        if token.value in OBJECT_WORDS and self._wants_flag:
            yield _mark(token, Kind.KEYWORD, name=str(token.value))
            self.at += 1
            return
        ahead = self.found[self.at : self.at + LONGEST]
        words = tuple(str(each.value) for each in ahead if each.kind is TokenKind.WORD)
        for count in range(len(words), 0, -1):
            row = BY_WORDS.get(words[:count])
            if row is not None:
                self.instruction = row
                for each in ahead[:count]:
                    yield _mark(each, Kind.COMMAND, name=row.name, row=row)
                self.at += count
                return
        yield from super()._word(token)

    @property
    def _wants_flag(self) -> bool:
        """Whether the flag of the instruction comes next."""
        before = self.found[self.at - 1] if self.at else _NOTHING
        takes_flag = self.instruction is not None and self.instruction.operand is Operand.FLAG
        return takes_flag and before.kind is TokenKind.WORD and before.value not in OBJECT_WORDS

    def _value(self, token: Token) -> Mark:
        if self._wants_flag and isinstance(token.value, int):
            return _mark(token, Kind.FLAG, name=f"BIT{token.value}", number=token.value)
        return super()._value(token)
