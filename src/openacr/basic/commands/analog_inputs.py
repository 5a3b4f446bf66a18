"""Global objects: the analog input scanner as a whole (ADC MODE, MAX, POS, NEG, ON, OFF).

ADCX says the same of an expansion board, which no modelled card has.

Bit 0 of the ADC state control parameter (P6917) is the scanner running. The channels are words
of four bits each (P6918, P6919), the resolution and the number of scanned inputs hidden rows.
"""

from functools import partial

from msgspec import Struct

from openacr.basic.commands.value_commands import check_number
from openacr.basic.language import registry
from openacr.basic.language.grammar import Int, Word
from openacr.basic.language.registry import ANY
from openacr.basic.memory.saving import each, kept
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.numbers import (
    P_ADC_NEGATIVE_CHANNELS,
    P_ADC_POSITIVE_CHANNELS,
    P_ADC_STATE_CONTROL,
)
from openacr.map.rows import kernel
from openacr.messages import INVALID_ARGUMENT, NOT_SUPPORTED
from openacr.motion.card import Card

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
SCANNING = 1
SIXTEEN_BITS = 1
INPUTS = 8
BITS_EACH = 4
ONES = 15
GROUND = -1
WRAP = 1 << 31


@command(
    "ADC MODE",
    levels=ANY,
    grammar=(Int("mode", 0, 1, optional=True),),
    default="0; 1 on the ACR9000 family",
    saved=True,
)
def adc_mode(run: Run, mode: int | None) -> None:
    """Choose 12-bit (0) or 16-bit (1) analog inputs; the ACR9000 family is always 16-bit."""
    fixed = run.card.model.has_fixed_adc_mode
    if mode is None:
        run.print(str(run.card.memory.I[kernel.adc_mode]))
    elif fixed and mode != SIXTEEN_BITS:
        raise CardError(INVALID_ARGUMENT)
    else:
        run.card.memory.I[kernel.adc_mode] = mode


@command(
    "ADC MAX", levels=ANY, grammar=(Int("channels", 1, 16, optional=True),), default="8", saved=True
)
def adc_max(run: Run, channels: int | None) -> None:
    """Set how many analog inputs are scanned."""
    if channels is None:
        run.print(str(run.card.memory.I[kernel.adc_channels]))
    elif channels > run.card.model.adcs:
        raise CardError(INVALID_ARGUMENT)
    else:
        run.card.memory.I[kernel.adc_channels] = channels


class Channels(Struct, frozen=True):
    """The word with the channels of all inputs, four bits each; all ones is ground."""

    word: int
    lowest: int

    def read(self, card: Card, number: int) -> int:
        """Channel number of an analog input; GROUND for any other number."""
        channel = card.memory.I[self.word] >> BITS_EACH * number & ONES
        return GROUND if channel == ONES else channel

    def write(self, card: Card, number: int, channel: int) -> None:
        """Choose the channel of an input."""
        if not self.lowest <= channel < INPUTS:
            raise CardError(INVALID_ARGUMENT)
        shift = BITS_EACH * number
        word = card.memory.I[self.word] & ~(ONES << shift) | (channel & ONES) << shift
        card.memory.write(self.word, (word + WRAP) % (2 * WRAP) - WRAP)


def inputs(card: Card) -> int:
    """How many analog inputs have a choice of channels: those of the card itself."""
    return min(INPUTS, card.model.adcs)


POSITIVE = Channels(P_ADC_POSITIVE_CHANNELS, 0)
NEGATIVE = Channels(P_ADC_NEGATIVE_CHANNELS, GROUND)
_CHOICE = (Int("input"), Int("channel", optional=True))
kept["ADC POS"] = each("ADC POS", inputs, POSITIVE.read, POSITIVE.write)
kept["ADC NEG"] = each("ADC NEG", inputs, NEGATIVE.read, NEGATIVE.write)


@command(
    "ADC POS", levels=ANY, grammar=_CHOICE, saved=True, default="the channel of the same number"
)
def adc_pos(run: Run, number: int, channel: int | None) -> None:
    """Choose the channel at the positive side of an analog input."""
    _choose(run, POSITIVE, number, channel)


@command("ADC NEG", levels=ANY, grammar=_CHOICE, saved=True, default="-1")
def adc_neg(run: Run, number: int, channel: int | None) -> None:
    """Choose the channel an analog input measures against; -1 is ground."""
    _choose(run, NEGATIVE, number, channel)


def _choose(run: Run, channels: Channels, number: int, channel: int | None) -> None:
    check_number(number, inputs(run.card))
    if channel is None:
        run.print(str(channels.read(run.card, number)))
    else:
        channels.write(run.card, number, channel)


@command("ADC ON", levels=ANY)
def adc_on(run: Run) -> None:
    """Scan the analog inputs."""
    run.card.memory.I[P_ADC_STATE_CONTROL] |= SCANNING


@command("ADC OFF", levels=ANY)
def adc_off(run: Run) -> None:
    """Stop scanning: the analog inputs keep their last values."""
    run.card.memory.I[P_ADC_STATE_CONTROL] &= ~SCANNING


@command(
    "ADCX",
    levels=ANY,
    grammar=(Word("MODE", "MAX", "ON", "OFF", optional=True), Int("value", optional=True)),
)
def adcx(run: Run, what: str | None, value: int | None) -> None:
    """Set up the analog inputs of an expansion board; refused without one."""
    raise CardError(NOT_SUPPORTED)
