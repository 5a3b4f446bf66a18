"""Conversion of the data bytes of a binary transfer, MODE 0 to 3 (UG2 ch. 6).

Prefixing keeps control characters (and with them XON and XOFF) out of the data,
stripping keeps the high bit out for 7-bit lines. The header byte that starts a transfer
is never converted; everything after it is.
"""

from dataclasses import dataclass

from openacr.channels import BinaryMode

PREFIX = ord("#")
HIGH = ord("&")
TOGGLE = 0x40  # turns a control character into a printable one and back


def _encode_byte(byte: int, strips: bool) -> bytes:
    """Encode one data byte with prefixing on."""
    if strips and byte > 0x7F:
        return bytes((HIGH,)) + _encode_byte(byte & 0x7F, strips)
    if byte < 0x20 or byte == 0x7F:
        return bytes((PREFIX, byte ^ TOGGLE))
    if byte == PREFIX or (strips and byte == HIGH):
        return bytes((PREFIX, byte))
    return bytes((byte,))


_TABLES = {strips: [_encode_byte(byte, strips) for byte in range(256)] for strips in (False, True)}


def encode(data: bytes, mode: BinaryMode) -> bytes:
    """Encode the data bytes of a transfer (without its header byte) for `mode`."""
    if not mode.prefixes:
        return data
    table = _TABLES[mode.strips]
    return b"".join([table[byte] for byte in data])


def encode_packet(packet: bytes, mode: BinaryMode) -> bytes:
    """Encode a whole packet for `mode`: its header byte is unchanged."""
    return packet[:1] + encode(packet[1:], mode) if mode.prefixes else packet


@dataclass(slots=True)
class Decoder:
    """Decodes the data bytes of one transfer, received byte by byte."""

    mode: BinaryMode
    prefixed: bool = False
    high: bool = False

    def feed(self, byte: int) -> int | None:
        """The data byte that `byte` completes, or None when more must follow."""
        if not self.mode.prefixes:
            return byte
        if self.prefixed:
            return self._deliver(byte ^ TOGGLE if 0x3F <= byte <= 0x5F else byte)
        if byte == PREFIX:
            self.prefixed = True
            return None
        if byte == HIGH and self.mode.strips and not self.high:
            self.high = True
            return None
        return self._deliver(byte)

    def _deliver(self, byte: int) -> int:
        value = byte | 0x80 if self.high else byte
        self.prefixed = self.high = False
        return value
