"""Steps of the control that fail: one is reported; several in a row end what moves the machine."""

import math
from collections.abc import Callable

from openacr.mill.card.alarms import CONTROL_FAILED
from openacr.panel.control.machine.link import Link

MOST = 5  # failures without a poll between them that end what runs


class Failures:
    """Counts the failures since the last poll of the machine, and ends what runs."""

    def __init__(self, link: Link, drop_keys: Callable[[str], None]) -> None:
        self._link = link
        self._drop_keys = drop_keys
        self._count = 0
        self._cut_s = math.inf  # when the power of the drives is cut

    def forget(self) -> None:
        """The machine was polled: it is watched again."""
        self._count, self._cut_s = 0, math.inf

    def note(self, cause: str, now_s: float) -> None:
        """A step has failed: held keys end; from `MOST` in a row on, what runs ends.

        It ends as by an alarm: feed hold, spindle and coolant off. What has to be polled for the
        rest may never be, so the power is cut when the time to come to rest is over.
        """
        self._count += 1
        try:
            self._drop_keys(CONTROL_FAILED.text.format(cause))
        finally:
            if self._count == MOST:
                self._end_run(cause, now_s)
            elif now_s >= self._cut_s:
                self._cut_power()

    def _end_run(self, cause: str, now_s: float) -> None:
        session = self._link.session
        if session is None or not session.is_set_up:
            return
        if session.runner.is_busy:
            self._cut_s = now_s + session.runner.settings.rest_s
        try:
            session.runner.fail(cause)
        except Exception:  # not even the hold was sent
            self._cut_power()
            raise

    def _cut_power(self) -> None:
        self._cut_s = math.inf
        if self._link.session is not None:
            self._link.session.runner.cut_power()
