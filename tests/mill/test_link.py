"""A card that does not answer any more: for a moment, or for good."""

from collections.abc import Callable

import pytest
from tests.mill.shop import Shop, at, end, line, src

from openacr.client.errors import ConnectionLostError, NoReplyError
from openacr.cnc import canonical as c
from openacr.mill.states import State

SPINDLE_CW = "P800_005"
CUT = (c.Spindle(src(1), c.Spin.CLOCKWISE, 500), line(2, at(50)), end())


def cutting(shop: Shop) -> Shop:
    shop.start(*CUT)
    shop.pass_time(0.5)
    assert shop.outputs([40]) == [True]
    return shop


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


@pytest.mark.parametrize("lost", [ConnectionLostError("gone"), NoReplyError("card", "P1", 2.0)])
@pytest.mark.parametrize("method", ["look", "hold"])
def test_a_card_that_is_back_is_brought_to_rest(
    monkeypatch: pytest.MonkeyPatch, lost: Exception, method: str
) -> None:
    shop = cutting(Shop(**{SPINDLE_CW: 40}))
    real: Callable[..., object] = getattr(shop.runner.machine, method)
    failures = iter([lost])

    def once(*arguments: object) -> object:
        if (failure := next(failures, None)) is not None:
            raise failure
        return real(*arguments)

    monkeypatch.setattr(shop.runner.machine, method, once)
    if method == "hold":
        shop.controller.bit[522] = True  # an alarm that aborts
    shop.until(State.ALARM)
    assert 3 in codes(shop)
    place = shop.place()
    shop.pass_time(0.5)
    assert (shop.place(), shop.outputs([40])) == (place, [False])
    assert place[0] < 49.0


def test_a_card_that_stays_away_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    shop = cutting(Shop(**{SPINDLE_CW: 40}))

    def gone(*_: object) -> None:
        raise ConnectionLostError("gone")

    monkeypatch.setattr(shop.card, "read_many", gone)
    monkeypatch.setattr(shop.card, "tell", gone)
    for _ in range(5):
        shop.runner.step()
    assert (shop.runner.is_busy, shop.runner.state, codes(shop)) == (False, State.ALARM, [3])
