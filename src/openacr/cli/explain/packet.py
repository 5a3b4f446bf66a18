"""`openacr packet`: what the bytes of binary packets say, field by field."""

import json as json_format
import struct
from collections.abc import Iterator
from typing import Annotated

import typer

from openacr.channels import BinaryMode
from openacr.errors import MapError, UserError
from openacr.map import Flag, Parameter, flag, parameter
from openacr.protocol.framing import PacketReader
from openacr.protocol.packet import WORD_BYTES
from openacr.protocol.packets import HEADER_IDS, Packet, PacketError, Part

HEADERS = ", ".join(f"{each:02X}" for each in sorted(HEADER_IDS))


def explain_packet(
    text: Annotated[
        list[str], typer.Argument(metavar="HEX...", help="Bytes as hex digits: 00 88 02 30")
    ],
    mode: Annotated[
        int, typer.Option(min=0, max=3, help="MODE of the stream with these bytes.")
    ] = 0,
    reply: Annotated[
        bool, typer.Option("--reply", help="The bytes came from the card: words follow.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print a JSON array of packets.")] = False,
) -> None:
    """Decode binary packets: every field with its meaning."""
    found = list(_packets(_bytes("".join(text)), BinaryMode(mode), is_reply=reply))
    if json:
        typer.echo(json_format.dumps([_fields(*each) for each in found], indent=1))
        return
    for number, (packet, parts) in enumerate(found):
        if number:
            typer.echo()
        for line in [*map(str, parts), *_targets(packet)]:
            typer.echo(line)


def _bytes(text: str) -> bytes:
    """Hex digits in any grouping, with or without 0x."""
    digits = "".join(text.replace("0x", " ").replace("0X", " ").replace(",", " ").split())
    try:
        return bytes.fromhex(digits)
    except ValueError:
        wrong = next((each for each in digits if each not in "0123456789abcdefABCDEF"), None)
        problem = f"{wrong!r} is no hex digit" if wrong else "an odd number of hex digits"
        raise UserError(f"{problem}; write bytes like 00 88 02 30") from None


def _packets(
    data: bytes, mode: BinaryMode, *, is_reply: bool
) -> Iterator[tuple[Packet, list[Part]]]:
    """The packets in `data`, one directly after the other."""
    at = 0
    while at < len(data):
        packet, used = _first(data, at, mode)
        at += used
        parts = packet.explain()
        if is_reply:
            words, used = _words(data[at:], packet.reply_words(), mode)
            parts += words
            at += used
        yield packet, parts


def _first(data: bytes, at: int, mode: BinaryMode) -> tuple[Packet, int]:
    if data[at] not in HEADER_IDS:
        raise UserError(f"byte {at + 1}: no packet starts with {data[at]:02X}; those: {HEADERS}")
    reader = PacketReader()
    reader.start(data[at], mode, 0)
    for used in range(2, len(data) - at + 1):
        try:
            packet = reader.feed(data[at + used - 1 : at + used], 0)
        except PacketError as wrong:
            raise UserError(f"byte {at + used}: {wrong}") from None
        if packet is not None:
            return packet, used
    raise UserError(f"the packet that starts at byte {at + 1} is not complete")


def _words(data: bytes, count: int, mode: BinaryMode) -> tuple[list[Part], int]:
    """The words of a reply, as integer and as IEEE single: the bytes do not tell which."""
    plain, used = _plain(data, WORD_BYTES * count, mode)
    parts = []
    for number in range(count):
        word = plain[WORD_BYTES * number : WORD_BYTES * (number + 1)]
        (whole,) = struct.unpack("<i", word)
        (real,) = struct.unpack("<f", word)
        parts.append(Part(word, f"word {number}", f"{whole} (as IEEE {real:.9g})"))
    return parts, used


def _plain(data: bytes, count: int, mode: BinaryMode) -> tuple[bytes, int]:
    """The first `count` bytes without the prefixes of MODE, and how many stand for them."""
    from openacr.protocol.escape import Decoder

    decoder, plain, used = Decoder(mode), bytearray(), 0
    for byte in data:
        if len(plain) == count:
            break
        used += 1
        value = decoder.feed(byte)
        if value is not None:
            plain.append(value)
    if len(plain) < count:
        raise UserError(f"the reply ends after {len(plain)} of {count} bytes of words")
    return bytes(plain), used


def _targets(packet: Packet) -> list[str]:
    """What the numbers in a packet are called on the card."""
    flags = [_named(f"BIT{number}", _flag_name(number)) for number in packet.flags()]
    names = ((number, _parameter_name(number)) for number in _parameters(packet))
    return flags + [_named(f"P{number}", name) for number, name in names]


def _parameters(packet: Packet) -> list[int]:
    try:
        return list(packet.parameters())
    except PacketError as wrong:
        raise UserError(str(wrong)) from None


def _named(number: str, name: str) -> str:
    return f"{'':<24}{number}: {name}"


def _parameter_name(number: int) -> str:
    try:
        return _full(parameter(number))
    except MapError:
        return "no such parameter"


def _flag_name(number: int) -> str:
    try:
        return _full(flag(number))
    except MapError:
        return "no such flag"


def _full(record: Parameter | Flag) -> str:
    """The name with the object it belongs to."""
    index = "" if record.index is None else record.index
    return f"{record.object}{index} {record.name}" if record.object else record.name


def _fields(packet: Packet, parts: list[Part]) -> dict[str, object]:
    fields = [
        {"bytes": part.data.hex(" "), "name": part.name, "value": str(part.value)} for part in parts
    ]
    return {"packet": type(packet).__name__, "fields": fields, "parameters": _parameters(packet)}
