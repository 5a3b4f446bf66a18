"""Communication channels (streams) of the card: buffers, prompt, echo and port settings."""

from openacr.map.block import LONG, NS, RW, Block, Span, consecutive
from openacr.map.flag_block import FlagBlock

STARTUP = (
    "Power-up port settings: baud/300 in bits 0-7, data bits 8-9, stop 10, parity 11-12, enable 15."
)


def _stream(name: str, first: int, *, is_serial: bool = False) -> Block:
    block = Block(
        f"Miscellaneous Parameters: {name} Stream",
        object=name,
        prefix="",
        spans=(Span(first, 1),),
        packet=consecutive(0x1B),
        indexed=False,
    )
    block.row(0, f"{name} Character Buffer Count", LONG, NS, "", "Characters waiting to be read.")
    block.row(1, f"{name} Line Buffer Count", LONG, NS, "", "Complete lines waiting to be read.")
    block.row(2, f"{name} Free Character Space", LONG, NS, "byte", "Room left in the input buffer.")
    block.row(3, f"{name} Command Counter", LONG, NS, "", "Command lines executed so far.")
    block.row(
        4,
        f"{name} Communication Timeout",
        LONG,
        NS,
        "ms",
        "Longest gap between the bytes of a binary packet.",
        default=50,
    )
    if is_serial:
        block.row(5, f"{name} Startup Mode", LONG, RW, "", STARTUP)
    return block


def _stream_flags(
    name: str, word: int, word_name: str, group: str, *, is_serial: bool = False
) -> FlagBlock:
    block = FlagBlock(
        f"{name} Stream Flags",
        object=name,
        prefix="STRM",
        spans=(Span(word, 1),),
        word_name=word_name,
        group=group,
        ident=name,
        packet=consecutive(0x10),
        first_index=None,
    )
    block.row(0, "Enable Character Echo", NS, "Typed characters are sent back.")
    block.row(1, "Disable Error Reporting", NS, "Refused commands print nothing.")
    block.row(2, "Disable Command Prompt", NS, "No prompt is printed.")
    for bit, state, doc in (
        (8, "Stream Active", "The channel exists and runs."),
        (9, "Stream Waiting", "Input waits to be read."),
        (10, "Stream Opened", "A program has opened the channel as a device."),
        (11, "Stream Disabled", "The channel takes no commands."),
        (12, "Stream Echoing", "Echo is in effect right now."),
        (13, "Redimensioned", "The buffer size has changed."),
        (16, "Open Request", "Asks the card to open the channel."),
        (17, "Escape Request", "Asks the card to act as if ESC was typed."),
        (20, "Control Prefixing", "Control codes in binary packets are escaped (MODE bit 0)."),
        (21, "High Bit Stripping", "Binary packets are sent as seven-bit bytes (MODE bit 1)."),
    ):
        block.row(bit, f"{name} {state}", NS, doc, ident=state)
    if is_serial:
        block.row(24, "Serial Input MUX0", RW, "With MUX1: protocol on ACR1200/2000/8010.")
        block.row(25, "Serial Input MUX1", RW, "With MUX0: protocol on ACR1200/2000/8010.")
        block.row(26, "Receive Flag", RW, "With Transmit: RS-422/485 on ACR1200/2000/8010.")
        block.row(27, "Transmit Flag", RW, "With Receive: RS-422/485 on ACR1200/2000/8010.")
    return block


def _printer_flags() -> FlagBlock:
    block = FlagBlock(
        "LPT1 Stream Flags",
        object="LPT1",
        prefix="LPTF",
        spans=(Span(4153, 1),),
        word_name="LPT1 Flags",
        group="Other Flags",
        ident="LPT1",
        packet=consecutive(0x10),
        first_index=None,
    )
    for bit in range(8):
        block.row(bit, f"PD{bit}", NS, f"Connector pin P5-{23 + bit}.")
    block.row(10, "PRINT")
    pins = {11: 19, 12: 34, 13: 33, 14: 31, 15: 32, 16: 17, 17: 18, 18: 20, 19: 21}
    names = ("ERR", "SLCT", "PE", "ACK", "BUSY", "STB", "AFD", "INIT", "SLIN")
    for (bit, pin), name in zip(pins.items(), names, strict=True):
        block.row(bit, name, NS, f"Connector pin P5-{pin}.")
    block.row(20, "INT2 EN")
    block.row(21, "DIR")
    return block


BLOCKS = (
    _stream("FIFO", 6976),
    _stream("COM1", 7008, is_serial=True),
    _stream("COM2", 7024, is_serial=True),
    _stream("DPCB", 7088),
)
DPCB_FLAGS = _stream_flags("DPCB", 4277, "DPCB", "Misc Control Flags")
DPCB_FLAGS.word_erratum = "The flag table prints packet mask 0x06; it is 0x20, the sixth word."
FLAG_BLOCKS = (
    _stream_flags("FIFO", 4152, "FIFO Flags", "Other Flags"),
    _printer_flags(),
    _stream_flags("COM1", 4154, "COM1 Flags", "Other Flags", is_serial=True),
    _stream_flags("COM2", 4155, "COM2 Flags", "Other Flags", is_serial=True),
    DPCB_FLAGS,
)
