"""The block that is executed: its words as numbers, and its position in the program."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from openacr.cnc.canonical import Source
from openacr.cnc.program.program import Node
from openacr.cnc.reading.blocks import Word
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import NEAR


class BlockWords(Protocol):
    """The words of a block as planned: which are axes, which belong to the active motion."""

    @property
    def axes(self) -> tuple[tuple[int, str], ...]:
        """Axis numbers and letters of the axis words."""

    @property
    def words(self) -> Mapping[str, Word]:
        """The words by letter."""

    @property
    def is_polar(self) -> bool:
        """Whether the block has @ or ^ instead of X and Y."""

    @property
    def modal_words(self) -> tuple[str, ...]:
        """Letters left for the active motion or cycle."""

    @property
    def code_names(self) -> list[str]:
        """The G and M codes of the block as written."""

    @property
    def taken(self) -> frozenset[str]:
        """Letters that codes of the block take for themselves."""

    @property
    def motion_code(self) -> float | None:
        """The number of the G code of motion in the block (G0 to G3), if it has one."""

    @property
    def is_motion(self) -> bool:
        """Whether the block moves as the active motion or cycle does."""

    def column(self, letter: str) -> int:
        """The column of a word, 1 based; that of the first word where it is absent."""


class BlockContext:
    """The block as a handler sees it."""

    __slots__ = ("has_moved", "is_confirmed", "node", "number", "plan", "words")

    def __init__(self, node: Node, plan: BlockWords, words: dict[str, float]) -> None:
        self.node = node
        self.plan = plan
        self.words = words
        self.number = 0.0  # of the code that acts
        self.is_confirmed = False  # G9
        self.has_moved = False

    @property
    def source(self) -> Source:
        """File and line of the block."""
        return self.node.source

    def get(self, letter: str, default: float = 0.0) -> float:
        """The value of a word."""
        return self.words.get(letter, default)

    def whole(self, letter: str, default: int = 0, code: str = "E204") -> int:
        """The value of a word, which has to be a whole number."""
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
        """Make an error at a word of the block."""
        return CodeError(code, self.plan.column(letter), detail, hint)
