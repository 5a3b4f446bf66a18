"""The card as binary packets see it."""

from collections.abc import Callable, Sequence

from openacr.controller.move_queue import MoveQueue
from openacr.map.numbers import (
    P_COM1_COMMUNICATION_TIMEOUT,
    P_COM2_COMMUNICATION_TIMEOUT,
    P_DPCB_COMMUNICATION_TIMEOUT,
    P_FIFO_COMMUNICATION_TIMEOUT,
)
from openacr.map.rows import masters as master_rows
from openacr.motion.card import Card
from openacr.protocol.addresses import AddressSpace
from openacr.protocol.move import Move
from openacr.protocol.string_words import ProgramStrings

TIMEOUT_MS = 50  # for channels without a time-out parameter
_TIMEOUTS = {
    "FIFO": P_FIFO_COMMUNICATION_TIMEOUT,
    "COM1": P_COM1_COMMUNICATION_TIMEOUT,
    "COM2": P_COM2_COMMUNICATION_TIMEOUT,
    "DPCB": P_DPCB_COMMUNICATION_TIMEOUT,
}


class PacketHost:
    """Parameters, flags, overrides and memory of a card for `protocol.execute`."""

    def __init__(
        self,
        card: Card,
        strings: Callable[[], Sequence[ProgramStrings]],
        *,
        short_overrides: bool = False,
    ) -> None:
        self._card = card
        self.short_overrides = short_overrides
        self._space = AddressSpace(card.memory, strings)
        self.moves = MoveQueue(card)
        self.read_parameter = card.memory.read
        self.write_parameter = card.memory.write
        self.write_bit = card.memory.set_bit
        self.read_words = self._space.read_words
        self.write_words = self._space.write_words
        self.parameter_address = self._space.parameter_address
        self.variable_address = self._space.variable_address

    def take_work(self) -> int:
        """The work since the last call that grows with what the card holds."""
        work, self._card.memory.work = self._card.memory.work, 0
        return work

    def timeout_tk(self, channel: str) -> int:
        """The longest permitted gap between the bytes of a packet on a channel, in ticks."""
        row = _TIMEOUTS.get(channel)
        time_ms = TIMEOUT_MS if row is None else self._card.memory.I[row]
        return max(1, round(time_ms / 1000 / self._card.clock.period_s))

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        """Set FOV, or ROV if `rapid`, of these masters; negative values count as 0."""
        row = master_rows.rapid_feedrate_override if rapid else master_rows.feedrate_override
        for master in masters:
            self._card.memory.S[row[master]] = max(value, 0.0)

    def issue_move(self, move: Move) -> None:
        """Issue a move, or queue it until the buffer of its master has room."""
        self.moves.add(move)
