r"""Prediction of the run time of a program from its plan, without a card.

The card runs each move from the speed the move before it ended with, up to its feed and
down to the speed it was sent with, at constant acceleration a. Over a length L

    end      v1 = min(planned, sqrt(v0^2 + 2 a L))    what can be reached at all
    peak     vp = min(feed, sqrt((2 a L + v0^2 + v1^2) / 2))
    time     (vp - v0)/a + (vp - v1)/a + (L - ramps)/vp

so the sum over all moves is the run time, without the ticks of a card. Corners that the card
rounds are passed in two halves at a constant acceleration each, the line between two of them
as above. Waits for the operator and for signals count as zero.
"""

import math
from dataclasses import dataclass
from typing import Protocol

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.encoding import Encoder, Job
from openacr.mill.plan.planning import CornerRules, Planner, backward_pass
from openacr.mill.plan.rounding import Corner

TOGETHER = 512  # moves planned at once
# Parts of a move at constant acceleration: length, speed at the begin and at the end. Plain
# tuples, because every move of a program has three of them.
Phases = list[tuple[float, float, float]]
MOTIONS = c.Rapid | c.Line | c.Arc | c.Polyline | c.Probe | c.Moves


@dataclass(slots=True)
class Prediction:
    """Run time in seconds by kind of motion, and the count of moves."""

    rapid_s: float = 0.0
    feed_s: float = 0.0
    dwell_s: float = 0.0
    moves: int = 0

    @property
    def time_s(self) -> float:
        """The whole run time."""
        return self.rapid_s + self.feed_s + self.dwell_s


class Reader(Protocol):
    """Observer of the moves while their times are added up."""

    def read(self, job: Job) -> None:
        """Receive a move that is not planned yet."""

    def passed(self, job: Job, phases: Phases) -> None:
        """Receive a planned move and its phases."""

    def rested(self, seconds: float) -> None:
        """Receive a stop, with the time of its dwell or 0."""


class Predictor:
    """Adds up the times of moves, planned as in a run."""

    def __init__(
        self,
        settings: Settings,
        begin: c.Point,
        *,
        is_dry: bool = False,
        rounds: bool = True,
        reader: Reader | None = None,
    ) -> None:
        """`rounds`: as on the virtual machine, which supports path tolerances."""
        self._encoder = Encoder(settings, is_dry=is_dry, rounds=rounds)
        rules = CornerRules.of(settings.speeds)
        self._planner: Planner[Job] = Planner(rules, settings.forward_threshold)
        self._position = begin
        self._speed_ups = 0.0
        self._entry_corner: Corner | None = None
        self._reader = reader
        self.found = Prediction()

    def add(self, entry: c.Entry) -> None:
        """Add the next entry of the program."""
        if isinstance(entry, MOTIONS):
            for job in self._encoder.jobs(entry, self._position):
                self._move(job)
            if isinstance(entry, c.Probe):
                self.rest()
        elif isinstance(entry, c.Say | c.SetCell | c.BlockEnd):
            return
        else:
            self.rest(entry.seconds if isinstance(entry, c.Dwell) else 0.0)

    def _move(self, job: Job) -> None:
        if self._reader is not None:
            self._reader.read(job)
        self._position = job.finish
        if job.length_u > 0.0:
            self._planner.add(job)
        if self._planner.ready() >= TOGETHER:
            self._release(is_complete=False)

    def rest(self, dwell_s: float = 0.0) -> None:
        """Add a stop with a dwell."""
        self._release(is_complete=True)
        self._speed_ups, self._entry_corner = 0.0, None
        self.found.dwell_s += dwell_s
        if self._reader is not None:
            self._reader.rested(dwell_s)

    def close(self) -> None:
        """The program has ended: the last moves end at rest."""
        self.rest()

    def _release(self, *, is_complete: bool) -> None:
        for job in self._planner.release(1 << 30, is_complete=is_complete):
            phases = travel(job, self._speed_ups, self._entry_corner)
            self._speed_ups, self._entry_corner = phases[-1][2], job.corner
            if self._reader is not None:
                self._reader.passed(job, phases)
            seconds = sum(seconds_of(*phase) for phase in phases)
            self.found.moves += 1
            if job.is_rapid:
                self.found.rapid_s += seconds
            else:
                self.found.feed_s += seconds


def travel(job: Job, begin_ups: float, entry_corner: Corner | None = None) -> Phases:
    """The phases of a move that begins at a speed, after a rounded corner if there is one."""
    a, rest_u = job.ramp_ups2, job.length_u
    begin = min(begin_ups, job.feed_ups)
    may = backward_pass(job, entry_corner)
    phases: Phases = []
    if entry_corner is not None:
        line = math.sqrt(entry_corner.pass2(begin * begin, may.line, a))
        phases.append((entry_corner.reach_u, begin, line))
        begin, rest_u = line, rest_u - entry_corner.reach_u
    if job.corner is None:
        return phases + _straight(rest_u, begin, job.exit_ups, job.feed_ups, a)
    rest_u -= job.corner.reach_u
    phases += _straight(rest_u, begin, math.sqrt(may.ahead), job.feed_ups, a)
    entry = phases[-1][2]
    end = math.sqrt(job.corner.pass2(entry * entry, job.exit_ups**2, a))
    phases.append((job.corner.reach_u, entry, end))
    return phases


def _straight(length: float, begin: float, end: float, feed: float, a: float) -> Phases:
    """The phases of a straight part: up to the peak speed, constant, down to the end speed."""
    end = min(end, math.sqrt(begin * begin + 2.0 * a * length))
    peak = min(feed, math.sqrt(0.5 * (2.0 * a * length + begin * begin + end * end)))
    up = (peak * peak - begin * begin) / (2.0 * a)
    down = (peak * peak - end * end) / (2.0 * a)
    return [(up, begin, peak), (max(length - up - down, 0.0), peak, peak), (down, peak, end)]


def seconds_of(length: float, begin: float, end: float) -> float:
    """The time of one phase at constant acceleration."""
    return 2.0 * length / (begin + end) if length > 0.0 else 0.0
