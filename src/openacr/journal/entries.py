"""Journal files: what happened at a card, each event with its tick, one record per line.

    openacr journal 1
    {...}                                   where the file comes from
    [tick, "open", stream, kind, name]      a connection begins
    [tick, "bytes", stream, text]           bytes that arrived together, as Latin-1
    [tick, "sent", stream, text]            bytes that the card sent (recorded sessions alone)
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

The first record is that of a virtual card with its state (`controller/journal.py`) or that of a
session with any card (`io/recorded_session.py`). The reader ignores a truncated last line.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Container, Iterable, Iterator
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeAlias, TypeVar

import msgspec
from msgspec import Meta, Struct

from openacr.channels import StreamKind
from openacr.errors import StoreError, reason
from openacr.protocol.events import ControlKey

MAGIC = b"openacr journal 1\n"
T = TypeVar("T")


class Entered(StrEnum):
    """The kind of an entry: an input to the card, what it sent, or a record of its state."""

    OPEN = "open"
    BYTES = "bytes"
    SENT = "sent"
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


class JournalEntry(Struct, frozen=True):
    """One event at a card, `tick` ticks into its life or into the session.

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
        """The bytes that arrived or were sent."""
        return self.text.encode("latin-1")

    @property
    def is_digest(self) -> bool:
        """Whether the entry records the state of the card instead of changing it."""
        return self.what in (Entered.DIGEST, Entered.END)


def record_of(entry: JournalEntry) -> bytes:
    """The line of an entry."""
    if entry.what in (Entered.BYTES, Entered.SENT):  # thousands a second
        return msgspec.json.encode((entry.tick, entry.what, entry.number, entry.text)) + b"\n"
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
_BYTES = tuple[_Tick, Entered, _Number, _Text]
_DIGEST = tuple[_Tick, Entered, str]
_FORMS: dict[Entered, Any] = {
    Entered.OPEN: tuple[_Tick, Entered, _Number, StreamKind, str],
    Entered.BYTES: _BYTES,
    Entered.SENT: _BYTES,
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


def entry_of(record: list[Any]) -> JournalEntry:
    """The entry of a record; ValueError, TypeError or LookupError if it is not one."""
    form = _FORMS.get(Entered(record[1]), _VALUE)
    tick, what, *rest = msgspec.convert(record, form)
    if what in (Entered.DIGEST, Entered.END):
        return JournalEntry(tick, what, text=rest[0])
    if what is Entered.OPEN:
        return JournalEntry(tick, what, rest[0], rest[1].value, name=rest[2])
    if what in (Entered.BYTES, Entered.SENT):
        return JournalEntry(tick, what, rest[0], rest[1])
    if what in (Entered.FAULT, Entered.COMMAND):
        return JournalEntry(tick, what, rest[0], value=rest[2], name=rest[1])
    if what is Entered.MEND:
        return JournalEntry(tick, what, rest[0], name=rest[1])
    value = rest[1] if len(rest) > 1 else 0.0
    return JournalEntry(tick, what, int(rest[0]), value=value)


# files


class Lines(NamedTuple):
    """The lines of a journal file: its first record, the others, and what of a last one is cut."""

    head: bytes
    records: list[bytes]
    rest: bytes


def read_content(path: Path) -> bytes:
    """The bytes of a file; StoreError if it cannot be read."""
    try:
        return path.read_bytes()
    except OSError as failure:
        raise StoreError(f"{path} cannot be read: {reason(failure)}") from None


def split_lines(path: Path, content: bytes) -> Lines:
    """The lines of a journal file; StoreError if it is something else."""
    if not content.startswith(MAGIC):
        raise StoreError(f"{path} is not a journal (or of another version)")
    head, *records = content[len(MAGIC) :].split(b"\n")
    if not records:
        raise StoreError(f"{path} ends within its first record: nothing can be replayed")
    return Lines(head, records[:-1], records[-1])


def read_head(path: Path, head: bytes, form: type[T]) -> T:
    """The first record of a journal file, in the form of its origin."""
    try:
        return msgspec.json.decode(head, type=form)
    except (ValueError, RecursionError) as error:  # MsgspecError, UnicodeDecodeError
        raise StoreError(f"{path}: its first record cannot be read: {error}") from None


def read_entries(
    path: Path,
    records: Iterable[bytes],
    known: Container[Entered],
    *,
    first_line: int = 3,
    decode: Callable[[bytes], list[Any]] = json.loads,
) -> Iterator[tuple[int, JournalEntry]]:
    """Yield the entries of records, each with its line in the file; StoreError for a damaged one.

    `known` are the kinds of entries that files of this origin hold.
    """
    for number, record in enumerate(records, first_line):
        try:
            entry = entry_of(decode(record))
        except (ValueError, TypeError, LookupError, OverflowError, RecursionError):
            raise damaged(path, number) from None
        if entry.what not in known:
            raise damaged(path, number)
        yield number, entry


def damaged(path: Path, line: int, why: str = "") -> StoreError:
    """The error of a line that no journal can hold."""
    return StoreError(f"{path}: line {line} is damaged" + (f": {why}" if why else ""))
