"""How far a card over a link may run on what it has of a planned curve.

A card that loses its host holds the feed along what it has of the curve (kernel
`timed_stop_cy.py`), and so does a feed hold. From the speed v that takes

    T = v/A + A/J    or    2 sqrt(v/J) where A is not reached,

at the quickest; where the plan itself uses the limits up, the ramp has to wait for a place that has
room for it, so that a multiple of T is set aside, and the time until the card has begun it. A hold
at piece k finds its rest on the pieces k to k + n if n of them last that long at the highest speed
of any of them. The card has to hold at the last piece of which that is true: `hold_at`. It only
grows as points are added, so that it can follow them on the line, and whatever is lost there leaves
the card with a number that is too low, never with one that is too high.
"""

from collections import deque

import numpy as np
from numpy.typing import NDArray

from openacr.mill.config.curves import PERIOD_S, RANK
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import accelerations, pieces_to_rest
from openacr.mill.plan.curves.curve_packets import COUNTED

Rows = NDArray[np.float64]
KEPT = 512  # speeds of pieces that were passed are dropped this many at a time


class Reserve:
    """Follows the control points of one curve that are sent: where the card has to hold."""

    def __init__(self, settings: Settings) -> None:
        self._acceleration_ups2 = min(accelerations(settings))
        self._jerk_ups3 = settings.lowest_jerk_ups3
        self.begin()

    def begin(self) -> None:
        """Begin another curve."""
        self._points = 0
        self._last: Rows | None = None
        self._steps: deque[float] = deque(maxlen=COUNTED - 1)  # speeds between the last points
        self._speeds: list[float] = []  # of the pieces from `_first` on
        self._first = 1
        self._hold_at = 0

    def note(self, point: Rows) -> None:
        """Note a control point that is sent; from the seventh on each completes a piece."""
        last = point if self._last is None else self._last
        self._steps.append(float(np.abs(point - last).max()) / PERIOD_S)
        self._last = point
        self._points += 1
        if self._points >= COUNTED:  # the piece lies between the first of the points
            self._speeds.append(max(list(self._steps)[: RANK - 1]))

    @property
    def pieces(self) -> int:
        """Pieces of the curve that are sent."""
        return self._first - 1 + len(self._speeds)

    @property
    def hold_at(self) -> int:
        """The piece at whose beginning the card has to hold, counted from 1; 0: it may not begin.

        It can come to rest on what follows that piece, and on what follows any earlier one.
        """
        while self._rests_from(self._hold_at + 1):
            self._hold_at += 1
        if self._hold_at - self._first >= KEPT:
            del self._speeds[: self._hold_at - self._first]
            self._first = self._hold_at
        return self._hold_at

    def _rests_from(self, piece: int) -> bool:
        """Whether a card that holds at a piece comes to rest on what is sent."""
        begin, count = piece - self._first, self._to_rest(0.0)
        while begin + count < len(self._speeds):
            needed = self._to_rest(max(self._speeds[begin : begin + count + 1]))
            if needed <= count:
                return True
            count = needed
        return False

    def _to_rest(self, speed_ups: float) -> int:
        return pieces_to_rest(speed_ups, self._acceleration_ups2, self._jerk_ups3)
