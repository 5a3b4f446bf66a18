"""A card at the end of a slow line: what a host sends arrives later, in pieces, in order.

All time is that of the card, so that every run is the same on any computer. A host that is killed
is a card to which nothing more arrives: a copy of the card is left alone from that tick on.
"""

import random
from collections import deque
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes

Reals = NDArray[np.float64]
AXES = 3
SAMPLES = [Sample(Watched.FP64, axes.psp_cnt[axis]) for axis in range(AXES)]


class SlowCard:
    """A card as a link takes it, with a line before it whose delays are drawn."""

    def __init__(self, card: Controller, chance: random.Random) -> None:
        self.card = card
        self.longest_tk = 0  # delay of what is sent, drawn anew for every piece of it
        self.leaves: list[int] = []  # ticks at which the card is copied
        self.copies: list[tuple[int, Any]] = []
        self._chance = chance
        self._under_way: deque[tuple[int, int, bytes]] = deque()
        self._answers: deque[tuple[int, bytes]] = deque()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.card, name)

    def open_stream(self, kind: StreamKind) -> int:
        return self.card.open_stream(kind)

    def _due_tk(self, after: int) -> int:
        delay_tk = self._chance.randint(0, self.longest_tk) if self.longest_tk else 0
        return max(after, self.card.lived_tk + delay_tk)

    def _pieces(self, data: bytes) -> Iterator[bytes]:
        while data and self.longest_tk:
            size = self._chance.randint(1, 400)
            yield data[:size]
            data = data[size:]
        if data:
            yield data

    def receive(self, stream: int, data: bytes) -> None:
        """Send bytes to the card; they arrive in order."""
        for piece in self._pieces(data):
            last = self._under_way[-1][0] if self._under_way else 0
            self._under_way.append((self._due_tk(last), stream, piece))
        self._deliver()

    def accepts_input(self, stream: int) -> bool:
        return self.card.accepts_input(stream)

    def take_output(self, stream: int) -> bytes:
        """What of the answers of the card has come back."""
        data = self.card.take_output(stream)
        if data:
            last = self._answers[-1][0] if self._answers else 0
            self._answers.append((self._due_tk(last), data))
        if self._answers and self._answers[0][0] <= self.card.lived_tk:
            return self._answers.popleft()[1]
        return b""

    def _deliver(self) -> None:
        while self._under_way and self._under_way[0][0] <= self.card.lived_tk:
            _, stream, data = self._under_way.popleft()
            self.card.receive(stream, data)

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Let card time pass; what is under way arrives in it."""
        left = ticks + round(seconds / self.card.period_s)
        while left > 0:
            now = self.card.lived_tk
            step = left
            if self._under_way:
                step = min(step, max(self._under_way[0][0] - now, 1))
            if self.leaves:
                step = min(step, max(self.leaves[0] - now, 1))
            self.card.advance(step)
            left -= step
            if self.leaves and self.card.lived_tk >= self.leaves[0]:
                self.leaves.pop(0)
                self.copies.append((len(self.places), self.card.snapshot()))
            self._deliver()

    @property
    def places(self) -> Reals:
        """Where the axes are commanded to since they are recorded, tick by tick [pulses]."""
        found: Reals = self.card.trace().values
        return found


def alone(copy: Controller, snapshot: Any, seconds: float) -> Reals:
    """Where the axes of a card are commanded to that nothing arrives at any more [pulses]."""
    copy.end_record()
    copy.restore(snapshot)
    copy.record(samples=SAMPLES)
    copy.advance(seconds=seconds)
    found: Reals = copy.trace().values
    return found
