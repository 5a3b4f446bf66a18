"""The whole state of a card at one tick, to come back to, in this process or from a file.

In a file the parts beside the memory are pickles. They are read with a list of what they
may contain - data of this package - so that a journal somebody sends runs no code.
"""

from __future__ import annotations

import io
import pickle
import zlib
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from importlib import import_module
from typing import TYPE_CHECKING, Any

import msgspec

from openacr.basic import registry
from openacr.errors import StoreError
from openacr.map import numbers

if TYPE_CHECKING:
    from openacr.controller.controller import Controller

COMPRESSION = 1  # the memory is mostly zeros: more effort gains nothing
_OURS = (
    "openacr.basic.",
    "openacr.lang.",
    "openacr.motion.attachments",
    "openacr.plc.",
    "openacr.protocol.",
)
_PLAIN = {("builtins", "bytearray"), ("builtins", "set"), ("builtins", "frozenset")}
_PLAIN |= {("collections", "deque")}
_FUNCTIONS = (registry.find, registry.find_function)


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Memory and everything beside it; independent of the card it was taken from."""

    memory: bytes
    language: bytes
    execution: bytes
    stored: dict[str, bytes]
    streams: bytes
    moves: list[bytes]
    lived_before_tk: int


def take(card: Controller) -> Snapshot:
    """Take a snapshot of a card."""
    language = pickle.dumps((card.card.attachments, card.system.state()))
    return Snapshot(
        card.memory.snapshot(),
        language,
        card.executor.state(),
        card.nonvolatile.state(),
        pickle.dumps(card.streams.state()),
        card.streams.moves.state(),
        card.lived_tk - card.tick,
    )


def put_back(card: Controller, snapshot: Snapshot) -> None:
    """Return a card to a snapshot; who is connected stays connected."""
    card.memory.restore(snapshot.memory)
    card.card.attachments, language = pickle.loads(snapshot.language)
    card.system.restore(language)
    card.executor.restore(snapshot.execution)
    card.nonvolatile.restore(snapshot.stored)
    card.streams.moves.restore(snapshot.moves)


def put_back_streams(card: Controller, snapshot: Snapshot) -> None:
    """Connect a new card to everything that was connected."""
    card.streams.restore(pickle.loads(snapshot.streams))


# files


def encode(snapshot: Snapshot) -> bytes:
    """A snapshot as bytes."""
    return zlib.compress(msgspec.msgpack.encode(snapshot), COMPRESSION)


def decode(data: bytes) -> Snapshot:
    """The snapshot `encode` made; StoreError for anything else, before any of it is used."""
    try:
        snapshot = msgspec.msgpack.decode(zlib.decompress(data), type=Snapshot)
        for part in (snapshot.language, snapshot.execution, snapshot.streams):
            _Reader(io.BytesIO(part)).load()
    except StoreError:
        raise
    except Exception as error:  # a pickle can fail in any way
        raise StoreError(f"the snapshot cannot be read: {error}") from None
    return snapshot


class _Reader(pickle.Unpickler):
    """Reads pickles that contain nothing but data of this package."""

    def find_class(self, module: str, name: str) -> Any:
        """A class or one of two look-ups; everything else is refused."""
        if (module, name) in _PLAIN:
            return super().find_class(module, name)
        if module.startswith(_OURS) and "." not in name:
            found = getattr(import_module(module), name, None)
            is_own = getattr(found, "__module__", "") == module
            if is_own and (isinstance(found, type) or found in _FUNCTIONS):
                return found
        raise StoreError(f"the snapshot contains {module}.{name}, which no card has")


@cache
def layout() -> str:
    """Fingerprint of the places of all rows: snapshots fit cards with the same one."""
    places = sorted((name, value) for name, value in vars(numbers).items() if name.isupper())
    return blake2b(repr(places).encode(), digest_size=8).hexdigest()
