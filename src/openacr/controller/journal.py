"""The journal of a virtual card: its state at first, then every external input with its tick.

The first record of the file is `{"model": ..., "world": ..., "tick": ..., "digest": ...,
"snapshot": ..., ...}`; those after it are entries (`journal/entries.py`). Ticks are counted over
the whole life of the card, restarts included.
"""

from __future__ import annotations

from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from openacr.controller import snapshot as snapshots
from openacr.controller import snapshot_file
from openacr.errors import StoreError
from openacr.journal.entries import (
    Entered,
    JournalEntry,
    damaged,
    read_content,
    read_entries,
    read_head,
    split_lines,
)
from openacr.map.fingerprint import LAYOUT
from openacr.models import MODELS
from openacr.plant.describe import schema
from openacr.plant.describe.check import contradictions

_KNOWN = frozenset(Entered) - {Entered.SENT}


class Header(msgspec.Struct, frozen=True):
    """The first record of a journal: the initial state of the card and its origin."""

    program: str
    layout: str
    model: str
    world: schema.World
    tick: Annotated[int, Meta(ge=0, lt=1 << 62)]
    period_s: float
    digest: str
    digest_every_tk: Annotated[int, Meta(ge=1, le=1_000_000)]
    snapshot: str
    project: str = ""
    fingerprint: str = ""


class Journal(Struct, frozen=True):
    """A journal as read from a file; `is_whole`: it was closed and is not truncated."""

    header: Header
    entries: tuple[JournalEntry, ...]
    is_whole: bool

    @property
    def snapshot(self) -> snapshots.Snapshot:
        """The initial state of the card; StoreError if this version cannot use it."""
        if self.header.layout != LAYOUT:
            raise StoreError(
                f"the journal was written by openacr {self.header.program} with another layout"
                " of the memory; replay it with that version"
            )
        try:
            data = b64decode(self.header.snapshot, validate=True)
        except ValueError:
            raise StoreError("the journal is damaged: its snapshot cannot be read") from None
        return snapshot_file.decode(data)


def read_journal(path: Path) -> Journal:
    """Read the journal of a card, up to its last whole record."""
    lines = split_lines(path, read_content(path))
    header = read_head(path, lines.head, Header)
    _check(path, header)
    entries = tuple(_in_order(path, header, lines.records))
    is_whole = bool(entries) and entries[-1].what is Entered.END and not lines.rest
    return Journal(header, entries, is_whole)


def _in_order(path: Path, header: Header, records: list[bytes]) -> Iterator[JournalEntry]:
    """The entries in order; no gap is longer than the interval between two digests."""
    latest = header.tick
    for line, entry in read_entries(path, records, _KNOWN):
        if not latest <= entry.tick <= latest + header.digest_every_tk:
            raise damaged(
                path, line,
                f"tick {entry.tick} follows tick {latest}, but there must be an entry every"
                f" {header.digest_every_tk} ticks",
            )  # fmt: skip
        latest = entry.tick
        yield entry


def _check(path: Path, header: Header) -> None:
    """Refuse a header that no card can have written."""
    if header.model not in MODELS:
        raise StoreError(f"{path} is the journal of an unknown model, {header.model}")
    wrong = next(contradictions(header.world), None)
    if wrong is not None:
        raise StoreError(f"{path}: its machine is damaged: {wrong.text}")
    if header.period_s != header.world.card.period_s:
        raise StoreError(f"{path}: its first record is damaged: it has two different tick lengths")
