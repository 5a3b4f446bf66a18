"""Global objects: the analog input scanner as a whole (ADC MODE, MAX, ON, OFF).

ADCX says the same of an expansion board, which no modelled card has.

Bit 0 of the ADC state control parameter (P6917) is the scanner running. The resolution and
the number of scanned channels are hidden rows.
"""

from openacr.basic.grammar import Int, Word
from openacr.basic.registry import ANY, command
from openacr.basic.run import Run
from openacr.errors import CardError
from openacr.map.numbers import KRI_ADC_CHANNELS, KRI_ADC_MODE, KRI_BASE, P_ADC_STATE_CONTROL
from openacr.messages import INVALID_ARGUMENT, NOT_SUPPORTED

GROUP = "Global Objects"
REF = "PG Global Objects"
SCANNING = 1
SIXTEEN_BITS = 1


@command(
    "ADC MODE",
    group=GROUP,
    levels=ANY,
    grammar=(Int("mode", 0, 1, optional=True),),
    ref=REF,
    default="0; 1 on the ACR9000 family",
    saved=True,
)
def adc_mode(run: Run, mode: int | None) -> None:
    """Choose 12-bit (0) or 16-bit (1) analog inputs; the ACR9000 family is always 16-bit."""
    fixed = run.card.model.has_fixed_adc_mode
    if mode is None:
        run.print(str(SIXTEEN_BITS if fixed else run.card.memory.I[KRI_BASE + KRI_ADC_MODE]))
    elif fixed and mode != SIXTEEN_BITS:
        raise CardError(INVALID_ARGUMENT)
    else:
        run.card.memory.I[KRI_BASE + KRI_ADC_MODE] = mode


@command(
    "ADC MAX",
    group=GROUP,
    levels=ANY,
    grammar=(Int("channels", 1, 16, optional=True),),
    ref=REF,
    default="8",
    saved=True,
)
def adc_max(run: Run, channels: int | None) -> None:
    """Set how many analog inputs are scanned."""
    if channels is None:
        run.print(str(run.card.memory.I[KRI_BASE + KRI_ADC_CHANNELS]))
    elif channels > run.card.model.adcs:
        raise CardError(INVALID_ARGUMENT)
    else:
        run.card.memory.I[KRI_BASE + KRI_ADC_CHANNELS] = channels


@command("ADC ON", group=GROUP, levels=ANY, ref=REF)
def adc_on(run: Run) -> None:
    """Scan the analog inputs."""
    run.card.memory.I[P_ADC_STATE_CONTROL] |= SCANNING


@command("ADC OFF", group=GROUP, levels=ANY, ref=REF)
def adc_off(run: Run) -> None:
    """Stop scanning: the analog inputs keep their last values."""
    run.card.memory.I[P_ADC_STATE_CONTROL] &= ~SCANNING


@command(
    "ADCX",
    group=GROUP,
    levels=ANY,
    grammar=(Word("MODE", "MAX", "ON", "OFF", optional=True), Int("value", optional=True)),
    ref=REF,
)
def adcx(run: Run, what: str | None, value: int | None) -> None:
    """Set up the analog inputs of an expansion board; refused without one."""
    raise CardError(NOT_SUPPORTED)
