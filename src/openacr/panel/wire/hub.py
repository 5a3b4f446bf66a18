"""All browsers of a panel: each frame is built once and offered to each one that wants it."""

import asyncio
import time
from collections.abc import Callable
from operator import or_
from typing import Any

from openacr.panel.control.engineer.scope import Samples, joined
from openacr.panel.control.engineer.watches import Changed, Wish
from openacr.panel.control.station import Station
from openacr.panel.wire import frames
from openacr.panel.wire.frames import Topic
from openacr.panel.wire.outbox import Outbox, SlowError

BEAT_S = 0.1  # longest time between two frames of the status, whatever the machine does


class Browser:
    """One connected browser; `drop` ends its connection."""

    def __init__(self, client: int, drop: Callable[[int, str], None]) -> None:
        self.client = client
        self.outbox = Outbox()
        self._drop = drop

    def say(self, event: dict[str, Any]) -> None:
        """Send a text; a browser that reads nothing is dropped."""
        try:
            self.outbox.say(event)
        except SlowError:
            self._drop(4408, "this browser does not read what it is sent")


class Hub:
    """Tells browsers what the station says and shows; lives in the asyncio thread."""

    def __init__(self, station: Station, clock: Callable[[], float] = time.monotonic) -> None:
        self._station = station
        self._clock = clock
        self._browsers: dict[int, Browser] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        self._seq: dict[Topic, int] = dict.fromkeys(Topic, 0)
        self._shown_s = 0.0
        station.screens.send = self._tell
        station.on_snapshot = self._looked
        station.watches.report = self._report
        station.on_samples = self._sampled
        station.world.watchers.report = self._report_world

    def attach(self) -> None:
        """Take over the running loop: from now on events reach the browsers."""
        self._loop = asyncio.get_running_loop()

    def join(self, browser: Browser) -> None:
        """Add a browser."""
        self._browsers[browser.client] = browser

    def leave(self, client: int) -> None:
        """Remove a browser."""
        self._browsers.pop(client, None)

    @property
    def count(self) -> int:
        """How many browsers are connected."""
        return len(self._browsers)

    # --- from the control thread ------------------------------------------------------

    def _tell(self, event: dict[str, Any]) -> None:
        self._soon(self._broadcast, event)

    def _looked(self) -> None:
        self._soon(self.show)

    def _sampled(self, to: int | None, taken: Samples) -> None:
        self._soon(self._show_samples, to, taken)

    def _report(self, wish: Wish, parameters: list[int], changed: Changed) -> None:
        self._soon(self._show_values, wish, parameters, changed)

    def _report_world(self, client: int, state: dict[str, Any]) -> None:
        self._soon(self._show_world, client, state)

    def _soon(self, do: Callable[..., None], *args: object) -> None:
        loop = self._loop
        if loop is None:
            return
        try:
            loop.call_soon_threadsafe(do, *args)
        except RuntimeError:
            self._loop = None  # the loop has ended

    # --- in the loop ------------------------------------------------------------------

    def _broadcast(self, event: dict[str, Any]) -> None:
        to = event.pop("to", None)
        if to is not None:
            if (browser := self._browsers.get(to)) is not None:
                browser.say(event)
            return
        holder = event.get("holder") or {}
        for browser in list(self._browsers.values()):
            is_control = event["event"] == "control"
            mine = {"you": holder.get("client") == browser.client} if is_control else {}
            browser.say({**event, **mine} if mine else event)

    def broadcast(self, event: dict[str, Any]) -> None:
        """Send a text to every browser."""
        self._broadcast(event)

    def show(self) -> None:
        """Offer the newest status to every browser that wants it."""
        now_s = self._shown_s = self._clock()
        wanted = [b for b in self._browsers.values() if b.outbox.wants(Topic.STATUS)]
        if not wanted:
            return
        seq = self.next(Topic.STATUS)
        is_lost = self._station.link.session is None and not self._station.link.is_away
        frame = frames.status(self._station.snapshot, seq, now_s, is_lost=is_lost)
        for browser in wanted:
            browser.outbox.offer(Topic.STATUS, seq, frame, now_s)

    def _show_samples(self, to: int | None, taken: Samples) -> None:
        """Send the new samples of a capture to its browser, or to all; none is left out."""
        snapshot = self._station.snapshot

        def build(samples: Samples) -> tuple[int, bytes]:
            first, block, period_s = samples
            seq, age_ms = self.next(Topic.SCOPE), 1000.0 * (self._clock() - snapshot.read_s)
            return seq, frames.scope(
                seq, snapshot.tick_ms, age_ms, first=first, period_s=period_s, block=block
            )

        for client, browser in self._browsers.items():
            if to is None or to == client:
                browser.outbox.put(Topic.SCOPE, taken, joined, build)

    def _show_values(self, wish: Wish, parameters: list[int], changed: Changed) -> None:
        """Send watched values to the browser that watches them; none is left out."""
        browser = self._browsers.get(wish.client)
        if browser is None:
            return
        topic = Topic.FLAGS if wish.topic == "flags" else Topic.WATCH

        def build(changes: dict[int, float]) -> tuple[int, bytes]:
            seq, snapshot = self.next(topic), self._station.snapshot
            age_ms = 1000.0 * (self._clock() - snapshot.read_s)
            if topic is Topic.WATCH:
                return seq, frames.watch(seq, snapshot.tick_ms, age_ms, list(changes.items()))
            words = [(parameters[place], int(value)) for place, value in changes.items()]
            return seq, frames.flags(seq, snapshot.tick_ms, age_ms, words)

        browser.outbox.put(topic, dict(changed), or_, build)

    def _show_world(self, client: int, state: dict[str, Any]) -> None:
        """Send the state of the world to a browser that watches it: the newest one."""
        browser = self._browsers.get(client)
        if browser is None:
            return

        def build(state: dict[str, Any]) -> tuple[int, bytes]:
            seq, snapshot = self.next(Topic.WORLD), self._station.snapshot
            age_ms = 1000.0 * (self._clock() - snapshot.read_s)
            return seq, frames.world(seq, snapshot.tick_ms, age_ms, state)

        browser.outbox.put(Topic.WORLD, state, lambda _old, new: new, build)

    def next(self, topic: Topic) -> int:
        """The number of the next frame of a topic."""
        self._seq[topic] += 1
        return self._seq[topic]

    async def beat(self) -> None:
        """Show the status also while the machine is silent, with its age."""
        while True:
            await asyncio.sleep(BEAT_S)
            if self._clock() - self._shown_s >= BEAT_S:
                self.show()
