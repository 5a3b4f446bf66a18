"""Lines a program is known to accept: by their shape, without reading them."""

from __future__ import annotations

from typing import NamedTuple

from openacr.basic.language.scope import Scope
from openacr.basic.memory.memory_cost import line_bytes, string_bytes
from openacr.lang.lexer import Token, TokenKind, tokens
from openacr.lang.shape import remark

MOST_SHAPES = 4096
_OF_VARYING_COST = frozenset((TokenKind.STRING, TokenKind.LABEL))


class _Cost(NamedTuple):
    """What the tokens of a shape cost but for its remark, if that is all that varies."""

    fixed: int
    has_remark: bool
    varies: bool


class KnownLines:
    """Shapes that have been accepted in one scope, with what lines of them cost.

    Another scope (axes attached, an alias defined) begins anew.
    """

    def __init__(self) -> None:
        self._scope = Scope()
        self._costs: dict[str, _Cost] = {}

    def cost(self, scope: Scope, shape: str, text: str) -> int | None:
        """What storing the line costs; None if its shape is not known here."""
        known = self._costs.get(shape)
        if known is None or not self._is_same(scope):
            return None
        if known.varies:
            return line_bytes(tokens(text))
        return known.fixed + (string_bytes(len(remark(text))) if known.has_remark else 0)

    def learn(self, scope: Scope, shape: str, found: list[Token]) -> None:
        """Remember a line that was accepted; digits in names would make shapes differ."""
        if scope.numbered:
            return
        if not self._is_same(scope) or len(self._costs) >= MOST_SHAPES:
            self._scope, self._costs = scope, {}
        varies = any(
            token.kind in _OF_VARYING_COST or isinstance(token.value, float) for token in found
        )
        said = [token for token in found if token.kind is not TokenKind.REMARK]
        self._costs[shape] = _Cost(line_bytes(said), len(said) < len(found), varies)

    def _is_same(self, scope: Scope) -> bool:
        known = self._scope
        if scope is known:
            return True
        return scope.axes == known.axes and scope.aliases is known.aliases
