"""User messages, and the variables of the operator."""

from pathlib import Path

import pytest
from tests.mill.shop import Shop, at, line

from openacr.errors import UserError
from openacr.mill.card.messages import (
    Message,
    Messages,
    define,
    definitions,
    free_number,
    remove,
)
from openacr.mill.config.pparm import OperatorParameters
from openacr.sysvar import Store
from openacr.sysvar.tabs import MESSAGES
from openacr.sysvar.values import SettingError


class Watched:
    """A machine whose messages are looked at."""

    def __init__(self, *messages: Message, **cells: float) -> None:
        self.shop = Shop(**cells)
        for message in messages:
            define(self.shop.store, message)
        self.seen: list[tuple[int, bool]] = []
        io = self.shop.runner.io
        self.messages = Messages(io, list(definitions(self.shop.store)), self.note)

    def note(self, message: Message, is_on: bool) -> None:
        self.seen.append((message.number, is_on))

    def pass_time(self, seconds: float) -> list[int]:
        for _ in range(round(seconds / 0.01)):
            self.shop.pass_time(0.01)
            self.messages.poll(self.shop.runner.machine.now_s)
        return [message.number for message in self.messages.shown]


@pytest.mark.req("MILL-MSG-TRIGGER", "MILL-MSG-CLEAR")
def test_a_message_is_there_while_its_input_or_output_has_the_state() -> None:
    watched = Watched(
        Message(0, 5, "door open"),
        Message(3, 40, "lamp off", is_shown_on=False),
        Message(7, 6, "inverted", is_shown_on=True),
        P251006=1,
    )
    assert watched.pass_time(0.1) == [3, 7]
    watched.shop.controller.set_input(5, True)
    watched.shop.controller.set_input(6, True)
    assert watched.pass_time(0.1) == [0, 3]
    watched.shop.runner.io.output(40, True)
    assert watched.pass_time(0.1) == [0]
    watched.shop.controller.set_input(5, False)
    assert watched.pass_time(0.1) == []
    assert watched.seen == [(3, True), (7, True), (0, True), (7, False), (3, False), (0, False)]
    (door,) = (each for each in watched.messages.history if each.message.number == 0)
    assert door.until_s is not None
    assert 0.05 < door.until_s - door.at_s < 0.35


@pytest.mark.req("MILL-MSG-32")
def test_32_messages_are_shown_together_and_there_is_no_33rd() -> None:
    store = Store()
    for number in range(32):
        assert free_number(store) == number
        define(store, Message(number, 128, f"text {number}", is_shown_on=False))
    with pytest.raises(UserError, match="32 messages are defined"):
        free_number(store)
    with pytest.raises(UserError, match="messages are numbered 0 to 31"):
        define(store, Message(32, 5, "one more"))
    assert store.read(1_003_424) == 32
    shop = Watched(*definitions(store))
    assert shop.pass_time(0.1) == list(range(32))


@pytest.mark.req("MILL-MSG-PERSIST", "MILL-MSG-COLOR")
def test_definitions_outlive_the_process_with_length_and_colours(tmp_path: Path) -> None:
    short = Message(4, 33, "tool changer is empty", False, 0, 14, 12, True)
    with Store(tmp_path / "s.db") as store:
        define(store, short)
        define(store, Message(9, 5, "x"))
        remove(store, 9)
    with Store(tmp_path / "s.db") as store:
        assert list(definitions(store)) == [short]
        assert short.shown == "tool changer"
        with pytest.raises(UserError, match="message 9 is not defined"):
            remove(store, 9)
        with pytest.raises(SettingError):
            define(store, Message(1, 5, "x", text_color=16))
        assert not store.read(MESSAGES.defined[9])


@pytest.mark.req("MILL-PPARM-RANGE", "MILL-PPARM-LIVE")
def test_p_parm_shows_what_is_there_now_and_changes_it_at_once() -> None:
    shop = Shop()
    values = OperatorParameters(shop.store, shop.card)
    shop.run_text("P5=P5+1.5\nP150=7\nM2")
    assert (values.read(5), values.read(150)) == (1.5, 7.0)
    shop.start(line(1, at(5)))
    shop.card.command("P6=3", program=1)
    assert values.read(6) == 3.0
    values.write(5, 42.25)
    assert shop.card.command("?P5", program=1) == ["42.25"]
    values.write(199, -1)
    assert shop.store.read(199) == -1.0
    for n in (-1, 200, 4096):
        with pytest.raises(UserError, match="not an operator variable: P0 to P199 are"):
            values.read(n)
        with pytest.raises(UserError, match="not an operator variable: P0 to P199 are"):
            values.write(n, 1.0)
    with pytest.raises(UserError, match="P5 is on the card: name the card with --host"):
        OperatorParameters(shop.store).read(5)
