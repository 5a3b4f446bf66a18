"""What the channels of a card are, for the side of bytes and the side of lines."""

from enum import Enum, IntFlag

ASCII_PORT, BINARY_PORT = 5002, 5006  # of TCP


class BinaryMode(IntFlag):
    """The value of the MODE command; stripping alone (MODE 2) converts nothing."""

    PLAIN = 0
    PREFIX_CONTROLS = 1
    STRIP_HIGH_BIT = 2

    @property
    def prefixes(self) -> bool:
        """Control characters travel after a `#`."""
        return int.__and__(self, 1) == 1  # asked for every byte: an enum would be slow

    @property
    def strips(self) -> bool:
        """Bytes above 0x7F travel after an `&`."""
        return self.prefixes and bool(self & BinaryMode.STRIP_HIGH_BIT)


class EchoMode(IntFlag):
    """The value of the ECHO command; streams start with CHARACTERS alone."""

    CHARACTERS = 1
    NO_ERRORS = 2
    NO_PROMPT = 4


class Attention(Enum):
    """Who gets what is typed."""

    COMMANDS = "commands"  # the command interpreter, line by line
    LISTENING = "listening"  # a program (LRUN, LISTEN); ESC ends it
    PASS_THROUGH = "pass-through"  # another device (DTALK, TALK TO); not echoed, ESC ends it
    OPEN = "open"  # a program holds the stream OPEN: every byte is data


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


# Channels of the card that a connection of a kind may take, in the order in which they are given.
CHANNELS = {
    StreamKind.TERMINAL: ("STREAM2", "STREAM3", "STREAM4", "STREAM5"),
    StreamKind.SERIAL: ("COM1", "COM2"),
    StreamKind.DPCB: ("DPCB",),
}


def startup_mode(channel: str) -> BinaryMode:
    """MODE of a channel after power-up, by its name."""
    kinds = (kind for kind, names in CHANNELS.items() if channel in names)
    return next(kinds, StreamKind.TERMINAL).startup_mode
