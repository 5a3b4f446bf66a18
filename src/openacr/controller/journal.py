"""The journal: every external input to a card with its tick, in memory and in replayable files.

A journal file is text, one record per line:

    openacr journal 1
    {"model": ..., "world": ..., "tick": ..., "digest": ..., "snapshot": ..., ...}
    [tick, "open", stream, kind, name]      a connection begins
    [tick, "bytes", stream, text]           bytes that arrived together, as Latin-1
    [tick, "close", stream]                 the connection ends
    [tick, "input", flag, 0 or 1]           an input switches
    [tick, "release", flag]                 a forced input is released
    [tick, "analog", parameter, value]      a value at an analog input
    [tick, "drag", axis, units]             a load is pushed by hand
    [tick, "fault", axis, kind, value]      a fault of the machine begins
    [tick, "mend", axis, kind]              the fault ends; "" for all kinds
    [tick, "command", device, name, value]  a command by hand to a device of the machine
    [tick, "parameter", number, value]      a parameter written from Python
    [tick, "flag", number, 0 or 1]          a flag written from Python
    [tick, "key", code]                     Ctrl-X, Ctrl-Y or Ctrl-Z pressed from Python
    [tick, "within", statement]             the next entries come before this statement of the
                                            tick (the first is 1), no longer after the tick; 0:
                                            after the tick again
    [tick, "digest", fingerprint]           every simulated second
    [tick, "end", fingerprint]              the end of a journal that was closed

Ticks are counted over the whole life of the card, restarts included. The reader ignores a
truncated last line.
"""

from __future__ import annotations

import json
from base64 import b64decode
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from openacr.channels import StreamKind
from openacr.controller import snapshot as snapshots
from openacr.controller import snapshot_file
from openacr.errors import StoreError, reason
from openacr.map.fingerprint import LAYOUT
from openacr.models import MODELS
from openacr.plant import schema
from openacr.plant.check import contradictions
from openacr.protocol.events import ControlKey

MAGIC = b"openacr journal 1\n"


class Entered(StrEnum):
    """The kind of an entry: an input to the card, or a record of its state."""

    OPEN = "open"
    BYTES = "bytes"
    CLOSE = "close"
    INPUT = "input"
    RELEASE = "release"
    ANALOG = "analog"
    DRAG = "drag"
    FAULT = "fault"
    MEND = "mend"
    COMMAND = "command"
    PARAMETER = "parameter"
    FLAG = "flag"
    KEY = "key"
    WITHIN = "within"
    DIGEST = "digest"
    END = "end"


@dataclass(frozen=True, slots=True)
class JournalEntry:
    """One input to the card, `tick` ticks into its life.

    `number` is the stream, input, axis, device, parameter, flag or key. `text` holds bytes (one
    character each), the kind of a stream, or a digest; `name` the stream requested, the kind of
    a fault or the command.
    """

    tick: int
    what: Entered
    number: int = 0
    text: str = ""
    value: float = 0.0
    name: str = ""

    @property
    def data(self) -> bytes:
        """The bytes that arrived."""
        return self.text.encode("latin-1")

    @property
    def is_digest(self) -> bool:
        """Whether the entry records the state of the card instead of changing it."""
        return self.what in (Entered.DIGEST, Entered.END)


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


@dataclass(frozen=True, slots=True)
class Journal:
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


# records


def record_of(entry: JournalEntry) -> bytes:
    """The line of an entry."""
    if entry.what is Entered.BYTES:  # thousands a second
        return msgspec.json.encode((entry.tick, "bytes", entry.number, entry.text)) + b"\n"
    return json.dumps(_record(entry)).encode() + b"\n"


def _record(entry: JournalEntry) -> list[Any]:
    head: list[Any] = [entry.tick, entry.what.value]
    if entry.is_digest:
        return [*head, entry.text]
    head.append(entry.number)
    if entry.what is Entered.OPEN:
        return [*head, entry.text, entry.name]
    if entry.what in (Entered.CLOSE, Entered.KEY, Entered.RELEASE, Entered.WITHIN):
        return head
    if entry.what in (Entered.FAULT, Entered.COMMAND):
        return [*head, entry.name, entry.value]
    if entry.what is Entered.MEND:
        return [*head, entry.name]
    return [*head, entry.value]


_Tick: TypeAlias = Annotated[int, Meta(ge=0, lt=1 << 62)]
_Number: TypeAlias = Annotated[int, Meta(ge=0, lt=1 << 31)]
_Text: TypeAlias = Annotated[str, Meta(pattern=r"\A[\x00-\xff]*\Z")]  # a character for each byte
_VALUE = tuple[_Tick, Entered, _Number, float]
_NUMBER = tuple[_Tick, Entered, _Number]
_DIGEST = tuple[_Tick, Entered, str]
_FORMS: dict[Entered, Any] = {
    Entered.OPEN: tuple[_Tick, Entered, _Number, StreamKind, str],
    Entered.BYTES: tuple[_Tick, Entered, _Number, _Text],
    Entered.CLOSE: _NUMBER,
    Entered.RELEASE: _NUMBER,
    Entered.WITHIN: _NUMBER,
    Entered.KEY: tuple[_Tick, Entered, ControlKey],
    Entered.FAULT: tuple[_Tick, Entered, _Number, str, float],
    Entered.COMMAND: tuple[_Tick, Entered, _Number, str, float],
    Entered.MEND: tuple[_Tick, Entered, _Number, str],
    Entered.DIGEST: _DIGEST,
    Entered.END: _DIGEST,
}


def _entry(record: list[Any]) -> JournalEntry:
    form = _FORMS.get(Entered(record[1]), _VALUE)
    tick, what, *rest = msgspec.convert(record, form)
    if what in (Entered.DIGEST, Entered.END):
        return JournalEntry(tick, what, text=rest[0])
    if what is Entered.OPEN:
        return JournalEntry(tick, what, rest[0], rest[1].value, name=rest[2])
    if what is Entered.BYTES:
        return JournalEntry(tick, what, rest[0], rest[1])
    if what in (Entered.FAULT, Entered.COMMAND):
        return JournalEntry(tick, what, rest[0], value=rest[2], name=rest[1])
    if what is Entered.MEND:
        return JournalEntry(tick, what, rest[0], name=rest[1])
    value = rest[1] if len(rest) > 1 else 0.0
    return JournalEntry(tick, what, int(rest[0]), value=value)


def read_journal(path: Path) -> Journal:
    """Read a journal file, up to its last whole record."""
    try:
        content = path.read_bytes()
    except OSError as failure:
        raise StoreError(f"{path} cannot be read: {reason(failure)}") from None
    if not content.startswith(MAGIC):
        raise StoreError(f"{path} is not a journal (or of another version)")
    head, *lines = content[len(MAGIC) :].split(b"\n")
    del content
    if not lines:
        raise StoreError(f"{path} ends within its first record: nothing can be replayed")
    try:
        header = msgspec.json.decode(head, type=Header)
    except (ValueError, RecursionError) as error:  # MsgspecError, UnicodeDecodeError
        raise StoreError(f"{path}: its first record cannot be read: {error}") from None
    _check(path, header)
    entries = tuple(
        _entries(path, header, lines[:-1])
    )  # after the last line end: nothing, or a part of a record
    is_whole = bool(entries) and entries[-1].what is Entered.END and not lines[-1]
    return Journal(header, entries, is_whole)


def _entries(path: Path, header: Header, lines: list[bytes]) -> Iterator[JournalEntry]:
    """The entries in order; no gap is longer than the interval between two digests."""
    latest = header.tick
    for number, line in enumerate(lines, 3):
        try:
            entry = _entry(json.loads(line))
        except (ValueError, TypeError, LookupError, RecursionError):
            raise StoreError(f"{path}: line {number} is damaged") from None
        if not latest <= entry.tick <= latest + header.digest_every_tk:
            raise StoreError(
                f"{path}: line {number} is damaged: tick {entry.tick} follows tick {latest}, but"
                f" there must be an entry every {header.digest_every_tk} ticks"
            )
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
