"""Effects that the generators of a conversation with a card yield, to be performed outside."""

from collections.abc import Generator
from dataclasses import dataclass
from typing import TypeAlias, TypeVar


@dataclass(frozen=True, slots=True)
class Open:
    """Open the link."""


@dataclass(frozen=True, slots=True)
class Close:
    """Close the link."""


@dataclass(frozen=True, slots=True)
class Send:
    """Send these bytes in one write."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Receive:
    """Wait for bytes (None: forever); the result is empty when none came in time."""

    wait_s: float | None


@dataclass(frozen=True, slots=True)
class Pause:
    """Let time pass."""

    seconds: float


Effect: TypeAlias = Open | Close | Send | Receive | Pause
T = TypeVar("T")
Op: TypeAlias = Generator[Effect, bytes | None, T]
