"""Tracing of the path in a pause: back along the cut path and forward again.

While a line or an arc is held the tool may go back over the moves before it, as far as the
last rapid, tool change or beginning of the program, and forward to the point where it was
held. Those moves run at Forward Backward Speed; spindle, coolant and outputs stay as they
are. RESUME continues the path from the position of the tool, at the feed of the program.

The path is two lists of moves, both in forward direction: those before the tool and those
after it. The move in which a trace stops is split at that point.
"""

from collections import deque

from msgspec.structs import replace

from openacr.cnc.canonical import Arc, Line, Pace, PathMode, Point, Probe, Rapid, Source
from openacr.errors import UserError
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import S_PER_MIN
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.plan.moves.planning import CornerRules, Planner
from openacr.mill.run.program_stream import ProgramStream
from openacr.mill.run.rejoin import Place, first_of, place, rest_of
from openacr.mill.run.sending import send
from openacr.mill.run.tracking import Tracker


class Retrace:
    """Traces the path of one machine back and forward in a pause."""

    def __init__(self, io: MachineIo, stream: ProgramStream, depth: int) -> None:
        self._machine = io.machine
        self._settings = io.settings
        self._stream = stream
        self._depth = depth
        self._encoder = Encoder(io.settings)
        self._player = ActionPlayer()
        self._tracker = Tracker()
        self._is_stopping = False
        self._done: list[Job] = []
        self._ahead: list[Job] = []
        self._left: Place | None = None  # where the tool is on the path now

    @property
    def is_active(self) -> bool:
        """Whether a trace is in progress."""
        return self._player.is_active

    @property
    def tracker(self) -> Tracker:
        """The moves of the present trace, or the last one."""
        return self._tracker

    @property
    def left(self) -> Place | None:
        """The place of the tool on the path, None before the first trace of a pause."""
        return self._left

    @property
    def source(self) -> Source | None:
        """The block of the tool in a trace."""
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
            raise UserError("the tool is where it was held: nothing to trace forward")
        self._is_stopping = False
        self._player.begin(self._steps(direction, left))

    def stop(self) -> None:
        """Ramp to rest on the path."""
        if self.is_active and not self._is_stopping:
            self._is_stopping = True
            self._machine.hold()

    def play(self, sample: CardState, step_s: float) -> None:
        """Continue a trace until it has to wait."""
        self._player.play(sample, step_s)

    def close(self) -> None:
        """Drop the trace: the program has ended."""
        self._player.close()
        self._done, self._ahead, self._left = [], [], None

    def finish(self) -> None:
        """Return the rest of the path to the program."""
        if self._left is not None:
            self._left = None
            self._stream.tracker.trail.restart(self._done)
            self._stream.insert_first(self._ahead)
            self._done, self._ahead = [], []

    # --- one trace --------------------------------------------------------------------

    def _steps(self, direction: int, left: Place) -> Steps:
        if self._left is None:
            self._left = left
            yield from self._take_over(left)
        is_forward = direction > 0
        path = self._forward() if is_forward else self._backward()
        yield self._all_of(path, "forward" if is_forward else "backward")
        count, present = self._finished(path)
        here = self._stream.host.position()
        yield from self._stream.drop_moves()
        if is_forward:
            self._done += self._ahead[:count]
            self._ahead = self._ahead[count:]
        else:
            kept = len(self._done) - count
            self._ahead = self._done[kept:] + self._ahead
            self._done = self._done[:kept]
        if present is not None:
            self._cut(here, is_forward=is_forward)
        self._left = self._place(left, here)

    def _take_over(self, left: Place) -> Steps:
        """Withdraw the moves of the program from the card, and take over the path so far."""
        yield from self._stream.withdraw(left.point)
        self._done = self._stream.tracker.trail.path()
        self._ahead = []

    def _all_of(self, path: list[Job], reason: str) -> Until:
        """Send moves while there is room, until all are made or a stop is at rest."""
        tracker = self._tracker = Tracker()
        queue, planner = deque(path), Planner[Job](CornerRules.of(self._settings.speeds))

        def is_over(sample: CardState) -> bool:
            tracker.update(sample.counter)
            if self._is_stopping and (sample.is_held or not sample.is_moving):
                return True
            room = self._depth - tracker.waiting
            while queue and planner.ready() < room:
                planner.add(queue.popleft())
            jobs = planner.release(room, is_complete=not queue)
            bounded = tracker.bounded(jobs, self._settings.buffered_s)
            send(self._machine, self._encoder, tracker, bounded)
            return not queue and not planner and tracker.is_at_end(sample)

        return Until(reason, is_over)

    def _finished(self, path: list[Job]) -> tuple[int, Job | None]:
        """The count of finished moves of a path, and the move in which a stop came to rest."""
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
        """The moves before the tool, reversed; a corner keeps its forward mode."""
        modes = [PathMode.EXACT, *(job.mode for job in self._done)]
        turned = [
            self._job(job.finish, _reversed(job), mode)
            for job, mode in zip(self._done, modes, strict=False)
        ]
        return turned[::-1]

    def _job(self, begin: Point, entry: Line | Arc, mode: PathMode) -> Job:
        speed_upm = self._settings.speeds.trace_ups * S_PER_MIN
        return self._encoder.job(replace(entry, pace=Pace(speed_upm, mode)), begin)

    def _cut(self, here: Point, *, is_forward: bool) -> None:
        """Split the move at the tool: its parts end one list and begin the other."""
        job = self._ahead.pop(0) if is_forward else self._done.pop()
        first, rest = first_of(_entry(job), job.begin, here), rest_of(_entry(job), job.begin, here)
        self._done += self._stream.pieces_of(job, first, job.begin)
        self._ahead = self._stream.pieces_of(job, rest, here) + self._ahead

    def _place(self, left: Place, here: Point) -> Place:
        """The place of the tool: on the move after it, or where the trace began."""
        return place(self._ahead[0], here) if self._ahead else replace(left, point=here)


def _entry(job: Job) -> Line | Arc:
    """The move of a job of the path, which has only lines and arcs."""
    if isinstance(job.entry, Line | Arc):
        return job.entry
    raise UserError("only lines and arcs are traced")


def _reversed(job: Job) -> Line | Arc:
    """A move reversed."""
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
