"""The card as binary packets see it."""

from collections.abc import Sequence

from openacr.errors import CardError
from openacr.map.numbers import MA_FEEDRATE_OVERRIDE, MA_RAPID_FEEDRATE_OVERRIDE
from openacr.messages import NOT_SUPPORTED
from openacr.motion.card import Card
from openacr.motion.rows import master_parameter
from openacr.protocol.addresses import AddressSpace
from openacr.protocol.move import Move


class PacketHost:
    """Parameters, flags, overrides and memory of a card for `protocol.execute`."""

    def __init__(self, card: Card) -> None:
        self._card = card
        self._space = AddressSpace(card.memory)
        self.read_parameter = card.memory.read
        self.write_parameter = card.memory.write
        self.write_bit = card.memory.set_bit
        self.read_words = self._space.read_words
        self.write_words = self._space.write_words
        self.parameter_address = self._space.parameter_address
        self.variable_address = self._space.variable_address

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        """Set FOV, or ROV if `rapid`, of these masters; negative values count as 0."""
        row = MA_RAPID_FEEDRATE_OVERRIDE if rapid else MA_FEEDRATE_OVERRIDE
        for master in masters:
            self._card.memory.S[master_parameter(master) + row] = max(value, 0.0)

    def issue_move(self, move: Move) -> None:
        """Binary moves need the move queue of the host interface, which is not there yet."""
        raise CardError(NOT_SUPPORTED)
