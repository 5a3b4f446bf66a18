"""The machine of a run: a `Controller` with its project loaded."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.cli.plots import AxisCurves, BitCurve, Curves, ValueCurve
from openacr.cli.results import AxisReport, Event, Watched
from openacr.cli.run.events import EventLog
from openacr.configure.setup_code import CONTACT_FLAGS, FLAGS_PER_AXIS, SWITCH_FLAGS
from openacr.controller import Controller
from openacr.controller.recorder import Recorder
from openacr.engine.watches import Watch
from openacr.errors import SourceError
from openacr.lang.characters import shown
from openacr.map.rows import axes as axis_rows
from openacr.project import Project
from openacr.scenario import Condition, card_view
from openacr.scenario.played import PlayedCard

FIRST_OUTPUT = 32
OUTPUTS = 32


def load(project: Project) -> tuple["ControlledMachine", list[SourceError]]:
    """Load a project into a new card; also give the lines the card has refused."""
    controller, refused = Controller.load(project)
    return ControlledMachine(controller), refused


class ControlledMachine(PlayedCard):
    """A controller, seen as what a run shows of it."""

    def __init__(self, controller: Controller) -> None:
        super().__init__(controller)
        self._begin_s = controller.time_s
        self._watched: tuple[Watched, ...] = ()
        self._event_watches: list[Watch] = []
        self._shown_starts: set[int] = set()
        self._events = EventLog(
            controller.memory, controller.model.axes, self._titles(), self.failure
        )

    def closed_switches(self) -> dict[int, list[int]]:
        """Inputs of normally closed limit switches that are enabled, by axis."""
        found: dict[int, list[int]] = {}
        for axis in range(self._controller.model.axes):
            first = self.memory.I[axis_rows.hlbit[axis]]
            for side in range(2):
                flags = (CONTACT_FLAGS[side], SWITCH_FLAGS[side])
                if all(self._controller.bit[flag + FLAGS_PER_AXIS * axis] for flag in flags):
                    found.setdefault(axis, []).append(first + side)
        return found

    def digest(self) -> str:
        """Fingerprint of the whole state."""
        return self._controller.digest()

    def has_new_events(self) -> bool:
        """Whether axes or programs have come into use since `watch`: call it once more."""
        return self._events.watches() != self._event_watches

    def watch(self, conditions: Sequence[Condition]) -> bool:
        """Make `advance` end when one of these may have changed; False if that is too much."""
        self._event_watches = self._events.watches()
        return self._watch(conditions, self._event_watches)

    def events(self) -> list[Event]:
        """What happened to the machine since the last call."""
        return [*self._empty_starts(), *self._events.poll(self.clock.lived_s - self._begin_s)]

    def _empty_starts(self) -> Iterator[Event]:
        """Programs that were started without lines, each once: the card says nothing of it."""
        found = self._controller.empty_starts
        for owner in sorted(found.keys() - self._shown_starts):
            self._shown_starts.add(owner)
            start = found[owner]
            name = f"PROG{owner}" if owner < PROGRAMS else f"PLC{owner - PROGRAMS}"
            place = f" ({shown(start.origin[0])}:{start.origin[1]})" if start.origin else ""
            time_s = max(0.0, start.tick * self.clock.period_s - self._begin_s)
            yield Event(time_s, f"{name} is empty: its RUN starts nothing{place}")

    @contextmanager
    def journalled(self, path: Path, project: Project) -> Iterator[None]:
        """Write everything that enters meanwhile to a file."""
        card, root = self._controller, str(project.root)
        card.recorder = Recorder(card, path, project=root, fingerprint=project.fingerprint)
        try:
            yield
        finally:
            card.close()

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
