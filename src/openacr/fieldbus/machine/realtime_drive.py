"""A drive of a bus in the real-time loop: led by Python, its positions are the loop's."""

import math

from openacr.fieldbus.ethercat.master.master import Member
from openacr.fieldbus.machine import exchange_cy as at
from openacr.fieldbus.machine.axis_drive import AxisDrive
from openacr.map.rows import axes
from openacr.views import F64

HOLD_TK = 20_000  # enabling waits that long for the next look at most


class RealtimeDrive(AxisDrive):
    """A drive whose positions and contacts the loop takes."""

    def connect_again(self, member: Member, now_s: float) -> None:
        """Use the drive after its bus has been brought up again; what it reports is reset."""
        self.connect(member)
        self.alarm = ""
        self._reset_s = now_s
        self.drive.reset()

    def follow(self, numbers: F64, first: int) -> None:
        """Where the loop keeps its counts."""
        self._numbers, self._first = numbers, first

    def _take_position(self, actual: int, passed_s: float) -> None:
        zero = self._numbers[self._first + at.ZERO]
        if not math.isnan(zero):
            self._zero = round(zero)
            self._counts = round(self._numbers[self._first + at.COUNTS])

    def _take_contacts(self, level: int) -> None:
        """The loop has done it."""

    def _hold(self, n: int) -> None:
        super()._hold(n)
        self.memory.I[axes.enable_ticks[n]] = HOLD_TK

    def _take_over(self, n: int) -> None:
        super()._take_over(n)
        if self._is_ready:
            self.memory.I[axes.enable_ticks[n]] = 1

    @property
    def is_ready(self) -> bool:
        """Whether it is to follow the setpoint."""
        return self._is_ready

    @property
    def scale(self) -> float:
        """Counts of the drive for a raw count of the card."""
        return self._scale

    @property
    def fastest_cps(self) -> float:
        """Counts a second beyond which a move is a jump."""
        return self._fastest_cps
