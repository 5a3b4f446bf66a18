"""The long record of a machine: hours of up to eight channels, in files, seen by every browser."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from openacr.errors import OpenacrError, UserError
from openacr.map import Flag, Parameter
from openacr.mill.card.driver import LINK_ERRORS
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.pyramid import Pyramid
from openacr.panel.control.engineer.sampling import Sampling
from openacr.panel.control.engineer.scope import LEAST_SAMPLES, Capture, Scope, name_of
from openacr.panel.control.engineer.sources import Sources
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.control.operator.people import People

MOST_BYTES = 2 << 30  # seven hours of eight channels at 1 kHz
WORTH_S = 60.0  # a record of this length is not dropped unasked


class Record:
    """Samples of some channels from a moment on."""

    def __init__(self, number: int, capture: Capture, scope: Scope, folder: Path | None) -> None:
        self.number, self.capture = number, capture
        self.channels, self.period_s = capture.channels, capture.period_s
        self.samples = Pyramid(len(capture.channels), MOST_BYTES, folder)
        self._scope = scope

    @property
    def is_over(self) -> bool:
        """Whether no sample is added any more."""
        return self.capture.is_over

    def add(self) -> None:
        """Keep what has been sampled; samples that a gap left out are missing."""
        while (taken := self._scope.take()) is not None:
            first, block, _ = taken
            gap = first - self.capture.first - self.samples.next
            if gap > 0:
                self.samples.append(np.full((len(block), gap), np.nan))
            self.samples.append(block)


class Records:
    """The record of one machine, at most one, and what samples for it."""

    def __init__(
        self,
        sources: Sources,
        people: People,
        say: Callable[[str], None],
        folder: Path | None = None,
    ) -> None:
        self._sources, self._people, self._say, self._folder = sources, people, say, folder
        self._scope = Scope()
        self._sampling: Sampling = sources.source()
        self.record: Record | None = None

    def require(self, number: int) -> Record:
        """The record of this number; UserError if it is another one by now."""
        if self.record is None or self.record.number != number:
            raise UserError(f"record {number} is not there any more")
        return self.record

    def begin(
        self, client: int, channels: Sequence[Parameter | Flag], period_s: float, *, take: bool
    ) -> Record:
        """Begin a record; PanelError unless the one before it may be dropped."""
        last = self.record
        if last is not None and not take:
            length_s = last.samples.next * last.period_s
            if not last.is_over or length_s >= WORTH_S:
                state = "kept" if last.is_over else "under way"
                raise PanelError(
                    "taken",
                    f"a record of {length_s:.0f} s is {state}: the new one drops it",
                )
        self.end()
        sampling = self._sources.source()
        capture = self._scope.arm(
            channels, sampling.period_s(period_s), LEAST_SAMPLES, None, client
        )
        number = 1 if last is None else last.number + 1
        try:
            record = Record(number, capture, self._scope, self._folder)
        except OSError as error:
            self._scope.stop()
            raise UserError(f"no record in {self._folder}: {error}") from None
        try:
            sampling.begin(self._scope)
        except OpenacrError:
            self._scope.stop()
            record.samples.close()
            raise
        if last is not None:
            last.samples.close()
        self._sampling, self.record = sampling, record
        return record

    def end(self) -> None:
        """Add no more samples; the record stays."""
        self.collect()
        self._scope.stop()
        self._sampling.end()

    def step(self, session: MillSession, now_s: float) -> None:
        """Read what is due; a refusal of the card ends the record."""
        try:
            self._sampling.step(session, self._scope, now_s)
        except LINK_ERRORS:
            raise
        except OpenacrError as error:
            self.end()
            self._say(f"the record has ended: {error}")

    def collect(self) -> None:
        """Keep what was sampled; a disk that is full ends the record."""
        self._sampling.collect(self._scope)
        if self.record is None:
            return
        try:
            self.record.add()
        except OSError as error:
            self._scope.stop()
            self._sampling.end()
            self._say(f"the record has ended: {error}")

    def data(self) -> dict[str, Any]:
        """The record and who has begun it; its samples are asked for by parts."""
        record = self.record
        if record is None:
            return {"number": 0, "running": False}
        owner = self._people.person(record.capture.owner)
        return {
            "number": record.number,
            "running": not record.is_over,
            "channels": [name_of(each) for each in record.channels],
            "period_s": record.period_s,
            "tick": record.capture.tick,
            "owner": None if owner is None else owner.data()["name"],
        }
