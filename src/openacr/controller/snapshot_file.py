"""Encode snapshots as bytes, and decode them.

    openacr snapshot 1 LF
    a header in MessagePack: Header, the lengths and the fingerprint of what follows
    compressed with zlib: the state outside the rows in MessagePack (snapshot.Beside), the rows

The rows are the memory map as it is in memory, little-endian. Everything is checked before it
is used: types and ranges of the plain data, and every row against its declaration.
"""

from __future__ import annotations

import zlib
from hashlib import blake2b
from importlib.metadata import version
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from openacr.basic.memory.heap import Heap
from openacr.controller.snapshot import Beside, Snapshot
from openacr.errors import StoreError
from openacr.map.fingerprint import LAYOUT
from openacr.map.memory import Memory
from openacr.map.numbers import MEMORY_BYTES
from openacr.map.valid import check_rows
from openacr.motion.path.buffer import check_rings
from openacr.plant.describe.places import check_places

MAGIC = b"openacr snapshot 1\n"
COMPRESSION = 1  # the memory is mostly zeros: more effort gains nothing
MOST_BESIDE_BYTES = 1 << 26


class Header(Struct, frozen=True):
    """The header of a snapshot: its card, and the lengths and digest of the content."""

    program: str
    layout: str
    model: str
    world: str
    beside_bytes: Annotated[int, Meta(ge=0, le=MOST_BESIDE_BYTES)]
    rows_bytes: int
    digest: bytes  # of the content before it was compressed


_HEADER_BYTES = 4  # length of the header, little-endian


def encode(snapshot: Snapshot) -> bytes:
    """Encode a snapshot as bytes."""
    beside = msgspec.msgpack.encode(snapshot.beside)
    content = beside + snapshot.rows
    header = msgspec.msgpack.encode(
        Header(
            version("openacr"), snapshot.layout, snapshot.model, snapshot.world,
            len(beside), len(snapshot.rows), _digest(content),
        )
    )  # fmt: skip
    length = len(header).to_bytes(_HEADER_BYTES, "little")
    return MAGIC + length + header + zlib.compress(content, COMPRESSION)


def decode(data: bytes) -> Snapshot:
    """Decode the bytes made by `encode`; StoreError for anything else, before any of it is used."""
    if not data.startswith(MAGIC):
        raise StoreError("the snapshot cannot be read: not a snapshot, or of another version")
    begin = len(MAGIC) + _HEADER_BYTES
    end = begin + int.from_bytes(data[len(MAGIC) : begin], "little")
    try:
        header = msgspec.msgpack.decode(data[begin:end], type=Header)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise StoreError(f"the snapshot cannot be read: {error}") from None
    if header.layout != LAYOUT or header.rows_bytes != MEMORY_BYTES:
        raise StoreError(
            f"the snapshot was written by openacr {header.program} with another layout of the"
            " memory; use that version"
        )
    content = _inflated(data[end:], header.beside_bytes + header.rows_bytes)
    if _digest(content) != header.digest:
        raise StoreError("the snapshot is damaged: its fingerprint does not match")
    rows = content[header.beside_bytes :]
    check(rows)
    try:
        beside = msgspec.msgpack.decode(content[: header.beside_bytes], type=Beside)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise StoreError(f"the snapshot cannot be read: {error}") from None
    return Snapshot(header.model, header.world, header.layout, rows, beside)


def check(rows: bytes) -> None:
    """Raise StoreError unless every row is within its declared range."""
    memory = Memory()
    memory.restore(rows)
    check_rows(memory)
    check_rings(memory)
    check_places(memory)
    Heap(memory).check()


def _inflated(data: bytes, size: int) -> bytes:
    """Decompress exactly `size` bytes; a longer stream is not read to its end."""
    inflater = zlib.decompressobj()
    try:
        content = inflater.decompress(data, size + 1)
    except zlib.error as error:
        raise StoreError(f"the snapshot is damaged: {error}") from None
    if len(content) != size or not inflater.eof or inflater.unused_data:
        raise StoreError("the snapshot is damaged: its length differs from that in its header")
    return content


def _digest(content: bytes) -> bytes:
    return blake2b(content, digest_size=16).digest()
