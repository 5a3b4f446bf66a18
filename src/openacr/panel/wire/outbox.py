"""What is on its path to one browser: texts in order, of each picture the newest one only."""

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from openacr.panel.wire.frames import Topic

CREDITS = {Topic.STATUS: 3, Topic.SCOPE: 1, Topic.FLAGS: 2, Topic.WATCH: 2, Topic.WORLD: 2}
MOST_WORDS = 2000  # texts that wait; a browser that reads nothing is closed

Join = Callable[[Any, Any], Any]  # what waits and what follows it: both as one
Build = Callable[[Any], tuple[int, bytes]]  # what has waited: number and frame


class SlowError(Exception):
    """The browser does not read what it gets."""


@dataclass(slots=True)
class _Flow:
    """Frames of one topic to one browser."""

    every_s: float
    due_s: float = 0.0
    seq: int = 0  # of the frame that waits
    pending: bytes | None = None
    waiting: Any = None  # put and not sent yet
    build: Build | None = None
    unread: deque[int] = field(default_factory=deque)  # sent and not acknowledged


class Outbox:
    """Frames and texts for one browser; `take` gives the next one."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
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

    def put(self, topic: Topic, part: Any, join: Join, build: Build) -> None:
        """Send a part of a topic, joined to what waits already: none is left out."""
        flow = self._flows.get(topic)
        if flow is not None:
            flow.waiting = part if flow.build is None else join(flow.waiting, part)
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
            with suppress(TimeoutError):
                async with asyncio.timeout(self._until_due_s()):
                    await self._wake.wait()

    def _until_due_s(self) -> float | None:
        """Time until a part that waits is due; None if none waits."""
        due = [
            flow.due_s - self._clock()
            for topic, flow in self._flows.items()
            if flow.build is not None and len(flow.unread) < CREDITS[topic]
        ]
        return max(0.0, min(due)) if due else None

    def _picture(self) -> bytes | None:
        """A frame whose topic has credit left."""
        now_s = self._clock()
        for topic, flow in self._flows.items():
            if len(flow.unread) >= CREDITS[topic]:
                continue
            if flow.build is not None and now_s >= flow.due_s:
                seq, frame = flow.build(flow.waiting)
                flow.waiting = flow.build = None
                flow.due_s = now_s + flow.every_s
                flow.unread.append(seq)
                return frame
            if flow.pending is not None:
                frame, flow.pending = flow.pending, None
                flow.unread.append(flow.seq)
                return frame
        return None
