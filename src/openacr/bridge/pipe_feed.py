"""A feed whose values come from another process, which carries writes out as well."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from itertools import count

from openacr.bridge.feed import STALE_S
from openacr.bridge.messages import Write, Written
from openacr.bridge.moment import AxisName, Moment
from openacr.errors import OpenacrError

STALE_PERIODS = 2.0  # of readings: a slow bridge has older values


class PipeFeed:
    """The newest moment that has come; a panel that sends nothing is lost."""

    def __init__(
        self,
        axes: tuple[AxisName, ...],
        ask: Callable[[Write], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._axes, self._ask, self._clock = axes, ask, clock
        self._moment = Moment(lost="the panel sends no values yet")
        self._taken_s: float | None = None
        self._stale_s = STALE_S
        self._numbers = count(1)
        self._waiting: dict[int, Future[None]] = {}
        self._lock = threading.Lock()

    @property
    def axes(self) -> tuple[AxisName, ...]:
        """The axes of the machine."""
        return self._axes

    def start(self, parameters: list[int], rate_hz: float) -> None:
        """The panel reads the parameters already."""
        self._stale_s = max(STALE_S, STALE_PERIODS / rate_hz)

    def take(self, moment: Moment) -> None:
        """Take over values that have come."""
        self._moment, self._taken_s = moment, self._clock()

    def newest(self) -> Moment:
        """The newest values."""
        moment, taken_s = self._moment, self._taken_s
        age_s = 0.0 if taken_s is None else self._clock() - taken_s
        if age_s > self._stale_s:
            return Moment(lost=f"the last values of the panel are {age_s:.1f} s old")
        return moment

    def write(self, number: int, value: float, *, is_flag: bool) -> "Future[None]":
        """Ask the panel to set a parameter or flag."""
        done: Future[None] = Future()
        with self._lock:
            asked = next(self._numbers)
            self._waiting[asked] = done
        self._ask(Write(asked, number, value, is_flag))
        return done

    def finish(self, written: Written) -> None:
        """A write has ended."""
        with self._lock:
            done = self._waiting.pop(written.number, None)
        if done is None or not done.set_running_or_notify_cancel():
            return
        if written.refusal:
            done.set_exception(OpenacrError(written.refusal))
        else:
            done.set_result(None)

    def stop(self) -> None:
        """Refuse what waits to be written."""
        for number in list(self._waiting):
            self.finish(Written(number, "the bridge ends"))
