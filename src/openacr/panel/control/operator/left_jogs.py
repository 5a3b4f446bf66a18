"""Jogs that were begun and not ended: what they have changed on the card is set back later.

A panel that is killed or loses its link within a jog leaves the offset and the jog speed of that
jog on the card. Both are noted in a file beside the store before they are changed; the next
session of the same card sets them back once the axis rests.
"""

import os
from contextlib import suppress
from pathlib import Path

import msgspec
from msgspec import Struct

from openacr.client import Card
from openacr.client.axis_jog import Jogged, set_back
from openacr.client.errors import RefusedError

NAME = "jogs.json"
EVERY_S = 1.0  # between two attempts to set something back


class LeftJog(Struct, frozen=True):
    """One jog that was begun: its card, its axis, the speed before it and its own, in units/s."""

    card: str
    axis: int
    own_ups: float
    speed_ups: float


class LeftJogs:
    """The noted jogs of one card; without a folder they are known to this process alone."""

    def __init__(self, folder: Path | None, card: str) -> None:
        self._path = None if folder is None else folder / NAME
        self._card = card
        self._all = self._read()
        self._due_s = -EVERY_S

    def note(self, axis: int, own_ups: float, speed_ups: float) -> None:
        """An axis is about to be jogged."""
        self._drop(axis)
        self._all.append(LeftJog(self._card, axis, own_ups, speed_ups))
        self._write()

    def forget(self, axis: int) -> None:
        """The jog of an axis has ended, and nothing of it is left on the card."""
        if self.has(axis):
            self._drop(axis)
            self._write()

    def has(self, axis: int) -> bool:
        """Whether something of a jog may be left on an axis."""
        return any(self._is_of(each, axis) for each in self._all)

    def axes(self, now_s: float) -> list[int]:
        """The axes on which something may be left, where it is time to try again."""
        if self._due_s - EVERY_S <= now_s < self._due_s:  # a new session counts from 0
            return []
        self._due_s = now_s + EVERY_S
        return [each.axis for each in self._all if each.card == self._card]

    def set_back(self, card: Card, jogged: Jogged) -> str:
        """Set back what is left on an axis, if it can be; what was done, in words."""
        left = next(each for each in self._all if self._is_of(each, jogged.axis))
        try:
            done = set_back(card, jogged, left.own_ups, left.speed_ups)
        except RefusedError:
            return ""  # tried again
        if done is not None:
            self.forget(jogged.axis)
        return done or ""

    def _is_of(self, each: LeftJog, axis: int) -> bool:
        return (each.card, each.axis) == (self._card, axis)

    def _drop(self, axis: int) -> None:
        self._all = [each for each in self._all if not self._is_of(each, axis)]

    def _read(self) -> list[LeftJog]:
        if self._path is None:
            return []
        try:
            return msgspec.json.decode(self._path.read_bytes(), type=list[LeftJog])
        except (OSError, msgspec.DecodeError):
            return []  # none yet; what cannot be read is not guessed

    def _write(self) -> None:
        if self._path is None:
            return
        partial = self._path.with_suffix(".part")
        with suppress(OSError):  # a full disk does not keep an axis from being jogged
            partial.write_bytes(msgspec.json.encode(self._all))
            os.replace(partial, self._path)
