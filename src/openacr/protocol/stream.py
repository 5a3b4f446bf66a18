"""What the streams of a card are, whoever carries their bytes."""

from enum import Enum, IntFlag

from openacr.errors import OpenacrError
from openacr.protocol.escape import BinaryMode

ASCII_PORT, BINARY_PORT = 5002, 5006  # of TCP


class StreamKind(Enum):
    """What a stream understands and how it starts up."""

    TERMINAL = "terminal"  # text and packets, 8-bit clean: TCP, USB
    PACKETS = "packets"  # packets only: TCP
    SERIAL = "serial"  # text and packets with XON/XOFF: COM1, COM2
    DPCB = "dpcb"  # as a terminal, SET and CLR packets with a fourth byte

    @property
    def startup_mode(self) -> BinaryMode:
        """MODE after power-up: 1 on serial lines, 0 on all others."""
        serial = self is StreamKind.SERIAL
        return BinaryMode.PREFIX_CONTROLS if serial else BinaryMode.PLAIN


class EchoMode(IntFlag):
    """The value of the ECHO command; streams start with CHARACTERS alone."""

    CHARACTERS = 1
    NO_ERRORS = 2
    NO_PROMPT = 4


class NoFreeStreamError(OpenacrError):
    """All streams of the card are taken."""
