"""What may help: a hint for each fault that `openacr check` finds."""

import re
from collections.abc import Collection, Iterable
from difflib import get_close_matches
from functools import lru_cache

from openacr.basic.language import registry
from openacr.basic.language.registry import Level
from openacr.basic.language.written import call, command_before, function_at, syntax
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind, plain, tokens
from openacr.lang.source import Span
from openacr.messages import (
    OUT_OF_DEFINE_SPACE,
    SYNTAX_ERROR,
    TYPE_MISMATCH,
    UNDEFINED_SYMBOL,
    UNDEFINED_VARIABLE,
    UNKNOWN_COMMAND,
    Message,
)

MOST_NAMES = 5
NEAR = 0.7  # how like two words are, of 1
WORDS = 4096  # whose hints are kept: a wrong word comes again and again
AFTER_A_TARGET = "after a target come other axes, a command or `:`"
NO_ALIASES = "DIM DEF(n) at SYS, before it, makes space for n aliases; a new card has none"
TEXT_AND_NUMBER = "STR$ makes text of a number, VAL a number of text"
_MEANT = "did you mean {}?"
_IS_MEANT = re.compile(re.escape(_MEANT).replace(r"\{\}", "(.+)"))
_WORDS = (UNKNOWN_COMMAND, SYNTAX_ERROR, UNDEFINED_SYMBOL, UNDEFINED_VARIABLE)


def hint_for(
    message: Message, text: str, span: Span | None, level: Level, names: Collection[str]
) -> str:
    """What may help against a message about a line; `names` are the aliases and axes there."""
    first = text.split()[0]
    word = plain(text)[span.column - 1 :][: span.length] if span else first
    if message is UNKNOWN_COMMAND and level is Level.SYS and _belongs_to_language(word, first):
        return "not valid at the system level; `PROG n` goes to a program"
    if message in _WORDS and (apart := _run_together(word.upper())):
        return f"letters without a blank are one word: write {apart}"
    if message in _WORDS and (close := _close_word(word, names)):
        return _MEANT.format(close)
    if message in (UNKNOWN_COMMAND, UNDEFINED_SYMBOL) and level is Level.PROG:
        return "no command, alias or axis of this program has this name"
    if message is OUT_OF_DEFINE_SPACE:
        return NO_ALIASES
    if message is TYPE_MISMATCH:
        return _called(text, span) or TEXT_AND_NUMBER
    return _usage(text, span, names) if message is SYNTAX_ERROR and span else ""


def meant(hint: str) -> str:
    """The word that a hint proposes in place of the one that was written; empty if it does not."""
    found = _IS_MEANT.fullmatch(hint)
    return found[1] if found else ""


def _belongs_to_language(*words: str) -> bool:
    return bool({word.upper() for word in words} & {*registry.keywords(), "PROGRAM"})


def _close_word(word: str, names: Collection[str]) -> str:
    if not word.rstrip("$").isalnum():
        return ""  # a call, not a word
    close = get_close_matches(word, sorted(names), n=1)
    if len(word) > 1:  # one letter is an axis, not a command with a letter missing
        close = close or _close_keywords(word.upper())
    return close[0] if close and close[0] != word.upper() else ""


@lru_cache(WORDS)
def _close_keywords(word: str) -> list[str]:
    """The command that is meant: the first letter is seldom the wrong one."""
    same_first = [known for known in registry.keywords() if known[0] == word[0]]
    return get_close_matches(word, same_first, n=1, cutoff=NEAR)


@lru_cache(WORDS)
def _run_together(word: str) -> str:
    """Two words of the language that are written as one, apart."""
    known = {*registry.keywords(), "P", "BIT"}
    ends = (end for end in range(len(word) - 1, 1, -1) if word[:end] in known)
    return next((f"{word[:end]} {word[end:]}" for end in ends if word[end:] in known), "")


def _usage(text: str, span: Span, names: Collection[str]) -> str:
    """How the function or command is written that a line fails to be."""
    if written := _called(text, span):
        return written
    try:
        found = tokens(text)
    except CardError:
        return ""
    row = command_before(found, span.column)
    if row is not None:
        return f"written: {syntax(row)}"
    return AFTER_A_TARGET if _begins_with_axis(found, names) else ""


def _begins_with_axis(found: list[Token], names: Collection[str]) -> bool:
    start = 1 if found[0].kind is TokenKind.NUMBER else 0
    return found[start].text.upper() in names


def _called(text: str, span: Span | None) -> str:
    try:
        function = function_at(tokens(text), span.column) if span else None
    except CardError:
        return ""
    return f"written: {call(function)}" if function else ""


def names_like(name: str, known: Iterable[str], what: str) -> str:
    """The name that was meant, or those there are."""
    there = sorted(known)
    if close := get_close_matches(name, there, n=1):
        return _MEANT.format(close[0])
    if not there:
        return f"there are no {what}"
    shown = ", ".join(there[:MOST_NAMES])
    return f"{what}: {shown}{', ...' if len(there) > MOST_NAMES else ''}"


def lines_near(number: int, known: Iterable[int]) -> str:
    """The lines around one that does not exist."""
    before = max((each for each in known if each < number), default=None)
    after = min((each for each in known if each > number), default=None)
    there = [str(each) for each in (before, after) if each is not None]
    return f"the nearest: {' and '.join(there)}" if there else "there are no other lines"
