"""Servo tuning at the screens: one axis at a time, on a stream of its own.

The card moves the axis by itself (`openacr.tuning.excitation`); what the record means is computed
in another process.
"""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from openacr.errors import UserError
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.conversations import Aside
from openacr.panel.control.engineer.gain_sets import GainSets
from openacr.panel.control.jobs import Jobs
from openacr.panel.control.machine.installation import Installation
from openacr.panel.work.tuning import Advised, Data, advised, stepped
from openacr.tuning.excitation import ARMED, Excitation
from openacr.tuning.filters import Filters
from openacr.tuning.measure import Measurement, measure
from openacr.tuning.propose import Wish

TRIAL_S = 0.3
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Change:
    """What is set before an axis moves."""

    gains: dict[str, float]
    filters: Filters | None = None  # None: as they are


class Tuning:
    """The axis that is measured, and what was proposed for each."""

    def __init__(
        self,
        installation: Installation,
        jobs: Jobs,
        tell: Callable[[Data], None],
        sets: GainSets,
    ) -> None:
        self._aside = Aside(installation)
        self._jobs = jobs
        self._tell = tell
        self._sets = sets
        self._advice: dict[int, Advised] = {}  # of the present session
        self._client: int | None = None  # who has the axis moved
        self._axis = 0

    @property
    def is_moving(self) -> bool:
        """Whether an axis is excited, or about to be."""
        return self._aside.is_busy

    @property
    def moved_axis(self) -> int | None:
        """The axis that is excited, or about to be."""
        return self._axis if self.is_moving else None

    def measure(self, client: int, axis: int, excitation: Excitation, wish: Wish) -> "Future[Data]":
        """Measure an axis and advise; UserError while another one is measured."""
        excitation = excitation.checked()
        advice = self._advice

        def keep(found: Advised) -> Data:
            advice[axis] = found
            return found.data

        return self._begin(client, axis, excitation, Change({}), keep, advised, wish)

    def jump(self, client: int, axis: int, height_cnt: float) -> "Future[Data]":
        """Move an axis by a step with the gains it has; what it did, and what was predicted."""
        trial = Excitation("step", height_cnt, duration_s=TRIAL_S).checked()
        return self._stepped(client, axis, trial, {})

    def apply(self, client: int, axis: int) -> "Future[Data]":
        """Have the card try what was proposed for an axis, and keep it; UserError if nothing was.

        What the card did with the gains, and what was predicted.
        """
        gains, before = self.proposed(axis), self._advice[axis].excitation
        trial = replace(before, kind="step", duration_s=TRIAL_S)
        return self._stepped(client, axis, trial, gains, self._advice[axis].filters)

    def _stepped(
        self,
        client: int,
        axis: int,
        trial: Excitation,
        gains: dict[str, float],
        filters: Filters | None = None,
    ) -> "Future[Data]":
        """Try gains, or the present ones, with a step."""
        known = self._advice.get(axis)
        motor = known.motor if known is not None else None
        change = Change(gains, filters)
        return self._begin(client, axis, trial, change, lambda data: data, stepped, gains, motor)

    def proposed(self, axis: int) -> dict[str, float]:
        """The gains that were proposed for an axis, by their words."""
        found = self._advice.get(axis)
        if found is None or found.gains is None:
            raise UserError("nothing was proposed for this axis: measure it first")
        return found.gains

    def require_kept(self, axis: int) -> None:
        """Refuse to keep gains whose filters the parameters of the machine cannot hold."""
        found = self._advice.get(axis)
        if found is not None and found.filters is not None:
            raise UserError(
                "the parameters of the machine have no NOTCH and LOPASS: set the gains without"
                " keeping them"
            )

    def _begin(
        self,
        client: int,
        axis: int,
        excitation: Excitation,
        change: Change,
        keep: Callable[[T], Data],
        work: Callable[..., T],
        *args: Any,
    ) -> "Future[Data]":
        """Excite an axis; `work` computes in another process, of the measurement and `args`.

        The future ends with what `keep` makes of its result, or with the error of any of them.
        """
        if self.is_moving:
            raise UserError("another axis is measured: wait, or STOP")
        answer: Future[Data] = Future()

        def progress(done: int, count: int) -> None:
            self._tell({"event": "tune", "done": done, "count": count, "to": client})

        def ended(done: "Future[Measurement]") -> None:
            self._client = None
            if (error := done.exception()) is not None:
                answer.set_exception(error)
            else:
                if change.gains:
                    self._sets.expect(axis)
                self._jobs.compute(computed, work, done.result(), *args)

        def computed(done: "Future[T]") -> None:
            try:
                answer.set_result(keep(done.result()))
            except Exception as error:  # the screen that asked waits for it
                answer.set_exception(error)

        begun = self._aside.begin(
            lambda talk: measure(
                talk,
                axis,
                excitation,
                gains=change.gains,
                filters=change.filters,
                progress=progress,
            )
        )
        self._client, self._axis = client, axis
        begun.add_done_callback(ended)
        return answer

    def step(self, now_s: float) -> None:
        """Carry on with what is under way; never waits."""
        self._aside.step(now_s)

    def stop(self, session: MillSession | None) -> None:
        """End the excitation: the card takes it back. Part of every stop."""
        if self.is_moving and session is not None:
            session.card.write_bit(ARMED, False)

    def leave(self, client: int, session: MillSession | None) -> None:
        """A browser has gone: what it has moved ends."""
        if client == self._client:
            self.stop(session)

    def end(self) -> None:
        """The session has ended; the card ends by itself what it does."""
        self._aside.end()
        self._advice = {}  # what is still computed belongs to the former session
