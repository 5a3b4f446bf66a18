"""Snapshots: the complete state of a card at one tick, which can be restored.

A snapshot holds the rows of the memory map and, in addition, plain data: program texts and
lines, input and output still pending, and the non-volatile memory. It holds no Python
objects: the code of programs and PLCs is compiled again from text and rows.
`snapshot_file.py` writes and reads it as bytes.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import Protocol

import msgspec
from msgspec import Struct

from openacr.basic.execute import language_state
from openacr.basic.execute.executor import Executor
from openacr.basic.execute.language_state import Language
from openacr.basic.execute.system import System
from openacr.basic.memory.ranges import Index
from openacr.controller.persistence import Persistence
from openacr.controller.streams import Streams, StreamsState
from openacr.errors import StoreError
from openacr.map.fingerprint import LAYOUT
from openacr.map.memory import Memory
from openacr.models import Model
from openacr.motion.clock import Clock
from openacr.plant.describe import schema
from openacr.plant.world.attached_devices import AttachedDevices
from openacr.protocol.packets import PacketError


class WholeCard(Protocol):
    """What a snapshot is taken of and put back into."""

    model: Model
    world: schema.World
    memory: Memory
    system: System
    executor: Executor
    streams: Streams
    nonvolatile: Persistence
    devices: AttachedDevices
    clock: Clock

    def image(self) -> bytearray:
        """The rows without what this process requested from the engine."""


class Beside(Struct, frozen=True):
    """The state of a card outside the memory map."""

    language: Language
    streams: StreamsState
    moves: list[bytes]  # packets of binary moves waiting for room
    devices: list[bytes]  # state of each device of the machine, as JSON
    stored: dict[str, bytes]  # the non-volatile memory
    lived_before_tk: Index


class Snapshot(Struct, frozen=True):
    """A snapshot; it fits cards with the same model, world and memory layout."""

    model: str
    world: str
    layout: str
    rows: bytes | bytearray  # of its own, never changed
    beside: Beside


def take(card: WholeCard) -> Snapshot:
    """Take a snapshot of a card."""
    return Snapshot(
        card.model.name,
        world_print(card.world),
        LAYOUT,
        card.image(),  # a copy of its own: another one of it would take 40 times as long
        take_beside(card),
    )


def take_beside(card: WholeCard) -> Beside:
    """The state of a card outside the memory map."""
    return Beside(
        language_state.take(card.system, card.executor),
        card.streams.state(),
        card.streams.moves.state(),
        card.devices.state(),
        card.nonvolatile.state(),
        card.clock.before_tk,
    )


def put_back(card: WholeCard, snapshot: Snapshot) -> None:
    """Return a card to a snapshot; open connections remain.

    StoreError, with the card unchanged, if the snapshot does not fit the card.
    """
    check_fits(card, snapshot)
    rows = card.memory.snapshot()
    language = language_state.take(card.system, card.executor)
    moves = card.streams.moves.state()
    try:
        _put_back(card, snapshot.rows, snapshot.beside.language, snapshot.beside.moves)
        card.devices.restore(snapshot.beside.devices)
    except StoreError:
        _put_back(card, rows, language, moves)
        raise
    card.nonvolatile.restore(snapshot.beside.stored)


def _put_back(
    card: WholeCard, rows: bytes | bytearray, language: Language, moves: list[bytes]
) -> None:
    card.memory.restore(rows)
    language_state.put_back(card.system, card.executor, language)
    try:
        card.streams.moves.restore(moves)
    except (PacketError, ValueError, LookupError) as error:
        raise StoreError(f"the snapshot holds a move that cannot be read: {error}") from None


def put_back_streams(card: WholeCard, snapshot: Snapshot) -> None:
    """Restore the connections of a snapshot on a new card."""
    card.streams.restore(snapshot.beside.streams)


def check_fits(card: WholeCard, snapshot: Snapshot) -> None:
    """StoreError if a snapshot is of another layout, model or world."""
    if snapshot.layout != LAYOUT:
        raise StoreError("the snapshot is of a version of openacr with another memory layout")
    if snapshot.model != card.model.name:
        raise StoreError(
            f"the snapshot is of an {snapshot.model}, the card is an {card.model.name}"
        )
    if snapshot.world != world_print(card.world):
        raise StoreError("the snapshot was taken with another machine connected to the card")


def world_print(world: schema.World) -> str:
    """Fingerprint of the machine around a card."""
    return blake2b(msgspec.json.encode(world), digest_size=8).hexdigest()
