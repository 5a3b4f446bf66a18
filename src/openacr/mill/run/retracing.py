"""Back along the path that has been cut, and forward again, in a pause.

While a line or an arc is held the tool may go back over the moves before it, as far as the
last rapid, tool change or beginning of the program, and forward to the point where it was
held. Those moves run at Forward Backward Speed, spindle, coolant and outputs stay as they
are. RESUME makes the way from wherever the tool is then, at the feed of the program.

The path is two lists of moves, both written forward: those behind the tool and those ahead
of it. Wherever a trace stops, the move it stopped in is cut in two at that point.
"""

from collections import deque
from collections.abc import Iterable
from dataclasses import replace

from openacr.cnc.canonical import Arc, Line, Pace, PathMode, Point, Probe, Rapid, Source
from openacr.errors import UserError
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import S_PER_MIN
from openacr.mill.plan.encoding import Encoder, Job
from openacr.mill.plan.planning import CornerRules, Planner
from openacr.mill.run.program_stream import ProgramStream
from openacr.mill.run.rejoin import Place, first_of, place, rest_of
from openacr.mill.run.tracking import Tracker


class Retrace:
    """The way back and forward of one machine in a pause."""

    def __init__(self, io: MachineIo, stream: ProgramStream, depth: int) -> None:
        self._machine = io.machine
        self._settings = io.settings
        self._stream = stream
        self._depth = depth
        self._encoder = Encoder(io.settings)
        self._player = ActionPlayer()
        self._tracker = Tracker()
        self._is_stopping = False
        self._behind: list[Job] = []
        self._ahead: list[Job] = []
        self._left: Place | None = None  # where the tool stands on the path now

    @property
    def is_active(self) -> bool:
        """Whether the tool is on its way back or forward."""
        return self._player.is_active

    @property
    def tracker(self) -> Tracker:
        """The moves of the present trace, or the last one."""
        return self._tracker

    @property
    def left(self) -> Place | None:
        """Where on the path the tool stands, once a trace has begun in this pause."""
        return self._left

    @property
    def source(self) -> Source | None:
        """The block the tool is on in a trace."""
        if self.is_active:
            return self._tracker.source
        return self._left.job.entry.source if self._left else None

    def begin(self, direction: int, left: Place) -> None:
        """Go back (-1) or forward (1) from where the machine is held."""
        if self.is_active:
            raise UserError("the tool is being traced: stop it first")
        if isinstance(left.job.entry, Rapid | Probe):
            raise UserError("only lines and arcs are traced")
        here = self._left or left
        if self._stream.is_off(here.point):
            raise UserError("the machine was moved off its path: resume first")
        if direction > 0 and self._left is None:
            raise UserError("the tool stands where it was held")
        self._is_stopping = False
        self._player.begin(self._steps(direction, left))

    def stop(self) -> None:
        """Ramp to rest on the path."""
        if self.is_active and not self._is_stopping:
            self._is_stopping = True
            self._machine.hold()

    def play(self, sample: CardState, step_s: float) -> None:
        """Go on with a trace as far as the card lets it."""
        self._player.play(sample, step_s)

    def close(self) -> None:
        """The program is over: there is nothing to be traced any more."""
        self._player.close()
        self._behind, self._ahead, self._left = [], [], None

    def finish(self) -> None:
        """Leave the rest of the way, if it was taken over, to the program again."""
        if self._left is not None:
            self._left = None
            self._stream.tracker.trail.restart(self._behind)
            self._stream.make_first(self._ahead)
            self._behind, self._ahead = [], []

    # --- one trace --------------------------------------------------------------------

    def _steps(self, direction: int, left: Place) -> Steps:
        if self._left is None:
            self._left = left
            yield from self._take_over(left)
        is_forward = direction > 0
        path = self._forward() if is_forward else self._backward()
        yield self._all_of(path, "forward" if is_forward else "backward")
        count, present = self._gone(path)
        here = self._stream.host.position()
        yield from self._stream.drop_moves()
        if is_forward:
            self._behind += self._ahead[:count]
            self._ahead = self._ahead[count:]
        else:
            kept = len(self._behind) - count
            self._ahead = self._behind[kept:] + self._ahead
            self._behind = self._behind[:kept]
        if present is not None:
            self._cut(here, is_forward=is_forward)
        self._left = self._place(left, here)

    def _take_over(self, left: Place) -> Steps:
        """Take the moves of the program back from the card; the path so far lies behind."""
        yield from self._stream.put_back(left.point)
        self._behind = self._stream.tracker.trail.path()
        self._ahead = []

    def _all_of(self, path: list[Job], reason: str) -> Until:
        """Send moves as there is room for them, until all are made or a stop has come to rest."""
        tracker = self._tracker = Tracker()
        queue, planner = deque(path), Planner[Job](CornerRules.of(self._settings.speeds))

        def is_over(sample: CardState) -> bool:
            tracker.update(sample.counter)
            if self._is_stopping and (sample.is_held or not sample.is_moving):
                return True
            room = self._depth - tracker.waiting
            while queue and planner.ready() < room:
                planner.add(queue.popleft())
            jobs = planner.take(room, is_complete=not queue)
            self._send(tracker.bounded(jobs, self._settings.buffered_s))
            return not queue and not planner and tracker.is_at_end(sample)

        return Until(reason, is_over)

    def _send(self, jobs: Iterable[Job]) -> None:
        for job in jobs:
            packet = self._encoder.packet(job)
            self._tracker.add(job, has_packet=packet is not None)
            if packet is not None:
                self._machine.send([packet])

    def _gone(self, path: list[Job]) -> tuple[int, Job | None]:
        """How many moves of a way are done, and the one a stop came to rest in."""
        current = self._tracker.current
        if not self._is_stopping or not self._machine.poll().is_held:
            return (len(path), None) if path and current is path[-1] else (0, None)
        if current is None:
            return 0, None
        return next(n for n, job in enumerate(path) if job is current), current

    # --- the two lists ----------------------------------------------------------------

    def _forward(self) -> list[Job]:
        return [self._job(job.begin, _entry(job), job.mode) for job in self._ahead]

    def _backward(self) -> list[Job]:
        """The moves behind, turned round; a corner keeps the mode it has forward."""
        modes = [PathMode.EXACT, *(job.mode for job in self._behind)]
        turned = [
            self._job(job.finish, _turned_round(job), mode)
            for job, mode in zip(self._behind, modes, strict=False)
        ]
        return turned[::-1]

    def _job(self, begin: Point, entry: Line | Arc, mode: PathMode) -> Job:
        speed_upm = self._settings.speeds.trace_ups * S_PER_MIN
        return self._encoder.job(replace(entry, pace=Pace(speed_upm, mode)), begin)

    def _cut(self, here: Point, *, is_forward: bool) -> None:
        """Cut the move the tool stands in: its parts end the one list and begin the other."""
        job = self._ahead.pop(0) if is_forward else self._behind.pop()
        first, rest = first_of(_entry(job), job.begin, here), rest_of(_entry(job), job.begin, here)
        self._behind += self._stream.pieces_of(job, first, job.begin)
        self._ahead = self._stream.pieces_of(job, rest, here) + self._ahead

    def _place(self, left: Place, here: Point) -> Place:
        """Where the tool is left: on the move ahead of it, or where the trace began."""
        return place(self._ahead[0], here) if self._ahead else replace(left, point=here)


def _entry(job: Job) -> Line | Arc:
    """The move of a job of the path, which holds nothing but lines and arcs."""
    if isinstance(job.entry, Line | Arc):
        return job.entry
    raise UserError("only lines and arcs are traced")


def _turned_round(job: Job) -> Line | Arc:
    """A move from its end to its beginning."""
    entry = _entry(job)
    if isinstance(entry, Line):
        return replace(entry, end=job.begin)
    return replace(
        entry,
        end=job.begin,
        sweep_rad=-entry.sweep_rad,
        start_radius=entry.end_radius,
        end_radius=entry.start_radius,
    )
