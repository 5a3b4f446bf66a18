"""Outputs of burning machines: plasma Hi/Lo, and Under Burn near the end of a cut.

Plasma Hi/Lo is on while the tool cuts at its percentage of the programmed feed or faster.
The Under Burn output is on along every cut, a chain of lines and arcs, and goes off when
less than Under Burn Distance of the chain remains.
"""

from collections.abc import Iterator

from openacr.cnc.canonical import Arc, Line
from openacr.map.rows import masters
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.run.program_stream import ProgramStream

PERCENT = 0.01


class Burner:
    """Switches the two outputs of one machine, as far as they are configured."""

    def __init__(self, io: MachineIo, stream: ProgramStream) -> None:
        self._io = io
        self._stream = stream
        self._row = io.settings.burning
        self._rows = (
            masters.fraction_into_move[io.settings.master],
            masters.vector_velocity[io.settings.master],
        )

    def update(self, sample: CardState, *, is_cutting: bool) -> None:
        """Switch both outputs for the present motion; off unless a program cuts."""
        if self._row.plasma == NONE and self._row.under_burn == NONE:
            return
        job = self._stream.tracker.current if is_cutting and sample.is_moving else None
        if job is None or not isinstance(job.entry, Line | Arc):
            self._switch(self._row.plasma, False)
            self._switch(self._row.under_burn, False)
            return
        share, speed_ups = map(float, self._io.machine.card.read_many(self._rows))
        fast_ups = job.feed_ups * self._row.plasma_percent * PERCENT
        self._switch(self._row.plasma, speed_ups >= fast_ups)
        self._switch(self._row.under_burn, not self._is_near_end((1.0 - share) * job.length_u))

    def _is_near_end(self, left_u: float) -> bool:
        """Whether the chain is known to end within the distance."""
        for job in self._following():
            if left_u >= self._row.under_burn_u or not isinstance(job.entry, Line | Arc):
                return left_u < self._row.under_burn_u
            left_u += job.length_u
        return left_u < self._row.under_burn_u and self._stream.is_read_up

    def _following(self) -> Iterator[Job]:
        """The moves after the present one."""
        moves = self._stream.ahead()
        next(moves, None)
        return moves

    def _switch(self, number: int, on: bool) -> None:
        if number != NONE and self._io.is_out(number) != on:
            self._io.output(number, on)
