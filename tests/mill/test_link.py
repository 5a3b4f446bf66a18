"""A card that does not answer any more: for a moment, or for good."""

from collections.abc import Callable, Iterable

import pytest
from tests.mill.shop import Shop, at, end, line, src

from openacr.client.errors import ConnectionLostError, NoReplyError
from openacr.cnc import canonical as c
from openacr.map.numbers import MA_BASE, MA_FEEDRATE_OVERRIDE, MA_RAPID_FEEDRATE_OVERRIDE
from openacr.mill.overrides import Override
from openacr.mill.states import State
from openacr.protocol.move import Move

SPINDLE_CW = "P800_005"
FOV, ROV = MA_BASE + MA_FEEDRATE_OVERRIDE, MA_BASE + MA_RAPID_FEEDRATE_OVERRIDE
CUT = (c.Spindle(src(1), c.Spin.CLOCKWISE, 500), line(2, at(50)), end())


def cutting(shop: Shop) -> Shop:
    shop.start(*CUT)
    shop.pass_time(0.5)
    assert shop.outputs([40]) == [True]
    return shop


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


LOST = ConnectionLostError("gone")


@pytest.mark.parametrize(
    ("lost", "method"), [(LOST, "hold"), (NoReplyError("card", "P1", 2.0), "look")]
)
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
    assert "alarm 3: Link lost; trying to reach the card" in shop.said
    place = shop.place()
    shop.pass_time(0.5)
    assert (shop.place(), shop.outputs([40])) == (place, [False])
    assert place[0] < 49.0


def test_a_connection_that_is_back_within_the_link_timeout_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("M3 S500\nG1 F600 X5\nM2\n")
    shop.pass_time(0.5)
    look, failures = shop.runner.machine.look, iter([LOST] * 3)

    def sometimes() -> object:
        if (failure := next(failures, None)) is not None:
            shop.card.pause(0.4)
            raise failure
        return look()

    monkeypatch.setattr(shop.runner.machine, "look", sometimes)
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((50_000, 0, 0), [])


def test_packets_that_may_be_lost_are_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those sent behind the last look, when the connection is a new one at the next."""
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("M3 S500\nF600\nG1 X1\nY1\nX0\nY0\nM2\n")
    machine = shop.runner.machine
    send, sent = machine.send, 0

    def lose(moves: Iterable[Move]) -> None:
        nonlocal sent
        sent += 1
        if sent == 1:
            machine._has_told = True
            shop.controller.bit[40] = False  # this one was lost, too
            shop.card._talk.connections += 1
        else:
            send(moves)

    monkeypatch.setattr(machine, "send", lose)
    places = []
    while shop.runner.is_busy:
        shop.pass_time(0.005)
        places.append(shop.place())
        if sent > 1 and shop.runner.is_busy:
            assert shop.outputs([40]) == [True]
    assert (shop.pulses(), codes(shop)) == ((0, 0, 0), [])
    corners = {(1.0, 1.0), (0.0, 1.0)}
    assert {(round(x, 1), round(y, 1)) for x, y, _ in places} >= corners


def test_overrides_that_may_be_lost_are_sent_again() -> None:
    shop = Shop()
    shop.load("F60\nG1 X9\nM2\n")
    shop.runner.overrides.choose(Override.FEED, 5)
    shop.runner.overrides.choose(Override.RAPID, 4)
    shop.pass_time(0.5)
    wanted = [shop.runner.overrides.factor(which) for which in (Override.FEED, Override.RAPID)]
    assert [shop.card.read(FOV), shop.card.read(ROV)] == wanted
    assert 1.0 not in wanted
    shop.card.command("FOV 1", program=0)  # as if the packets had not arrived
    shop.card.command("ROV 1", program=0)
    shop.pass_time(0.5)
    assert [shop.card.read(FOV), shop.card.read(ROV)] == [1.0, 1.0]
    shop.runner.machine._has_told = True
    shop.card._talk.connections += 1
    shop.pass_time(0.01)
    assert [shop.card.read(FOV), shop.card.read(ROV)] == wanted
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((90_000, 0, 0), [])


def test_an_action_that_may_be_lost_ends_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("M3 S500\nG4 F10\nG1 F600 X5\nM2\n")
    shop.pass_time(0.5)
    shop.runner.machine._has_told = True
    shop.card._talk.connections += 1
    shop.until(State.ALARM)
    assert (codes(shop), shop.outputs([40]), shop.pulses()) == ([3], [False], (0, 0, 0))


def test_a_connection_that_is_new_changes_nothing_where_all_was_answered() -> None:
    shop = Shop()
    shop.load("G4 F1\nM2\n")
    shop.pass_time(0.5)
    shop.card._talk.connections += 1
    shop.until(State.IDLE)
    assert codes(shop) == []


def test_a_card_that_stays_away_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    shop = cutting(Shop(**{SPINDLE_CW: 40}))

    def gone(*_: object) -> None:
        shop.card.pause(0.5)
        raise ConnectionLostError("gone")

    monkeypatch.setattr(shop.card, "read_many", gone)
    monkeypatch.setattr(shop.card, "tell", gone)
    lost = []
    while shop.runner.is_busy:
        shop.runner.step()
        lost.append(bool(codes(shop)))
    # The link timeout is 2 s, and the card is given up after three of them.
    assert (lost.index(True), len(lost)) == (4, 13)
    assert (shop.runner.is_out_of_reach, shop.runner.state, codes(shop)) == (
        True, State.ALARM, [3],
    )  # fmt: skip
    before = shop.card.now_s()
    with pytest.raises(ConnectionLostError, match="it does not answer"):
        shop.runner.course.host.position()
    assert shop.card.now_s() == before
