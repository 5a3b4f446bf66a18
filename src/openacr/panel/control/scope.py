"""The scope: up to four parameters of the card, sampled in its time.

A card in this process is stopped at every sample; an exchange with the host lasts a few ticks,
and the sample after it is late by them. Of another card every look of the control thread is a
sample.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from openacr.errors import UserError

CHANNELS = 4
MOST_SAMPLES = 100_000
Samples = tuple[int, list[list[float]], float]  # number of the first, channels, period


@dataclass(frozen=True, slots=True)
class Trigger:
    """A channel that crosses a level; `before` is the share of samples before it."""

    channel: int
    level: float
    slope: int
    mode: str  # auto, normal or single
    before: float


@dataclass(slots=True)
class Capture:
    """A capture under way."""

    parameters: list[int]
    period_s: float
    samples: int
    trigger: Trigger | None
    count: int = 0  # samples taken
    triggered_at: int | None = None
    is_over: bool = False
    fresh: list[list[float]] = field(default_factory=list)  # by channel, not sent yet
    first: int = 0  # number of the first of them
    last: list[float] | None = None

    def data(self) -> dict[str, Any]:
        """The state of the capture."""
        return {
            "running": not self.is_over,
            "parameters": self.parameters,
            "period_s": self.period_s,
            "samples": self.samples,
            "taken": self.count,
            "trigger": self.triggered_at,
        }


def joined(earlier: Samples, later: Samples) -> Samples:
    """Samples that wait and those that follow, as one piece of at most MOST_SAMPLES, the newest.

    Samples of another capture, and those after a gap, take the place of the earlier ones.
    """
    first, channels, period_s = earlier
    if later[0] != first + len(channels[0]) or len(channels) != len(later[1]):
        return later
    both = [[*a, *b] for a, b in zip(channels, later[1], strict=True)]
    over = max(0, len(both[0]) - MOST_SAMPLES)
    return first + over, [channel[over:] for channel in both], period_s


class Scope:
    """The scope of one machine."""

    def __init__(self) -> None:
        self.capture: Capture | None = None
        self.changed: Callable[[], None] = lambda: None

    @property
    def every_s(self) -> float:
        """Time between two samples; 0 while nothing is captured."""
        capture = self.capture
        return 0.0 if capture is None or capture.is_over else capture.period_s

    def arm(
        self,
        parameters: Sequence[int],
        period_s: float,
        samples: int,
        trigger: Trigger | None,
    ) -> None:
        """Begin a capture."""
        if not 1 <= len(parameters) <= CHANNELS:
            raise UserError(f"{len(parameters)} channels: the scope has 1 to {CHANNELS}")
        if trigger is not None and not 0 <= trigger.channel < len(parameters):
            raise UserError(f"trigger channel {trigger.channel}: there are {len(parameters)}")
        self.capture = Capture(list(parameters), period_s, min(samples, MOST_SAMPLES), trigger)
        self.capture.fresh = [[] for _ in parameters]
        self.changed()

    def stop(self) -> None:
        """End the capture."""
        if self.capture is not None and not self.capture.is_over:
            self.capture.is_over = True
            self.changed()

    def add(self, values: Sequence[float]) -> None:
        """Add one sample of every channel."""
        capture = self.capture
        if capture is None or capture.is_over:
            return
        for channel, value in zip(capture.fresh, values, strict=True):
            channel.append(value)
        self._watch(capture, values)
        capture.count += 1
        capture.last = list(values)
        self._end(capture)

    def _watch(self, capture: Capture, values: Sequence[float]) -> None:
        trigger, last = capture.trigger, capture.last
        if trigger is None or last is None or capture.triggered_at is not None:
            return
        if capture.count < trigger.before * capture.samples:
            return
        before = (last[trigger.channel] - trigger.level) * trigger.slope
        now = (values[trigger.channel] - trigger.level) * trigger.slope
        if before < 0.0 <= now:
            capture.triggered_at = capture.count
            self.changed()

    def _end(self, capture: Capture) -> None:
        """A single capture ends when it is full; the others begin again."""
        trigger = capture.trigger
        if trigger is None:
            return
        at = capture.triggered_at
        if at is None:
            return
        if capture.count - at < (1.0 - trigger.before) * capture.samples:
            return
        if trigger.mode == "single":
            capture.is_over = True
        else:
            capture.triggered_at = None
        self.changed()

    def take(self) -> Samples | None:
        """The samples that were not taken yet: the number of the first, channels, period."""
        capture = self.capture
        if capture is None or not capture.fresh or not capture.fresh[0]:
            return None
        fresh, first = capture.fresh, capture.first
        capture.fresh = [[] for _ in fresh]
        capture.first = first + len(fresh[0])
        return first, fresh, capture.period_s
