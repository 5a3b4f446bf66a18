"""The turns of the control thread: orders that flood it, stops that overtake, failing steps."""

from collections.abc import Callable
from typing import Any

import pytest
from tests.panel.bench import HandStation

from openacr.errors import UserError
from openacr.panel.commands.registry import COMMANDS
from openacr.panel.control.operator.orders import Order
from openacr.panel.control.operator.people import Person
from openacr.panel.control.thread import ORDERS_S, URGENT, ControlThread, Waiting


class Hand(ControlThread):
    """A control thread whose turns and time are a test's."""

    def __init__(self, hand: HandStation) -> None:
        self.hand = hand
        super().__init__(hand.station, lambda: hand.now_s)

    def send(self, name: str, answers: list[Any], *, client: int = 1, **args: Any) -> None:
        person = Person(client, self.hand.me.role, "127.0.0.1")
        self.put(Order(person, name, args, self.hand.now_s, answers.append))


@pytest.fixture
def thread(hand: HandStation) -> Hand:
    return Hand(hand)


def flood(thread: Hand) -> list[float]:
    """Orders of 1 ms of which each one puts the next: the queue is never empty."""
    done: list[float] = []

    def one(_station: object) -> None:
        thread.hand.now_s += 0.001
        done.append(thread.hand.now_s)
        thread.call(one)

    thread.call(one)
    return done


def test_a_flood_of_orders_leaves_every_turn_its_step(thread: Hand) -> None:
    done = flood(thread)
    before = thread.hand.station.now_s
    thread.turn(0.0)
    assert ORDERS_S == 0.005
    assert len(done) == 5
    assert thread.hand.station.now_s == pytest.approx(before + 0.005)
    thread.turn(0.0)
    assert len(done) == 10


def test_the_dead_man_ends_a_key_while_orders_flood(thread: Hand) -> None:
    hand = thread.hand
    hand.press(1)
    flood(thread)
    for _ in range(39):
        thread.turn(0.0)
    assert hand.events("jog") == []
    for _ in range(3):
        thread.turn(0.0)
    assert [(e["press"], e["ended"]) for e in hand.events("jog")] == [(1, "silence")]


@pytest.mark.parametrize(
    ("name", "args"),
    [
        ("stop.hold", {}),
        ("stop.all", {}),
        ("stop.estop", {}),
        ("jog.stop", {}),
        ("jog.release", {"press": 1}),
    ],
)
def test_what_stops_is_carried_out_before_all_that_waits(
    thread: Hand, name: str, args: dict[str, Any]
) -> None:
    done = flood(thread)
    answers: list[Any] = []
    for _ in range(20):
        thread.call(lambda _station: done.append(0.0))
    thread.put(
        Order(
            thread.hand.me,
            name,
            args,
            thread.hand.now_s,
            lambda answer: answers.append((len(done), answer)),
        )
    )
    thread.turn(0.0)
    result: Any = {"stopped": []} if name.startswith("stop.") else None
    assert answers == [(0, {"ok": True, "result": result})]


@pytest.mark.parametrize("stop", ["stop.hold", "stop.all", "stop.estop", "jog.stop"])
def test_motion_that_was_commanded_before_a_stop_does_not_begin_after_it(
    thread: Hand, stop: str
) -> None:
    hand = thread.hand
    moved: list[Any] = []
    stopped: list[Any] = []
    thread.send("mdi.execute", moved, line="G0 X5")
    hand.now_s += 0.001
    thread.send(stop, stopped)
    thread.turn(0.0)
    assert stopped[0]["ok"]
    text = "a stop was received after this command: give it again"
    assert moved == [{"ok": False, "error": {"code": "refused", "text": text}}]
    assert not hand.is_busy


def test_motion_that_is_commanded_at_or_after_a_stop_begins(thread: Hand) -> None:
    answers: list[Any] = []
    thread.send("stop.hold", answers)
    thread.send("mdi.execute", answers, line="G0 X5")
    thread.turn(0.0)
    assert [each["ok"] for each in answers] == [True, True]


def busy(text: str) -> dict[str, Any]:
    return {"ok": False, "error": {"code": "busy", "text": text}}


def test_of_one_browser_a_hundred_commands_wait_and_another_one_has_room(thread: Hand) -> None:
    mine: list[Any] = []
    other: list[Any] = []
    for _ in range(102):
        thread.send("nothing", mine)
    assert mine == [busy("100 commands of this browser wait already: try again")] * 2
    thread.send("nothing", other, client=2)
    assert other == []
    thread.turn(0.0)  # the clock is still: all are carried out
    assert len(mine) == 102
    assert [each["error"]["code"] for each in other] == ["bad"]
    thread.send("nothing", mine)
    assert len(mine) == 102


def test_of_all_browsers_a_thousand_commands_wait_and_each_one_still_stops(thread: Hand) -> None:
    answers: list[Any] = []
    for client in range(10, 20):
        for _ in range(100):
            thread.send("nothing", answers, client=client)
    assert answers == []
    thread.send("nothing", answers, client=2)
    assert answers == [busy("too many commands wait: try again")]
    thread.send("stop.all", answers, client=2)
    assert len(answers) == 1


def test_stops_of_one_browser_have_a_bound_and_the_stop_of_another_one_is_the_next(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine: list[Any] = []
    other: list[Any] = []
    order: list[str] = []
    for _ in range(1000):
        thread.send("stop.hold", mine)
    assert mine == [busy("stop.hold: 8 of this browser wait already")] * 992
    del mine[:]
    real = thread.station.order

    def noted(each: Order, now_s: float) -> None:
        order.append(f"{each.person.client} {each.name}")
        real(each, now_s)

    monkeypatch.setattr(thread.station, "order", noted)
    thread.send("stop.hold", other, client=2)
    thread.send("stop.estop", mine)  # a stronger one of the same browser is not kept out
    thread.turn(0.0)
    assert order == [*["1 stop.hold"] * 8, "2 stop.hold", "1 stop.estop"]
    assert [each["ok"] for each in mine + other] == [True] * 10
    thread.send("stop.hold", mine)
    assert len(mine) == 9


def test_a_browser_that_may_send_no_more_commands_still_stops(thread: Hand) -> None:
    answers: list[Any] = []
    for _ in range(100):
        thread.send("nothing", answers)
    thread.send("stop.all", answers)
    thread.turn(0.0)
    assert answers[0] == {"ok": True, "result": {"stopped": []}}


def test_all_that_stops_is_urgent() -> None:
    stops = {name for name, each in COMMANDS.items() if each.is_stop}
    assert {*URGENT} == {*stops, "jog.release"}


def failing(*_args: object) -> None:
    raise ZeroDivisionError("nothing there")


@pytest.mark.parametrize(
    ("stop", "done"), [("stop.estop", "kill"), ("stop.all", "bring_to_rest"), ("stop.hold", "stop")]
)
@pytest.mark.parametrize("broken", ["drop", "end_all"])
def test_a_stop_stops_whatever_else_of_it_fails(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch, stop: str, done: str, broken: str
) -> None:
    hand.do("mdi.execute", line="G1 X50 F600")
    hand.run(0.3)
    runner = hand.station.link.machine.runner
    calls: list[str] = []
    real: Callable[..., None] = getattr(runner, done)

    def counted(*args: Any) -> None:
        calls.append(done)
        real(*args)

    monkeypatch.setattr(runner, done, counted)
    place = hand.station.typed if broken == "drop" else hand.station.hand_motion.presses
    monkeypatch.setattr(place, broken, lambda *_args, **_more: failing())
    assert hand.refused(stop)["code"] == "internal"
    assert calls == [done]
    monkeypatch.undo()
    hand.run(1.0)
    assert hand.speeds() == (0.0, 0.0, 0.0)


def test_keys_end_and_nothing_waits_after_a_stop_that_fails(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand.press(1)
    for name in ("kill", "bring_to_rest"):
        monkeypatch.setattr(hand.station.link.machine.runner, name, failing)
    hand.refused("stop.all")
    assert [(e["press"], e["ended"]) for e in hand.events("jog")] == [(1, "stop")]
    hand.run(0.3)
    hand.press(2)
    hand.refused("stop.estop")
    assert [(e["press"], e["ended"]) for e in hand.events("jog")][1:] == [(2, "stop")]


FAILURE = "Control of the machine has failed: ZeroDivisionError: nothing there"


def test_a_step_that_fails_again_and_again_ends_keys_and_is_said_every_ten_seconds(
    thread: Hand, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    hand = thread.hand
    hand.press(1)
    monkeypatch.setattr(hand.station.jobs, "poll", failing)
    hand.now_s += 0.04
    thread.turn(0.0)
    first_s = hand.now_s
    assert [(e["press"], e["ended"], e["text"]) for e in hand.events("jog")] == [
        (1, "alarm", FAILURE)
    ]
    for now_s, count in ((first_s + 9.99, 1), (first_s + 10.1, 2), (first_s + 20.0, 2)):
        hand.now_s = now_s
        thread.turn(0.0)
        assert hand.said.count(FAILURE) == count
        assert [r.getMessage() for r in caplog.records if r.exc_info] == [
            "a step of the control thread has failed"
        ] * count


def test_another_failure_is_said_at_once(thread: Hand, monkeypatch: pytest.MonkeyPatch) -> None:
    hand = thread.hand
    monkeypatch.setattr(hand.station.jobs, "poll", failing)
    thread.turn(0.0)

    def other() -> None:
        raise KeyError("X")

    monkeypatch.setattr(hand.station.jobs, "poll", other)
    thread.turn(0.0)
    assert hand.said[-2:] == [FAILURE, "Control of the machine has failed: KeyError: 'X'"]


def test_the_thread_lives_on_when_the_machine_cannot_be_opened(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    turns: list[float] = []

    def turn(idle_s: float) -> None:
        turns.append(idle_s)
        thread._is_over.set()

    monkeypatch.setattr(thread.hand.station, "open", failing)
    monkeypatch.setattr(thread, "turn", turn)
    thread._run()
    assert len(turns) == 1
    assert thread.hand.said[-1] == FAILURE


def test_urgent_items_are_taken_first_and_each_kind_in_its_order() -> None:
    waiting: Waiting[str] = Waiting()
    for item in ("a", "b"):
        waiting.put(item)
    for item in ("U", "V"):
        waiting.put(item, is_urgent=True)
    assert len(waiting) == 4
    assert [waiting.take() for _ in range(5)] == ["U", "V", "a", "b", None]
    assert waiting.take(0.001) is None


def test_an_item_is_refused_while_the_most_of_its_sender_wait() -> None:
    waiting: Waiting[str] = Waiting()
    assert waiting.put("a", sender=1, most=2)
    assert waiting.put("b", is_urgent=True, sender=1, most=2)
    assert not waiting.put("c", sender=1, most=2)
    assert waiting.put("d", sender=2, most=1)
    assert waiting.put("e", sender=1)
    assert [waiting.take() for _ in range(2)] == ["b", "a"]
    assert waiting.put("f", sender=1, most=2)
    assert [waiting.take() for _ in range(4)] == ["d", "e", "f", None]
    assert not waiting._counts


def test_an_unexpected_failure_at_the_end_cuts_the_power_and_closes_the_machine(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = thread.hand.station.link.machine
    cut: list[bool] = []

    def fail() -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(session.runner, "bring_to_rest", fail)
    monkeypatch.setattr(session.runner, "cut_power", lambda: cut.append(True))
    thread.rest()
    assert cut == [True]
    assert thread.hand.station.link.session is None


def test_a_refusal_at_the_end_closes_the_machine_without_cutting_its_power(
    thread: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another program may have taken the machine: its motion is not ours to kill."""
    session = thread.hand.station.link.machine
    cut: list[bool] = []

    def refuse() -> None:
        raise UserError("another program has the machine")

    monkeypatch.setattr(session.runner, "bring_to_rest", refuse)
    monkeypatch.setattr(session.runner, "cut_power", lambda: cut.append(True))
    thread.rest()
    assert cut == []
    assert thread.hand.station.link.session is None
