"""Binary frames: a head of 24 bytes, then typed arrays whose 8-byte values lie on 8-byte offsets.

HEAD_FIELDS and FIELDS name every field in the order of its bytes, little-endian; the fields
without a shape are packed by these rows, and docs/panel.md and the OpenAPI document show them.
"""

import json
from collections.abc import Sequence
from enum import IntEnum
from struct import Struct
from typing import Any, NamedTuple

import numpy as np

from openacr.panel.control.engineer.scope import Block
from openacr.panel.control.machine.snapshot import STATES, Light, Snapshot

VERSION = 1
WRAP = 1 << 32
# What `Field.kind` can be, as the letters of `struct`; text is the rest of a frame, in UTF-8.
KINDS = {"u8": "B", "u16": "H", "u32": "I", "u64": "Q", "f64": "d", "text": "s"}


class Topic(IntEnum):
    """What a frame is about; the number is its first byte."""

    STATUS = 1
    FLAGS = 2
    WATCH = 3
    SCOPE = 4
    WORLD = 5


class Field(NamedTuple):
    """One field of a frame; `shape` has a number or the name of a field for each dimension."""

    name: str
    kind: str
    what: str
    shape: tuple[str | int, ...] = ()


HEAD_FIELDS = (
    Field("topic", "u8", ", ".join(f"{topic.value} {topic.name.lower()}" for topic in Topic)),
    Field("version", "u8", f"of the frames: {VERSION}"),
    Field("count", "u16", "axes, words, values or channels"),
    Field("seq", "u32", "sequence number of the topic, for `ack`"),
    Field("tick_ms", "f64", "card time when the values were read [ms]"),
    Field("age_ms", "f64", "age of the values when the frame was sent [ms]"),
)
_AXES = ("count",)
FIELDS = {
    Topic.STATUS: (
        Field("state", "u8", ", ".join(f"{n} {state.name}" for n, state in enumerate(STATES))),
        Field("homed", "u8", "a bit for each axis: it is homed"),
        Field("jogging", "u8", "a bit for each axis: it moves"),
        Field("near_limit", "u8", "a bit for each axis: it is near an end of its travel"),
        Field("lights", "u32", ", ".join(f"{light.value} {light.name}" for light in Light)),
        Field("line", "u32", "line of the part program"),
        Field("tool", "u32", "number of the tool"),
        Field("feed_upm", "f64", "programmed feed [units/min]"),
        Field("speed_upm", "f64", "actual feed [units/min]"),
        Field("spindle_rpm", "f64", "spindle [rev/min]"),
        Field("feed_percent", "f64", "feed override [%]"),
        Field("rapid_percent", "f64", "rapid override [%]"),
        Field("spindle_percent", "f64", "spindle override [%]"),
        Field("run_s", "f64", "time of this run [s]"),
        Field("left_s", "f64", "predicted time that is left [s]; NaN: not known"),
        Field("parts", "f64", "parts made"),
        Field("work", "f64", "work position [units]", _AXES),
        Field("commanded", "f64", "commanded machine position [units]", _AXES),
        Field("actual", "f64", "actual machine position [units]", _AXES),
        Field("following", "f64", "following error [units]", _AXES),
        Field("to_go", "f64", "distance to go [units]", _AXES),
        Field("following_end", "f64", "end of the next move, program coordinates [units]", _AXES),
    ),
    Topic.FLAGS: (
        Field("words", "u32", "number of the parameter, its 32 flags; pair by pair", ("count", 2)),
    ),
    Topic.WATCH: (
        Field("places", "u32", "places in the list of `sub`; those that changed", ("count",)),
        Field("values", "f64", "their values", ("count",)),
    ),
    Topic.SCOPE: (
        Field("first", "f64", "number of the first sample"),
        Field("samples", "u64", "samples of each channel"),
        Field("period_s", "f64", "time between two samples [s]"),
        Field("values", "f64", "samples, channel by channel", ("count", "samples")),
    ),
    Topic.WORLD: (Field("state", "text", "the world around the card as JSON", ("rest",)),),
}


def _single(fields: Sequence[Field]) -> Struct:
    """The fields without a shape, packed one after the other."""
    return Struct("<" + "".join(KINDS[field.kind] for field in fields if not field.shape))


HEAD = _single(HEAD_FIELDS)
_SINGLE = {topic: _single(fields) for topic, fields in FIELDS.items()}


def head(topic: Topic, count: int, seq: int, tick_ms: float, age_ms: float) -> bytes:
    """The first 24 bytes of a frame."""
    return HEAD.pack(topic, VERSION, count, seq % WRAP, tick_ms, age_ms)


def status(snapshot: Snapshot, seq: int, now_s: float, *, is_lost: bool) -> bytes:
    """A frame of the status: lamps, numbers and six arrays of the axes."""
    packed = {
        "state": STATES.index(snapshot.state),
        "lights": snapshot.lights | (Light.LINK_LOST if is_lost else 0),
        "line": snapshot.line % WRAP,
        "tool": max(0, snapshot.tool) % WRAP,
    }
    single: list[float] = []
    columns: list[bytes] = []
    for field in FIELDS[Topic.STATUS]:
        value = packed.get(field.name, getattr(snapshot, field.name))
        if field.shape:
            columns.append(_doubles(value))
        else:
            single.append(value)
    first = head(
        Topic.STATUS,
        len(snapshot.commanded),
        seq,
        snapshot.tick_ms,
        1000.0 * (now_s - snapshot.read_s),
    )
    return b"".join((first, _SINGLE[Topic.STATUS].pack(*single), *columns))


def _doubles(values: Sequence[float]) -> bytes:
    return Struct(f"<{len(values)}d").pack(*values)


def flags(seq: int, tick_ms: float, age_ms: float, words: Sequence[tuple[int, int]]) -> bytes:
    """A frame of flag words: the number of the parameter and its 32 bits, pair by pair."""
    numbers = [part % WRAP for pair in words for part in pair]
    body = Struct(f"<{len(numbers)}I").pack(*numbers)
    return head(Topic.FLAGS, len(words), seq, tick_ms, age_ms) + body


def watch(seq: int, tick_ms: float, age_ms: float, values: Sequence[tuple[int, float]]) -> bytes:
    """A frame of watched parameters: their places in the list of the browser, then values."""
    places = Struct(f"<{len(values)}I").pack(*(place for place, _ in values))
    padding = b"\0" * (-len(places) % 8)
    numbers = _doubles([value for _, value in values])
    return head(Topic.WATCH, len(values), seq, tick_ms, age_ms) + places + padding + numbers


def scope(
    seq: int,
    tick_ms: float,
    age_ms: float,
    *,
    first: int,
    period_s: float,
    block: Block,
) -> bytes:
    """A frame of scope samples, channel by channel, from sample `first` on."""
    channels, count = block.shape
    body = _SINGLE[Topic.SCOPE].pack(first, count, period_s)
    data = np.ascontiguousarray(block, "<f8").tobytes()
    return head(Topic.SCOPE, channels, seq, tick_ms, age_ms) + body + data


def world(seq: int, tick_ms: float, age_ms: float, state: dict[str, Any]) -> bytes:
    """A frame of the world around the card: its state as JSON."""
    text = json.dumps(state, separators=(",", ":")).encode()
    return head(Topic.WORLD, 1, seq, tick_ms, age_ms) + text
