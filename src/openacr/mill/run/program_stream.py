"""Stream of a program to the card: the moves that were sent and those that follow.

It executes the decisions of the runner (hold, continue, withdraw, rejoin) on the moves.
"""

from collections.abc import Callable, Iterable, Iterator

from openacr.cnc import canonical as c
from openacr.errors import UserError
from openacr.map.rows import axes as axis_rows
from openacr.mill.card import alarms
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.driver import CLEAR_S, CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.manual.probing import Probing
from openacr.mill.plan.moves.encoding import Encoder, Job, Motion
from openacr.mill.plan.moves.geometry import weights
from openacr.mill.plan.moves.travel_limits import first_excess
from openacr.mill.run.curve_run import CurveRun
from openacr.mill.run.entry_actions import EntryActions
from openacr.mill.run.feeding import Fault, Feed, Halt, Starved
from openacr.mill.run.rejoin import (
    Place,
    apart_u,
    first_of,
    lead_in,
    pace_of,
    place,
    rest_of,
    straight_back,
)
from openacr.mill.run.run_host import RunHost
from openacr.mill.run.sending import send
from openacr.mill.run.tracking import Tracker, time_s

SHORT_S = 0.3  # motion left on the card at which a starved program is brought to rest
KILL_S = 0.5  # longest reaction time of a card at rest
NEAR_TOLERANCES = 4.0  # path tolerances that the tool may be off a move under way
NEAR_MM, NEAR_INCH = 0.5, 0.02  # and this
PULSES_OFF = 2.0  # larger deviations mean that the machine was moved
Entries = Callable[[RunHost], Iterator[c.Entry | Starved]]


class ProgramStream:
    """Sends the moves of a program to the buffer of the card."""

    def __init__(self, io: MachineIo, entry_actions: EntryActions, depth: int) -> None:
        self.settings = io.settings
        self.host = RunHost(
            io.machine, io.settings, lambda: self._probing.point, entry_actions.switched
        )
        self.tracker = Tracker()
        self._sent = 0  # moves sent one by one
        self.is_retaking = False  # moves are being withdrawn from the card
        self.may_lack_moves = False  # moves sent at the beginning of a pause may be lost
        self._machine = io.machine
        self._entry_actions = entry_actions
        self._depth = depth
        self._probing = Probing(io, self._send, self.host.position, entry_actions.say)
        self._encoder = Encoder(io.settings)
        self._weights = weights(io.settings)
        self._curve = CurveRun(io.machine, io.settings, self.tracker, depth)
        self._feed: Feed | None = None
        self._halt_block = 0  # the blocks before the last halt that was reached
        self._excused: Job | None = None  # a last move whose end the machine left on purpose
        self._begin: c.Point = (0.0,) * c.AXES  # where the program was started
        self._rapid_level: float | None = None  # highest tool level of its rapids

    def begin(self, entries: Entries, *, is_dry: bool, is_single: bool) -> None:
        """Start a pass of a program at its first block."""
        self._machine.reset_counter()
        self.tracker.reset()
        self._curve.drop()
        self._halt_block = 0
        self.tracker.trail.restart([])
        rounds = self._machine.rounds_corners
        self._encoder = Encoder(self.settings, is_dry=is_dry, rounds=rounds)
        self._begin, self._rapid_level = self.host.position(), None
        self._feed = Feed(entries(self.host), self._begin, self.settings, self._encoder)
        self._feed.is_single = is_single

    def end(self) -> None:
        """Drop the program."""
        self._feed = None

    @property
    def has_program(self) -> bool:
        """Whether a program is being sent."""
        return self._feed is not None

    @property
    def moves(self) -> int:
        """Moves sent, those of planned curves as they begin."""
        return self._sent + self._curve.jobs

    @property
    def is_read_up(self) -> bool:
        """Whether no move follows the known ones before the machine rests."""
        return self._feed is None or self._feed.halt is not None

    def ahead(self) -> Iterator[Job]:
        """The executing move and those known to follow it."""
        yield from self.tracker.jobs()
        if self._feed is not None:
            yield from self._feed.jobs()

    def set_single(self, on: bool) -> None:
        """Switch single block on or off."""
        if self._feed is not None:
            self._feed.is_single = on

    # --- forward ----------------------------------------------------------------------

    def advance(self, sample: CardState) -> Halt | None:
        """Read and send as far as there is room; returns the halt reached at rest, if any."""
        feed = self._feed
        if feed is None:
            return None
        room = self._depth - self.tracker.waiting
        feed.read(room)
        is_at_rest = self.tracker.is_at_end(sample)
        curve = feed.curve(is_at_rest=is_at_rest)
        lack = self._curve.lack if curve is not None else ""
        if curve is not None and not lack:
            self._curve.plan(curve, is_complete=feed.is_complete, is_starved=feed.is_starved)
        jobs = feed.release(room, is_urgent=feed.is_starved and self._is_short())
        with self._machine.repeating():
            self._send(self.tracker.bounded(jobs, self.settings.buffered_s))
            is_at_rest = self.tracker.is_at_end(sample)
            for note in feed.passed(self.tracker, is_at_rest=is_at_rest):
                for _ in self._entry_actions.steps(note):
                    pass  # no note waits
        fault = lack or (curve.fault if curve is not None else "")
        if fault and is_at_rest:
            return Fault(alarms.PROGRAM_ERROR, fault)
        halt = feed.halt if feed.is_empty and is_at_rest else None
        if halt is not None:
            self._halt_block = feed.block
        if halt is not None and (moved := self._moved_by_others()):
            return Fault(alarms.NOT_IN_PLACE, moved)
        if isinstance(halt, c.Tool):
            self.tracker.trail.bar(self.tracker.current)
        return halt

    def block_at(self, counter: int) -> int:
        """The count of blocks that were over when the card had started `counter` packets."""
        return max(self._halt_block, self.tracker.block_at(counter))

    def poll(self, sample: CardState) -> None:
        """Send more of the present curve, in every state of the run: it ends at rest."""
        with self._machine.repeating():
            self._curve.poll(sample)

    def override(self, feed: float, rapid: float) -> None:
        """Set the overrides of planned curves, which the card does not act on."""
        self._curve.override(feed, rapid)

    def hold(self) -> None:
        """Hold the feed: moves ramp to rest on their path."""
        if not self._curve.hold():
            self._machine.hold()

    @property
    def is_planned(self) -> bool:
        """Whether the held or executing move is part of a planned curve, which is planned again."""
        job = self.tracker.current
        return self._curve.is_begun or (job is not None and job.last > job.count)

    def excuse(self) -> None:
        """Accept that the machine leaves the end of its last move, by jogging or probing."""
        self._excused = next(reversed(self.tracker.jobs()), None)

    def _moved_by_others(self) -> str:
        """The axis that is not at the end of the last move, as text; empty if all are."""
        jobs = self.tracker.jobs()
        if not jobs or jobs[-1] is self._excused:
            return ""
        both = self._machine.axis_values(axis_rows.current_position, axis_rows.jog_offset)
        here, jogs = both[: len(both) // 2], both[len(both) // 2 :]
        for axis, at, jog, end in zip(
            self.settings.axes, here, jogs, jobs[-1].finish_cnt, strict=True
        ):
            if abs(at + jog - end) > PULSES_OFF:
                at_u, end_u = (at + jog) / axis.pulses_per_unit, end / axis.pulses_per_unit
                return f"axis {axis.name} is at {at_u:.6g}, its program position is {end_u:.6g}"
        return ""

    def strayed(self) -> str:
        """Where the machine is if it is on none of the moves it was sent, as text; else empty."""
        current = self.tracker.current
        if current is None or current is self._excused:
            return ""
        here = self.host.position()
        if any(self._is_near(job, here) for job in self.tracker.near()):
            return ""
        places = " ".join(f"{axis.name}{here[axis.index]:.6g}" for axis in self.settings.axes)
        return f"it is at {places}, off the path of line {current.entry.source.line}"

    def _is_near(self, job: Job, here: c.Point) -> bool:
        """Whether a machine is as near to a move as corners, holds and rounding explain."""
        tolerance_u = max(job.path_tolerance_u, job.tolerance_u)
        near_u = NEAR_TOLERANCES * tolerance_u + (NEAR_MM if self.settings.is_metric else NEAR_INCH)
        return apart_u(job.entry, job.begin, here, self._weights) <= near_u

    def _is_short(self) -> bool:
        """Whether the card soon runs out of moves."""
        following = self.tracker.jobs()[1:]
        return sum(map(time_s, following)) < SHORT_S

    @property
    def is_starved(self) -> bool:
        """Whether the program has to wait for its sender."""
        return self._feed is not None and self._feed.is_starved

    def go_on(self) -> None:
        """Continue after a halt."""
        if self._feed is not None:
            self._feed.go_on()

    def _send(self, jobs: Iterable[Job]) -> None:
        jobs = list(jobs)
        for job in jobs:
            if isinstance(job.entry, c.Rapid):
                before, level = self._rapid_level, job.finish[c.TOOL_AXIS]
                self._rapid_level = level if before is None else max(before, level)
        self._sent += send(self._machine, self._encoder, self.tracker, jobs)

    def probe(self, entry: c.Probe) -> Steps:
        """Make a probing move (G31), from rest to rest."""
        feed = self._feed
        if feed is not None:
            yield from self._probing.steps(feed.probe(entry), self._encoder.job)
            feed.position = self.host.position()
            self.excuse()

    # --- withdrawing and rejoining ---------------------------------------------------------------

    def place(self) -> Place | None:
        """The place of a held machine on its path."""
        job = self.tracker.current
        return place(job, self.host.position()) if job else None

    def is_off(self, point: c.Point) -> bool:
        """Whether the machine has been moved away from where it was held."""
        return bool(self._moved_axes(self.host.position(), point))

    def _moved_axes(self, here: c.Point, point: c.Point) -> set[int]:
        """The axes that are no longer at a point."""
        return {
            axis.index
            for axis in self.settings.axes
            if abs(here[axis.index] - point[axis.index])
            > max(axis.in_position_u, PULSES_OFF / axis.pulses_per_unit)
        }

    def require_return_path(self, point: c.Point) -> None:
        """UserError if returning to a point may cross the part: no clear level is known."""
        self._level(self.host.position(), point)

    def _level(self, here: c.Point, target: c.Point) -> float:
        """The level of the tool axis at which the tool travels to a point.

        A tool that was only moved along its axis needs no level. Otherwise it is the highest
        level of the rapids of this program, or the one it was raised to by hand.
        """
        moved, axis = self._moved_axes(here, target), c.TOOL_AXIS
        high = max(here[axis], target[axis])
        if moved <= {axis} or all(one.index != axis for one in self.settings.axes):
            return high
        if self._rapid_level is not None:
            return max(high, self._rapid_level)
        if axis in moved and here[axis] > target[axis]:
            return high
        raise UserError(
            "the tool was moved off its path, and no rapid of the program has shown a clear"
            f" level yet: raise {self.settings.axis(axis).name} by hand first"
        )

    def retake(self) -> Steps:
        """Stop, withdraw every unfinished move, and read them again.

        It may be cancelled anywhere, and started again.
        """
        if self._feed is None:
            return
        self.is_retaking = True
        try:
            with self._machine.repeating():
                self.hold()
                yield self.stops()
                yield from self.withdraw(self.host.position())
        finally:
            self.is_retaking = False

    def stops(self) -> Until:
        """Wait until a feed hold is at rest; alarm 15 if it does not come to rest."""
        return Until(
            "stops",
            lambda sample: sample.is_held or not sample.is_moving,
            self.settings.rest_s,
            alarms.NO_REST,
        )

    def withdraw(self, here: c.Point) -> Steps:
        """Withdraw the rest of the path from the card, for a machine held at `here`."""
        self.insert_first(self._withdrawn(here))
        yield from self.drop_moves()

    def insert_first(self, jobs: list[Job]) -> None:
        """Insert moves before all remaining moves of the program."""
        if self._feed is not None:
            self._feed.replace(jobs)

    def rejoin(self, target: c.Point, left: Place | None) -> Steps:
        """Return to where the machine was held, then continue the path."""
        feed = self._feed
        if feed is None:
            return
        here = self.host.position()
        leading = self._leading(here, target, left)
        jobs = self._withdrawn(target)
        yield from self.drop_moves()
        feed.replace([*leading, *jobs])

    def _leading(self, here: c.Point, target: c.Point, left: Place | None) -> list[Job]:
        """The moves back to where the machine was held, with a lead-in arc where possible."""
        if left is None:
            return self._straight_back(here, target)
        level_u = self._level(here, target)
        was_raised = self._moved_axes(here, target) <= {c.TOOL_AXIS}
        radius_u = 0.0 if was_raised else self.settings.lead_in_u
        leading = self._jobs(lead_in(left, here, level_u, radius_u), here)
        if any(first_excess(job, self.settings) for job in leading):
            leading = self._jobs(lead_in(left, here, level_u, 0.0), here)
        return leading

    def come_back(self, target: c.Point) -> None:
        """Insert straight moves back to a point where the machine rested."""
        jobs = self._straight_back(self.host.position(), target)
        if self._feed is not None and jobs:
            self.excuse()
            self._feed.replace(jobs)

    def _straight_back(self, here: c.Point, target: c.Point) -> list[Job]:
        job = self.tracker.current
        source, pace = (job.entry.source, pace_of(job)) if job else (c.Source("", 1, ""), None)
        level_u = self._level(here, target)
        return self._jobs(straight_back(source, here, target, level_u, pace), here)

    def return_to_begin(self) -> Steps:
        """Return straight to where the program was started, if a clear tool level is known."""
        try:
            jobs = self._straight_back(self.host.position(), self._begin)
        except UserError as refused:
            yield from self._entry_actions.steps(c.Say(c.Source("", 1, ""), f"stays: {refused}"))
            return
        self._send(jobs)
        yield Until("back to the start", self.tracker.is_at_end)

    def drop_moves(self) -> Steps:
        """Drop the moves on the card and reset the counter; alarm 15 if motion continues.

        A kill that cannot be cleared was set by another host or by the card; it then raises
        alarm 14.
        """
        self._curve.drop()
        self._machine.stop()
        limit_s = self.settings.rest_s
        yield Until("moves end", lambda sample: not sample.is_moving, limit_s, alarms.NO_REST)
        yield Until("kill is seen", lambda sample: sample.is_killed, KILL_S)
        self._machine.clear_kill()
        self._machine.reset_counter()
        self.tracker.reset()
        self.may_lack_moves = False
        # A state sampled before the counter reset must not count as the end of new moves.
        yield Until(
            "kill is cleared", lambda sample: not sample.is_killed and sample.counter == 0, CLEAR_S
        )

    def _jobs(self, entries: Iterator[Motion], begin: c.Point) -> list[Job]:
        jobs = []
        for entry in entries:
            jobs.append(self._encoder.job(entry, begin))
            begin = entry.end
        return [job for job in jobs if job.length_u > 0.0]

    def _withdrawn(self, here: c.Point) -> list[Job]:
        """The rest of the move held at `here`, and the moves after it."""
        is_planned = self.is_planned
        jobs, held, rest = self.tracker.withdraw(), None, []
        if jobs and 0 < jobs[0].count <= self.tracker.started:
            held = jobs.pop(0)
            while is_planned and jobs and self._is_on(jobs[0], held, here):
                self.tracker.trail.add(held)
                held = jobs.pop(0)
            first = first_of(held.entry, held.begin, here)
            for piece in self.pieces_of(held, first, held.begin):
                self.tracker.trail.add(piece)
            rest = self.pieces_of(held, rest_of(held.entry, held.begin, here), here)
        if self._feed is not None:
            self._feed.restart_count(jobs, held, rest[0] if rest else None)
        return rest + jobs

    def _is_on(self, job: Job, before: Job, here: c.Point) -> bool:
        """Whether a machine that rests within a planned curve is on a move, not the one before.

        The piece of the curve that is executed may lead from one to the other.
        """
        if job.count > self.tracker.started + 1:
            return False
        to_job, to_before = (
            apart_u(one.entry, one.begin, here, self._weights) for one in (job, before)
        )
        return to_job < to_before

    def pieces_of(self, whole: Job, entry: Motion, begin: c.Point) -> list[Job]:
        """A part of a move as a separate move; empty if it has no length."""
        part = self._encoder.job(entry, begin)
        part.block = whole.block
        return [part] if part.length_u > 0.0 else []
