"""What the handler of a command gets for its arguments."""

from __future__ import annotations

from msgspec import Struct


class Axis(Struct, frozen=True):
    """An axis by number, with the name it was called by (for reports)."""

    number: int
    name: str


class AxisValue(Struct, frozen=True):
    """An axis with the values given for it; none at all is a query."""

    axis: Axis
    values: tuple[float, ...] = ()

    @property
    def is_query(self) -> bool:
        """Whether the value was left out."""
        return not self.values

    @property
    def value(self) -> float:
        """The only or first value."""
        return self.values[0]


class AxisTarget(Struct, frozen=True):
    """A target of a coordinated move."""

    axis: Axis
    values: tuple[float, ...]
    incremental: bool = False

    @property
    def value(self) -> float:
        """The only or first value."""
        return self.values[0]


class BitState(Struct, frozen=True):
    """A flag, and whether it is meant set or (written with a minus) clear."""

    number: int
    clear: bool = False


class SignedParameter(Struct, frozen=True):
    """A parameter, and whether it was written with a minus."""

    number: int
    negative: bool = False


class ObjectRef(Struct, frozen=True):
    """A word with a number: ENC 0, PROG 3; number -1 where the word needs none (ALL, NONE)."""

    word: str
    number: int = -1
