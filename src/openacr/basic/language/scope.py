"""What the words of a line may mean beside those of the language: axes and aliases."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct, field

from openacr.basic.language.nodes import Expr
from openacr.basic.language.registry import Level
from openacr.lang.lexer import Token, TokenKind
from openacr.models import Feature

_NAME_PARTS = frozenset((TokenKind.WORD, TokenKind.NUMBER))


class Scope(Struct, frozen=True):
    """What a line may refer to: the level, the program's axes and all aliases.

    `stored` lines belong to a program, others are executed at once. Commands that need what the
    card `lacks` are refused.
    """

    level: Level = Level.PROG
    stored: bool = False
    axes: frozenset[str] = frozenset()
    aliases: Mapping[str, Expr] = field(default_factory=dict)
    numbered: frozenset[str] = frozenset()  # the aliases that hold digits
    lacks: Feature = Feature.NONE


def join_names(found: list[Token], names: frozenset[str]) -> None:
    """Make one word of the words and numbers that spell one of these names without a gap."""
    for at, first in enumerate(found):
        if first.kind is not TokenKind.WORD:
            continue
        run, name, stop = "", "", at
        for end in range(at, len(found)):
            if found[end].kind not in _NAME_PARTS or found[end].column != first.column + len(run):
                break
            run += found[end].text
            if run in names:  # the longest counts
                name, stop = run, end + 1
        if name:
            found[at:stop] = [Token(TokenKind.WORD, name, name.upper(), first.line, first.column)]
