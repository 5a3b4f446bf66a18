"""A terminal of the bus: digital and analog channels on the numbers of the card."""

from struct import Struct

from openacr.fieldbus.ethercat.master.master import Member
from openacr.map.memory import Memory
from openacr.plant import inputs
from openacr.plant.build.analogs import dac_step, put_volts
from openacr.plant.describe.bus_schema import Terminal
from openacr.plant.physics.drive_cy import converter_volts

WORD = Struct("<h")
FULL_SCALE = 32767  # of the voltage `full_v`


class RealTerminal:
    """The inputs and outputs of one terminal."""

    def __init__(self, memory: Memory, table: Terminal, member: Member, dac_bits: int) -> None:
        self._memory = memory
        self._seen: dict[int, bool] = {}
        self._step, self._full_v = dac_step(dac_bits), table.full_v
        ins, outs = member.inputs, member.outputs
        self._inputs = _channels(table.inputs_from, ins.contacts, table.inputs)
        self._outputs = [
            (bit, *inputs.output_place(flag))
            for flag, bit in _channels(table.outputs_from, outs.contacts, table.outputs)
        ]
        self._adcs = _channels(table.adcs_from, ins.words, table.adcs)
        self._dacs = _channels(table.dacs_from, outs.words, table.dacs)
        self._inputs_at, self._outputs_at = member.inputs_at, member.outputs_at

    def give(self, image: bytearray) -> None:
        """Put the outputs of the card into the image."""
        for bit, word, mask in self._outputs:
            at = 8 * self._outputs_at + bit
            if self._memory.I[word] & mask:
                image[at // 8] |= 1 << at % 8
            else:
                image[at // 8] &= ~(1 << at % 8)
        for dac, byte in self._dacs:
            volts = converter_volts(self._memory.S, dac, self._step)
            value = round(volts / self._full_v * FULL_SCALE)
            value = max(-FULL_SCALE - 1, min(FULL_SCALE, value))
            WORD.pack_into(image, self._outputs_at + byte, value)

    def take(self, image: bytes) -> None:
        """Bring its inputs to those of the card."""
        for flag, bit in self._inputs:
            at = 8 * self._inputs_at + bit
            on = bool(image[at // 8] >> at % 8 & 1)
            if self._seen.get(flag) is not on:
                self._seen[flag] = on
                inputs.drive(self._memory, flag, on)
        for adc, byte in self._adcs:
            value: int = WORD.unpack_from(image, self._inputs_at + byte)[0]
            put_volts(self._memory, adc, value * self._full_v / FULL_SCALE)


def _channels(first: int | None, places: list[int], count: int) -> list[tuple[int, int]]:
    """Number on the card and place of each channel."""
    return [] if first is None else list(zip(range(first, first + count), places, strict=False))
