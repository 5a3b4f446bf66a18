"""Lines a program is known to accept: by their shape, without reading them."""

from __future__ import annotations

import re
from collections.abc import Callable

from msgspec import Struct

from openacr.basic.language.scope import Scope
from openacr.basic.memory.memory_cost import constant_bytes, line_bytes
from openacr.lang.lexer import Token, TokenKind, decimal, tokens
from openacr.lang.shape import remark

MOST_SHAPES = 4096
_TEXTS = frozenset((TokenKind.STRING, TokenKind.LABEL, TokenKind.REMARK))
_FLOAT = re.compile(r"(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+")


class LineCost(Struct, frozen=True):
    """What lines of one shape cost: what is the same in all, and what is of each."""

    fixed: int
    varying: Callable[[str], int] | None = None

    def bytes(self, text: str) -> int:
        """What a line costs."""
        return self.fixed if self.varying is None else self.fixed + self.varying(text)


def line_cost(text: str, shape: str, found: list[Token]) -> LineCost | None:
    """The cost of lines of the shape of a line; None where it takes the tokens of each of them."""
    kinds = {token.kind for token in found}
    texts = kinds & _TEXTS
    if any(isinstance(token.value, float) for token in found):
        varying = None if texts else _floats
    elif not texts:
        return LineCost(line_bytes(found))
    elif texts == {TokenKind.STRING}:
        varying = _strings
    elif TokenKind.REMARK in texts and shape.upper().find("REM") != len(shape) - 3:
        varying = None  # it is no remark to the shape
    elif texts == {TokenKind.REMARK}:
        varying = _remark
    else:
        varying = None if kinds & {TokenKind.STRING, TokenKind.NUMBER} else _length
    if varying is None or "'" in shape:
        return None
    return LineCost(line_bytes(found) - varying(text), varying)


def _length(text: str) -> int:
    """Of lines that differ in the digits of labels and in the remark."""
    return len(text.rstrip())


def _remark(text: str) -> int:
    return len(remark(text))


def _strings(text: str) -> int:
    return sum(map(len, text.split('"')[1::2]))


def _floats(text: str) -> int:
    return sum(constant_bytes(decimal(each)) for each in _FLOAT.findall(text))


class KnownLines:
    """Shapes that have been accepted in one scope, with what lines of them cost.

    Another scope (axes attached, an alias defined) begins anew.
    """

    def __init__(self) -> None:
        self._scope = Scope()
        self._costs: dict[str, LineCost | None] = {}

    def cost(self, scope: Scope, shape: str, text: str) -> int | None:
        """What storing the line costs; None if its shape is not known here."""
        if shape not in self._costs or not self._is_same(scope):
            return None
        known = self._costs[shape]
        return line_bytes(tokens(text)) if known is None else known.bytes(text)

    def learn(self, scope: Scope, shape: str, text: str, found: list[Token]) -> None:
        """Remember a line that was accepted; digits in names would make shapes differ."""
        if scope.numbered:
            return
        if not self._is_same(scope) or len(self._costs) >= MOST_SHAPES:
            self._scope, self._costs = scope, {}
        self._costs[shape] = line_cost(text, shape, found)

    def _is_same(self, scope: Scope) -> bool:
        known = self._scope
        if scope is known:
            return True
        return scope.axes == known.axes and scope.aliases is known.aliases
