"""The composition root: one virtual card with the world around it.

Everything that changes a card from outside enters here - bytes on a stream, an input that
switches - and is recorded in the journal with its tick. The same entries at the same ticks
give the same state: `digest` is equal on every machine and build of the core.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.channels import StreamKind
from openacr.controller import snapshot as snapshots
from openacr.controller.changes import Changes
from openacr.controller.engine_run import AskLine, EngineRun
from openacr.controller.inputs import JournalFile
from openacr.controller.loading import PATIENCE_S, EmptyStart, Loader, LoadError, Origins
from openacr.controller.pages import card_page
from openacr.controller.parts import CardParts
from openacr.controller.realtime_card import SILENCE_S, RealtimeCard
from openacr.controller.streams import CONSOLE
from openacr.controller.surroundings import Surroundings, needs_axis
from openacr.controller.trace import Trace
from openacr.controller.views import AxisStatistics, AxisView
from openacr.engine.samples import Sample
from openacr.engine.watches import (
    Places,
    Watch,
    Words,
    give_orders,
    state_differences,
    state_image,
    take_orders,
)
from openacr.errors import CardError, SourceError, StoreError, UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.lang.characters import as_typed
from openacr.map.memory import digest_of
from openacr.map.rows import fast_status as fast_status_rows
from openacr.map.rows import programs as program_rows
from openacr.models import DEFAULT_MODEL, Model
from openacr.plant.describe import load, schema
from openacr.plant.world.world_view import WorldView
from openacr.project import Project, find_project
from openacr.protocol.events import ControlKey
from openacr.protocol.status import GROUPS, WORDS, FastStatus

if TYPE_CHECKING:
    from openacr.fieldbus.machine.realtime_bus import RealtimeBus


class Controller:
    """A virtual card; see docs/overview.md for the design."""

    def __init__(
        self,
        model: str | Model = DEFAULT_MODEL,
        *,
        world: schema.World | str | Path | None = None,
        data: str | Path | None = None,
        device_folder: str | Path | None = None,
    ) -> None:
        """A card that is new, or found in the folder `data`.

        `world` is the machine around it, or its machine.toml, whose folder is then the one of
        `device_folder`. SourceError for a machine.toml with mistakes, UserError for files that
        cannot be read.
        """
        if isinstance(world, str | Path):
            device_folder = device_folder or Path(world).parent
            world = load.load_world(world)
        device_folder = None if device_folder is None else Path(device_folder)
        parts = self._parts = CardParts(
            model,
            world=world,
            data=None if data is None else Path(data),
            device_folder=device_folder,
        )
        self.device_folder = device_folder  # of Python files with devices of the world
        self.model, self.world, self.card, self.memory = (
            parts.model, parts.world, parts.card, parts.memory
        )  # fmt: skip
        self.clock = parts.clock
        self.system, self.executor, self.control = parts.system, parts.executor, parts.control
        self.plcs, self.networks, self.streams = parts.plcs, parts.networks, parts.streams
        self.devices = parts.devices
        self.nonvolatile, self.p, self.bit = parts.nonvolatile, parts.p, parts.bit
        self._inputs = parts.inputs
        self._engine = EngineRun(parts)
        self._inputs.place = lambda: self._engine.within
        self._surroundings = Surroundings(self.card, self.world, self._inputs.note)
        self.world_view = WorldView(self.memory, self.world, self.devices)
        self.owns_console = False  # STREAM1, when it is open, is of the calling process
        self._origins = Origins()
        self.empty_starts: dict[int, EmptyStart] = {}  # by program (0-15) or PLC (16-23)
        self.system.programs.on_empty_start = self._note_empty

    @classmethod
    def from_project(cls, path: str | Path, *, world: schema.World | None = None) -> Controller:
        """Create a card from a project folder or controller file; LoadError on refused lines.

        `world` takes the place of the machine file of the project.
        """
        controller, errors = cls.load(find_project(path), world=world)
        if errors:
            raise LoadError(errors)
        return controller

    @classmethod
    def load(
        cls, project: Project, *, data: Path | None = None, world: schema.World | None = None
    ) -> tuple[Controller, list[SourceError]]:
        """Create a card with a project loaded; returns it with the lines it refused.

        A card that finds programs in its data folder keeps them and uses only the machine
        description of the project, like a machine that is switched on again. `world` takes the
        place of the machine file.
        """
        if world is None and project.machine:
            world = load.load_world(project.machine)
        controller = cls(
            world.card.board if world else DEFAULT_MODEL,
            world=world,
            data=data,
            device_folder=project.root,
        )
        if not all(map(controller.system.programs.is_empty, controller.system.owners())):
            controller.nonvolatile.store.notice(
                f"the card has programs in {data} and keeps them; of {project.root} only the"
                " machine is used (give an empty folder to load its programs)"
            )
            return controller, []
        session = controller.system.sessions[CONSOLE]
        session.connect()
        wait, origins = controller._wait_for_console_line, controller._origins
        errors = Loader(controller.system, session, wait, origins).load(project)
        session.disconnect()
        try:
            controller.system.start_boot_programs()
        except CardError as error:
            errors.append(SourceError(error.text, path=str(project.root)))
        return controller, errors

    # time

    @property
    def tick(self) -> int:
        """Servo interrupts since power-up."""
        return self.clock.tick

    @property
    def lived_tk(self) -> int:
        """Ticks this card has run in total; a restart does not reset the count."""
        return self.clock.lived_tk

    @property
    def time_s(self) -> float:
        """Simulated seconds since power-up."""
        return self.clock.time_s

    @property
    def period_s(self) -> float:
        """Length of a tick [s]."""
        return self.clock.period_s

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Advance the card by `ticks` ticks plus `seconds`, or until an event ends it.

        Events are those of `watch` and `announce_lines`. UserError for a time that is negative or
        not a number.
        """
        self._engine.advance(ticks, seconds=seconds)

    @property
    def was_ended(self) -> bool:
        """Whether an event ended the latest `advance`."""
        return self._engine.was_ended

    def until(
        self, bit: int, is_: bool = True, *, timeout_s: float = 60.0, ticks: int | None = None
    ) -> bool:
        """Advance the card until a flag has this state; False if it does not in time.

        MapError for a flag that does not exist, UserError for a negative time.
        """
        return self._engine.until(bit, is_, timeout_s=timeout_s, ticks=ticks)

    def watch(self, watches: Sequence[Watch] = (), poll: Callable[[], bool] | None = None) -> None:
        """End `advance` and `until` early from now on, after the tick in which an event occurs.

        An event is a change of a watch, or that `poll` returns True; `poll` is called after every
        tick in which statements were executed that can print or answer.
        """
        self._engine.watch(watches, poll)

    def take_fired(self) -> list[int]:
        """The watches that have fired since the last call, by their places in `watch`."""
        return self._engine.take_fired()

    def leave_out_rest(self, on: bool) -> None:
        """Whether ticks at rest, which change nothing but the clocks, are left out.

        They are, as far as the core is compiled; the state is the same. Who measures what a tick
        takes wants each of them in full.
        """
        self._engine.leave_out_rest(on)

    def delay_handlers(self, longest_tk: int | None, *, seed: int = 0) -> None:
        """Let ticks go on while Python works for the card, 0 to `longest_tk` ticks each time.

        So it is on a computer that controls a machine: commands, packets and networks take time,
        the servo loop does not wait for them. The ticks are drawn; an equal `seed` gives an equal
        life. With None everything takes no time again. UserError for a number below 0.
        """
        if longest_tk is not None and longest_tk < 0:
            raise UserError(f"handlers that take {longest_tk} ticks: the minimum is 0")
        self._engine.delay_handlers(-1 if longest_tk is None else longest_tk, seed)

    def real_time(
        self, silence_s: float = SILENCE_S, bus: RealtimeBus | None = None
    ) -> RealtimeCard:
        """The card on the wall clock, in a loop that waits for no work of Python (Linux).

        It lives from `start` to `close`; until then `advance`, `until` and `ask` are refused.
        Programs get no slices while Python is silent for `silence_s`; the frame of a bus is
        exchanged within the loop. UserError where the compiled
        core is missing, a journal is kept, lines are announced or the servo period is too short.
        """
        if self.announced[1] is not None:
            raise UserError("a card in real time stops before no line: end `announce_lines` first")
        self.delay_handlers(None)
        return self._engine.real_time(self, silence_s, bus)

    def announce_lines(self, programs: int = 0, ask: AskLine | None = None) -> None:
        """Call `ask(program, line)` before each line of these programs (a mask of 0-15).

        If it returns True, `advance` and `until` end there: before the line, within the tick. The
        next call completes the tick (`advance()` that alone). Without `ask`, lines run unannounced.
        """
        self._engine.announce_lines(programs, ask)

    @property
    def announced(self) -> tuple[int, AskLine | None]:
        """The programs and the `ask` of `announce_lines`."""
        return self._engine.announced

    @contextmanager
    def undisturbed(self) -> Iterator[None]:
        """Live through known time: no watch or line ends it, nothing is recorded or heard."""
        file, self._inputs.file = self._inputs.file, None
        is_kept, self._inputs.is_kept = self._inputs.is_kept, False
        taps, self.system.listeners.taps = self.system.listeners.taps, []
        try:
            with self._engine.undisturbed():
                yield
        finally:
            self._inputs.file, self._inputs.is_kept = file, is_kept
            self.system.listeners.taps = taps

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Do something with the card, between ticks or within one, of which nothing remains."""
        with self.undisturbed(), self._engine.standing():
            snapshot = snapshots.take(self)
            try:
                yield
            finally:
                snapshots.put_back(self, snapshot)
                snapshots.put_back_streams(self, snapshot)

    @property
    def within(self) -> int:
        """0 between ticks; before a line within a tick, the number of its statement in the tick.

        The statements of all programs and channels are counted, from 1.
        """
        return self._engine.within

    @property
    def announced_program(self) -> int | None:
        """The program before whose line the card stands; None if it stands between ticks."""
        return self._engine.announced_program

    @property
    def next_statement(self) -> int:
        """Number, in its tick, of the statement that follows; for an `ask` of `announce_lines`."""
        return self._engine.next_statement

    def record(
        self,
        every_tk: int = 1,
        *,
        keep_peaks: bool = False,
        samples: Sequence[Sample] = (),
    ) -> None:
        """Record all axes, and the chosen samples, once in `every_tk` ticks (1 or more) from now.

        With `keep_peaks` no peak of velocity or following error between two samples is lost:
        samples alternate between the lowest and the highest value since the previous pair.
        """
        if every_tk < 1:
            raise UserError(f"record every {every_tk} ticks: the minimum is 1")
        self._engine.recording.start(every_tk, keep_peaks=keep_peaks, samples=samples)

    def end_record(self) -> None:
        """Record no more; what has been recorded is dropped."""
        self._engine.recording.stop()

    def trace(self) -> Trace:
        """The samples recorded so far."""
        return self._engine.recording.trace()

    def take_trace(self) -> Trace:
        """The samples recorded since the last call, which are then dropped."""
        return self._engine.recording.take()

    def log_changes(self, words: Sequence[tuple[int, int]], numbers: Sequence[int] = ()) -> None:
        """Note from now on in which ticks bits change, and in which numbers do.

        `words` are places in the memory with masks, `numbers` places of numbers of 64 bits.
        """
        self._engine.changes.begin(words, numbers)

    def logged(self) -> list[int]:
        """The present values of the words of `log_changes`."""
        return self._engine.changes.present()

    def take_changes(self) -> Changes:
        """What `log_changes` has noted since the last call."""
        return self._engine.changes.take(self.clock.before_tk)

    # journals

    @property
    def journal(self) -> list[JournalEntry]:
        """The external inputs so far, in order."""
        return self._inputs.entries

    @property
    def is_journalled(self) -> bool:
        """Whether external inputs are kept in `journal`."""
        return self._inputs.is_kept

    @is_journalled.setter
    def is_journalled(self, on: bool) -> None:
        self._inputs.is_kept = on

    @property
    def recorder(self) -> JournalFile | None:
        """What writes the journal to a file, if anything does."""
        return self._inputs.file

    @recorder.setter
    def recorder(self, file: JournalFile | None) -> None:
        self._inputs.file = file

    # streams

    def open_stream(self, kind: StreamKind, name: str | None = None) -> int:
        """Open a stream for a new connection; NoFreeStreamError if all (or that one) are in use."""
        stream = self.streams.open(kind, name)
        self._inputs.note(Entered.OPEN, stream, text=kind.value, name=name or "")
        return stream

    def close_stream(self, stream: int) -> None:
        """Close the stream of an ended connection; motion and programs continue."""
        self._inputs.note(Entered.CLOSE, stream)
        self.streams.close(stream)

    def receive(self, stream: int, data: bytes) -> None:
        """Process bytes that arrived together at the present tick; UserError if not open.

        Lines and packets beyond about 2 ms of work wait for the following ticks; keys do not.
        """
        self.streams.opened(stream)
        self._inputs.note(Entered.BYTES, stream, text=data.decode("latin-1"))
        self.streams.receive(stream, data, self.clock.tick)
        self._parts.reboot_if_requested()
        self.nonvolatile.battery.follow()

    def has_stream(self, stream: int) -> bool:
        """Whether a stream with this number is open."""
        return stream in self.streams

    def type_lines(self, stream: int, data: bytes) -> None:
        """Process bytes of a caller in this process line by line, each in a turn of its own."""
        for line in data.splitlines(keepends=True) or [data]:
            self.receive(stream, line)

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""
        return self.streams.accepts_input(stream)

    def replying(self, stream: int) -> bool:
        """True while a line is being processed and is not blocked."""
        session = self.streams.session(stream)
        if session is None or not session.busy:
            return False
        return not self.executor.is_waiting(session.thread)

    def fast_status(self) -> bytes:
        """The datagram of the status service: what FSTAT0 to FSTAT9 hold, high byte first."""
        first = fast_status_rows.words[:GROUPS]
        places = (row + word for row in first for word in range(WORDS))
        return FastStatus(tuple(self.memory.I[place] for place in places)).encode()

    def take_output(self, stream: int) -> bytes:
        """Return the bytes of the next write, empty when there is nothing to send."""
        return self.streams.take_output(stream)

    @property
    def console(self) -> int:
        """The stream of the calling process, opened at first use."""
        number = self.streams.number_of(CONSOLE) if self.owns_console else None
        if number is None:
            number = self.open_stream(StreamKind.TERMINAL, CONSOLE)
            self.owns_console = True
        return number

    def send(self, text: str) -> str:
        """Type text on the console and return what the card has answered so far.

        Longer actions need card time (a LIST of more than 20 lines, a wait): use `ask`, or call
        `advance`, then `send("")` for the rest of the answer.
        """
        self.type_lines(self.console, as_typed(text))
        return self._heard()

    def ask(self, text: str, *, timeout_s: float = 60.0) -> str:
        """Type text on the console and let time pass until all of it is answered.

        Returns the whole answer, of LRUN up to the end of its program. UserError when `timeout_s`
        seconds of card time do not suffice; what was heard until then is in its text.
        """
        heard = self.send(text)
        end_tk = self.clock.tick + round(timeout_s / self.clock.period_s)
        while not self.streams.is_answered(self.console):
            if self.clock.tick >= end_tk:
                raise UserError(f"not answered within {timeout_s:g} s of the card: {heard!r}")
            self.advance(1)
            heard += self._heard()
        return heard

    def _heard(self) -> str:
        """What the console has been sent since it was last read."""
        return b"".join(iter(lambda: self.take_output(self.console), b"")).decode("latin-1")

    def press(self, key: ControlKey) -> None:
        """Press Ctrl-X (kill motion, end programs), Ctrl-Y (clear kills) or Ctrl-Z (drives off)."""
        if key not in set(ControlKey):
            raise UserError(
                f"key {key!r}: known are {', '.join(known.name for known in ControlKey)}"
            )
        self._inputs.note(Entered.KEY, int(key))
        self._parts.press(key)

    def listen(self, hear: Callable[[int, str], None]) -> None:
        """Call `hear(program, text)` with everything programs print."""
        self.system.listeners.taps.append(hear)

    # the machine around it

    def set_input(self, bit: int, on: bool) -> None:
        """Switch an input; one that the world drives is forced to this level until it is released.

        Inputs are those onboard (0-31), the miscellaneous ones (64-95), those of expansion boards
        and of CANopen nodes; UserError for any other number.
        """
        self._surroundings.set_input(bit, on)

    def release_input(self, bit: int) -> None:
        """Release a forced input: the machine drives it again; off if nothing drives it."""
        self._surroundings.release_input(bit)

    def set_analog(self, parameter: int, value: float) -> None:
        """Bring a value, in its unit, to the analog input that a parameter shows."""
        self._surroundings.set_analog(parameter, value)

    def drag(self, axis: int, by_u: float) -> None:
        """Move the load of an axis by hand, at once; the simulation continues from there."""
        self._surroundings.drag(axis, by_u)

    def fault(self, axis: int, kind: str, value: float = 0.0) -> None:
        """Cause a fault on an axis of the machine, by its number in machine.toml.

        Kinds are those of `MachineFault`; `value` is the quantity of the kind (docs/scenario.md), 0
        where it has none. It lasts until `mend`.
        """
        self._surroundings.fault(axis, kind, value)

    def mend(self, axis: int, kind: str | None = None) -> None:
        """End one kind of fault of an axis, or all of them."""
        self._surroundings.mend(axis, kind)

    def command(self, device: str, name: str, value: float = 1.0) -> None:
        """Give a command to a device of the machine by hand, as a person at it would.

        UserError for a device or command that does not exist, and for a command that is wired.
        """
        number, taken = self.devices.command(device, name, value)
        self._inputs.note(Entered.COMMAND, number, float(taken), name=name)

    # reading

    def axis(self, number: int) -> AxisView:
        """A read-only view of one axis."""
        needs_axis(self.card, number)
        return AxisView(self.card, number)

    def origin(self, program: int, line: int) -> tuple[str, int] | None:
        """Source file and line of a stored line of a program (0-15) or PLC (16-23).

        None for lines that were typed or changed since, and for lines that do not exist.
        """
        return self._origins.find(self.system.programs, program, line)

    def _note_empty(self, owner: int, thread: int) -> None:
        """Remember where a program or PLC without lines was started first."""
        origins = self._origins
        origin = (origins.path, origins.line) if origins.path else None
        if thread < PROGRAMS:
            row = program_rows.line_number[thread]
            origin = self.origin(thread, self.memory.I[row])
        self.empty_starts.setdefault(owner, EmptyStart(self.clock.lived_tk, origin))

    def statistics(self, axis: int) -> AxisStatistics:
        """Totals of an axis since power-up."""
        needs_axis(self.card, axis)
        return AxisStatistics.of(self.card, axis)

    def _repr_html_(self) -> str:
        """What notebooks show: time, motors, programs."""
        return card_page(self.system, self.world)

    def digest(self) -> str:
        """Fingerprint of the state, without what this process requested from the engine."""
        return digest_of(self.image())

    def image(self) -> bytearray:
        """A copy of the state that `digest` covers."""
        return state_image(self.memory)

    # snapshots

    def snapshot(self) -> snapshots.Snapshot:
        """The whole state at this tick; StoreError within a tick."""
        if self.within:
            raise StoreError("a card within a tick has no snapshot: complete the tick first")
        return snapshots.take(self)

    def differences(self, image: Words) -> tuple[Places, Words]:
        """The words of 64 bits of `image` that are not as in another one: places and values."""
        return state_differences(self.memory, image)

    def beside(self) -> snapshots.Beside:
        """The part of a snapshot outside the memory map."""
        return snapshots.take_beside(self)

    def restore(self, snapshot: snapshots.Snapshot) -> None:
        """Return to a snapshot of this card, or of one with the same model and world.

        A journal cannot record this: StoreError while one is being written.
        """
        if self.recorder is not None:
            raise StoreError("a card that writes a journal cannot return to a snapshot")
        orders = take_orders(self.memory)
        try:
            snapshots.put_back(self, snapshot)
        finally:
            give_orders(self.memory, orders)
        self._engine.moved_in_time()
        self.clock.before_tk = snapshot.beside.lived_before_tk

    def take_over(self, snapshot: snapshots.Snapshot) -> None:
        """Become the card of a snapshot, with every connection it had."""
        self.restore(snapshot)
        snapshots.put_back_streams(self, snapshot)
        self.owns_console |= self.streams.number_of(CONSOLE) is not None

    # the end

    def close(self) -> None:
        """Close the journal and the data folder; the card must not be used afterwards."""
        self._inputs.close()
        self.nonvolatile.close()

    # loading

    def _wait_for_console_line(self) -> bool:
        """Advance until the line on the loading session is done; False if it hangs."""
        session = self.system.sessions[CONSOLE]
        for _ in range(round(PATIENCE_S * 1000)):
            if not session.busy:
                return True
            self.advance(seconds=0.001)
        return False
