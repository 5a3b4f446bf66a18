"""Recorded sessions: what hosts and a card send each other, as a journal with both voices.

The ticks of the journal are microseconds from the beginning; its first record names the card:

    {"card": "192.168.10.40:5002", "program": ..., "ticks_per_s": 1000000}

Entries are those of connections: `open`, `bytes` of the host, `sent` by the card, `close`. Files of
the earlier form are read, too: JSON objects with times in seconds.
"""

import json
import logging
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from openacr.channels import StreamKind
from openacr.errors import reason
from openacr.journal.entries import (
    MAGIC,
    Entered,
    JournalEntry,
    damaged,
    read_content,
    read_entries,
    read_head,
    record_of,
    split_lines,
)
from openacr.journal.records import Output, Records

log = logging.getLogger(__name__)

TICKS_PER_S = 1_000_000
LONGEST_S = 10_000_000
_KNOWN = {Entered.OPEN, Entered.BYTES, Entered.SENT, Entered.CLOSE}


class SessionHeader(msgspec.Struct, frozen=True):
    """The first record: which card it was, and the unit of time."""

    card: str
    program: str
    ticks_per_s: Annotated[int, Meta(ge=1, le=1_000_000_000)]


@dataclass(frozen=True, slots=True)
class Recording:
    """A recorded session that was read; `is_whole` is false where its last line is cut off."""

    header: SessionHeader
    entries: tuple[JournalEntry, ...]
    is_whole: bool = True

    def time_s(self, entry: JournalEntry) -> float:
        """When an entry happened, from the beginning of the session [s]."""
        return entry.tick / self.header.ticks_per_s


class SessionRecorder:
    """Writes what happens on connections; each event is in the file, whole, before the next one.

    Any thread may note events. If the file cannot be written any more, it ends with the last
    whole event (`failure` is why), and the session continues. `when_begun` is called once, after
    the first bytes of a host or the card are in the file.
    """

    def __init__(
        self,
        file: Output,
        card: str,
        kind: StreamKind,
        when_begun: Callable[[], None] | None = None,
    ) -> None:
        """Begin the file of a session of connections of a kind; OSError if that is impossible."""
        self.failure: OSError | None = None
        self.events = 0
        self._kind = kind
        self._when_begun = when_begun
        self._lock = threading.Lock()
        self._begin_s = time.monotonic()
        header = SessionHeader(card, version("openacr"), TICKS_PER_S)
        self._records = Records(file, self._end, msgspec.json.encode(header) + b"\n")

    def note(self, connection: int, what: Entered, data: bytes = b"") -> None:
        """Record what happens now on a connection: `open`, `bytes`, `sent` or `close`."""
        text = self._kind.value if what is Entered.OPEN else data.decode("latin-1")
        with self._lock:
            if self.failure is None:
                tick = round((time.monotonic() - self._begin_s) * TICKS_PER_S)
                self._put(JournalEntry(tick, what, connection, text), is_talk=bool(data))

    def _put(self, entry: JournalEntry, *, is_talk: bool) -> None:
        self._records.put(record_of(entry))
        self._records.flush()
        if self.failure is not None:
            return
        self.events += 1
        if is_talk and self._when_begun is not None:
            begun, self._when_begun = self._when_begun, None
            try:
                begun()
            except OSError as failure:
                self._end(failure)

    def _end(self, failure: OSError) -> None:
        self.failure = failure
        rest = "the line goes on" if self._kind is StreamKind.SERIAL else "connections go on"
        log.error("the recording ends here: %s; %s", reason(failure).lower(), rest)


def is_recording(path: Path) -> bool:
    """Whether the file begins as a recorded session does, not as the journal of a virtual card."""
    return _begins(path, _START) or _begins(path, _OLD_START)


def _begins(path: Path, start: bytes) -> bool:
    with path.open("rb") as file:
        return file.read(len(start)) == start


_START = MAGIC + b'{"card":'


def read_recording(path: Path) -> Recording:
    """Read a recorded session; StoreError with the line that is wrong, without a cut last line."""
    content = read_content(path)
    if content.startswith(_OLD_START):
        return _read_old(path, content)
    lines = split_lines(path, content)
    header = read_head(path, lines.head, SessionHeader)
    entries = read_entries(path, lines.records, _KNOWN)
    return Recording(header, tuple(_in_order(path, entries, header)), not lines.rest)


def _in_order(
    path: Path, entries: Iterable[tuple[int, JournalEntry]], header: SessionHeader
) -> Iterator[JournalEntry]:
    """Refuse times that go back, and what happens on a connection that is not open."""
    latest, opened = 0, set[int]()
    for line, entry in entries:
        if not latest <= entry.tick <= LONGEST_S * header.ticks_per_s:
            raise damaged(path, line, "the time is not that of a next event")
        if (entry.what is Entered.OPEN) is (entry.number in opened):
            what = "opened twice" if entry.what is Entered.OPEN else "not open"
            raise damaged(path, line, f"connection {entry.number} is {what}")
        (opened.discard if entry.what is Entered.CLOSE else opened.add)(entry.number)
        latest = entry.tick
        yield entry


# files of the earlier form

_OLD_START = b'{"format": "openacr recording"'
_OLD_KINDS = {"open": "open", "host": "bytes", "card": "sent", "close": "close"}


class _OldHeader(msgspec.Struct, frozen=True):
    """The first line: `{"format": "openacr recording", "version": 1, "card": ..., "kind": ...}`."""

    version: Literal[1]
    card: str = ""
    kind: StreamKind = StreamKind.TERMINAL


def _read_old(path: Path, content: bytes) -> Recording:
    first, *records = content.split(b"\n")
    old = read_head(path, first, _OldHeader)
    rest = records.pop() if records else first
    header = SessionHeader(old.card, "", TICKS_PER_S)

    def record(line: bytes) -> list[Any]:
        """The record of `{"t": seconds, "c": connection, "what": ..., "data": ...}`."""
        event = json.loads(line)
        what = _OLD_KINDS[event["what"]]
        head = [round(float(event["t"]) * TICKS_PER_S), what, int(event["c"])]
        if what == "open":
            return [*head, old.kind.value, ""]
        return head if what == "close" else [*head, event.get("data", "")]

    entries = read_entries(path, records, _KNOWN, first_line=2, decode=record)
    return Recording(header, tuple(_in_order(path, entries, header)), not rest)
