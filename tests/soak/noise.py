"""Random and mutated input for a card: lines that nearly mean something, and bytes."""

import random
import struct

from openacr.basic import commands as _commands  # noqa: F401 - registers the commands
from openacr.basic.language import registry

NUMBERS = (
    "0", "1", "-1", "2", "3", "15", "16", "0.5", "-0.001", "1e5", "-1E-7", "255", "256", "4095",
    "4096", "12288", "32767", "65536", "2147483647", "-2147483648", "4294967296", "1e38", "1e300",
)  # fmt: skip
NAMES = (
    "X", "Y", "Z", "Q", "AXIS0", "AXIS1", "AXIS7", "AXIS8", "AXIS99", "MASTER0", "MASTER1",
    "PROG0", "PROG1", "PROG15", "PLC0", "ALL", "ENC0", "DAC0", "ADC0", "COM1", "STREAM2", "P0",
    "P12288", "P(P0)", "BIT32", "BIT8467", "LV0", "SV1", "DV2", "LA0(1)", "$V0", "$A0(0)", "count",
)  # fmt: skip
MARKS = (
    "(", ")", "/", ",", ";", ":", "=", "+", "-", "*", "**", "<", ">", "<=", "<>", '"', "'", "#",
    "$", "%", "&", "@", "_L", "THEN", "TO", "STEP", "USING", "AS", "AND", "OR", "NOT", "MOD",
)  # fmt: skip
TEXTS = ('"text"', '"STREAM3:"', '"####.##"', '"X"', '"', '"a>b"', "REM what > ever")
HEADERS = bytes((0x00, 0x04, 0x07, 0x1C, 0x1D, 0x1F))
PACKETS = (0x10, 0x18, 0x20, 0x30, 0x40, 0x60, 0x88, 0x89, 0x8A, 0x8B, *range(0x90, 0x97))
WORDS = tuple(command.name for command in registry.commands())
FUNCTIONS = tuple(f"{name}(" for name in registry.functions)


class Noise:
    """A source of trouble that can be repeated: same seed, same trouble."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def line(self) -> str:
        """A line that begins like a command, cut up and mutated."""
        chance = self.random
        parts = [chance.choice(WORDS).replace("#", str(chance.randrange(20)))]
        for _ in range(chance.randrange(5)):
            kind = chance.choices(
                (NAMES, NUMBERS, MARKS, WORDS, FUNCTIONS, TEXTS), (4, 4, 2, 1, 1, 1)
            )[0]
            parts.append(chance.choice(kind))
        text = chance.choice((" ", " ", "")).join(parts)
        if chance.random() < 0.2:
            text = f"{chance.randrange(200)} {text}"
        if chance.random() < 0.2:
            text = self._mutated(text)
        return text

    def _mutated(self, text: str) -> str:
        chance = self.random
        at = chance.randrange(len(text) + 1)
        other = chr(chance.randrange(32, 256))
        return chance.choice(
            (
                text[:at],
                text[at:],
                text[:at] + other + text[at:],
                text * 3,
                text[::-1],
                text.lower(),
            )
        )

    def packet(self) -> bytes:
        """A packet that may be whole."""
        chance = self.random
        head = bytes((chance.choice(HEADERS),))
        if head == b"\0":
            head += bytes((chance.choice(PACKETS),))
        number = chance.choice((0, 4097, 6916, 8192, 12288, 40959, 65535, chance.randrange(65536)))
        body = struct.pack("<H", number) + chance.randbytes(chance.randrange(24))
        return head + body

    def raw(self) -> bytes:
        """Anything, control keys included."""
        return self.random.randbytes(self.random.randrange(1, 40))

    def harmless(self) -> bytes:
        """What no card acts on, though it has to answer or to drop it."""
        chance = self.random
        plain = bytes(chance.randrange(0x30, 0x70) for _ in range(2))  # as such in every MODE
        letters = bytes(chance.choice(b"qwzkj?!^~\x80\xc3\xff\t ;)") for _ in range(12))
        return chance.choice(
            (
                b"ZZ" + letters + b"\r",
                b"\r\n",
                b"ZZ" * 200 + b"\r",
                b"zz\b\x7f\x1b",
                b"\x00\x88" + plain,
                b"\x00\x30" + plain,
                b"\x00\xfe",  # no such packet
            )
        )
