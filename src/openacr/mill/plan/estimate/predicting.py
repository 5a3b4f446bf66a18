"""Prediction of the run time of a program from its plan, without a card.

The sum of the times of all moves (`planning_cy`) is the run time, without the ticks of a card.
With a jerk limit the ramps are S-curves (see `jerk_ramps`), and paths that have a tolerance as well
take the time of their control points, as in a run. Waits for the operator and
for signals count as zero.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from msgspec import Struct

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.route import Route
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.plan.moves.phases import Phases, duration_s
from openacr.mill.plan.moves.planning import Ramps

if TYPE_CHECKING:
    from openacr.mill.plan.curves.curve_times import CurveTimes
    from openacr.mill.plan.curves.planned_path import PlannedPath, Rows
    from openacr.mill.plan.moves.jerk_ramps import JerkRamps

TOGETHER = 512  # moves planned at once
MOTIONS = c.Rapid | c.Line | c.Arc | c.Polyline | c.Probe | c.Moves


class Prediction(Struct):
    """Run time in seconds by kind of motion, and the count of moves."""

    rapid_s: float = 0.0
    feed_s: float = 0.0
    dwell_s: float = 0.0
    moves: int = 0
    planned: int = 0  # moves of planned curves
    lost_s: float = 0.0  # by these, compared with their programmed feeds
    slowest_line: int = 0  # the line of the move that loses most
    slowest_s: float = 0.0

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

    def curve(self, points: Rows) -> None:
        """Receive all control points of a planned curve, after its moves; it ends at rest."""


class Timing(ABC):
    """Adds up the times of the moves of a program: the meaning of its entries."""

    def __init__(
        self, settings: Settings, begin: c.Point, *, is_dry: bool = False, rounds: bool = True
    ) -> None:
        """`rounds`: as on the virtual machine, which supports path tolerances."""
        self._encoder = Encoder(settings, is_dry=is_dry, rounds=rounds)
        self._position = begin

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

    @abstractmethod
    def _move(self, job: Job) -> None:
        """Plan a move."""

    @abstractmethod
    def rest(self, dwell_s: float = 0.0) -> None:
        """Add a stop with a dwell."""

    def close(self) -> None:
        """The program has ended: the last moves end at rest."""
        self.rest()


class Predictor(Timing):
    """Adds up the times of moves, planned as in a run."""

    def __init__(
        self,
        settings: Settings,
        begin: c.Point,
        *,
        is_dry: bool = False,
        rounds: bool = True,
        reader: Reader | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        """`rounds`: as on the virtual machine, which supports path tolerances.

        `progress` gets the line of every move that is planned.
        """
        super().__init__(settings, begin, is_dry=is_dry, rounds=rounds)
        self._route = Route(settings)
        self._curve: CurveTimes | None = None
        has_jerk = settings.speeds.jerk_ups3 > 0.0
        self._ramps: Ramps | JerkRamps = _jerk_ramps(self._encoder) if has_jerk else Ramps()
        self._reader, self._progress = reader, progress
        self.found = Prediction()

    def _move(self, job: Job) -> None:
        if self._reader is not None:
            self._reader.read(job)
        self._position = job.finish
        if job.length_u > 0.0:
            self._route.add(job)
        if self._route.ready() >= TOGETHER:
            self._release(is_complete=False)

    def rest(self, dwell_s: float = 0.0) -> None:
        """Add a stop with a dwell."""
        self._release(is_complete=True)
        self.found.dwell_s += dwell_s
        if self._reader is not None:
            self._reader.rested(dwell_s)

    def _release(self, *, is_complete: bool) -> None:
        """Pass everything that is planned, section after section."""
        while True:
            has_more = self._route.has_more
            if self._route.curve is not None:
                self._pass_curve(self._route.curve, is_complete=is_complete or has_more)
            else:
                self._pass_moves(is_complete=is_complete)
            if not has_more:
                return
            self._route.go_on()

    def _pass_moves(self, *, is_complete: bool) -> None:
        for job in self._route.release(1 << 30, is_complete=is_complete):
            self._pass(job, self._ramps.travel(job))

    def _pass_curve(self, path: PlannedPath, *, is_complete: bool) -> None:
        from openacr.mill.plan.curves.curve_times import (
            CurveTimes,  # loads numpy: most runs have none
        )

        if self._curve is None or self._curve.path is not path:
            self._curve = CurveTimes(path, self._reader.curve if self._reader else None)
        curve = self._curve
        for job, phases in curve.advance(is_complete=is_complete):
            self._pass(job, phases)
            self._note_loss(job, phases)
        self.found.feed_s += curve.rest_s
        curve.rest_s = 0.0

    def _note_loss(self, job: Job, phases: Phases) -> None:
        """Note how much longer than at its programmed feed a planned move takes."""
        found, seconds = self.found, duration_s(phases)
        lost_s = seconds - job.length_u / job.feed_ups
        found.planned += 1
        found.lost_s += lost_s
        if lost_s > found.slowest_s:
            found.slowest_s, found.slowest_line = lost_s, job.entry.source.line

    def _pass(self, job: Job, phases: Phases) -> None:
        """Count a move that is planned."""
        if self._progress is not None:
            self._progress(job.entry.source.line)
        if self._reader is not None:
            self._reader.passed(job, phases)
        seconds = duration_s(phases)
        self.found.moves += 1
        if job.is_rapid:
            self.found.rapid_s += seconds
        else:
            self.found.feed_s += seconds


def _jerk_ramps(encoder: Encoder) -> JerkRamps:
    from openacr.mill.plan.moves.jerk_ramps import (
        JerkRamps,  # has a card: most machines have no jerk
    )

    return JerkRamps(encoder)
