"""The machine of a run: a `Controller` with its project loaded."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np

from openacr.basic.language.lister import Lister
from openacr.channels import StreamKind
from openacr.cli.plots import AxisCurves, BitCurve, Curves, ValueCurve
from openacr.cli.results import AxisReport, Event, Failure, Watched
from openacr.cli.run import card_view
from openacr.cli.run.events import EventLog
from openacr.controller import Controller
from openacr.controller.recorder import Recorder
from openacr.engine.watches import WATCHES, Watch
from openacr.errors import SourceError, UserError
from openacr.lang.characters import as_typed, readable, shown
from openacr.map.memory import Memory
from openacr.project import Project
from openacr.scenario import Condition
from openacr.scenario.watches import watches

FIRST_OUTPUT = 32
OUTPUTS = 32


def load(project: Project) -> tuple["ControlledMachine", list[SourceError]]:
    """Load a project into a new card; also give the lines the card has refused."""
    controller, refused = Controller.load(project)
    return ControlledMachine(controller), refused


class ControlledMachine:
    """A controller, seen as what a run needs."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._begin_s = controller.time_s
        self._streams: dict[str, int] = {}
        self._overhear: Callable[[str], None] = lambda text: None
        self._awaits_text = False
        self._was_heard = False
        self._watched: tuple[Watched, ...] = ()
        self._event_watches: list[Watch] = []
        self._events = EventLog(
            controller.memory, controller.model.axes, self._titles(), self.failure
        )

    @property
    def memory(self) -> Memory:
        """All parameters and flags."""
        return self._controller.memory

    @property
    def tick(self) -> int:
        """Servo periods lived so far."""
        return self._controller.lived_tk

    @property
    def time_s(self) -> float:
        """Simulated seconds lived so far."""
        return self._controller.lived_tk * self._controller.period_s

    @property
    def period_s(self) -> float:
        """Seconds per tick."""
        return self._controller.period_s

    def digest(self) -> str:
        """Fingerprint of the whole state."""
        return self._controller.digest()

    def has_new_events(self) -> bool:
        """Whether axes or programs have come into use since `watch`: call it once more."""
        return self._events.watches() != self._event_watches

    def watch(self, conditions: Sequence[Condition]) -> bool:
        """Make `advance` end when one of these may have changed; False if that is too much."""
        wanted = [watch for each in conditions for watch in watches(each, self.memory)]
        self._awaits_text = any(condition.printed for condition in conditions)
        of_events = self._event_watches = self._events.watches()
        is_possible = len(wanted) + len(of_events) <= WATCHES
        self._controller.watch(of_events + wanted if is_possible else of_events, self._look)
        return is_possible

    def events(self) -> list[Event]:
        """What happened to the machine since the last call."""
        return self._events.poll(self.time_s - self._begin_s)

    def _look(self) -> bool:
        """Read what terminals have answered in this tick; True if a text is waited for."""
        self._read_terminals()
        was_heard, self._was_heard = self._was_heard, False
        return was_heard and self._awaits_text

    def advance(self, ticks: int) -> None:
        """Run the card for `ticks` ticks, fewer if something watched changes."""
        self._controller.advance(ticks)
        self._read_terminals()

    def advance_until(self, bit: int, is_on: bool, ticks: int) -> bool:
        """Let the card live until a flag has this state, but no longer than `advance` would."""
        has_come = self._controller.until(bit, is_on, ticks=ticks)
        self._read_terminals()
        return has_come

    def listen(self, hear: Callable[[str], None], overhear: Callable[[str], None]) -> None:
        """Call `hear` with what programs print, `overhear` with what terminals answer."""

        def take(program: int, text: str) -> None:
            self._was_heard = True
            hear(readable(text))

        self._controller.listen(take)
        self._overhear = overhear

    def type_text(self, text: str, stream: str | None) -> None:
        """Type text on a stream, by default the console."""
        name = stream or ""
        if name not in self._streams:
            self._streams[name] = self._open(stream)
        self._controller.type_lines(self._streams[name], as_typed(text))
        self._read_terminals()

    @contextmanager
    def journalled(self, path: Path, project: Project) -> Iterator[None]:
        """Write everything that enters meanwhile to a file."""
        card, root = self._controller, str(project.root)
        card.recorder = Recorder(card, path, project=root, fingerprint=project.fingerprint)
        try:
            yield
        finally:
            card.close()

    def _open(self, stream: str | None) -> int:
        controller = self._controller
        if stream is None:
            return controller.console
        if stream not in controller.system.sessions:
            known = ", ".join(controller.system.sessions)
            raise UserError(f"stream {stream}: the {controller.model.name} has {known}")
        kind = _KINDS.get(stream[:3], StreamKind.TERMINAL)
        return controller.open_stream(kind, stream)

    def _read_terminals(self) -> None:
        for stream in self._streams.values():
            if data := b"".join(iter(partial(self._controller.take_output, stream), b"")):
                self._was_heard = True
                self._overhear(readable(data.decode("latin-1")))

    def start_all(self) -> None:
        """Start every stored program, as RUN ALL does."""
        self.type_text("SYS\rRUN ALL\r", None)

    def failure(self, program: int) -> Failure:
        """Say what ended a program with an error, and in which line."""
        system, line = self._controller.system, card_view.program_line(self.memory, program)
        stored = system.programs.texts[program].get(line)
        text = Lister(system.aliases.nodes).line(stored.tokens) if stored else ""
        file, file_line = self._controller.origin(program, line) or (None, None)
        error = self._controller.executor.threads.failures.get(program, "error")
        return Failure(error, readable(text), file and shown(file), file_line)

    def set_input(self, bit: int, on: bool) -> None:
        """Switch an input."""
        self._controller.set_input(bit, on)

    def release_input(self, bit: int) -> None:
        """Let go of an input that was switched."""
        self._controller.release_input(bit)

    def fault(self, axis: int, kind: str, value: float) -> None:
        """Let something go wrong with an axis of the machine."""
        self._controller.fault(axis, kind, value)

    def mend(self, axis: int, kind: str | None) -> None:
        """End one kind of fault of an axis, or all."""
        self._controller.mend(axis, kind)

    def set_analog(self, parameter: int, value: float) -> None:
        """Bring a value to the analog input a parameter shows."""
        self._controller.set_analog(parameter, value)

    def drag(self, axis: int, by_u: float) -> None:
        """Move the load of an axis by hand, at once."""
        self._controller.drag(axis, by_u)

    def axis_reports(self) -> list[AxisReport]:
        """Position and extremes of every axis."""
        return [
            AxisReport(
                number,
                found.position_u,
                found.actual_u,
                found.distance_u,
                found.peak_velocity_ups,
                found.peak_following_error_u,
            )
            for number in range(self._controller.model.axes)
            for found in (self._controller.statistics(number),)
        ]

    def record(self, every_tk: int, *, keep_peaks: bool, watched: Sequence[Watched] = ()) -> None:
        """Record once in `every_tk` ticks from now on, with the peaks between if wanted."""
        samples = [one.sample(self.memory) for one in watched]
        self._watched = tuple(watched)
        self._controller.record(every_tk, keep_peaks=keep_peaks, samples=samples)

    def curves(self, title: str) -> Curves:
        """Give what was recorded, in time since the start of the run."""
        trace = self._controller.trace()
        masters, names = card_view.masters_of_axes(self.memory), self._names()
        units = {axis.number: axis.units for axis in self._controller.world.axis}
        axes = tuple(
            AxisCurves(
                number,
                axis.commanded_u,
                axis.actual_u,
                axis.velocity_ups,
                axis.following_error_u,
                name=names.get(number, ""),
                unit=units.get(number, "units"),
                master=masters.get(number),
            )
            for number, axis in enumerate(trace.axes)
        )
        chosen = list(zip(self._watched, trace.values.T, strict=True))
        bits = tuple(
            BitCurve(FIRST_OUTPUT + output, (trace.outputs >> output & 1).astype(np.bool_))
            for output in range(OUTPUTS)
        )
        return Curves(
            trace.time_s - self._begin_s,
            axes,
            bits,
            title,
            watched=tuple(ValueCurve(one, values) for one, values in chosen),
        )

    def _names(self) -> dict[int, str]:
        """Name every axis as its first program calls it, else as the machine file does."""
        names: dict[int, str] = {}
        for name, axis in self._attached():
            names.setdefault(axis, name)
        return {axis.number: axis.name for axis in self._controller.world.axis} | names

    def _titles(self) -> dict[int, str]:
        return {number: f"{name} (axis {number})" for number, name in self._names().items()}

    def _attached(self) -> Iterator[tuple[str, int]]:
        for program in card_view.PROGRAMS:
            yield from self._controller.card.attachments.axes(program)


_KINDS = {"COM": StreamKind.SERIAL, "DPC": StreamKind.DPCB}
