"""Tracking of the executing move by the move counter of the card.

The counter starts at 0 and every packet counts up, so packet number c has started when the
counter reaches c. A move without a packet (it ends on
the same pulse) counts with the one before it.
"""

from collections import deque
from collections.abc import Iterable, Iterator

from openacr.cnc.canonical import Probe, Rapid, Source
from openacr.mill.card.driver import CardState
from openacr.mill.plan.moves.encoding import Job

MOST_TRAILED = 10_000
MOST_PASSED = 200
STALL_S = 3.0  # longer than a kill and its clearing, which also delay moves


class Trail:
    """Lines and arcs executed since the last rapid, probing or tool change."""

    def __init__(self) -> None:
        self._jobs: deque[Job] = deque(maxlen=MOST_TRAILED)
        self._barrier: Job | None = None

    def add(self, job: Job) -> None:
        """Add a finished move."""
        if job is self._barrier or isinstance(job.entry, Rapid | Probe):
            self._jobs.clear()
        else:
            self._jobs.append(job)

    def bar(self, last: Job | None) -> None:
        """Bar tracing back over anything up to this move."""
        self._barrier = last
        self._jobs.clear()

    def path(self) -> list[Job]:
        """The moves, in the order of execution."""
        return list(self._jobs)

    def restart(self, jobs: list[Job]) -> None:
        """Replace the moves: the tool is at the end of these."""
        self._jobs = deque(jobs, maxlen=MOST_TRAILED)


class Tracker:
    """Tracks moves: sent, started, finished."""

    def __init__(self) -> None:
        self.sent = 0  # packets
        self.started = 0
        self._jobs: deque[Job] = deque()  # sent and not known to be finished
        self._sent_s = 0.0  # how long these take at their feeds
        self._passed: deque[Job] = deque(maxlen=MOST_PASSED)
        self.trail = Trail()  # done

    @property
    def waiting(self) -> int:
        """Packets that wait in the buffer of the card."""
        return self.sent - self.started

    @property
    def waiting_s(self) -> float:
        """The time the moves after the executing one take at their feeds."""
        current = self.current
        return max(self._sent_s - (time_s(current) if current else 0.0), 0.0)

    @property
    def current(self) -> Job | None:
        """The executing move, or the last one."""
        return self._jobs[0] if self._jobs and self._jobs[0].count <= self.started else None

    @property
    def source(self) -> Source | None:
        """The executing block."""
        return self.current.entry.source if self.current else None

    def jobs(self) -> list[Job]:
        """The executing or last move, and those after it."""
        return list(self._jobs)

    def add(self, job: Job, *, has_packet: bool) -> None:
        """Add a sent move; one without a packet counts with the one before it."""
        self.sent += has_packet
        job.count = job.last = self.sent
        self._jobs.append(job)
        self._sent_s += time_s(job)

    def add_packet(self) -> None:
        """Add a packet of the last move that was added: one of a curve has many."""
        self.sent += 1
        if self._jobs:
            self._jobs[-1].last = self.sent

    def bounded(self, jobs: Iterable[Job], most_s: float) -> Iterator[Job]:
        """Yield moves until those buffered on the card take `most_s`."""
        waiting_s = self.waiting_s
        if waiting_s < most_s:
            for job in jobs:
                yield job
                waiting_s += time_s(job)
                if waiting_s >= most_s:
                    break

    def update(self, counter: int) -> None:
        """Update from the packet counter of the card; earlier moves are finished."""
        self.started = counter
        jobs = self._jobs
        while len(jobs) > 1 and jobs[1].count <= counter:
            self._sent_s -= time_s(jobs[0])
            self._passed.append(jobs[0])
            self.trail.add(jobs.popleft())

    def near(self) -> Iterator[Job]:
        """The moves on one of which the tool is: a curve counts some on before they are reached."""
        yield from self._jobs
        yield from reversed(self._passed)

    def is_at_end(self, sample: CardState) -> bool:
        """Whether all sent moves are finished."""
        return sample.counter >= self.sent and not sample.is_moving

    def is_done(self, job: Job | None, *, is_at_rest: bool) -> bool:
        """Whether a move has been executed; None is the beginning."""
        if job is None:
            return True
        if not job.count:
            return False  # not sent yet
        return self.started > job.last or (is_at_rest and self.started == job.last)

    def block_at(self, counter: int) -> int:
        """The count of blocks that were over when the card had started `counter` packets."""
        found = 0
        for job in self._jobs:
            if job.count > counter:
                break
            found = job.block
        return found

    def withdraw(self) -> list[Job]:
        """Remove and return the executing move and all after it, to be planned again."""
        left = [job for job in self._jobs if job.last >= self.started]
        self._clear()
        return left

    def reset(self) -> None:
        """Restart the count at zero."""
        self.sent = self.started = 0
        self._clear()

    def _clear(self) -> None:
        self._jobs.clear()
        self._passed.clear()
        self._sent_s = 0.0


class Stall:
    """Detects moves that the card does not start although it is at rest."""

    def __init__(self) -> None:
        self._since_s: float | None = None

    def has_come(self, tracker: Tracker, sample: CardState, now_s: float) -> bool:
        """Whether the card has been at rest too long with moves left to execute."""
        if sample.is_moving or sample.counter >= tracker.sent:
            self._since_s = None
            return False
        if self._since_s is None:
            self._since_s = now_s
        return now_s - self._since_s >= STALL_S


def time_s(job: Job) -> float:
    """The time a move takes at its feed, s."""
    return job.length_u / job.feed_ups if job.feed_ups > 0.0 else 0.0
