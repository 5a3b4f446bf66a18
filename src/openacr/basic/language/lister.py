"""Write stored lines as LIST shows them: from their tokens, in one spelling for all.

Reading a listed line gives the same tokens again. Words of the language are upper case
followed by one blank, axes and variables stand before their value without one, numbers
keep their value, remarks and strings stay as they were typed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from openacr.basic.language import registry
from openacr.basic.language.grammar import Form, Mark, Object, Word
from openacr.basic.language.parser import PREFIXES
from openacr.lang.lexer import Token, TokenKind

if TYPE_CHECKING:
    from openacr.basic.memory.program_store import StoredLine

LONGEST_AXIS_NAME = 4

_SPACED = frozenset(("=", "<>", "<", ">", "<=", ">=", "<<", ">>"))
_TIGHT = frozenset(("+", "-", "*", "/", "**", ",", ";", "#", "(", "?"))
_OPENING = frozenset(("IF", "FOR", "WHILE"))
_CLOSING = frozenset(("ENDIF", "NEXT", "WEND"))
_OUTDENTED = frozenset(("ELSE", "ELSEIF", "NEXT", "WEND"))
_SPACED_VARIABLE = "BIT"


class Lister:
    """Writes lines; knows which words are keywords, objects and aliases."""

    def __init__(self, aliases: Collection[str] = ()) -> None:
        self.aliases = aliases
        self.known, self.objects = _vocabulary_of(registry.count())

    def program(self, lines: Iterable[StoredLine], *, numbers: bool = False) -> Iterator[str]:
        """The whole text; line numbers are hidden in free-form programs unless wanted."""
        depth = 0
        is_free_form = False
        for place, line in enumerate(lines):
            if place == 0:
                is_free_form = opens_free_form(line)
            yield self.stored(line, depth, is_free_form=is_free_form, numbers=numbers)
            depth = depth_after(line, depth)

    def stored(
        self, line: StoredLine, depth: int, *, is_free_form: bool, numbers: bool = False
    ) -> str:
        """One stored line at a depth of blocks, as LIST shows it."""
        first = _first_word(line)
        numbered = f"{line.number} " if numbers or not is_free_form else ""
        frame = first in ("PROGRAM", "ENDP")
        outer = depth - (first in _OUTDENTED) + is_free_form
        indent = 0 if frame else max(outer, 0)
        tree = None if line.is_unread else line.tree
        spelled: str | None = getattr(tree, "spelled", None)  # of a line that is not AcroBASIC
        text = self.line(line.tokens) if spelled is None else spelled
        return f"{numbered}{' ' * indent}{text}"

    def line(self, tokens: Iterable[Token]) -> str:
        """One line without its number."""
        text = ""
        before: Token | None = None
        older: Token | None = None
        is_naming = False  # in the name that #DEFINE gives, which ends at the first blank
        for token in tokens:
            if token.kind is TokenKind.END:
                break
            if is_naming and before is not None and _touches(before, token):
                text += token.text
            else:
                is_apart = before is not None and self._is_apart(older, before, token)
                text += " " * (is_apart or is_naming) + self._spelling(token, before)
                is_naming = _follows_define(before)
            older, before = before, token
        return text

    def _spelling(self, token: Token, before: Token | None) -> str:
        if token.kind is TokenKind.WORD:
            return self._word(token, before)
        if token.kind is TokenKind.NUMBER:
            return literal(token.value)
        if token.kind is TokenKind.STRING:
            return '"{}"'.format(str(token.value).replace('"', '""'))
        if token.kind is TokenKind.LABEL:
            is_target = before is not None and before.value in ("GOTO", "GOSUB")
            return f"{'' if is_target else '_'}{token.value}"
        if token.kind is TokenKind.REMARK:
            return f"REM{token.value}"
        return str(token.value)

    def _word(self, token: Token, before: Token | None) -> str:
        if _follows_define(before) or token.text in self.aliases:
            return token.text
        is_name = token.value in self.known or len(token.text) <= LONGEST_AXIS_NAME
        return str(token.value) if is_name else token.text

    def _is_apart(self, older: Token | None, before: Token, token: Token) -> bool:
        """Whether a blank stands between two tokens."""
        if ":" in (before.value, token.value) or token.kind is TokenKind.REMARK:
            return True
        if _is_operator(token, _SPACED) or _is_operator(before, _SPACED):
            return True
        if before.kind is TokenKind.OPERATOR and before.value != ")":
            return False
        if _is_operator(token, {",", ";", ")"}):
            return False
        if before.text in self.aliases and token.kind is TokenKind.NUMBER:
            return True  # it would become part of the name
        if before.kind is TokenKind.WORD:
            return self._is_keyword(before) or token.kind in (TokenKind.WORD, TokenKind.STRING)
        if _is_operator(token, {"("}):
            return not self._is_index(older, before)
        return not _is_operator(token, _TIGHT) or token.value in ("#", "?")

    def _is_keyword(self, token: Token) -> bool:
        """Whether a blank follows this word whatever comes."""
        word = str(token.value)
        if token.text in self.aliases or word in registry.functions or word in self.objects:
            return False
        if word in registry.VARIABLES:
            return word == _SPACED_VARIABLE
        return word in self.known

    def _is_index(self, older: Token | None, before: Token) -> bool:
        """Whether the number before belongs to a variable or object: `LA0(1)`, `PROG0(8192)`."""
        if older is None or older.kind is not TokenKind.WORD or before.kind is not TokenKind.NUMBER:
            return False
        return older.value in registry.VARIABLES or older.value in self.objects


def opens_free_form(line: StoredLine) -> bool:
    """Whether the first line of a program says that its lines have hidden numbers."""
    return _first_word(line) == "PROGRAM"


def depth_after(line: StoredLine, depth: int) -> int:
    """The depth of blocks after a line that is at `depth`."""
    if line.nesting is None:
        line.nesting = _depth_change(line.tokens)
    return max(depth + line.nesting, 0)


def _first_word(line: StoredLine) -> str:
    return next((str(token.value) for token in line.tokens if token.kind is TokenKind.WORD), "")


def literal(value: str | int | float) -> str:
    """A number that reads back as exactly this value."""
    if isinstance(value, float):
        return repr(value).removesuffix(".0").upper()
    return str(value)


def _follows_define(before: Token | None) -> bool:
    return before is not None and before.value == "DEFINE"


def _touches(before: Token, token: Token) -> bool:
    return token.value != ":" and token.column == before.column + len(before.text)


def _is_operator(token: Token, texts: Collection[str]) -> bool:
    return token.kind is TokenKind.OPERATOR and token.value in texts


def _depth_change(tokens: Iterable[Token]) -> int:
    """Blocks a line opens, less those it closes; a one-line IF opens none."""
    words = [
        str(token.value) for token in tokens if token.kind is TokenKind.WORD or token.value == ":"
    ]
    if "THEN" in words:
        words = words[: words.index("IF")] if "IF" in words else []
    opened = sum(word in _OPENING for word in words)
    opened -= sum(pair == ("ELSE", "IF") for pair in pairwise(words))  # that is ELSEIF
    return opened - sum(word in _CLOSING for word in words)


@lru_cache(maxsize=1)
def _vocabulary_of(commands: int) -> tuple[frozenset[str], frozenset[str]]:
    """The vocabulary, cached until the number of commands changes."""
    return _vocabulary()


def _vocabulary() -> tuple[frozenset[str], frozenset[str]]:
    """All words of the language, and those that name an object by a number."""
    known = set(registry.keywords())
    objects = set(PREFIXES)
    for row in registry.commands():
        for path in (row.words, *row.synonyms):
            known.update(word.lstrip("#") for word in path)
            pairs = pairwise(path)
            objects.update(word for word, index in pairs if index == registry.INDEX)
        for form in row.grammar:
            _form_words(form, known, objects)
    return frozenset(known), frozenset(objects)


def _form_words(form: Form, known: set[str], objects: set[str]) -> None:
    if isinstance(form, Object):
        objects.update(form.words)
        known.update(form.words | form.singles)
    elif isinstance(form, Word):
        known.update(form.words)
    elif isinstance(form, Mark):
        known.add(form.name)
    inner = getattr(form, "each", None)
    for each in (*getattr(form, "forms", ()), *((inner,) if inner else ())):
        _form_words(each, known, objects)
