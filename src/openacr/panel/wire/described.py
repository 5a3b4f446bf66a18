"""What travels on the WebSocket beside commands, as tables of docs/panel.md and as JSON."""

from collections.abc import Iterable, Iterator
from struct import calcsize
from typing import Any

from openacr.panel.wire.frames import FIELDS, HEAD, HEAD_FIELDS, KINDS, Field, Topic
from openacr.panel.wire.outbox import CREDITS

MOST_HZ = 60.0  # frames of a topic
LEAST_HZ = 0.1
TOPICS = ", ".join(f"`{topic.name.lower()}`" for topic in Topic)
_ALL = f"{TOPICS}, `programs` (events)"
# Texts of a browser: message, member, whether it must be there, what it is.
MESSAGES = (
    ("sub", "topic", True, f"{_ALL}; the answer has the same id"),
    ("sub", "hz", False, f"most frames a second: {LEAST_HZ:g} to {MOST_HZ:g}; without it 25,"
     " of `programs` 10"),
    ("sub", "parameters", False, "`watch`: numbers or expressions of parameters and variables"),
    ("sub", "words", False, "`flags`: numbers of the parameters that are flag words"),
    ("sub", "inputs", False, "`flags`: true adds the words of the inputs and outputs"),
    ("unsub", "topic", True, "the topic that ends"),
    ("ack", "ack", True, f"topic of the frame: {TOPICS}"),
    ("ack", "seq", True, "its sequence number; it acknowledges the earlier ones, too"),
)  # fmt: skip


def offsets(fields: Iterable[Field], start: int) -> Iterator[tuple[int | None, Field]]:
    """Each field with its offset [bytes]; None after an array, whose length the frame tells."""
    at: int | None = start
    for field in fields:
        yield at, field
        at = None if at is None or field.shape else at + calcsize(KINDS[field.kind])


def document() -> dict[str, Any]:
    """The fields of every frame, and the texts that order and acknowledge frames."""
    texts: dict[str, dict[str, Any]] = {}
    for text, member, is_needed, what in MESSAGES:
        texts.setdefault(text, {})[member] = {"needed": is_needed, "what": what}
    return {
        "head": _rows(HEAD_FIELDS, 0),
        "topics": {
            topic.name.lower(): {
                "number": topic.value,
                "unacknowledged": CREDITS[topic],
                "fields": _rows(fields, HEAD.size),
            }
            for topic, fields in FIELDS.items()
        },
        "texts": texts,
    }


def _rows(fields: Iterable[Field], start: int) -> list[dict[str, Any]]:
    return [{"offset": at, **field._asdict()} for at, field in offsets(fields, start)]


def page() -> str:
    """The tables of docs/panel.md."""
    parts = ["Head of every frame:\n\n" + _table(HEAD_FIELDS, 0)]
    parts += [
        f"`{topic.name.lower()}`, up to {CREDITS[topic]} until one is acknowledged:\n\n"
        + _table(fields, HEAD.size)
        for topic, fields in FIELDS.items()
    ]
    rows = "".join(
        f"| `{text}` | `{member}` | {'yes' if is_needed else 'no'} | {what} |\n"
        for text, member, is_needed, what in MESSAGES
    )
    parts.append(
        f"Texts of a browser:\n\n| text | member | needed | what |\n|---|---|---|---|\n{rows}"
    )
    return "\n".join(parts)


def _table(fields: Iterable[Field], start: int) -> str:
    rows = "".join(
        f"| {'next' if at is None else at} | `{field.name}` | {_kind(field)} | {field.what} |\n"
        for at, field in offsets(fields, start)
    )
    return f"| offset | field | type | what |\n|---|---|---|---|\n{rows}"


def _kind(field: Field) -> str:
    return field.kind + "".join(f"[{length}]" for length in field.shape)
