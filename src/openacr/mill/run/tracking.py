"""Which move is executed now: the move counter of the card says how many have started.

The counter starts at 0 and every packet counts up, so packet number c has started when the
counter reaches c. What belongs behind a move that has no packet (it ends on the same
pulse) counts with the one before it.
"""

from collections import deque
from collections.abc import Iterable, Iterator

from openacr.cnc.canonical import Probe, Rapid, Source
from openacr.mill.card.driver import CardState
from openacr.mill.plan.encoding import Job

MOST_TRAILED = 10_000
STALL_S = 3.0  # longer than a kill and its clearing take, which moves wait for, too


class Trail:
    """The lines and arcs that were made since the last rapid, probing or tool change."""

    def __init__(self) -> None:
        self._jobs: deque[Job] = deque(maxlen=MOST_TRAILED)
        self._barrier: Job | None = None

    def add(self, job: Job) -> None:
        """A move is done."""
        if job is self._barrier or isinstance(job.entry, Rapid | Probe):
            self._jobs.clear()
        else:
            self._jobs.append(job)

    def bar(self, last: Job | None) -> None:
        """Nothing up to this move is gone back over."""
        self._barrier = last
        self._jobs.clear()

    def path(self) -> list[Job]:
        """The moves, in the order they were made."""
        return list(self._jobs)

    def restart(self, jobs: list[Job]) -> None:
        """The tool stands at the end of these."""
        self._jobs = deque(jobs, maxlen=MOST_TRAILED)


class Tracker:
    """The moves on their way: sent, started, done."""

    def __init__(self) -> None:
        self.sent = 0  # packets
        self.started = 0
        self._jobs: deque[Job] = deque()  # sent and not known to be done
        self._sent_s = 0.0  # how long these take at their feeds
        self.trail = Trail()  # done

    @property
    def waiting(self) -> int:
        """Packets that wait in the buffer of the card."""
        return self.sent - self.started

    @property
    def waiting_s(self) -> float:
        """How long the moves behind the executed one take at their feeds."""
        current = self.current
        return max(self._sent_s - (time_s(current) if current else 0.0), 0.0)

    @property
    def current(self) -> Job | None:
        """The move that is executed, or was last."""
        return self._jobs[0] if self._jobs and self._jobs[0].count <= self.started else None

    @property
    def source(self) -> Source | None:
        """The block that is executed."""
        return self.current.entry.source if self.current else None

    def jobs(self) -> list[Job]:
        """The move that is executed, or was last, and those behind it."""
        return list(self._jobs)

    def add(self, job: Job, *, has_packet: bool) -> None:
        """A move has left for the card; one without packet counts with the one before it."""
        self.sent += has_packet
        job.count = self.sent
        self._jobs.append(job)
        self._sent_s += time_s(job)

    def bounded(self, jobs: Iterable[Job], most_s: float) -> Iterator[Job]:
        """As many of these as may wait on the card: until the waiting ones take `most_s`."""
        waiting_s = self.waiting_s
        if waiting_s < most_s:
            for job in jobs:
                yield job
                waiting_s += time_s(job)
                if waiting_s >= most_s:
                    break

    def update(self, counter: int) -> None:
        """The card says how many packets have started; earlier moves are done."""
        self.started = counter
        jobs = self._jobs
        while len(jobs) > 1 and jobs[1].count <= counter:
            self._sent_s -= time_s(jobs[0])
            self.trail.add(jobs.popleft())

    def is_at_end(self, sample: CardState) -> bool:
        """Whether everything that was sent has been made."""
        return sample.counter >= self.sent and not sample.is_moving

    def is_done(self, job: Job | None, *, is_at_rest: bool) -> bool:
        """Whether a move has been executed; None stands for the beginning."""
        if job is None:
            return True
        if not job.count:
            return False  # not sent yet
        return self.started > job.count or (is_at_rest and self.started == job.count)

    def take_back(self) -> list[Job]:
        """The executed move and all behind it, for a way that is planned anew."""
        left = [job for job in self._jobs if job.count >= self.started]
        self._clear()
        return left

    def reset(self) -> None:
        """Count from zero again."""
        self.sent = self.started = 0
        self._clear()

    def _clear(self) -> None:
        self._jobs.clear()
        self._sent_s = 0.0


class Stall:
    """Notices moves that the card was sent and does not begin, although it is at rest."""

    def __init__(self) -> None:
        self._since_s: float | None = None

    def has_come(self, tracker: Tracker, sample: CardState, now_s: float) -> bool:
        """Whether the card has been at rest before the end of what was sent for too long."""
        if sample.is_moving or sample.counter >= tracker.sent:
            self._since_s = None
            return False
        if self._since_s is None:
            self._since_s = now_s
        return now_s - self._since_s >= STALL_S


def time_s(job: Job) -> float:
    """How long a move takes at its feed."""
    return job.length_u / job.feed_ups if job.feed_ups > 0.0 else 0.0
