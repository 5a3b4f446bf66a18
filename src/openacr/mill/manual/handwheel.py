"""Hand wheel: a pulse generator whose clicks move the selected axes.

At every poll the distance turned since the last one is added to the target of each selected axis,
which follows as a jog, at the jog speed and at most to its soft limit. Turns beyond
a limit are discarded, so that turning back moves the axis at once. When the wheel is released,
the distance becomes position.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from openacr.errors import UserError
from openacr.map.rows import encoders
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE
from openacr.mill.config.tabs import AxisSettings
from openacr.mill.manual.jogging import Jogging
from openacr.sysvar.tabs import AXIS

COUNTS_PER_CLICK = 4  # one period of the encoder, at MULT 4
WRAP = 1 << 32


@dataclass(slots=True)
class _Follower:
    """An axis that follows its wheel."""

    row: AxisSettings
    encoder: int
    u_per_count: float
    counts: int
    target_u: float


class HandWheel:
    """The hand wheel of one machine."""

    def __init__(self, io: MachineIo, jogging: Jogging) -> None:
        self._io = io
        self._machine = io.machine
        self._jogging = jogging
        self._followers: list[_Follower] = []
        self._is_left = False

    @property
    def axes(self) -> list[int]:
        """The axes that follow the wheel now."""
        return [one.row.index for one in self._followers]

    def select(self, axes: Iterable[int]) -> None:
        """Select the axes that follow the wheel until `leave`; no others do.

        UserError or AlarmError, with no change, if one of them has no wheel or may not move.
        """
        self._followers = [self._follower(axis) for axis in axes]
        self._is_left = False

    def leave(self) -> None:
        """Disconnect the wheel; the axes still move to their targets."""
        self._is_left = True

    def follow(self) -> Steps:
        """Follow the wheel until `leave`, then settle all axes at rest."""
        yield Until("hand wheel", lambda _sample: self._is_left or self._turned())
        self._followers = []
        yield from self._jogging.settle()

    def _follower(self, axis: int) -> _Follower:
        settings = self._io.settings
        encoder = int(settings.real(AXIS.handwheel_src[axis]))
        if encoder == NONE:
            raise UserError(f"no hand wheel is installed for axis {settings.axis(axis).name}")
        row, _ = self._jogging.ready(axis, fast=True)
        self._machine.type([f"ENC{encoder} MULT {COUNTS_PER_CLICK}"])
        ratio = settings.real(AXIS.handwheel_ratio[axis]) / COUNTS_PER_CLICK
        return _Follower(row, encoder, ratio, self._counts(encoder), self._jogging.position(row))

    def _counts(self, encoder: int) -> int:
        return int(self._machine.read(encoders.encoder_position[encoder]))

    def _turned(self) -> bool:
        """Move every axis by the turn of its wheel; always False, so that the wait continues."""
        for one in self._followers:
            now = self._counts(one.encoder)
            path = (now - one.counts + WRAP // 2) % WRAP - WRAP // 2
            one.counts = now
            if path:
                self._move(one, path * one.u_per_count)
        return False

    def _move(self, one: _Follower, distance_u: float) -> None:
        limit = self._jogging.limit(one.row, 1 if distance_u > 0 else -1)
        target = one.target_u + distance_u
        if limit is not None and (target - limit) * distance_u > 0.0:
            target = limit if (one.target_u - limit) * distance_u <= 0.0 else one.target_u
        one.target_u = target
        self._jogging.aim(one.row, target)
