"""Recordings of what hosts and a card send each other: a file of JSON, one event a line.

The first line is the header; each other line has the time since the beginning [s], the number of
the connection, and what happened: bytes of the host, bytes of the card, a connection opened or
closed. Bytes are characters 0 to 255 of the same code, so that lines of a terminal can be read.
"""

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Protocol

from openacr.channels import StreamKind
from openacr.errors import SourceError, read_bytes

FORMAT = "openacr recording"
VERSION = 1
KINDS = {kind.value: kind for kind in StreamKind}
LONGEST_S = 1e7


class What(StrEnum):
    """The kinds of events."""

    OPEN = "open"
    HOST = "host"
    CARD = "card"
    CLOSE = "close"


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened on one connection."""

    time_s: float
    connection: int
    what: What
    data: bytes = b""


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording that was read; `is_whole` is false where its last line is cut off."""

    target: str
    kind: StreamKind
    events: tuple[Event, ...]
    is_whole: bool = True


class Output(Protocol):
    """What a recording is written to: a file without a buffer."""

    def write(self, data: bytes, /) -> int:
        """Write; how many bytes were taken."""

    def truncate(self, size: int, /) -> int:
        """Leave out what comes after this size."""


class Recorder:
    """Writes events as they happen; each is in the file, whole, before the next one.

    `failure` is why the file could not be written any more. It ends with the last whole event.
    `when_begun` is called once, after the first bytes of a host or the card are in the file.
    """

    def __init__(
        self,
        file: Output,
        target: str,
        kind: StreamKind,
        when_begun: Callable[[], None] | None = None,
    ) -> None:
        self.failure: OSError | None = None
        self._file = file
        self._when_begun = when_begun
        self._size_bytes = 0
        self._put({"format": FORMAT, "version": VERSION, "card": target, "kind": kind.value})

    def add(self, event: Event) -> None:
        """Write one event; OSError where the file cannot be written."""
        record: dict[str, object] = {
            "t": round(event.time_s, 6),
            "c": event.connection,
            "what": event.what.value,
        }
        if event.data:
            record["data"] = event.data.decode("latin-1")
        self._put(record)
        if event.data and self._when_begun is not None:
            begun, self._when_begun = self._when_begun, None
            try:
                begun()
            except OSError as failure:
                self.failure = failure
                raise

    def _put(self, record: dict[str, object]) -> None:
        line = rest = json.dumps(record).encode() + b"\n"
        try:
            while rest:  # a disk that gets full takes a part
                rest = rest[self._file.write(rest) :]
        except OSError as failure:
            self.failure = failure
            with suppress(OSError):
                self._file.truncate(self._size_bytes)
            raise
        self._size_bytes += len(line)


def is_recording(path: Path) -> bool:
    """Whether the file begins as a recording does."""
    with path.open("rb") as file:
        return file.read(len(_START)) == _START


_START = json.dumps({"format": FORMAT}).encode()[:-1]


def read_recording(path: Path) -> Recording:
    """Read a recording; SourceError with the line that is wrong. A cut last line is left out."""
    lines = read_bytes(path).split(b"\n")
    last = lines.pop()  # empty where the last event is whole
    if not lines:
        raise SourceError("not a recording of a session with a card", path=str(path), line=1)
    header = _object(lines[0], str(path), 1)
    if header.get("format") != FORMAT or header.get("version") != VERSION:
        raise SourceError(
            f"not a recording of version {VERSION}", path=str(path), line=1,
            hint="`openacr record` writes them",
        )  # fmt: skip
    events = tuple(_in_order(_events(lines[1:], str(path)), str(path)))
    kind = KINDS.get(str(header.get("kind")), StreamKind.TERMINAL)
    return Recording(str(header.get("card", "")), kind, events, not last)


def _events(lines: Iterable[bytes], path: str) -> Iterator[Event]:
    for number, line in enumerate(lines, 2):
        record = _object(line, path, number)
        try:
            yield Event(
                float(record["t"]), int(record["c"]), What(record["what"]),
                str(record.get("data", "")).encode("latin-1"),
            )  # fmt: skip
        except (KeyError, ValueError, TypeError, OverflowError):
            raise SourceError("not an event of a recording", path=path, line=number) from None


def _in_order(events: Iterator[Event], path: str) -> Iterator[Event]:
    """Refuse times that go back, and what happens on a connection that is not open."""
    before_s, opened = 0.0, set[int]()
    for number, event in enumerate(events, 2):
        if not before_s <= event.time_s <= LONGEST_S:
            raise SourceError("the time is not that of a next event", path=path, line=number)
        if (event.what is What.OPEN) is (event.connection in opened):
            what = "opened twice" if event.what is What.OPEN else "not open"
            raise SourceError(f"connection {event.connection} is {what}", path=path, line=number)
        (opened.discard if event.what is What.CLOSE else opened.add)(event.connection)
        before_s = event.time_s
        yield event


def _object(line: bytes, path: str, number: int) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except ValueError:
        found = None
    if not isinstance(found, dict):
        raise SourceError("not a line of a recording", path=path, line=number)
    return found
