"""A block in action: its words as numbers, and where it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.findings import CodeError

if TYPE_CHECKING:
    from openacr.cnc.canonical import Source
    from openacr.cnc.plan import Plan
    from openacr.cnc.program import Node

NEAR = 1e-4  # how far from a whole number a whole number may be


class Turn:
    """What a handler sees of its block."""

    __slots__ = ("has_moved", "is_confirmed", "node", "number", "plan", "words")

    def __init__(self, node: Node, plan: Plan, words: dict[str, float]) -> None:
        self.node = node
        self.plan = plan
        self.words = words
        self.number = 0.0  # of the code that acts
        self.is_confirmed = False  # G9
        self.has_moved = False

    @property
    def source(self) -> Source:
        """Where the block stands."""
        return self.node.source

    def get(self, letter: str, default: float = 0.0) -> float:
        """The value of a word."""
        return self.words.get(letter, default)

    def whole(self, letter: str, default: int = 0, code: str = "E204") -> int:
        """The value of a word that has to be a whole number."""
        value = self.words.get(letter)
        if value is None:
            return default
        nearest = round(value)
        if abs(value - nearest) > NEAR:
            raise self.fault(code, letter)
        return nearest

    @property
    def axes(self) -> list[tuple[int, str, float]]:
        """Axis, letter and value of the axis words."""
        return [(axis, letter, self.words[letter]) for axis, letter in self.plan.axes]

    def fault(self, code: str, letter: str = "", detail: str = "", hint: str = "") -> CodeError:
        """An error at a word of the block."""
        return CodeError(code, self.plan.column(letter), detail, hint)
