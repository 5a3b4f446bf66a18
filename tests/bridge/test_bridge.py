"""A bridge keeps going whatever one of its parts does, and ends with all of them closed."""

import threading
from collections.abc import Callable, Sequence

import pytest
from tests.bridge.bench import RUNNING, GivenFeed
from tests.waiting import until

from openacr.bridge.bridge import Bridge, System
from openacr.bridge.card_feed import CardFeed
from openacr.bridge.items import Item, Readings
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import Moment
from openacr.bridge.settings import OnCard
from openacr.errors import OpenacrError, UserError

FILE = parse_bridge("rate_hz = 50\n[prometheus]\n")


class Watcher:
    """A system that notes what it gets; `fail` is called before."""

    def __init__(self, name: str, fail: Callable[[], None] = lambda: None) -> None:
        self.name, self._fail = name, fail
        self.seen: list[tuple[Readings, list[int]]] = []
        self.is_closed = False

    async def open(self) -> str:
        if self.name == "closed":
            raise UserError("closed: it cannot begin")
        return "here"

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        self._fail()
        self.seen.append((readings, list(changed)))

    async def close(self) -> None:
        self.is_closed = True
        self._fail()


def broken() -> None:
    raise RuntimeError("broken")


def bridge_to(feed: GivenFeed, *systems: Watcher) -> Bridge:
    def make(_items: tuple[Item, ...]) -> list[System]:
        return list(systems)

    return Bridge(FILE, feed, make)


def test_a_system_that_fails_takes_no_other_one_with_it(caplog: pytest.LogCaptureFixture) -> None:
    bad, good = Watcher("bad", broken), Watcher("good")
    bridge = bridge_to(GivenFeed(), bad, good)
    bridge.start()
    until(lambda: len(good.seen) > 5)
    bridge.stop()
    assert (bad.is_closed, good.is_closed) == (True, True)
    texts = [record.getMessage() for record in caplog.records]
    assert texts.count("bad cannot publish: RuntimeError: broken") == 1
    assert "bad has not ended: broken" in texts
    assert bridge.places == ["bad here", "good here"]


def test_all_values_come_first_and_then_those_that_differ() -> None:
    feed, system = GivenFeed(), Watcher("good")
    bridge = bridge_to(feed, system)
    bridge.start()
    until(lambda: len(system.seen) > 2)
    feed.lose()
    until(lambda: system.seen[-1][0][0] is False)
    bridge.stop()
    (first, all_places), (_, none), *_ = system.seen
    assert (all_places, none) == (list(range(len(first))), [])
    lost = next(each for each in system.seen if each[0][0] is False)
    names = {bridge.items[place].name for place in lost[1]}
    assert {"available", "line", "X.actual"} <= names
    assert {"alarms", "time_left"} & names == set()


def test_values_that_cannot_be_read_are_logged_and_read_again(
    caplog: pytest.LogCaptureFixture,
) -> None:
    feed, system = GivenFeed(), Watcher("good")
    feed.moment = Moment(run=RUNNING.run, facts={"alarms": {"active": [{}]}})
    bridge = bridge_to(feed, system)
    bridge.start()
    until(lambda: caplog.records)
    feed.moment = RUNNING
    until(lambda: system.seen)
    bridge.stop()
    assert [r.getMessage() for r in caplog.records] == [
        "the values cannot be read: KeyError: 'code'"
    ]


def test_a_system_that_cannot_begin_ends_the_others() -> None:
    good = Watcher("good")
    bridge = bridge_to(GivenFeed(), good, Watcher("closed"), Watcher("never"))
    with pytest.raises(UserError, match="closed: it cannot begin"):
        bridge.start()
    assert good.is_closed
    assert "bridge" not in [thread.name for thread in threading.enumerate()]


def test_a_write_that_was_given_up_does_not_end_the_feed() -> None:
    feed = CardFeed("127.0.0.1:1", OnCard())
    given_up, waiting = (feed.write(12304, 1.0, is_flag=False) for _ in range(2))
    assert given_up.cancel()
    feed._refuse("the card is lost")
    with pytest.raises(OpenacrError, match="the card is lost"):
        waiting.result(0)
