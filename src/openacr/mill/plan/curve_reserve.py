"""How much of a planned curve has to wait on a card over a link.

A card that loses its host holds the feed along what it has of the curve (kernel
`timed_stop_cy.py`), and so does a feed hold. From the speed v that takes

    T = v/A + A/J    or    2 sqrt(v/J) where A is not reached,

at the quickest; where the plan itself uses the limits up, the ramp has to wait for a place that has
room for it. RAMPS times T is measured, not proved: with 0.3 s of path known at 100 mm/s, 1000 mm/s2
and 20,000 mm/s3, 3 of 60 random holds of a square, corners and a surface found no ramp; with the
reserve, 0.45 s there, none of 15 did. To this comes the time until the card has
noticed, and the packets on their way.
"""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curve_limits import accelerations, stop_s

Rows = NDArray[np.float64]
RAMPS = 2.4
NOTICED_S = 0.07  # the cycle of the watchdog, and that in which the card serves a hold
ON_THE_LINE_S = 0.1
STEP = 8  # pieces: smaller changes are not sent to the watchdog


class Reserve:
    """Follows the control points that are sent: how many pieces have to wait on the card."""

    def __init__(self, settings: Settings, most: int) -> None:
        self._acceleration_ups2 = min(accelerations(settings))
        self._jerk_ups3 = settings.lowest_jerk_ups3
        self._most = most
        self._speeds: deque[float] = deque(maxlen=most)
        self._last: Rows | None = None

    def note(self, point: Rows) -> None:
        """Note a control point that is sent."""
        last = point if self._last is None else self._last
        self._speeds.append(float(np.abs(point - last).max()) / PERIOD_S)
        self._last = point

    @property
    def least(self) -> int:
        """Pieces with which the card comes to rest without its host."""
        pieces = self._to_rest(max(self._speeds, default=0.0))
        return min(pieces, self._most - self.on_the_line)

    def full(self, speed_ups: float) -> int:
        """Pieces for a speed: those to come to rest, and those that the host may be late by."""
        return self._to_rest(speed_ups) + self.on_the_line

    def _to_rest(self, speed_ups: float) -> int:
        rest_s = RAMPS * stop_s(speed_ups, self._acceleration_ups2, self._jerk_ups3)
        return math.ceil((rest_s + NOTICED_S) / PERIOD_S / STEP) * STEP

    @property
    def on_the_line(self) -> int:
        """Pieces that the host may be late by."""
        return math.ceil(ON_THE_LINE_S / PERIOD_S)
