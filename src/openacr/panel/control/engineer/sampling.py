"""How the scope gets its samples: from the engine of a card in this process, or by polls.

The engine records every servo period, whatever passes its time; other cards are read at each
step of the control thread, so that a period is as exact as the link.
"""

from typing import Protocol

import numpy as np

from openacr.map import Flag, Parameter
from openacr.mill.session import MillSession
from openacr.panel.control.engineer.recorder import Recorder, Share
from openacr.panel.control.engineer.scope import Scope

LEAST_S = 0.001  # from one poll of a card to the next


class Sampling(Protocol):
    """A source of samples."""

    def period_s(self, wanted_s: float) -> float:
        """The time between two samples that is nearest to a wanted one."""

    def begin(self, scope: Scope) -> None:
        """Begin the capture of a scope."""

    def step(self, session: MillSession, scope: Scope, now_s: float) -> None:
        """Add samples that are due; called at each step of the control thread."""

    def collect(self, scope: Scope) -> None:
        """Add what was recorded; called before samples are sent."""

    def end(self) -> None:
        """The capture is over."""


class Recorded:
    """Samples of a card in this process, of every chosen tick, by the recorder that all share."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._share: Share | None = None

    def _every_tk(self, wanted_s: float) -> int:
        return max(1, round(wanted_s / self._recorder.period_s))

    def period_s(self, wanted_s: float) -> float:
        """Whole servo periods, at least one."""
        return self._every_tk(wanted_s) * self._recorder.period_s

    def begin(self, scope: Scope) -> None:
        """Record from the next tick on; UserError for a channel that the card does not have."""
        if scope.running is not None:
            every_tk = self._every_tk(scope.running.period_s)
            self._share = self._recorder.join(scope.running.channels, every_tk)
            scope.running.tick = self._share.due_tk

    def step(self, session: MillSession, scope: Scope, now_s: float) -> None:
        """The engine records by itself."""

    def collect(self, scope: Scope) -> None:
        """Add what the engine has recorded since the last call."""
        if self._share is not None and scope.running is not None:
            for block in self._recorder.take(self._share):
                scope.add(block)
        if scope.running is None:
            self.end()

    def end(self) -> None:
        """Record no more."""
        if self._share is not None:
            self._recorder.leave(self._share)
            self._share = None


class Polled:
    """Samples of a card at the end of a link, read one by one."""

    def __init__(self) -> None:
        self._due_s = 0.0

    def period_s(self, wanted_s: float) -> float:
        """At least 1 ms; how exactly it is kept depends on the link."""
        return max(wanted_s, LEAST_S)

    def begin(self, scope: Scope) -> None:
        """The first sample is due at once."""
        self._due_s = 0.0

    def step(self, session: MillSession, scope: Scope, now_s: float) -> None:
        """Read a sample if one is due."""
        capture = scope.running
        if capture is None or now_s < self._due_s:
            return
        self._due_s = now_s + capture.period_s
        rows = session.machine.read_rows([row_of(each) for each in capture.channels])
        values = [value_in(each, row) for each, row in zip(capture.channels, rows, strict=True)]
        scope.add(np.array(values)[:, None])

    def collect(self, scope: Scope) -> None:
        """Samples have been added as they were read."""

    def end(self) -> None:
        """Nothing goes on."""


def row_of(channel: Parameter | Flag) -> int:
    """The parameter that holds a channel."""
    return channel.parameter if isinstance(channel, Flag) else channel.number


def value_in(channel: Parameter | Flag, row: float) -> float:
    """The value of a channel in its parameter."""
    return float(int(row) >> channel.bit & 1) if isinstance(channel, Flag) else row
