"""What is on its way to one browser: words in order, and of each picture the newest one only."""

import asyncio
import json
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from openacr.panel.wire.frames import Topic

CREDITS = {Topic.STATUS: 3, Topic.SCOPE: 1, Topic.FLAGS: 2, Topic.WATCH: 2}
MOST_WORDS = 2000  # texts that wait; a browser that reads nothing is closed

Build = Callable[[dict[int, float]], tuple[int, bytes]]  # changes by place: number and frame


class SlowError(Exception):
    """The browser does not read what it gets."""


@dataclass(slots=True)
class _Flow:
    """Frames of one topic to one browser."""

    every_s: float
    due_s: float = 0.0
    seq: int = 0  # of the frame that waits
    pending: bytes | None = None
    changes: dict[int, float] = field(default_factory=dict)  # not sent yet, by place
    build: Build | None = None
    unread: deque[int] = field(default_factory=deque)  # sent and not acknowledged


class Outbox:
    """Frames and texts for one browser; `take` gives the next one."""

    def __init__(self) -> None:
        self._words: deque[str] = deque()
        self._flows: dict[Topic, _Flow] = {}
        self._wake = asyncio.Event()

    # --- texts ------------------------------------------------------------------------

    def say(self, data: dict[str, Any]) -> None:
        """Queue a text; SlowError if too many wait."""
        if len(self._words) >= MOST_WORDS:
            raise SlowError
        self._words.append(json.dumps(data, separators=(",", ":"), default=str))
        self._wake.set()

    # --- pictures ---------------------------------------------------------------------

    def subscribe(self, topic: Topic, hz: float) -> None:
        """Send a topic from now on, at most so often."""
        self._flows[topic] = _Flow(1.0 / hz)

    def unsubscribe(self, topic: Topic) -> None:
        """Send a topic no more."""
        self._flows.pop(topic, None)

    def wants(self, topic: Topic) -> bool:
        """Whether the browser has subscribed a topic."""
        return topic in self._flows

    def offer(self, topic: Topic, seq: int, frame: bytes, now_s: float) -> None:
        """Put the newest frame of a topic in place of an older one that waits."""
        flow = self._flows.get(topic)
        if flow is None or now_s < flow.due_s - 0.2 * flow.every_s:
            return
        flow.pending, flow.seq = frame, seq
        flow.due_s = max(flow.due_s + flow.every_s, now_s)
        self._wake.set()

    def put(self, topic: Topic, changes: dict[int, float], build: Build) -> None:
        """Send changed values; those that wait already are replaced, none is left out."""
        flow = self._flows.get(topic)
        if flow is not None:
            flow.changes.update(changes)
            flow.build = build
            self._wake.set()

    def acknowledge(self, topic: Topic, seq: int) -> None:
        """Note that the browser has drawn all frames up to this one."""
        flow = self._flows.get(topic)
        while flow is not None and flow.unread and flow.unread[0] <= seq:
            flow.unread.popleft()
        self._wake.set()

    # --- sending ----------------------------------------------------------------------

    async def take(self) -> str | bytes:
        """The next text or frame, as soon as there is one."""
        while True:
            if self._words:
                return self._words.popleft()
            frame = self._picture()
            if frame is not None:
                return frame
            self._wake.clear()
            await self._wake.wait()

    def _picture(self) -> bytes | None:
        """A frame whose topic has credit left."""
        for topic, flow in self._flows.items():
            if len(flow.unread) >= CREDITS[topic]:
                continue
            if flow.build is not None:
                seq, frame = flow.build(flow.changes)
                flow.changes, flow.build = {}, None
                flow.unread.append(seq)
                return frame
            if flow.pending is not None:
                frame, flow.pending = flow.pending, None
                flow.unread.append(flow.seq)
                return frame
        return None
