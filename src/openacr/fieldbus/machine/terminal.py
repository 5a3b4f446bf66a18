"""A terminal of the bus: digital channels on the numbers of the card."""

from openacr.fieldbus.ethercat.master.master import Member
from openacr.map.memory import Memory
from openacr.plant import inputs
from openacr.plant.describe.bus_schema import Terminal


class RealTerminal:
    """The inputs and outputs of one terminal."""

    def __init__(self, memory: Memory, table: Terminal, member: Member) -> None:
        self._memory = memory
        self._seen: dict[int, bool] = {}
        self._inputs = _channels(table.inputs_from, member.inputs.contacts, table.inputs)
        self._outputs = [
            (bit, *inputs.output_place(flag))
            for flag, bit in _channels(table.outputs_from, member.outputs.contacts, table.outputs)
        ]
        self._inputs_at, self._outputs_at = 8 * member.inputs_at, 8 * member.outputs_at

    def give(self, image: bytearray) -> None:
        """Put the outputs of the card into the image."""
        for bit, word, mask in self._outputs:
            at = self._outputs_at + bit
            if self._memory.I[word] & mask:
                image[at // 8] |= 1 << at % 8
            else:
                image[at // 8] &= ~(1 << at % 8)

    def take(self, image: bytes) -> None:
        """Bring its inputs to those of the card."""
        for flag, bit in self._inputs:
            at = self._inputs_at + bit
            on = bool(image[at // 8] >> at % 8 & 1)
            if self._seen.get(flag) is not on:
                self._seen[flag] = on
                inputs.drive(self._memory, flag, on)


def _channels(first: int | None, bits: list[int], count: int) -> list[tuple[int, int]]:
    """Number on the card and bit of each channel."""
    return [] if first is None else list(zip(range(first, first + count), bits, strict=False))
