"""Recording of the setpoints of a run on the virtual machine, per servo period.

The card records its setpoints and its count of packets; the moves that
were sent give the line of each packet. Between two polls of the machine no packet is sent, so
the moves known at one poll explain all rows up to the next.
"""

from bisect import bisect_right
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from openacr.controller import Controller
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.errors import UserError
from openacr.mill.run.runner import Runner

Rows = NDArray[np.float64]


class RunTrace:
    """Records a run; call `note` after every step.

    `write` gets rows of time since the begin [s], the setpoint of each axis [units of the machine]
    and the line.
    """

    def __init__(
        self, card: Controller, runner: Runner, every_s: float | None, write: Callable[[Rows], None]
    ) -> None:
        """`every_s`: time between rows, rounded to the servo period; None: every period."""
        self._card, self._runner, self._write = card, runner, write
        self._begin_s = card.time_s
        every_tk = 1 if every_s is None else round(every_s / card.period_s)
        if every_tk < 1:
            raise UserError(
                f"a row every {every_s:g} s: the servo period is {card.period_s:g} s, "
                "a trace has at most one row per period"
            )
        card.record(every_tk, samples=(Sample(Watched.LONG, runner.machine.counter),))
        self._counts: list[int] = []  # of the packets, ascending
        self._lines: list[int] = []  # of their moves

    def note(self) -> None:
        """Write the rows recorded since the last call."""
        found = self._card.take_trace()
        axes = [axis.index for axis in self._runner.settings.axes]
        columns = [found.time_s - self._begin_s, *(found.axes[k].commanded_u for k in axes)]
        columns.append(np.array([self._line(count) for count in found.values[:, 0]]))
        if found.time_s.size:
            self._write(np.column_stack(columns))
        jobs = self._runner.stream.tracker.jobs()
        if jobs:
            self._counts = [job.count for job in jobs]
            self._lines = [job.entry.source.line for job in jobs]

    def _line(self, count: float) -> int:
        """The line of the move with this packet; 0 before the first."""
        place = bisect_right(self._counts, count)
        return self._lines[place - 1] if place else 0
