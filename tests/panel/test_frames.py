"""Frames are read with nothing but the table of their fields."""

import json
from collections.abc import Mapping
from pathlib import Path
from struct import calcsize
from typing import Any

import numpy as np

from openacr.mill.run.lifecycle import State
from openacr.panel.control.machine.snapshot import STATES, Snapshot
from openacr.panel.server import openapi
from openacr.panel.wire import described, frames

DOCUMENT = json.loads(json.dumps(openapi.document((), ())))["x-frames"]
PAGE = (Path(__file__).parents[2] / "docs" / "panel.md").read_text(encoding="utf-8")
DTYPES = {"u8": "<u1", "u16": "<u2", "u32": "<u4", "u64": "<u8", "f64": "<f8"}


def read(frame: bytes) -> dict[str, Any]:
    """The fields of a frame by their names."""
    found: dict[str, Any] = {}
    at = take(frame, 0, DOCUMENT["head"], found)
    names = {each["number"]: name for name, each in DOCUMENT["topics"].items()}
    topic = DOCUMENT["topics"][names[found["topic"]]]
    assert take(frame, at, topic["fields"], found) == len(frame)
    return found


def take(frame: bytes, at: int, fields: list[Mapping[str, Any]], found: dict[str, Any]) -> int:
    """Read fields from an offset on and return that of their end."""
    for field in fields:
        if field["kind"] == "text":
            found[field["name"]] = frame[at:].decode()
            return len(frame)
        kind = np.dtype(DTYPES[field["kind"]])
        at = -(-at // kind.itemsize) * kind.itemsize
        assert field["offset"] in (at, None)
        shape = [found[length] if isinstance(length, str) else length for length in field["shape"]]
        values = np.frombuffer(frame, kind, int(np.prod(shape, dtype=int)), at).reshape(shape)
        found[field["name"]] = values.tolist()
        at += values.nbytes
    return at


def test_a_status_is_read_by_its_table() -> None:
    snapshot = Snapshot(
        number=1, tick_ms=1500.5, read_s=10.0, state=State.HOLD, lights=3, homed=1, jogging=2,
        near_limit=4, line=-1, tool=-5, feed_upm=1.5, speed_upm=2.5, spindle_rpm=3.5,
        feed_percent=4.5, rapid_percent=5.5, spindle_percent=6.5, run_s=7.5, left_s=8.5, parts=9.0,
        work=(1.0, 2.0, 3.0), commanded=(4.0, 5.0, 6.0), actual=(7.0, 8.0, 9.0),
        following=(10.0, 11.0, 12.0), to_go=(13.0, 14.0, 15.0), following_end=(16.0, 17.0, 18.0),
    )  # fmt: skip
    frame = frames.status(snapshot, (1 << 32) + 7, 10.25, is_lost=True)
    assert len(frame) == 112 + 6 * 3 * 8
    assert read(frame) == {
        "topic": 1, "version": 1, "count": 3, "seq": 7, "tick_ms": 1500.5, "age_ms": 250.0,
        "state": STATES.index(State.HOLD), "homed": 1, "jogging": 2, "near_limit": 4,
        "lights": 3 + 64, "line": (1 << 32) - 1, "tool": 0, "feed_upm": 1.5, "speed_upm": 2.5,
        "spindle_rpm": 3.5, "feed_percent": 4.5, "rapid_percent": 5.5, "spindle_percent": 6.5,
        "run_s": 7.5, "left_s": 8.5, "parts": 9.0, "work": [1.0, 2.0, 3.0],
        "commanded": [4.0, 5.0, 6.0], "actual": [7.0, 8.0, 9.0], "following": [10.0, 11.0, 12.0],
        "to_go": [13.0, 14.0, 15.0], "following_end": [16.0, 17.0, 18.0],
    }  # fmt: skip
    assert read(frames.status(snapshot, 8, 10.25, is_lost=False))["lights"] == 3


def test_the_other_frames_are_read_by_their_tables() -> None:
    head = {"version": 1, "tick_ms": 2.0, "age_ms": 3.0}
    assert read(frames.flags(4, 2.0, 3.0, [(4096, 1), (4097, -1)])) == head | {
        "topic": 2, "count": 2, "seq": 4, "words": [[4096, 1], [4097, 0xFFFFFFFF]],
    }  # fmt: skip
    for places in ([2, 0, 1], [2, 0]):  # an odd count has a gap before the values
        values = [(place, place + 0.5) for place in places]
        assert read(frames.watch(5, 2.0, 3.0, values)) == head | {
            "topic": 3, "count": len(places), "seq": 5, "places": places,
            "values": [place + 0.5 for place in places],
        }  # fmt: skip
    block = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    assert read(frames.scope(6, 2.0, 3.0, first=9, period_s=0.25, block=block)) == head | {
        "topic": 4, "count": 2, "seq": 6, "first": 9.0, "samples": 3, "period_s": 0.25,
        "values": block.tolist(),
    }  # fmt: skip
    assert read(frames.world(7, 2.0, 3.0, {"name": "µ"})) == head | {
        "topic": 5, "count": 1, "seq": 7, "state": '{"name":"\\u00b5"}',
    }  # fmt: skip


def test_the_page_shows_the_tables() -> None:
    assert described.page() in PAGE


def test_every_single_field_has_its_offset() -> None:
    for topic in DOCUMENT["topics"].values():
        single = [field for field in topic["fields"] if not field["shape"]]
        ends = [field["offset"] + calcsize(frames.KINDS[field["kind"]]) for field in single]
        assert [field["offset"] for field in single] == [24, *ends][: len(single)]
    assert set(DOCUMENT["texts"]) == {"sub", "unsub", "ack"}
