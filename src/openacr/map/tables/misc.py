"""Sampling, clock, board and firmware information, logging."""

from openacr.map.block import LONG, NS, RW, Block, R, Span, consecutive
from openacr.models import ACR8020

SAMPLE = Block(
    "Miscellaneous Parameters: Position",
    object="SAMPLE",
    prefix="",
    spans=(Span(6912, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
SAMPLE.row(0, "Sample Array Index", LONG, NS, "", "Where the next sample is stored.")
SAMPLE.row(1, "Sample Trigger Index", LONG, NS, "", "Where the first sample after the trigger is.")
SAMPLE.row(2, "Sample Timer Clock", LONG, NS, "ms", "Time since the last sample.")
SAMPLE.row(3, "Sample Timer Period", LONG, NS, "ms", "Time from sample to sample.")

CLOCK = Block(
    "Miscellaneous Parameters: Position",
    object="SYSTEM",
    prefix="",
    spans=(Span(6916, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
CLOCK.row(
    0, "Global System Clock", LONG, RW, "ms", "Runs freely, from 2^31 - 1 on to 0; may be written."
)

ADC_SETUP = Block(
    "Miscellaneous Parameters: Position",
    object="ADC",
    prefix="",
    spans=(Span(6917, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
# Four bits for each of ADC0 to ADC7, the lowest for ADC0; 15 is ground.
EACH_ITS_OWN, ALL_GROUND = 0x76543210, -1
ADC_SETUP.row(
    0, "ADC State Control", LONG, NS, "", "State of the converter's sequence: 1 scans.", default=1
)
ADC_SETUP.row(
    1,
    "ADC Positive Channels",
    LONG,
    NS,
    "",
    "Channels used as positive inputs.",
    default=EACH_ITS_OWN,
)
ADC_SETUP.row(
    2,
    "ADC Negative Channels",
    LONG,
    NS,
    "",
    "Channels used as negative inputs.",
    default=ALL_GROUND,
)

BOARD = Block(
    "Miscellaneous Parameters: Board Information",
    object="BOARD",
    prefix="",
    spans=(Span(7040, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
BOARD.row(
    0,
    "Card / Serial Number",
    LONG,
    R,
    "",
    "Card type * 10000 + serial number, which is 0.",
    default=ACR8020.serial_number,
)
BOARD.row(1, "Card Number", LONG, R, "", "Number set with the address switch.")
BOARD.row(
    2,
    "Firmware Version",
    LONG,
    R,
    "",
    "Digits of the version: 1.18.06 is 11806.",
    default=ACR8020.firmware_number,
)
BOARD.row(
    3,
    "Update Number",
    LONG,
    R,
    "",
    "Update of this firmware version, 0: none.",
    default=ACR8020.update,
)
BOARD.row(
    4,
    "Diagnostics",
    LONG,
    R,
    "",
    "Image of the DIAG report, a set bit is a failure.",
    erratum="Its description prints packet index 0x80; the table and the number give 0x10.",
)
BOARD.row(5, "FPGA ID", LONG, R, "", "Identity of the encoder circuits.")
BOARD.row(6, "IO Configuration", LONG, R, "", "I/O options of the ACR1500, 0 on others.")

FIRMWARE = Block(
    "Miscellaneous Parameters: Firmware Information",
    object="FIRMWARE",
    prefix="",
    spans=(Span(7104, 1),),
    packet=consecutive(0x1B),
    indexed=False,
)
FIRMWARE.row(0, "Bootflash Version", LONG)
FIRMWARE.row(1, "Bootflash Checksum", LONG, NS, "", "Found by FIRMWARE CHECKSUM.")
FIRMWARE.reserved(LONG, (2, 3))
FIRMWARE.row(4, "Sysflash1 Version", LONG)
FIRMWARE.row(5, "Sysflash1 Checksum", LONG, NS, "", "Found by FIRMWARE CHECKSUM.")
FIRMWARE.reserved(LONG, (6, 7))
FIRMWARE.row(8, "Sysflash2 Version", LONG)
FIRMWARE.row(9, "Sysflash2 Checksum", LONG, NS, "", "Found by FIRMWARE CHECKSUM.")
FIRMWARE.reserved(LONG, range(10, 13))
FIRMWARE.row(13, "Userflash Checksum", LONG, NS, "", "Found by FIRMWARE CHECKSUM.")
FIRMWARE.reserved(LONG, (14, 15))

LOG = Block(
    "Logging Parameters",
    object="LOG",
    prefix="",
    spans=(Span(20480, 1),),
    packet=consecutive(0x50),
    indexed=False,
)
LOG.row(0, "MAX Servo Period", LONG, NS, "", "Longest servo period met.")
LOG.reserved(LONG, range(1, 8))

BLOCKS = (SAMPLE, CLOCK, ADC_SETUP, BOARD, FIRMWARE, LOG)
