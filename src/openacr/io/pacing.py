"""Real time for a card: how many ticks are due, and how well that was kept.

The only clock of the program is read by the callers in this package; times come in as
arguments (seconds of a monotonic clock). Deadlines are absolute, so that rounding and late
wake-ups never add up. A card that cannot keep up is not driven into a spiral: work per
call is bounded, and a lag beyond MAX_LAG_S is given up and counted as lost.
"""

import logging
import math
from dataclasses import dataclass, field

from openacr.errors import UserError

log = logging.getLogger(__name__)

BURST_S = 0.010  # card time advanced at once, so that sockets are served in between
MAX_LAG_S = 0.25
AHEAD_S = 0.002  # how far an answer may be fetched from the future
BIN_S = 0.0001
BINS = 4096


@dataclass(frozen=True, slots=True)
class PacingReport:
    """Deviation of card time from the wall clock, measured at every wake-up."""

    observations: int
    median_s: float
    p99_s: float
    worst_s: float
    lost_s: float  # wall-clock time the card has skipped

    def __str__(self) -> str:
        return (
            f"pacing error {1e3 * self.median_s:.1f} ms (median), {1e3 * self.p99_s:.1f} ms"
            f" (99 %), {1e3 * self.worst_s:.1f} ms (worst); lost {self.lost_s:.2f} s"
        )


@dataclass(slots=True)
class _Errors:
    """Histogram of pacing errors with bins of 0.1 ms; the last one takes the rest."""

    counts: list[int] = field(default_factory=lambda: [0] * BINS)
    total: int = 0
    worst_s: float = 0.0

    def add(self, error_s: float) -> None:
        self.counts[min(BINS - 1, int(error_s / BIN_S))] += 1
        self.total += 1
        self.worst_s = max(self.worst_s, error_s)

    def percentile(self, part: float) -> float:
        """Upper edge of the bin that holds this part of the observations."""
        wanted, seen = part * self.total, 0
        for at, count in enumerate(self.counts):
            seen += count
            if count and seen >= wanted:
                return min(self.worst_s, (at + 1) * BIN_S)
        return 0.0


class Pacer:
    """Relates ticks of a card to seconds of a clock, `speed` times as fast as real.

    A lag that is given up is warned of, unless the card `keeps_time` by itself.
    """

    def __init__(self, period_s: float, speed: float = 1.0, *, keeps_time: bool = False) -> None:
        if not (math.isfinite(speed) and speed > 0):
            raise UserError(f"speed {speed} is not above 0 (1.0 is real time)")
        self.tick_s = period_s / speed  # wall-clock time of one tick
        self.speed = speed
        self._keeps_time = keeps_time
        self._start_s = 0.0
        self._ticks = 0
        self._lost_s = 0.0
        self._errors = _Errors()
        self._burst_tk = max(1, round(BURST_S / period_s))

    def start(self, now_s: float) -> None:
        """Let the first tick be due one period from now."""
        self._start_s, self._ticks = now_s, 0

    def lag_s(self, now_s: float) -> float:
        """Wall-clock time by which the card is late; negative when it is ahead."""
        return now_s - self._start_s - self._ticks * self.tick_s

    def due_tk(self, now_s: float) -> int:
        """Ticks to advance now; a bounded number, more may be due right afterwards."""
        lag_s = self.lag_s(now_s)
        self._errors.add(abs(lag_s))
        if lag_s > MAX_LAG_S:
            self._give_up(lag_s)
            return 1
        return min(self._burst_tk, max(0, int(lag_s / self.tick_s)))

    def _give_up(self, lag_s: float) -> None:
        """Forget a lag that cannot be caught up, keeping one tick due."""
        if not self._lost_s and not self._keeps_time:
            log.warning("the card is %.2f s late and cannot keep real time", lag_s)
        self._start_s += lag_s - self.tick_s
        self._lost_s += lag_s - self.tick_s

    def advanced(self, ticks: int) -> None:
        """Note that the card was advanced."""
        self._ticks += ticks

    def may_run_ahead(self, now_s: float) -> bool:
        """One more tick may be taken before it is due, to answer a host at once."""
        return self.lag_s(now_s) > -AHEAD_S

    def pause_s(self, now_s: float, longest_s: float) -> float:
        """How long to sleep before more ticks are due; 0 when some are due already."""
        return min(longest_s, max(0.0, self.tick_s - self.lag_s(now_s)))

    def report(self) -> PacingReport:
        """The figures so far."""
        errors = self._errors
        return PacingReport(
            errors.total,
            errors.percentile(0.5),
            errors.percentile(0.99),
            errors.worst_s,
            self._lost_s,
        )
