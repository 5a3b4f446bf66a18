"""Sampling, clock, board and firmware information, logging."""

from openacr.map.block import LONG, RW, Block, R, Span, consecutive

SAMPLE = Block(
    "Miscellaneous Parameters: Position",
    object="SAMPLE",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
SAMPLE.row(0x00, "Sample Array Index", LONG)
SAMPLE.row(0x01, "Sample Trigger Index", LONG)
SAMPLE.row(0x02, "Sample Timer Clock", LONG)
SAMPLE.row(0x03, "Sample Timer Period", LONG)

CLOCK = Block(
    "Miscellaneous Parameters: Position",
    object="SYSTEM",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
CLOCK.row(
    0x04,
    "Global System Clock",
    LONG,
    RW,
    "Free-running millisecond clock; returns to 0 at 2^31; may be preset by the user (000).",
)

ADC_SETUP = Block(
    "Miscellaneous Parameters: Position",
    object="ADC",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
ADC_SETUP.row(0x05, "ADC State Control", LONG)
ADC_SETUP.row(0x06, "ADC Positive Channels", LONG)
ADC_SETUP.row(0x07, "ADC Negative Channels", LONG)

BOARD = Block(
    "Miscellaneous Parameters: Board Information",
    object="BOARD",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
BOARD.row(
    0x80,
    "Card / Serial Number",
    LONG,
    R,
    "Card type in the upper four digits, serial (always 0000) in the lower four, e.g. 80100000.",
)
BOARD.row(0x81, "Card Number", LONG, R, "Card number from the address DIP switch.")
BOARD.row(0x82, "Firmware Version", LONG, R, "Firmware version as digits, 1.18.01 reads 11801.")
BOARD.row(0x83, "Update Number", LONG, R, "Firmware update number, 0 if none.")
BOARD.row(
    0x84,
    "Diagnostics",
    LONG,
    R,
    "32-bit image of the DIAG report; layout differs per card, 0 = pass, 1 = fail.",
)
BOARD.row(0x85, "FPGA ID", LONG, R, "ID of the encoder FPGAs fitted.")
BOARD.row(0x86, "IO Configuration", LONG, R, "ACR1500 I/O configuration; 0 on other boards.")

FIRMWARE = Block(
    "Miscellaneous Parameters: Firmware Information",
    object="FIRMWARE",
    prefix="",
    spans=(Span(6912, 1),),
    stride=0,
    packet=consecutive(0x1B),
    indexed=False,
)
FIRMWARE.row(0xC0, "Bootflash Version", LONG)
FIRMWARE.row(0xC1, "Bootflash Checksum", LONG)
FIRMWARE.reserved(LONG, (0xC2, 0xC3))
FIRMWARE.row(0xC4, "Sysflash1 Version", LONG)
FIRMWARE.row(0xC5, "Sysflash1 Checksum", LONG)
FIRMWARE.reserved(LONG, (0xC6, 0xC7))
FIRMWARE.row(0xC8, "Sysflash2 Version", LONG)
FIRMWARE.row(0xC9, "Sysflash2 Checksum", LONG)
FIRMWARE.reserved(LONG, range(0xCA, 0xCD))
FIRMWARE.row(0xCD, "Userflash Checksum", LONG)
FIRMWARE.reserved(LONG, (0xCE, 0xCF))

LOG = Block(
    "Logging Parameters",
    object="LOG",
    prefix="",
    spans=(Span(20480, 1),),
    stride=0,
    packet=consecutive(0x50),
    indexed=False,
)
LOG.row(0x00, "MAX Servo Period", LONG)
LOG.reserved(LONG, range(0x01, 0x08))

BLOCKS = (SAMPLE, CLOCK, ADC_SETUP, BOARD, FIRMWARE, LOG)
