"""One run of a sweep: a card with the values of a point, lived to its end, and its measures."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from openacr.controller import Controller, LoadError, Snapshot
from openacr.controller.recorder import Recorder
from openacr.controller.streams import CONSOLE
from openacr.controller.trace import Trace
from openacr.engine.samples import Sample, sample_of_flag, sample_of_parameter
from openacr.errors import OpenacrError, UserError
from openacr.scenario import card_view
from openacr.scenario.course import Course, Stop, stored_but_idle
from openacr.scenario.played import PlayedCard
from openacr.sweep import targets
from openacr.sweep.expressions import Series, Value
from openacr.sweep.study import Point, Study

OK, FAILED, LOST = "ok", "failed", "lost"


@dataclass(frozen=True, slots=True)
class Task:
    """A run to be done; with `is_journalled` its result has the journal of the run."""

    number: int
    point: Point
    study: Study
    is_journalled: bool = False


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a run: its measures in their order, how it ended, what went wrong."""

    measures: tuple[float, ...]
    status: str = OK
    error: str = ""
    end: str = ""  # time, bit or idle
    time_s: float = 0.0
    journal: bytes = b""


_kept = threading.local()  # a worker of a cluster may have several threads


def perform(task: Task) -> Outcome:
    """Do a run; what a user can cause is the status of its outcome, not an exception."""
    study = task.study
    try:
        if not task.is_journalled:
            card = _card(study, task.point)
            try:
                return _live(card, study, task.point)
            finally:
                card.watch()
                card.system.listeners.taps.clear()
        with TemporaryDirectory() as folder:
            path = Path(folder, "journal")
            outcome = _journalled(study, task.point, path)
            return Outcome(
                outcome.measures, outcome.status, outcome.error, outcome.end, outcome.time_s,
                path.read_bytes(),
            )  # fmt: skip
    except OpenacrError as error:
        return Outcome((float("nan"),) * len(study.measures), FAILED, str(error))


def loaded(study: Study, point: Point) -> Controller:
    """A new card with machine and defines of a point; LoadError for lines it refuses."""
    project = targets.project_of(study, point)
    card, refused = Controller.load(project, world=targets.world_of(study, point))
    if refused:
        raise LoadError(refused)
    card.is_journalled = False
    return card


def _card(study: Study, point: Point) -> Controller:
    """The card of a point as it is after loading; the last one is kept for the next run."""
    chosen = [
        value
        for quantity, value in zip(study.quantities.values(), point, strict=True)
        if targets.is_loaded(quantity)
    ]
    key = (study.fingerprint, tuple(chosen))
    kept: tuple[object, Controller, Snapshot] | None = getattr(_kept, "card", None)
    if kept is None or kept[0] != key:
        card = loaded(study, point)
        kept = _kept.card = (key, card, card.snapshot())
    else:
        kept[1].take_over(kept[2])
    return kept[1]


def _journalled(study: Study, point: Point, path: Path) -> Outcome:
    card = loaded(study, point)
    try:
        card.recorder = Recorder(card, path, project=str(study.project.root))
        return _live(card, study, point)
    finally:
        card.close()


def _live(controller: Controller, study: Study, point: Point) -> Outcome:
    """Set the values, let the card live, and measure."""
    set_values(controller, study, point)
    card = PlayedCard(controller)
    needs = study.needs
    if needs.has_series:
        controller.record(
            study.every_tk, samples=[_sample(controller, name) for name in sorted(needs.samples)]
        )
    begin_s = controller.lived_tk * controller.period_s
    course = Course(card, study.scenario, study.limit_s, study.until)
    card.listen(course.play.heard, course.play.heard)
    if study.scenario is None and stored_but_idle(card):
        card.start_all()
    while (stop := course.step()) is None:
        pass
    course.play.finish(course.world)
    recorded = _Recorded(controller, study, begin_s, course.lived_s)
    error = _failure(card, course, stop, study)
    return Outcome(
        measured(study, point, recorded), FAILED if error else OK, error, stop.value, course.lived_s
    )


def set_values(controller: Controller, study: Study, point: Point) -> None:
    """Set parameters and type lines, as a run begins; UserError for what the card refuses."""
    for parameter, value in targets.parameters_of(study, point).items():
        targets.set_parameter(controller.p, parameter, value)
    lines = targets.typed_of(study, point)
    session = controller.system.sessions[CONSOLE]
    for line in ["SYS", *lines] if lines else ():
        controller.send(f"{line}\r")
        if session.last_error is not None:
            raise UserError(f"{line}: {session.last_error.text}")


def _sample(controller: Controller, name: str) -> Sample:
    if name.startswith("BIT"):
        return sample_of_flag(int(name[3:]))
    found = sample_of_parameter(controller.memory, int(name[1:]))
    if found is None:
        raise UserError(f"this card has no parameter {name}")
    return found


def _failure(card: PlayedCard, course: Course, stop: Stop, study: Study) -> str:
    """What went wrong in a run, as one line; empty if nothing did."""
    found = [
        f"PROG{program}: {failure.error} ({failure.place or failure.text})"
        for program in card_view.PROGRAMS
        if card_view.has_failed(card.memory, program)
        for failure in (card.failure(program),)
    ]
    found += [f"expectation: {verdict}" for verdict in course.play.failures]
    if stop is Stop.TIME and study.until is not None and study.until.bit is not None:
        found.append(f"{study.until} was not reached within {study.limit_s:g} s")
    return "; ".join(found)


def measured(study: Study, point: Point, recorded: _Recorded) -> tuple[float, ...]:
    """The measures of a run in their order."""
    numbers: dict[str, float] = dict(zip(study.quantities, point, strict=True))
    for name, expression in study.expressions.items():
        numbers[name] = expression.value(recorded, numbers)
    return tuple(numbers[name] for name in study.expressions)


class _Recorded:
    """What was recorded of a run, for its measures."""

    def __init__(self, card: Controller, study: Study, begin_s: float, end_s: float) -> None:
        self._card = card
        self.end_s = end_s
        self.period_s = card.period_s * study.every_tk
        self._trace: Trace | None = card.trace() if study.needs.has_series else None
        self._samples: Mapping[str, int] = {
            name: column for column, name in enumerate(sorted(study.needs.samples))
        }
        self.time_s: Series = self._trace.time_s - begin_s if self._trace else np.empty(0)

    def axis(self, number: int, name: str) -> Value:
        """A series or a total of an axis, in its units."""
        if name.startswith("peak_") or name == "distance":
            found = f"{name}_u" if name != "peak_velocity" else "peak_velocity_ups"
            return float(getattr(self._card.statistics(number), found))
        suffix = "_ups" if name == "velocity" else "_u"
        series: Series = getattr(self._rows.axes[number], f"{name}{suffix}")
        return series

    @property
    def _rows(self) -> Trace:
        if self._trace is None:
            raise UserError("nothing was recorded")
        return self._trace

    def series(self, name: str) -> Series:
        """A recorded parameter or flag."""
        column: Series = self._rows.values[:, self._samples[name]]
        return column

    def present(self, name: str) -> float:
        """A parameter, a flag or a value of an axis at the end of the run."""
        if name.startswith("BIT"):
            return float(self._card.bit[int(name[3:])])
        if name.startswith("P"):
            return float(self._card.p[int(name[1:])])
        whole, _, quantity = name.partition(".")
        axis = self._card.axis(int(whole[4:]))
        if quantity == "velocity":
            return axis.velocity_ups
        if quantity == "following_error":
            return axis.commanded_u - axis.actual_u
        return axis.commanded_u if quantity == "commanded" else axis.actual_u
