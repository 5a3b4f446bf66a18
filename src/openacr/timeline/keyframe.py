"""Keyframes: snapshots that share what they have in common with the first one."""

from __future__ import annotations

from typing import TypeAlias

import msgspec
import numpy as np
import numpy.typing as npt

from openacr.controller.snapshot import Beside, Snapshot

_WORD = np.dtype("<u8")
Words: TypeAlias = npt.NDArray[np.uint64]


class Base:
    """The first snapshot of a timeline, which keyframes are compared with."""

    def __init__(self, snapshot: Snapshot) -> None:
        self.snapshot = snapshot
        self.words: Words = np.frombuffer(snapshot.rows, _WORD)
        self.latest = snapshot.beside

    def shared(self, beside: Beside) -> tuple[Beside, int]:
        """Texts and queues, kept once while they do not change, and the bytes they take anew."""
        if beside == self.latest:
            return self.latest, 0
        self.latest = beside
        return beside, len(msgspec.msgpack.encode(beside))


class Keyframe:
    """The state of a card at the end of a tick, as the words that differ from the base."""

    def __init__(self, base: Base, snapshot: Snapshot, tick: int, entered: int) -> None:
        self._base = base
        words: Words = np.frombuffer(snapshot.rows, _WORD)
        self._places = np.flatnonzero(words != base.words).astype(np.uint32)
        self._values: Words = words[self._places]
        self._beside, beside_bytes = base.shared(snapshot.beside)
        self.tick = tick
        self.entered = entered  # inputs before it, counted from the beginning of the timeline
        self.size_bytes = self._places.nbytes + self._values.nbytes + beside_bytes

    @property
    def snapshot(self) -> Snapshot:
        """The snapshot it was made of."""
        words = self._base.words.copy()
        words[self._places] = self._values
        return msgspec.structs.replace(
            self._base.snapshot, rows=words.tobytes(), beside=self._beside
        )
