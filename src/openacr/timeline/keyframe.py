"""Keyframes: snapshots that share what they have in common with the first one."""

from __future__ import annotations

import msgspec
import numpy as np

from openacr.controller.controller import Controller
from openacr.controller.snapshot import Beside, Snapshot
from openacr.engine.watches import Words


class Base:
    """The first snapshot of a timeline, which keyframes are compared with."""

    def __init__(self, snapshot: Snapshot) -> None:
        self.snapshot = snapshot
        self.words: Words = np.frombuffer(snapshot.rows, np.uint64)
        self.latest = snapshot.beside

    def shared(self, beside: Beside) -> tuple[Beside, int]:
        """Texts and queues, kept once while they do not change, and the bytes they take anew."""
        if beside == self.latest:
            return self.latest, 0
        self.latest = beside
        return beside, len(msgspec.msgpack.encode(beside))


class Keyframe:
    """The state of a card at the end of a tick, as the words that differ from the base."""

    def __init__(self, base: Base, card: Controller, entered: int) -> None:
        self._base = base
        self._places, self._values = card.differences(base.words)
        self._beside, beside_bytes = base.shared(card.beside())
        self.tick = card.lived_tk
        self.entered = entered  # inputs before it, counted from the beginning of the timeline
        self.size_bytes = self._places.nbytes + self._values.nbytes + beside_bytes

    @property
    def snapshot(self) -> Snapshot:
        """The whole state."""
        rows = bytearray(self._base.snapshot.rows)
        np.frombuffer(rows, np.uint64)[self._places] = self._values
        return msgspec.structs.replace(self._base.snapshot, rows=rows, beside=self._beside)
