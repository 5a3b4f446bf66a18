"""From canonical entries to moves ready to be sent, and the things that wait for rest.

The feed reads ahead of the machine: moves go through the planner, everything else is a
halt - it acts when all moves before it are done - or a note, which takes effect in passing.
"""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

from openacr.cnc.canonical import (
    Arc,
    BlockEnd,
    Coolant,
    Entry,
    Line,
    Output,
    Point,
    Polyline,
    Probe,
    Rapid,
    Say,
    SetCell,
    Source,
)
from openacr.cnc.reading.findings import BlockError
from openacr.mill.card import alarms
from openacr.mill.card.alarms import Kind
from openacr.mill.config.settings import Settings
from openacr.mill.plan.encoding import Encoder, Job
from openacr.mill.plan.planning import CornerRules, Planner
from openacr.mill.plan.travel_limits import first_excess, unhomed
from openacr.mill.run.tracking import Tracker

READ_TOGETHER = 32


@dataclass(frozen=True, slots=True)
class Fault:
    """What ends the program where it was found: before its block acts."""

    kind: Kind
    detail: str
    source: Source | None = None


@dataclass(frozen=True, slots=True)
class InPosition:
    """The wait of G9 and G61 behind a move."""

    source: Source


@dataclass(frozen=True, slots=True)
class Starved:
    """Nothing more of the program has arrived."""


Halt = Entry | Fault | InPosition


@dataclass(frozen=True, slots=True)
class Note:
    """What takes effect in passing, when the moves up to a number are done."""

    entry: Say | SetCell | Output | Coolant
    behind: Job | None  # the move before it


class Feed:
    """The way of one program's entries to the card."""

    def __init__(
        self, entries: Iterator[Entry | Starved], begin: Point, settings: Settings, encoder: Encoder
    ) -> None:
        self._entries = entries
        self._settings = settings
        self._encoder = encoder
        self._planner: Planner[Job] = Planner(
            CornerRules.of(settings.speeds), settings.forward_threshold
        )
        self._waits = any(axis.in_position_u > 0.0 for axis in settings.axes)
        self._has_begun = False
        self._last: Job | None = None
        self.position = begin  # behind everything read so far
        self.block = 0  # blocks read
        self.halt: Halt | None = None
        self.notes: deque[Note] = deque()
        self._lines: Iterator[Job] = iter(())  # of the polyline that is being read
        self._again: deque[Job] = deque()  # taken back from the card, still to be made
        self._halt_behind: Halt | None = None
        self.is_single = False
        self.is_starved = False

    # --- reading ----------------------------------------------------------------------

    def read(self, room: int) -> None:
        """Read on until `room` moves may leave, or something has to wait for rest."""
        self.is_starved = False
        while self.halt is None and not self.is_starved and self._wants_more(room):
            for _ in range(READ_TOGETHER):
                self._read_one()
                if self.halt is not None or self.is_starved:
                    break

    def _wants_more(self, room: int) -> bool:
        if not self._has_begun and len(self._planner) < self._settings.drip_threshold:
            return True
        return self._planner.ready() < max(room, 1)

    def _read_one(self) -> None:
        if self._again:
            self._repeat(self._again.popleft())
        elif (job := next(self._lines, None)) is not None:
            self._read_line(job)
        else:
            self._read_entry()

    def _repeat(self, job: Job) -> None:
        """A move that was taken back; in single block every block stops once more."""
        self._planner.add(job)
        is_last = not self._again
        if self.is_single and (is_last or self._again[0].block != job.block):
            self.halt = BlockEnd(job.entry.source)
        elif is_last:
            self.halt, self._halt_behind = self._halt_behind, None

    def _read_entry(self) -> None:
        try:
            entry = next(self._entries, None)
        except BlockError as error:
            self.halt = _fault_of(error)
            return
        if isinstance(entry, Starved):
            self.is_starved = True
        elif entry is None:
            self.halt = Fault(alarms.PROGRAM_ERROR, "the program has no end")
        elif isinstance(entry, Polyline):
            self._lines = self._encoder.jobs(entry, self.position)
        elif isinstance(entry, Rapid | Line | Arc):
            self._move(entry)
        elif isinstance(entry, Probe):
            self.halt = self._fault(self.probe(entry)) or entry
        elif isinstance(entry, BlockEnd):
            self.block += 1
            if self.is_single:
                self.halt = entry
        elif isinstance(entry, Say | SetCell) or (
            self._settings.on_the_fly and isinstance(entry, Output | Coolant)
        ):
            self.notes.append(Note(entry, self._last))
        else:
            self.halt = entry

    def _move(self, entry: Rapid | Line | Arc) -> None:
        for job in self._encoder.jobs(entry, self.position):
            self._take_up(job)
            if self.halt is not None:
                return
        if isinstance(entry, Line | Arc):
            self._confirm(entry)

    def _read_line(self, job: Job) -> None:
        """One line of a polyline: a block of its own."""
        self._take_up(job)
        self.block += 1
        if self.halt is None and isinstance(job.entry, Line):
            self._confirm(job.entry)
        if self.is_single and not isinstance(self.halt, Fault):
            end = BlockEnd(job.entry.source)
            if self.halt is None:
                self.halt = end
            else:
                self._halt_behind = end

    def _confirm(self, entry: Line | Arc) -> None:
        """G9 and G61 wait until all axes are in position, where a band says what that is."""
        if self._waits and entry.pace.is_confirmed:
            self.halt = InPosition(entry.source)

    def _take_up(self, job: Job) -> None:
        """One more move, or why it may not be made."""
        self.halt = self._fault(job)
        if self.halt is not None:
            return
        job.block = self.block
        self.position = job.finish
        if job.length_u > 0.0:
            self._last = job
            self._planner.add(job)

    def _fault(self, job: Job) -> Fault | None:
        """Why a move may not be made at all."""
        source = job.entry.source
        axis = unhomed(job, self._settings)
        if axis is not None:
            return Fault(alarms.NOT_HOMED, axis.name, source)
        excess = first_excess(job, self._settings)
        if excess is not None:
            return Fault(alarms.TARGET_BEYOND, f"line {source.line}, {excess}", source)
        beyond = self._encoder.beyond_pulses(job)
        if beyond is not None:
            detail = f"line {source.line}: E403 {beyond} is beyond 32 bits of pulses"
            return Fault(alarms.PROGRAM_ERROR, detail, source)
        return None

    def probe(self, entry: Probe) -> Job:
        """The job of a probing move; it is sent by itself."""
        return self._encoder.job(entry, self.position)

    # --- leaving ----------------------------------------------------------------------

    def take(self, room: int, *, is_urgent: bool = False) -> Iterator[Job]:
        """Moves to be sent now, with the speed they end with.

        `is_urgent`: the card runs out of moves, and nothing more arrives. The way ends at
        rest then, as far as it is known, and goes on from there.
        """
        is_complete = self.halt is not None
        is_urgent = is_urgent and self.is_starved and self._has_begun
        if not self._has_begun and not is_complete:
            self._has_begun = len(self._planner) >= self._settings.drip_threshold
        if self._has_begun or is_complete:
            self._has_begun = True
            yield from self._planner.take(room, is_complete=is_complete or is_urgent)

    def jobs(self) -> Iterator[Job]:
        """The moves that have been read and have not left yet."""
        yield from self._planner
        yield from self._again

    @property
    def is_empty(self) -> bool:
        """Every move read so far has left."""
        return not len(self._planner)

    def passed(
        self, tracker: Tracker, *, is_at_rest: bool
    ) -> Iterator[Say | SetCell | Output | Coolant]:
        """The notes whose moment has come."""
        while self.notes and tracker.is_done(self.notes[0].behind, is_at_rest=is_at_rest):
            yield self.notes[0].entry
            self.notes.popleft()  # not before it has taken effect

    def go_on(self) -> None:
        """The halt is over; one that was set aside for a stop behind a block comes next."""
        if self._again:
            self.halt = None
        else:
            self.halt, self._halt_behind = self._halt_behind, None

    # --- another way ------------------------------------------------------------------

    def replace(self, jobs: list[Job]) -> None:
        """Make these moves, then those that have been read and have not left yet."""
        self._again = deque([*jobs, *self._planner.clear(), *self._again])
        self._has_begun = True
        if not self._again:
            return  # a halt that waits for rest is still what comes next
        if self._halt_behind is None:
            self._halt_behind = self.halt
        self.halt = None

    def count_anew(self, jobs: list[Job], held: Job | None, rest: Job | None) -> None:
        """The card counts from zero: `rest` is left of the held move, `jobs` come behind it."""
        for job in jobs:
            job.count = 0
        for _ in range(len(self.notes)):
            note = self.notes.popleft()
            is_held = held is not None and note.behind is held
            self.notes.append(Note(note.entry, rest if is_held else _if_ahead(note.behind)))


def _if_ahead(job: Job | None) -> Job | None:
    """A move that has no number of a packet, so it is not done."""
    return job if job is not None and not job.count else None


def _fault_of(error: BlockError) -> Fault:
    """An error of a block; codes `Ann` are alarms of their own, all others are alarm 60."""
    finding = error.finding
    if finding.code.startswith("A"):
        return Fault(alarms.kind(int(finding.code[1:])), f"line {finding.line}")
    return Fault(alarms.PROGRAM_ERROR, str(finding))
