"""Payloads of Sparkplug B as bytes: the part of its protobuf schema that scalar metrics need.

Fields of Payload: timestamp 1, metrics 2, seq 3. Fields of Metric: name 1, alias 2, timestamp 3,
datatype 4, is_null 7, properties 9, then the value by its type, 10 to 15. What is not among them
is skipped.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

VARINT, DOUBLE, BYTES, FLOAT = 0, 1, 2, 5  # wire types
LONGEST = 1 << 20
WORD = 1 << 64


class DataType(IntEnum):
    """Types of metrics that are sent; others are understood as far as their field tells."""

    INT64 = 4
    UINT64 = 8
    DOUBLE = 10
    BOOLEAN = 11
    STRING = 12


Scalar = int | float | bool | str


@dataclass(frozen=True, slots=True)
class Metric:
    """One metric; a name in births, an alias in data, either of them in commands."""

    value: Scalar | None
    datatype: DataType | None = None
    name: str = ""
    alias: int | None = None
    timestamp_ms: int | None = None
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Payload:
    """A message."""

    metrics: tuple[Metric, ...]
    timestamp_ms: int | None = None
    seq: int | None = None


class PayloadError(ValueError):
    """Bytes that are no payload."""


# --- writing --------------------------------------------------------------------------


def encode(payload: Payload) -> bytes:
    """The bytes of a message."""
    out = bytearray()
    if payload.timestamp_ms is not None:
        _number(out, 1, payload.timestamp_ms)
    for metric in payload.metrics:
        _block(out, 2, _metric(metric))
    if payload.seq is not None:
        _number(out, 3, payload.seq)
    return bytes(out)


def _metric(metric: Metric) -> bytes:
    out = bytearray()
    if metric.name:
        _block(out, 1, metric.name.encode())
    if metric.alias is not None:
        _number(out, 2, metric.alias)
    if metric.timestamp_ms is not None:
        _number(out, 3, metric.timestamp_ms)
    if metric.datatype is not None:
        _number(out, 4, metric.datatype)
    if metric.unit:
        _block(out, 9, _properties({"engUnit": metric.unit}))
    value = metric.value
    if value is None:
        _number(out, 7, 1)
    elif isinstance(value, bool):
        _number(out, 14, value)
    elif isinstance(value, int):
        _number(out, 11, value % WORD)
    elif isinstance(value, float):
        out += bytes([13 << 3 | DOUBLE]) + struct.pack("<d", value)
    else:
        _block(out, 15, value.encode())
    return bytes(out)


def _properties(texts: dict[str, str]) -> bytes:
    out = bytearray()
    for key in texts:
        _block(out, 1, key.encode())
    for text in texts.values():
        inner = bytearray()
        _number(inner, 1, DataType.STRING)
        _block(inner, 8, text.encode())
        _block(out, 2, bytes(inner))
    return bytes(out)


def _number(out: bytearray, field: int, value: int) -> None:
    _varint(out, field << 3 | VARINT)
    _varint(out, value)


def _block(out: bytearray, field: int, data: bytes) -> None:
    _varint(out, field << 3 | BYTES)
    _varint(out, len(data))
    out += data


def _varint(out: bytearray, value: int) -> None:
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)


# --- reading --------------------------------------------------------------------------

Field = tuple[int, int, int | bytes]  # number, wire type, value


def decode(data: bytes) -> Payload:
    """The message in some bytes; PayloadError where there is no message."""
    if len(data) > LONGEST:
        raise PayloadError(f"{len(data)} bytes are too many")
    metrics: list[Metric] = []
    timestamp_ms = seq = None
    for number, wire, value in _fields(data):
        if number == 2 and isinstance(value, bytes):
            metrics.append(_read_metric(value))
        elif number == 1 and wire == VARINT and isinstance(value, int):
            timestamp_ms = value
        elif number == 3 and wire == VARINT and isinstance(value, int):
            seq = value
    return Payload(tuple(metrics), timestamp_ms, seq)


def _read_metric(data: bytes) -> Metric:
    found: dict[int, int | bytes] = {number: value for number, _, value in _fields(data)}
    name, alias = found.get(1, b""), found.get(2)
    if not isinstance(name, bytes) or isinstance(alias, bytes):
        raise PayloadError("name or alias of a metric has a wrong type")
    try:
        value = None if found.get(7) else _value(found)
        return Metric(value, name=name.decode(), alias=alias)
    except (struct.error, UnicodeDecodeError, TypeError) as error:
        raise PayloadError(f"a metric is damaged: {error}") from None


def _value(found: dict[int, int | bytes]) -> Scalar | None:
    """The value of a metric: signed integers by their data type."""
    for number in (10, 11):
        if number in found and isinstance(whole := found[number], int):
            return _signed(whole, found.get(4))
    if 12 in found:
        return float(struct.unpack("<f", _data(found[12]))[0])
    if 13 in found:
        return float(struct.unpack("<d", _data(found[13]))[0])
    if 14 in found:
        return bool(found[14])
    return _data(found[15]).decode() if 15 in found else None


BITS = {1: 8, 2: 16, 3: 32, 4: 64}  # of signed data types


def _signed(value: int, datatype: object) -> int:
    bits = BITS.get(datatype) if isinstance(datatype, int) else None
    if bits is None:
        return value
    value %= 1 << bits
    return value - (1 << bits) if value >> (bits - 1) else value


def _data(value: int | bytes) -> bytes:
    if not isinstance(value, bytes):
        raise TypeError("a number stands for bytes")
    return value


def _fields(data: bytes) -> Iterator[Field]:
    place = 0
    while place < len(data):
        key, place = _read_varint(data, place)
        number, wire = key >> 3, key & 7
        if wire == VARINT:
            value, place = _read_varint(data, place)
            yield number, wire, value
            continue
        if wire == BYTES:
            size, place = _read_varint(data, place)
        elif wire in (DOUBLE, FLOAT):
            size = 8 if wire == DOUBLE else 4
        else:
            raise PayloadError(f"wire type {wire} is not known")
        if place + size > len(data):
            raise PayloadError("it ends within a field")
        yield number, wire, data[place : place + size]
        place += size


def _read_varint(data: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        if place >= len(data) or shift > 63:
            raise PayloadError("it ends within a number")
        byte = data[place]
        value |= (byte & 0x7F) << shift
        place, shift = place + 1, shift + 7
        if not byte & 0x80:
            return value, place
