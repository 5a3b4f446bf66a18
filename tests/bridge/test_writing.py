"""What may be written: values the file lists, within their limits, and only finite numbers."""

import asyncio
from concurrent.futures import Future

import pytest
from tests.bridge.bench import VALUES, GivenFeed

from openacr.bridge.items import Item, items_of
from openacr.bridge.load import parse_bridge
from openacr.bridge.settings import Chosen
from openacr.bridge.writing import KindError, RangeError, Writer, checked
from openacr.errors import UserError

PULSES, GATE = parse_bridge(VALUES + "[prometheus]\n").value
REAL = Chosen(name="gain", parameter="axis0.proportional gain", write=True, low=0.5, high=1.5)


@pytest.mark.parametrize(
    ("chosen", "value", "number"),
    [
        (PULSES, -1000, -1000.0), (PULSES, 1000.0, 1000.0), (REAL, 0.5, 0.5), (REAL, 1.5, 1.5),
        (REAL, 1, 1.0), (GATE, True, 1.0), (GATE, 0, 0.0), (GATE, 1, 1.0),
    ],
)  # fmt: skip
def test_values_within_their_limits_are_numbers(
    chosen: Chosen, value: object, number: float
) -> None:
    assert checked(chosen, value) == number


@pytest.mark.parametrize(
    ("chosen", "value", "said"),
    [
        (PULSES, 1001, "pulses: 1001 is not in -1000..1000"),
        (PULSES, 0.5, "pulses is a whole number: 0.5 is not"),
        (REAL, 0.49, "gain: 0.49 is not in 0.5..1.5"),
        (REAL, 1.51, "gain: 1.51 is not in 0.5..1.5"),
        (GATE, 2, "gate is a flag: 2 is neither 0 nor 1"),
        (GATE, "1", "gate is a flag: '1' is neither 0 nor 1"),
    ],
)
def test_values_beyond_them_are_refused(chosen: Chosen, value: object, said: str) -> None:
    with pytest.raises(KindError if isinstance(value, str) else RangeError) as caught:
        checked(chosen, value)
    assert str(caught.value) == said


@pytest.mark.parametrize("value", [True, "1", None, [1.0]])
def test_what_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(KindError, match="is not a number"):
        checked(REAL, value)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_number_that_is_not_finite_is_beyond_all_limits(value: float) -> None:
    with pytest.raises(RangeError, match="is not a number"):
        checked(REAL, value)


def item(name: str) -> Item:
    found = items_of(GivenFeed().axes, (PULSES, GATE, Chosen(name="seen", flag=3)))
    return next(each for each in found if each.name == name)


@pytest.mark.parametrize("name", ["line", "X.actual", "user.seen"])
def test_what_the_file_does_not_allow_is_refused(name: str) -> None:
    feed = GivenFeed()
    with pytest.raises(UserError, match=f"{name} cannot be written: the bridge file"):
        asyncio.run(Writer(feed).write(item(name), 1, "test"))
    assert feed.written == []


def test_a_card_that_does_not_answer_ends_the_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("openacr.bridge.writing.WRITE_S", 0.01)
    feed = GivenFeed()
    never: Future[None] = Future()
    monkeypatch.setattr(feed, "write", lambda *_words, **_more: never)
    with pytest.raises(UserError, match=r"user\.gate: the card has not answered in 0\.01 s"):
        asyncio.run(Writer(feed).write(item("user.gate"), 1, "test"))
    assert never.cancelled()
