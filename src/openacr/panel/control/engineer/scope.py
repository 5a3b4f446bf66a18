"""The scope: up to eight parameters and flags of the card, sampled in its time.

Samples are numbered through all captures, so that those of an earlier one are known as such.
They come as blocks of any length; a trigger is found at the same sample however they are cut.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from openacr.errors import UserError
from openacr.map import Flag, Parameter

CHANNELS = 8
LEAST_SAMPLES = 10  # of a sweep
MOST_SAMPLES = 100_000
EITHER = 0  # slope of a trigger; else 1 rising, -1 falling

Block: TypeAlias = NDArray[np.float64]  # samples of all channels, shape (channels, samples)
Samples: TypeAlias = tuple[int, Block, float]  # number of the first, block, period


@dataclass(frozen=True, slots=True)
class Trigger:
    """A channel that crosses a level; `before` is the share of samples before it."""

    channel: int
    level: float
    slope: int
    mode: str  # auto, normal or single
    before: float

    def crossings(self, values: Block) -> NDArray[np.intp]:
        """The places of values at or past the level whose predecessor has not reached it."""
        crossed = np.zeros(max(0, len(values) - 1), bool)
        for slope in (1, -1):
            if self.slope in (slope, EITHER):
                over = (values - self.level) * slope
                crossed |= (over[:-1] < 0.0) & (over[1:] >= 0.0)
        return np.flatnonzero(crossed) + 1


@dataclass(slots=True)
class Capture:
    """A capture under way."""

    channels: list[Parameter | Flag]
    period_s: float
    samples: int
    trigger: Trigger | None
    owner: int | None = None  # the client that began it
    number: int = 0  # of this panel
    first: int = 0  # number of the first sample
    next: int = 0  # number of the sample that follows
    since: int = 0  # number of the first sample after the last gap
    triggered_at: int | None = None  # the latest trigger
    swept_at: int | None = None  # the trigger of the latest sweep that is whole
    is_waiting: bool = True  # for a trigger
    is_over: bool = False
    fresh: list[tuple[int, Block]] = field(default_factory=list)  # not sent yet
    last: float | None = None  # of the channel of the trigger
    tick: int | None = None  # of the card at the first sample, where every one has its tick

    @property
    def before(self) -> int:
        """Samples of a sweep before its trigger."""
        return 0 if self.trigger is None else round(self.trigger.before * self.samples)

    def data(self) -> dict[str, Any]:
        """The state of the capture."""
        return {
            "number": self.number,
            "running": not self.is_over,
            "channels": [name_of(each) for each in self.channels],
            "period_s": self.period_s,
            "first": self.first,
            "samples": self.samples,
            "trigger": self.triggered_at,
            "swept": self.swept_at,
            "tick": self.tick,
        }


def name_of(channel: Parameter | Flag) -> str:
    """The short name of a parameter or flag: P12290, BIT516."""
    return f"{'BIT' if isinstance(channel, Flag) else 'P'}{channel.number}"


def joined(earlier: Samples, later: Samples) -> Samples:
    """Samples that wait and those that follow, as one piece of at most MOST_SAMPLES, the newest.

    Samples of another capture, and those after a gap, take the place of the earlier ones.
    """
    first, block, period_s = earlier
    if later[0] != first + block.shape[1] or len(block) != len(later[1]):
        return later
    both = np.concatenate((block, later[1]), axis=1)
    over = max(0, both.shape[1] - MOST_SAMPLES)
    return first + over, both[:, over:], period_s


class Scope:
    """The scope of one machine."""

    def __init__(self) -> None:
        self.capture: Capture | None = None

    @property
    def running(self) -> Capture | None:
        """The capture that takes samples."""
        capture = self.capture
        return None if capture is None or capture.is_over else capture

    def arm(
        self,
        channels: Sequence[Parameter | Flag],
        period_s: float,
        samples: int,
        trigger: Trigger | None,
        owner: int | None = None,
    ) -> Capture:
        """Begin a capture."""
        if not 1 <= len(channels) <= CHANNELS:
            raise UserError(f"{len(channels)} channels: the scope has 1 to {CHANNELS}")
        if trigger is not None and not 0 <= trigger.channel < len(channels):
            raise UserError(f"trigger channel {trigger.channel}: there are {len(channels)}")
        first = 0 if self.capture is None else self.capture.next + 1
        self.capture = Capture(
            list(channels), period_s, samples, trigger, owner, first, first, first
        )
        return self.capture

    def stop(self) -> None:
        """End the capture."""
        if self.running is not None:
            self.running.is_over = True

    def add(self, block: Block) -> None:
        """Add the samples that follow; those after the end of a single capture are dropped."""
        capture = self.running
        if capture is None or not block.shape[1]:
            return
        if capture.trigger is not None:
            block = block[:, : self._follow(capture, capture.trigger, block)]
        capture.fresh.append((capture.next, block))
        capture.next += block.shape[1]

    def _follow(self, capture: Capture, trigger: Trigger, block: Block) -> int:
        """Find triggers and ends of sweeps in a block; returns how many samples belong to it."""
        values, first = block[trigger.channel], capture.next
        if capture.last is not None:
            values, first = np.concatenate(([capture.last], values)), first - 1
        capture.last = float(values[-1])
        crossings = first + trigger.crossings(values)
        size = int(block.shape[1])
        known, earliest = capture.next + size, capture.since + capture.before
        while True:
            if capture.is_waiting:
                found = crossings[crossings >= earliest]
                if not len(found):
                    return size
                capture.triggered_at, capture.is_waiting = int(found[0]), False
            end = (capture.triggered_at or 0) - capture.before + capture.samples
            if end > known:
                return size
            capture.swept_at = capture.triggered_at
            if trigger.mode == "single":
                self.stop()
                return end - capture.next
            capture.is_waiting, earliest = True, end

    def break_off(self) -> None:
        """Leave a gap: what follows belongs to no sweep that has begun."""
        capture = self.running
        if capture is not None:
            capture.next += 1
            capture.since = capture.next
            capture.last, capture.is_waiting = None, True
            capture.triggered_at = capture.swept_at

    def follow(self, value: float) -> None:
        """The channel of the trigger had this value before the next sample, after a gap, too."""
        if self.running is not None:
            self.running.last = value

    def take(self) -> Samples | None:
        """The samples that were not taken yet, up to a gap: number of the first, block, period."""
        capture = self.capture
        if capture is None or not capture.fresh:
            return None
        first, block = capture.fresh.pop(0)
        blocks, next_ = [block], first + block.shape[1]
        while capture.fresh and capture.fresh[0][0] == next_:
            block = capture.fresh.pop(0)[1]
            blocks.append(block)
            next_ += block.shape[1]
        return first, np.concatenate(blocks, axis=1), capture.period_s
