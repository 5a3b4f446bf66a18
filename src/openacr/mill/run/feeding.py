"""Feed of a program: converts canonical entries to planned moves and to halts at rest.

The feed reads ahead of the machine: moves go through the planner; everything else is a
halt, which acts when all moves before it are done, or a note, which acts without a stop.
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
from openacr.mill.plan.curves.planned_path import PlannedPath
from openacr.mill.plan.estimate.route import Route
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.plan.moves.travel_limits import first_excess, unhomed
from openacr.mill.run.tracking import Tracker

READ_TOGETHER = 32


@dataclass(frozen=True, slots=True)
class Fault:
    """An alarm found in reading; it ends the program before its block acts."""

    kind: Kind
    detail: str
    source: Source | None = None


@dataclass(frozen=True, slots=True)
class InPosition:
    """The in-position wait of G9 and G61 after a move."""

    source: Source


@dataclass(frozen=True, slots=True)
class Starved:
    """Marker: no more of the program has arrived."""


Halt = Entry | Fault | InPosition


@dataclass(frozen=True, slots=True)
class Note:
    """An entry that acts without a stop, when the move before it is done."""

    entry: Say | SetCell | Output | Coolant
    after: Job | None  # the move before it


class Feed:
    """Reads the entries of one program and plans its moves."""

    def __init__(
        self, entries: Iterator[Entry | Starved], begin: Point, settings: Settings, encoder: Encoder
    ) -> None:
        self._entries = entries
        self._settings = settings
        self._encoder = encoder
        self._planner = Route(settings)
        self._waits = any(axis.in_position_u > 0.0 for axis in settings.axes)
        self._has_begun = False
        self._last: Job | None = None
        self.position = begin  # after everything read so far
        self.block = 0  # blocks read
        self.halt: Halt | None = None
        self.notes: deque[Note] = deque()
        self._lines: Iterator[Job] = iter(())  # of the current polyline
        self._again: deque[Job] = deque()  # withdrawn from the card, to be sent again
        self._next_halt: Halt | None = None
        self.is_single = False
        self.is_starved = False

    # --- reading ----------------------------------------------------------------------

    def read(self, room: int) -> None:
        """Read until `room` moves may be sent, or a halt is reached."""
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
        """Plan a withdrawn move again; in single block every block stops again."""
        self._planner.add(job)
        is_last = not self._again
        if self.is_single and (is_last or self._again[0].block != job.block):
            self.halt = BlockEnd(job.entry.source)
        elif is_last:
            self.halt, self._next_halt = self._next_halt, None

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
            self._accept(job)
            if self.halt is not None:
                return
        self._confirm(entry)

    def _read_line(self, job: Job) -> None:
        """Read one line of a polyline, which is a block of its own."""
        self._accept(job)
        self.block += 1
        if self.halt is None and isinstance(job.entry, Line):
            self._confirm(job.entry)
        if self.is_single and not isinstance(self.halt, Fault):
            end = BlockEnd(job.entry.source)
            if self.halt is None:
                self.halt = end
            else:
                self._next_halt = end

    def _confirm(self, entry: Rapid | Line | Arc) -> None:
        """Add the in-position wait of G9 and G61, if an in-position band is configured."""
        how = entry if isinstance(entry, Rapid) else entry.pace
        if self._waits and how.is_confirmed:
            self.halt = InPosition(entry.source)

    def _accept(self, job: Job) -> None:
        """Plan a move, or set its fault as the halt."""
        self.halt = self._fault(job)
        if self.halt is not None:
            return
        job.block = self.block
        self.position = job.finish
        if job.length_u > 0.0:
            self._last = job
            self._planner.add(job)

    def _fault(self, job: Job) -> Fault | None:
        """The fault that bars a move; None if it may be made."""
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
        """The job of a probing move, which is sent separately."""
        return self._encoder.job(entry, self.position)

    # --- sending ----------------------------------------------------------------------

    def release(self, room: int, *, is_urgent: bool = False) -> Iterator[Job]:
        """Yield moves to be sent now, with their end speeds.

        `is_urgent`: the card runs out of moves and no more arrive. The known path then ends
        at rest, and continues from there.
        """
        is_complete = self.halt is not None
        is_urgent = is_urgent and self.is_starved and self._has_begun
        if not self._has_begun and not is_complete:
            self._has_begun = len(self._planner) >= self._settings.drip_threshold
        if self._has_begun or is_complete:
            self._has_begun = True
            yield from self._planner.release(room, is_complete=is_complete or is_urgent)

    def curve(self, *, is_at_rest: bool) -> PlannedPath | None:
        """The planned curve whose turn it is; None while moves are sent one by one."""
        if is_at_rest:
            self._planner.go_on()
        return self._planner.curve

    @property
    def is_complete(self) -> bool:
        """Whether the present moves or curve end at rest: something else follows, or nothing."""
        return self.halt is not None or self._planner.has_more

    def jobs(self) -> Iterator[Job]:
        """The moves that were read and are not sent yet."""
        yield from self._planner
        yield from self._again

    @property
    def is_empty(self) -> bool:
        """Whether every move read so far is sent."""
        return not len(self._planner)

    def passed(
        self, tracker: Tracker, *, is_at_rest: bool
    ) -> Iterator[Say | SetCell | Output | Coolant]:
        """Yield the notes whose moves are done."""
        while self.notes and tracker.is_done(self.notes[0].after, is_at_rest=is_at_rest):
            yield self.notes[0].entry
            self.notes.popleft()  # only after it has taken effect

    def go_on(self) -> None:
        """End the halt; one deferred by a single-block stop comes next."""
        if self._again:
            self.halt = None
        else:
            self.halt, self._next_halt = self._next_halt, None

    # --- changed path ------------------------------------------------------------------

    def replace(self, jobs: list[Job]) -> None:
        """Insert moves before those that were read and are not sent yet."""
        self._again = deque([*jobs, *self._planner.clear(), *self._again])
        self._has_begun = True
        if not self._again:
            return  # a pending halt still comes next
        if self._next_halt is None:
            self._next_halt = self.halt
        self.halt = None

    def restart_count(self, jobs: list[Job], held: Job | None, rest: Job | None) -> None:
        """Restart packet numbers at zero: `rest` remains of the held move, `jobs` follow it."""
        for job in jobs:
            job.count = 0
        for _ in range(len(self.notes)):
            note = self.notes.popleft()
            is_held = held is not None and note.after is held
            self.notes.append(Note(note.entry, rest if is_held else _if_ahead(note.after)))


def _if_ahead(job: Job | None) -> Job | None:
    """The move if it is still to be sent, that is, has no packet number."""
    return job if job is not None and not job.count else None


def _fault_of(error: BlockError) -> Fault:
    """The fault of a block error: code `Ann` is alarm nn, every other code alarm 60."""
    finding = error.finding
    if finding.code.startswith("A"):
        kind = alarms.kind(int(finding.code[1:]))
        axis = finding.text.partition(": ")[2] if kind is alarms.NOT_HOMED else ""
        return Fault(kind, axis or f"line {finding.line}")
    return Fault(alarms.PROGRAM_ERROR, str(finding))
