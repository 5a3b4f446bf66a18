"""What waits for a browser: parts are joined, none is left out, and none comes before its time."""

import asyncio
from collections.abc import Callable, Iterator
from operator import or_
from typing import Any

import numpy as np
import pytest

from openacr.panel.control.engineer.scope import MOST_SAMPLES, Samples, joined
from openacr.panel.wire.frames import Topic
from openacr.panel.wire.outbox import CREDITS, Outbox


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class Counted(Clock):
    """A clock that knows how often it was asked."""

    def __init__(self) -> None:
        super().__init__()
        self.count = 0

    def __call__(self) -> float:
        self.count += 1
        return self.now_s


class Frames:
    """Builds frames that are texts of what they carry."""

    def __init__(self) -> None:
        self.count = 0

    def __call__(self, waiting: Any) -> tuple[int, bytes]:
        self.count += 1
        return self.count, repr(waiting).encode()


def add(earlier: list[int], later: list[int]) -> list[int]:
    return earlier + later


Take = Callable[[Outbox], bytes | str | None]


@pytest.fixture
def taken() -> Iterator[Take]:
    """What an outbox has ready now; None if it has nothing."""

    async def take(outbox: Outbox) -> bytes | str | None:
        task = asyncio.ensure_future(outbox.take())
        await asyncio.sleep(0)
        if task.done():
            return task.result()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        return None

    with asyncio.Runner() as runner:
        yield lambda outbox: runner.run(take(outbox))


def test_parts_that_wait_for_an_acknowledgement_are_joined(taken: Take) -> None:
    clock, build = Clock(), Frames()
    outbox = Outbox(clock)
    outbox.subscribe(Topic.SCOPE, 10)
    assert CREDITS[Topic.SCOPE] == 1
    for number in range(4):
        outbox.put(Topic.SCOPE, [number], add, build)
        if number == 0:
            assert taken(outbox) == b"[0]"
        clock.now_s += 0.125
        assert taken(outbox) is None
    outbox.acknowledge(Topic.SCOPE, 1)
    assert taken(outbox) == b"[1, 2, 3]"
    assert taken(outbox) is None


def test_a_part_that_comes_early_waits_until_it_is_due(taken: Take) -> None:
    clock, build = Clock(), Frames()
    outbox = Outbox(clock)
    outbox.subscribe(Topic.WATCH, 8)
    assert CREDITS[Topic.WATCH] == 2
    outbox.put(Topic.WATCH, {3: 1.0, 4: 1.0}, or_, build)
    assert taken(outbox) == b"{3: 1.0, 4: 1.0}"
    outbox.put(Topic.WATCH, {4: 2.0}, or_, build)
    clock.now_s += 0.12
    assert taken(outbox) is None
    outbox.put(Topic.WATCH, {4: 3.0, 5: 3.0}, or_, build)
    clock.now_s += 0.005  # an eighth of a second after the first
    assert taken(outbox) == b"{4: 3.0, 5: 3.0}"


def test_the_time_of_a_waiting_part_needs_no_other_event() -> None:
    outbox, build = Outbox(), Frames()
    outbox.subscribe(Topic.SCOPE, 50)

    async def two() -> list[bytes | str]:
        outbox.put(Topic.SCOPE, [1], add, build)
        first = await outbox.take()
        outbox.acknowledge(Topic.SCOPE, 1)
        outbox.put(Topic.SCOPE, [2], add, build)
        async with asyncio.timeout(60.0):
            return [first, await outbox.take()]

    assert asyncio.run(two()) == [b"[1]", b"[2]"]


def test_a_part_without_credit_waits_for_its_acknowledgement_and_not_for_the_time() -> None:
    clock, build = Counted(), Frames()
    outbox = Outbox(clock)
    outbox.subscribe(Topic.SCOPE, 10)

    async def waits() -> list[bytes | str]:
        outbox.put(Topic.SCOPE, [1], add, build)
        first = await outbox.take()
        outbox.put(Topic.SCOPE, [2], add, build)
        clock.now_s += 1.0  # it has long been due
        task = asyncio.ensure_future(outbox.take())
        await asyncio.sleep(0)
        asked = clock.count
        for _ in range(50):
            await asyncio.sleep(0)
        assert (task.done(), clock.count) == (False, asked)
        outbox.acknowledge(Topic.SCOPE, 1)
        return [first, await task]

    assert asyncio.run(waits()) == [b"[1]", b"[2]"]


def test_nothing_is_put_to_a_browser_that_has_not_subscribed(taken: Take) -> None:
    outbox, build = Outbox(Clock()), Frames()
    outbox.put(Topic.SCOPE, [1], add, build)
    outbox.subscribe(Topic.SCOPE, 10)
    assert taken(outbox) is None
    outbox.put(Topic.SCOPE, [2], add, build)
    outbox.unsubscribe(Topic.SCOPE)
    assert taken(outbox) is None


def piece(first: int, count: int, *, channels: int = 2) -> Samples:
    numbers = np.arange(first, first + count, dtype=float)
    return first, np.array([numbers + 1000.0 * c for c in range(channels)]), 0.001


def equal(found: Samples, wanted: Samples) -> bool:
    same = np.array_equal(found[1], wanted[1])
    return same and (found[0], found[2]) == (wanted[0], wanted[2])


def test_samples_that_follow_each_other_become_one_piece() -> None:
    assert equal(joined(piece(7, 3), piece(10, 2)), piece(7, 5))


@pytest.mark.parametrize(
    "later", [piece(0, 4), piece(11, 2), piece(9, 2), piece(10, 2, channels=1)]
)
def test_samples_of_another_capture_take_the_place_of_those_that_wait(later: Samples) -> None:
    assert equal(joined(piece(7, 3), later), later)


def test_the_newest_samples_are_kept_for_a_browser_that_is_away() -> None:
    found = joined(piece(5, MOST_SAMPLES - 1, channels=1), piece(4 + MOST_SAMPLES, 3, channels=1))
    assert equal(found, piece(7, MOST_SAMPLES, channels=1))
    exactly = joined(piece(5, MOST_SAMPLES - 1, channels=1), piece(4 + MOST_SAMPLES, 1, channels=1))
    assert equal(exactly, piece(5, MOST_SAMPLES, channels=1))
