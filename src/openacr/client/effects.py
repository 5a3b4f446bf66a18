"""Effects that the generators of a conversation with a card yield, to be performed outside."""

from collections.abc import Generator
from typing import TypeAlias, TypeVar

from msgspec import Struct


class Open(Struct, frozen=True):
    """Open the link."""


class Close(Struct, frozen=True):
    """Close the link."""


class Send(Struct, frozen=True):
    """Send these bytes in one write."""

    data: bytes


class Receive(Struct, frozen=True):
    """Wait for bytes (None: forever); the result is empty when none came in time."""

    wait_s: float | None


class Pause(Struct, frozen=True):
    """Let time pass."""

    seconds: float


Effect: TypeAlias = Open | Close | Send | Receive | Pause
T = TypeVar("T")
Op: TypeAlias = Generator[Effect, bytes | None, T]
