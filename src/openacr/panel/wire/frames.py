"""Binary frames: a head of 24 bytes, then typed arrays whose 8-byte values lie on 8-byte offsets.

| offset | type | what |
|---|---|---|
| 0 | u8 | topic |
| 1 | u8 | version |
| 2 | u16 | count of axes, words, values or channels |
| 4 | u32 | sequence number of the topic |
| 8 | f64 | card time in ms when the values were read |
| 16 | f64 | age of the values when the frame was sent, ms |
"""

import json
from collections.abc import Sequence
from enum import IntEnum
from struct import Struct
from typing import Any

import numpy as np

from openacr.panel.control.scope import Block
from openacr.panel.control.snapshot import STATES, Snapshot

VERSION = 1
HEAD = Struct("<BBHIdd")
_LAMPS = Struct("<BBBBIII")
_NUMBERS = Struct("<9d")
WRAP = 1 << 32


class Topic(IntEnum):
    """What a frame is about; the number is its first byte."""

    STATUS = 1
    FLAGS = 2
    WATCH = 3
    SCOPE = 4
    WORLD = 5


def head(topic: Topic, count: int, seq: int, tick_ms: float, age_ms: float) -> bytes:
    """The first 24 bytes of a frame."""
    return HEAD.pack(topic, VERSION, count, seq % WRAP, tick_ms, age_ms)


def status(snapshot: Snapshot, seq: int, now_s: float, *, is_lost: bool) -> bytes:
    """A frame of the status: lamps, numbers and six arrays of the axes."""
    axes = len(snapshot.commanded)
    lights = snapshot.lights | (64 if is_lost else 0)
    lamps = _LAMPS.pack(
        STATES.index(snapshot.state),
        snapshot.homed,
        snapshot.jogging,
        snapshot.near_limit,
        lights,
        snapshot.line % WRAP,
        max(0, snapshot.tool) % WRAP,
    )
    numbers = _NUMBERS.pack(
        snapshot.feed_upm,
        snapshot.speed_upm,
        snapshot.spindle_rpm,
        snapshot.feed_percent,
        snapshot.rapid_percent,
        snapshot.spindle_percent,
        snapshot.run_s,
        snapshot.left_s,
        snapshot.parts,
    )
    columns = (
        snapshot.work, snapshot.commanded, snapshot.actual,
        snapshot.following, snapshot.to_go, snapshot.following_end,
    )  # fmt: skip
    age_ms = 1000.0 * (now_s - snapshot.read_s)
    return b"".join(
        (
            head(Topic.STATUS, axes, seq, snapshot.tick_ms, age_ms),
            lamps,
            numbers,
            *(_doubles(column) for column in columns),
        )
    )


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
    body = Struct("<dQd").pack(first, count, period_s)
    data = np.ascontiguousarray(block, "<f8").tobytes()
    return head(Topic.SCOPE, channels, seq, tick_ms, age_ms) + body + data


def world(seq: int, tick_ms: float, age_ms: float, state: dict[str, Any]) -> bytes:
    """A frame of the world around the card: its state as JSON."""
    text = json.dumps(state, separators=(",", ":")).encode()
    return head(Topic.WORLD, 1, seq, tick_ms, age_ms) + text
