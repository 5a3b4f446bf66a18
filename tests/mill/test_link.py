"""A card that does not answer any more: for a moment, or for good."""

from collections.abc import Callable, Iterable

import pytest
from tests.mill.shop import Shop, at, end, line, src
from tests.search import sparse

from openacr.client.errors import ConnectionLostError, NoReplyError
from openacr.cnc import canonical as c
from openacr.map.rows import masters
from openacr.mill.card.driver import StepLostError
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import State
from openacr.protocol.move import Move

SPINDLE_CW = "P800_005"
FOV, ROV = (
    masters.feedrate_override[0],
    masters.rapid_feedrate_override[0],
)
DAC3 = 6448
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
    ("lost", "method"), [(LOST, "hold"), (NoReplyError("card", "P1", 2.0), "poll")]
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
    sample, failures = shop.runner.machine.poll, iter([LOST] * 3)

    def sometimes() -> object:
        if (failure := next(failures, None)) is not None:
            shop.card.pause(0.4)
            raise failure
        return sample()

    monkeypatch.setattr(shop.runner.machine, "poll", sometimes)
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((50_000, 0, 0), [])


def test_packets_that_may_be_lost_are_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those sent after the last poll, when the connection is a new one at the next."""
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("M3 S500\nF600\nG1 X1\nY1\nX0\nY0\nM2\n")
    machine = shop.runner.machine
    send, sent = machine.send, 0

    def lose(moves: Iterable[Move]) -> None:
        nonlocal sent
        sent += 1
        if sent == 1:
            machine._has_sent = True
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
    shop.load("F60\nG1 X2\nM2\n")
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
    shop.runner.machine._has_sent = True
    shop.card._talk.connections += 1
    shop.pass_time(0.01)
    assert [shop.card.read(FOV), shop.card.read(ROV)] == wanted
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((20_000, 0, 0), [])


def test_an_action_that_may_be_lost_ends_the_program() -> None:
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("M3 S500\nG4 F10\nG1 F600 X5\nM2\n")
    shop.pass_time(0.5)
    shop.runner.machine._has_sent = True
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
        shop.runner.stream.host.position()
    assert shop.card.now_s() == before


SQUARE = "F600\nG1 X.1\nY.1\nX0\nY0\nX.2\nY.1\nM2\n"


class Breaking:
    """Breaks the connection of a shop at operations of its link, counted from now on.

    Bytes written at an even one are lost without a word; an odd one is an error at once.
    """

    def __init__(self, shop: Shop, *operations: int) -> None:
        self.left = list(operations)
        self._count = 0
        self._link = shop.card._link
        self._read, self._write = self._link.read, self._link.write
        self._link.read = self.read  # type: ignore[method-assign]
        self._link.write = self.write  # type: ignore[method-assign]

    def _breaks(self) -> bool:
        self._count += 1
        if not self.left or self._count < self.left[0]:
            return False
        self.left.pop(0)
        self._link.close()
        return True

    def read(self, timeout_s: float | None) -> bytes:
        self._breaks()
        return self._read(timeout_s)

    def write(self, data: bytes) -> None:
        if not (self._breaks() and self._count % 2 == 0):
            self._write(data)


@pytest.mark.parametrize("second", sparse([None, 1, 2, 3, 4], 2))
def test_a_connection_that_breaks_at_any_moment_of_a_cut_goes_on(second: int | None) -> None:
    """Every exchange of a run in turn, or one early in it and then each of those after that.

    From 59 to 76 the moves are taken back: stop, kill, its clearing, the counter.
    """
    places = set()
    every: Iterable[int] = range(1, 31)
    if second is not None:
        every = [*range(7 + second, 25, 4), *range(57 + second, 77, 4)]
    for operation in every:
        shop = Shop()
        shop.load(SQUARE)
        breaking = Breaking(shop, *([operation] if second is None else [7, operation]))
        while shop.runner.is_busy:
            shop.pass_time(0.02)
            places.add(shop.place())
        assert breaking.left == []
        assert (shop.pulses(), codes(shop)) == ((2000, 1000, 0), []), operation
    assert all(x in (0.0, 0.1, 0.2) or y in (0.0, 0.1) for x, y, _ in places)


def lose_after(monkeypatch: pytest.MonkeyPatch, shop: Shop, moves: int) -> None:
    """Of the first moves that are sent only some arrive; the connection is a new one then."""
    machine = shop.runner.machine
    send, is_first = machine.send, True

    def lose(sent: Iterable[Move]) -> None:
        nonlocal is_first
        send(list(sent)[:moves] if is_first else sent)
        if is_first:
            shop.card._talk.connections += 1
        is_first = False

    monkeypatch.setattr(machine, "send", lose)


def test_moves_that_may_be_lost_when_a_pause_begins_are_sent_again_at_resume(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop()
    lose_after(monkeypatch, shop, 1)
    shop.load("F60\nG1 X1\nY1\nX0\nY0\nM2\n")
    shop.pass_time(0.005)
    shop.runner.stop()
    shop.pass_time(0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((0, 0, 0), [])
    corners = {(1.0, 1.0), (0.0, 1.0)}
    assert {(round(x, 2), round(y, 2)) for x, y, _ in shop.path} >= corners
    assert not shop.runner.stream.may_lack_moves  # the next pause just goes on


def test_a_trace_whose_moves_may_be_lost_ends_the_program_at_rest() -> None:
    shop = Shop(P650_006=60.0)
    shop.load("F600\nG1 X1\nY1\nX0\nM2\n")
    shop.pass_time(0.15)
    shop.runner.stop()
    shop.pass_time(0.5)
    shop.runner.trace(-1)
    shop.pass_time(0.2)
    assert codes(shop) == []
    shop.runner.machine._has_sent = True
    shop.card._talk.connections += 1
    shop.until(State.ALARM)
    place = shop.place()
    shop.pass_time(0.5)
    assert (codes(shop), shop.place()) == ([3], place)


def test_moves_are_never_sent_on_a_newer_connection_than_that_of_the_last_look() -> None:
    shop = Shop()
    machine = shop.runner.machine
    machine.poll()
    shop.card._talk.connections += 1
    with pytest.raises(ConnectionLostError, match="connected again since the last poll"):
        machine.send([])
    machine.poll()
    machine.send([])
    with pytest.raises(StepLostError, match="gone"), machine.repeating():
        raise LOST
    assert machine.poll().may_have_lost
    with pytest.raises(ConnectionLostError):
        machine.send([])
    assert machine.poll().may_have_lost  # until it is sent again
    machine.forget_losses()
    machine.send([])
    assert not machine.poll().may_have_lost


def test_a_spindle_override_that_was_not_answered_is_written_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop(P800_002=3, P800_001=0.01)
    shop.load("M3 S500\nF60\nG1 X1\nM2\n")
    shop.pass_time(0.3)
    assert shop.card.read(DAC3) == 5.0
    write, failures = shop.runner.machine.write, iter([LOST])

    def once(parameter: int, value: float) -> None:
        if parameter == DAC3 and (failure := next(failures, None)) is not None:
            raise failure
        write(parameter, value)

    monkeypatch.setattr(shop.runner.machine, "write", once)
    shop.runner.overrides.choose(Override.SPINDLE, 4)
    factor = shop.runner.overrides.factor(Override.SPINDLE)
    assert factor < 1.0
    shop.pass_time(0.2)
    assert (shop.card.read(DAC3), codes(shop)) == (5.0 * factor, [])
    shop.until(State.IDLE)
    assert (shop.pulses(), codes(shop)) == ((10_000, 0, 0), [])


def test_soft_limits_whose_switching_was_lost_are_switched_at_the_next_look(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    key = 6
    shop = Shop(P400_005=key, P200_000=2.0, P200_001=-1.5, P200_002=0, P271=1)
    shop.controller.set_input(key, True)
    shop.load("F60\nG1 X1\nM2\n")
    shop.pass_time(0.1)
    assert shop.card.command("AXIS0 SLIM", program=0) == ["3"]
    machine = shop.runner.machine
    set_flag, failures = machine.set_flag, iter([LOST])

    def once(number: int, on: bool) -> None:
        if (failure := next(failures, None)) is not None:
            raise failure
        set_flag(number, on)

    monkeypatch.setattr(machine, "set_flag", once)
    shop.controller.set_input(key, False)
    shop.until(State.IDLE)
    assert next(failures, None) is None
    assert shop.card.command("AXIS0 SLIM", program=0) == ["0"]
    assert (codes(shop), shop.pulses()) == ([], (10_000, 0, 0))
