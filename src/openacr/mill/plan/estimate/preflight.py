"""Preflight check of a program: moves a machine would refuse or make slower than programmed.

The moves are those a run would send. On a machine soft limits act only on homed axes; here every
axis is checked as if it were homed, and one warning names those that are not.
"""

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.canonical import Probe, Rapid, Source
from openacr.cnc.reading.findings import Finding, found
from openacr.mill.config.capture import capture_of
from openacr.mill.config.settings import S_PER_MIN, Settings
from openacr.mill.plan.moves.encoding import LONG_MAX, Encoder, Job
from openacr.mill.plan.moves.phases import Phases
from openacr.mill.plan.moves.travel_limits import Excess, excesses, limited
from openacr.sysvar.tabs import SPEEDS
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.mill.plan.curves.planned_path import Rows

REACHED = 1.0 - 1e-6  # of the feed; speeds of the plan are results of square roots
SMOOTH = 2.0 * math.sin(math.radians(0.5 * 1.0))  # apart are tangents of a corner of a degree
NO_TOLERANCE = f"with one (G64 P, or P{SPEEDS.path_tolerance}) the path keeps its acceleration"
REACHED_PLANNED = 0.99  # a planned path is somewhat shorter than the programmed one


class Beyond(Struct):
    """All moves beyond one limit: the first, the last, the farthest and their count."""

    first: Job
    excess: Excess  # of the first
    last: Job
    farthest: Excess
    farthest_line: int
    cnt: int = 1

    def add(self, job: Job, excess: Excess) -> None:
        """Add a point beyond the same limit."""
        if job is not self.last:
            self.cnt += 1
            self.last = job
        if excess.beyond_u > self.farthest.beyond_u:
            self.farthest, self.farthest_line = excess, job.entry.source.line

    @property
    def hint(self) -> str:
        """The hint of the finding, which summarizes the other moves."""
        if self.cnt == 1:
            return ""
        return f"{self.cnt} moves, line {self.farthest_line} by {self.farthest.beyond_u:.6g}"


class Slow(Struct):
    """A chain of feed moves up to rest or another feed, with its highest speed."""

    source: Source
    feed_ups: float
    top_ups: float = 0.0
    cnt: int = 0
    is_planned: bool = False

    @property
    def share(self) -> float:
        """The reached share of the feed, 0..1."""
        return self.top_ups / self.feed_ups


class Preflight:
    """Checks the moves of a program as they are read and planned, in constant memory."""

    def __init__(self, settings: Settings) -> None:
        self._encoder = Encoder(settings)
        self._limited = limited(settings)
        self._unhomed = {
            axis.index: axis.name for axis in self._limited if not settings.is_homed(axis.index)
        }
        self._untested: dict[str, Source] = {}
        self._beyond: dict[tuple[int, bool], Beyond] = {}
        self._unsayable: tuple[Source, str] | None = None
        self._settings = settings
        self._polled: dict[str, Source] = {}  # why a probe is polled, and the first line
        self._chain: Slow | None = None
        self._slow: Slow | None = None  # the slowest of all
        self._first_slow: Source | None = None
        self._slow_cnt = 0
        self._has_jerk = settings.speeds.jerk_ups3 > 0.0
        self._before: Job | None = None  # the last move planned
        self._hard: tuple[Source, int] | None = None  # the first hard corner, and their count

    # --- moves ------------------------------------------------------------------------

    def read(self, job: Job) -> None:
        """Check the path of a move."""
        if self._limited:
            for excess in excesses(job, self._limited):
                self._note(job, excess)
        if self._unhomed:
            self._miss(job)
        if isinstance(job.entry, Probe):
            self._note_probe(job)
        if self._unsayable is None and max(map(abs, job.finish_cnt)) > LONG_MAX:
            text = self._encoder.beyond_pulses(job) or ""
            self._unsayable = job.entry.source, text

    @property
    def unhomed(self) -> int:
        """The mask of axes with limits whose first move was not seen yet."""
        return sum(1 << axis for axis in self._unhomed)

    def note_slow(self, cnt: int, first: Source, slowest: Source, share: float) -> None:
        """Note moves that do not reach their feed, as a forecast found them."""
        self._slow_cnt, self._first_slow = cnt, first
        self._slow = Slow(slowest, 1.0, share)

    def _note_probe(self, job: Job) -> None:
        """Note a probing move whose positions the card cannot capture."""
        travel_u = [end - begin for begin, end in zip(job.begin, job.finish, strict=True)]
        capture = capture_of(self._settings, travel_u, is_rising=True)
        if capture.reason:
            self._polled.setdefault(capture.reason, job.entry.source)

    def _note(self, job: Job, excess: Excess) -> None:
        limits = excess.axis.soft_limits
        key = excess.axis.index, limits is not None and excess.limit_u == limits[0]
        if key in self._beyond:
            self._beyond[key].add(job, excess)
        else:
            line = job.entry.source.line
            self._beyond[key] = Beyond(job, excess, job, excess, line)

    def _miss(self, job: Job) -> None:
        """Note the first move of an axis whose limits would not be active."""
        for axis, name in list(self._unhomed.items()):
            if job.begin[axis] != job.finish[axis]:
                self._untested[name] = job.entry.source
                del self._unhomed[axis]

    def rested(self, seconds: float) -> None:
        """Ignore dwells."""

    def curve(self, points: "Rows") -> None:
        """A planned curve has ended at rest; the planner keeps the limits of its points."""
        self._close()

    def passed(self, job: Job, phases: Phases) -> None:
        """Check the speed of a planned move, and the corner before it."""
        entry = job.entry
        if self._has_jerk:
            self._corner(self._before, job)
        self._before = job
        if isinstance(entry, Rapid):
            return
        feed_ups, chain = entry.pace.feed_upm / S_PER_MIN, self._chain
        if chain is None or chain.feed_ups != feed_ups:
            self._close()
            chain = self._chain = Slow(entry.source, feed_ups)
        chain.cnt += 1
        for phase in phases:
            chain.top_ups = max(chain.top_ups, phase.begin_ups, phase.end_ups)
        chain.is_planned = job.path_tolerance_u > 0.0
        if job.exit_ups == 0.0 and not chain.is_planned:
            self._close()

    def _corner(self, before: Job | None, job: Job) -> None:
        """Note a corner that is passed at speed: the card makes a step of the velocity there."""
        if before is None or before.exit_ups <= 0.0 or before.end is None or job.start is None:
            return
        if math.dist(before.end, job.start) > SMOOTH:
            first, cnt = self._hard or (job.entry.source, 0)
            self._hard = first, cnt + 1

    def _close(self) -> None:
        """End a chain of moves; note it if it did not reach the feed."""
        chain, self._chain = self._chain, None
        if chain is None or chain.share >= (REACHED_PLANNED if chain.is_planned else REACHED):
            return
        self._slow_cnt += chain.cnt
        self._first_slow = self._first_slow or chain.source
        if self._slow is None or chain.share < self._slow.share:
            self._slow = chain

    # --- findings ---------------------------------------------------------------------

    def findings(self, text_of: Callable[[Source], str]) -> list[Finding]:
        """The findings, after the whole program has been read."""
        self._close()
        return [
            found(code, source.file, source.line, 1, detail, hint, text_of(source))
            for code, source, detail, hint in self._all()
        ]

    def _all(self) -> Iterator[tuple[str, Source, str, str]]:
        """Codes with their sources, details and hints."""
        for beyond in self._beyond.values():
            yield "E401", beyond.first.entry.source, str(beyond.excess), beyond.hint
        if self._unsayable is not None:
            yield "E403", *self._unsayable, ""
        if self._untested:
            names = " ".join(self._untested)
            source = next(iter(self._untested.values()))
            yield "W403", source, f"{names} not homed", "tested as if homed"
        for reason, source in self._polled.items():
            yield "W404", source, reason, "the probe is polled, which is less accurate"
        if self._hard is not None:
            first, cnt = self._hard
            yield "W407", first, counted(cnt, "corner"), NO_TOLERANCE
        if self._first_slow is not None and self._slow is not None:
            slow = self._slow
            worst = f"line {slow.source.line} reaches {100.0 * slow.share:.3g} % of F"
            yield "W402", self._first_slow, _moves(self._slow_cnt), worst


def _moves(cnt: int) -> str:
    return "1 move" if cnt == 1 else f"{cnt} moves"
