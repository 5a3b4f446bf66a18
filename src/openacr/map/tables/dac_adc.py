"""Analog outputs (DAC) and inputs (ADC) of the card."""

from openacr.map.block import FP32, NS, Block, Span, sixteen_apart
from openacr.map.flag_block import reserved_words

DAC = Block(
    "Object Parameters: DAC",
    object="DAC",
    prefix="DAC",
    family="dacs",
    spans=(Span(6400, 16),),
    stride=16,
    packet=sixteen_apart,
)
DAC.row(0x00, "DAC Output", FP32, NS, "V", "Voltage put out.")
DAC.reserved(FP32, (0x01,))
DAC.row(0x02, "DAC Gain", FP32, NS, "count/V", "Counts of the converter per volt.", default=3276.8)
DAC.row(0x03, "DAC Offset", FP32, NS, "V", "Added to every output.")
DAC.reserved(FP32, range(0x04, 0x08))

ADC = Block(
    "Object Parameters: ADC",
    object="ADC",
    prefix="ADC",
    family="adcs",
    spans=(Span(6400, 16),),
    stride=16,
    packet=sixteen_apart,
)
ADC.row(0x08, "ADC Input", FP32, NS, "V", "Voltage measured.")
ADC.reserved(FP32, (0x09,))
ADC.row(0x0A, "ADC Gain", FP32, NS, "V", "Voltage at full scale of the converter.", default=10)
ADC.row(0x0B, "ADC Offset", FP32, NS, "V", "Added to every input.")
ADC.reserved(FP32, range(0x0C, 0x10))

BLOCKS = (DAC, ADC)
FLAG_BLOCKS = (
    reserved_words("DAC Flags", Span(4224, 16)),
    reserved_words("ADC Flags", Span(4240, 16)),
)
