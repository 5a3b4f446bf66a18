"""Analog outputs (DAC) and inputs (ADC) of the card."""

from openacr.map.block import FP32, Block, FlagBlock, Span, consecutive, sixteen_apart

DAC = Block(
    "Object Parameters: DAC",
    object="DAC",
    prefix="DAC",
    spans=(Span(6400, 16),),
    stride=16,
    packet=sixteen_apart,
)
DAC.row(0x00, "DAC Output", FP32)
DAC.reserved(FP32, (0x01,))
DAC.row(0x02, "DAC Gain", FP32)
DAC.row(0x03, "DAC Offset", FP32)
DAC.reserved(FP32, range(0x04, 0x08))

ADC = Block(
    "Object Parameters: ADC",
    object="ADC",
    prefix="ADC",
    spans=(Span(6400, 16),),
    stride=16,
    packet=sixteen_apart,
)
ADC.row(0x08, "ADC Input", FP32)
ADC.reserved(FP32, (0x09,))
ADC.row(0x0A, "ADC Gain", FP32)
ADC.row(0x0B, "ADC Offset", FP32)
ADC.reserved(FP32, range(0x0C, 0x10))

_DAC_FLAGS = FlagBlock(
    "DAC Flags",
    object="",
    prefix="",
    spans=(Span(4224, 16),),
    word_name="Reserved",
    packet=consecutive(0x10),
    first_index=None,
)
_ADC_FLAGS = FlagBlock(
    "ADC Flags",
    object="",
    prefix="",
    spans=(Span(4240, 16),),
    word_name="Reserved",
    packet=consecutive(0x10),
    first_index=None,
)

BLOCKS = (DAC, ADC)
FLAG_BLOCKS = (_DAC_FLAGS, _ADC_FLAGS)
