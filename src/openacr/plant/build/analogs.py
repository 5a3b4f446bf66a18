"""The terminals of the card's analog inputs, set by the machine file and by scenarios."""

from openacr.map.memory import Memory
from openacr.map.rows import adcs, analogs, plant
from openacr.plant.describe.counts import count_of
from openacr.plant.describe.schema import Analog, Axis, World

FULL_DAC_BITS = 16
_FIRST, _LAST = (adcs.adc_input[n] for n in (0, analogs.COUNT - 1))


def write_analogs(memory: Memory, world: World) -> None:
    """Wire the analog inputs; the voltage of an axis is stored per encoder count."""
    by_number = {axis.number: axis for axis in world.axis}
    for analog in world.analog:
        memory.F[analogs.base_v[analog.input]] = analog.volts
        memory.F[analogs.dac_step[analog.input]] = dac_step(world.card.dac_bits)
        memory.I[analogs.dac[analog.input]] = 0 if analog.dac is None else analog.dac + 1
        if analog.axis is not None:
            memory.I[analogs.axis[analog.input]] = analog.axis + 1
            _follow(memory, analog, by_number[analog.axis])
    memory.I[plant.analogs] = len(world.analog)


def dac_step(bits: int) -> float:
    """How many counts of a converter of 16 bits one of so few bits takes at a time."""
    return float(2.0 ** (FULL_DAC_BITS - bits))


def _follow(memory: Memory, analog: Analog, axis: Axis) -> None:
    origin, unit = count_of(axis, 0.0), count_of(axis, 1.0)
    per_count = analog.volts_per_unit / (unit - origin)
    memory.F[analogs.volts_per_cnt[analog.input]] = per_count
    memory.F[analogs.base_v[analog.input]] -= per_count * origin


def terminal(parameter: int) -> int | None:
    """The analog input of the card that a parameter shows; None for other parameters."""
    if not _FIRST <= parameter <= _LAST or (parameter - _FIRST) % adcs.PARAMETERS_SIZE:
        return None
    return (parameter - _FIRST) // adcs.PARAMETERS_SIZE


def put_volts(memory: Memory, channel: int, volts: float) -> None:
    """Apply a fixed voltage to an analog input, replacing what was wired to it."""
    memory.F[analogs.base_v[channel]] = volts
    memory.F[analogs.volts_per_cnt[channel]] = 0.0
    memory.I[analogs.axis[channel]] = memory.I[analogs.dac[channel]] = 0
    memory.I[plant.analogs] |= 1
