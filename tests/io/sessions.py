"""Recorded sessions that tests write entry by entry."""

from pathlib import Path

from openacr.channels import StreamKind
from openacr.journal.entries import Entered, JournalEntry, record_of

HEAD = b'openacr journal 1\n{"card":"c:5002","program":"0","ticks_per_s":1000000}\n'


def event(
    time_s: float,
    connection: int,
    what: Entered,
    data: bytes = b"",
    *,
    kind: StreamKind = StreamKind.TERMINAL,
) -> JournalEntry:
    """What happened on a connection, which is of a kind when it is opened."""
    text = kind.value if what is Entered.OPEN else data.decode("latin-1")
    return JournalEntry(round(time_s * 1e6), what, connection, text)


def written(path: Path, *entries: JournalEntry) -> Path:
    """The file of a session."""
    path.write_bytes(HEAD + b"".join(map(record_of, entries)))
    return path
