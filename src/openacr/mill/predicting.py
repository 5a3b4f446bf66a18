r"""How long a program takes, from the plan alone.

The card runs each move from the speed the move before it ended with, up to its feed and
down to the speed it was sent with, at constant acceleration a. Over a length L

    end      v1 = min(planned, sqrt(v0^2 + 2 a L))    what can be reached at all
    peak     vp = min(feed, sqrt((2 a L + v0^2 + v1^2) / 2))
    time     (vp - v0)/a + (vp - v1)/a + (L - ramps)/vp

so the sum over all moves is the run time, without a card and without its ticks. Corners that
the card rounds are passed in two halves at a constant acceleration each, the line between two
of them as above. Waits for people and signals count as nothing.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from openacr.cnc import canonical as c
from openacr.mill.encoding import Encoder, Job
from openacr.mill.feeding import corner_rules
from openacr.mill.planning import Planner, pieces
from openacr.mill.rounding import Corner
from openacr.mill.settings import Settings

TOGETHER = 512  # moves planned at once
Passage = tuple[float, float, float]  # seconds, speed at the end, highest speed
MOTIONS = c.Rapid | c.Line | c.Arc | c.Polyline | c.Probe


@dataclass(slots=True)
class Prediction:
    """Seconds by kind; dwells are waits."""

    rapid_s: float = 0.0
    feed_s: float = 0.0
    dwell_s: float = 0.0
    moves: int = 0

    @property
    def time_s(self) -> float:
        """All of it."""
        return self.rapid_s + self.feed_s + self.dwell_s


class Reader(Protocol):
    """Who looks at the moves while their times are added up."""

    def read(self, job: Job) -> None:
        """A move of the program, not planned yet."""

    def passed(self, job: Job, top_ups: float) -> None:
        """A move that is planned, and the highest speed it comes to."""


class Predictor:
    """Adds up the times of moves as they would be sent."""

    def __init__(
        self,
        settings: Settings,
        begin: c.Point,
        *,
        is_dry: bool = False,
        rounds: bool = True,
        reader: Reader | None = None,
    ) -> None:
        """`rounds`: of the virtual machine, which knows path tolerances."""
        self._encoder = Encoder(settings, is_dry=is_dry, rounds=rounds)
        rules = corner_rules(settings.speeds)
        self._planner: Planner[Job] = Planner(rules, settings.forward_threshold)
        self._position = begin
        self._speed_ups = 0.0
        self._behind: Corner | None = None
        self._reader = reader
        self.found = Prediction()

    def add(self, entry: c.Entry) -> None:
        """One more entry of the program."""
        if isinstance(entry, MOTIONS):
            for job in self._encoder.jobs(entry, self._position):
                self._move(job)
            if isinstance(entry, c.Probe):
                self.rest()
        elif isinstance(entry, c.Say | c.SetCell | c.BlockEnd):
            return
        else:
            self.rest()
            if isinstance(entry, c.Dwell):
                self.found.dwell_s += entry.seconds

    def _move(self, job: Job) -> None:
        if self._reader is not None:
            self._reader.read(job)
        self._position = job.finish
        if job.length_u > 0.0:
            self._planner.add(job)
        if self._planner.ready() >= TOGETHER:
            self._take(is_complete=False)

    def rest(self) -> None:
        """The machine comes to rest here."""
        self._take(is_complete=True)
        self._speed_ups, self._behind = 0.0, None

    def _take(self, *, is_complete: bool) -> None:
        for job in self._planner.take(1 << 30, is_complete=is_complete):
            seconds, self._speed_ups, top = travel(job, self._speed_ups, self._behind)
            self._behind = job.corner
            if self._reader is not None:
                self._reader.passed(job, top)
            self.found.moves += 1
            if job.is_rapid:
                self.found.rapid_s += seconds
            else:
                self.found.feed_s += seconds


def travel(job: Job, begin_ups: float, behind: Corner | None = None) -> Passage:
    """The time of a move that begins at a speed, the speed it ends with and its highest."""
    a, way, seconds = job.ramp_ups2, job.length_u, 0.0
    begin = min(begin_ups, job.feed_ups)
    may = pieces(job, behind)
    if behind is not None:
        line = math.sqrt(behind.pass2(begin * begin, may.line, a))
        seconds += _even(behind.reach_u, begin, line)
        begin, way = line, way - behind.reach_u
    if job.corner is None:
        more, end, top = _straight(way, begin, job.exit_ups, job.feed_ups, a)
        return seconds + more, end, top
    way -= job.corner.reach_u
    more, entry, top = _straight(way, begin, math.sqrt(may.ahead), job.feed_ups, a)
    end = math.sqrt(job.corner.pass2(entry * entry, job.exit_ups**2, a))
    return seconds + more + _even(job.corner.reach_u, entry, end), end, top


def _even(way_u: float, begin: float, end: float) -> float:
    """The time of a way at constant acceleration."""
    return 2.0 * way_u / (begin + end)


def _straight(length: float, begin: float, end: float, feed: float, a: float) -> Passage:
    """The time of a straight way, the speed it ends with and its highest."""
    end = min(end, math.sqrt(begin * begin + 2.0 * a * length))
    peak = min(feed, math.sqrt(0.5 * (2.0 * a * length + begin * begin + end * end)))
    ramps = ((peak * peak - begin * begin) + (peak * peak - end * end)) / (2.0 * a)
    return (2.0 * peak - begin - end) / a + max(length - ramps, 0.0) / peak, end, peak


def predicted(
    entries: Iterable[c.Entry],
    settings: Settings,
    begin: c.Point,
    *,
    is_dry: bool = False,
    rounds: bool = True,
) -> Prediction:
    """The run time of a whole program."""
    predictor = Predictor(settings, begin, is_dry=is_dry, rounds=rounds)
    for entry in entries:
        predictor.add(entry)
    predictor.rest()
    return predictor.found
