"""A panel that is left alone for days: nothing that it keeps grows with the time."""

import gc
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from sqlite3 import Connection
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any

import pytest

from openacr.controller import Controller
from openacr.mill.card import alarms, messages
from openacr.mill.card.alarms import Alarms
from openacr.mill.card.messages import Message, Messages
from openacr.panel.commands.all import carry_out
from openacr.panel.control.engineer.watches import Wish
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.pace import OwnTime
from openacr.panel.control.operator.people import Person
from openacr.panel.control.station import Station
from openacr.panel.machine import opened
from openacr.panel.roles import Role

STEP_S = 0.02
SETTLE, STEPS = 500, 600
SIZED = (list, dict, set, frozenset, tuple, deque, str, bytes, bytearray)
OF_THE_PROGRAM = (type, ModuleType, FunctionType, BuiltinFunctionType)


class OnLink:
    """A station on a card that it sees as one at the end of a link; both are stepped by hand."""

    def __init__(self, folder: Path, *, is_agreed: bool) -> None:
        (folder / "programs").mkdir()
        self.card = Controller()
        self.installation = Installation(
            "tcp", "card", self.card, opened(folder / "sysvar.db"), folder / "programs", OwnTime()
        )
        self.installation.is_agreed = is_agreed
        self.station = Station(self.installation, carry_out)
        self.now_s = 100.0
        self.station.open(self.now_s)
        assert self.station.link.lost == ""

    def run(self, steps: int) -> None:
        for _ in range(steps):
            self.now_s += STEP_S
            self.card.advance(1)
            self.station.step(self.now_s)

    def held(self) -> int:
        """The entries of all that the station holds, without the card."""
        seen = {id(self.card)}
        found: list[Any] = [self.station]
        count = 0
        gc.collect()
        while found:
            each = found.pop()
            if id(each) in seen or isinstance(each, OF_THE_PROGRAM):
                continue
            seen.add(id(each))
            if isinstance(each, Connection):  # it has up to 200 cursors that have ended
                continue
            count += 1 + (len(each) if isinstance(each, SIZED) else 0)
            found.extend(gc.get_referents(each))
        return count

    def close(self) -> None:
        self.station.close()
        self.station.jobs.close()
        self.installation.close()


@pytest.fixture(params=[False, True], ids=["bare", "set up"])
def on_link(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[OnLink]:
    made = OnLink(tmp_path, is_agreed=request.param)
    yield made
    made.close()


def test_a_station_holds_as_much_after_hundreds_of_steps_as_before(on_link: OnLink) -> None:
    station = on_link.station
    station.join(Person(1, Role.SERVICE, "127.0.0.1"))
    station.watches.begin(Wish(1, "watch"), [12288, 6144], 25.0)
    on_link.run(SETTLE)
    before, shown = on_link.held(), station.snapshot.number
    on_link.run(STEPS)
    assert station.snapshot.number - shown > STEPS / 4
    assert abs(on_link.held() - before) < 50


def test_a_list_that_grows_at_each_poll_would_be_seen(on_link: OnLink) -> None:
    on_link.run(100)
    kept: list[float] = []
    before = on_link.held()

    def growing() -> None:
        kept.append(float(len(kept)))

    on_link.station.on_snapshot = growing
    on_link.station.__dict__["kept"] = kept
    on_link.run(200)
    assert len(kept) > 50
    assert on_link.held() - before >= 2 * len(kept)


def test_alarms_that_come_again_and_again_keep_the_last_hundred() -> None:
    raised = Alarms()
    for n in range(250):
        raised.raise_alarm(alarms.CONTROL_FAILED, n, float(n))
        raised.raise_alarm(alarms.CONTROL_FAILED, n, float(n))  # it is active already
        raised.acknowledge(lambda _alarm: True)
    assert raised.raised == 250
    assert [each.detail for each in raised.history] == [str(n) for n in range(150, 250)]
    assert [each.detail for each in raised.since(248)] == ["248", "249"]
    assert raised.since(250) == []
    assert len(raised.since(130)) == len(raised.since(0)) == 100


def test_a_message_that_blinks_for_days_keeps_its_last_displays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Blinking:
        """What `Messages` needs of the inputs: one flag that is on every other time."""

        outputs: tuple[int, ...] = ()
        is_on = False

        @property
        def machine(self) -> "Blinking":
            return self

        @property
        def card(self) -> "Blinking":
            return self

        def has_input(self, _bit: int) -> bool:
            return False

        @property
        def settings(self) -> None:
            return None

        def read_bits(self, _bits: list[int]) -> list[bool]:
            self.is_on = not self.is_on
            return [self.is_on]

    monkeypatch.setattr(messages, "MOST_KEPT", 5)
    blinking: Any = Blinking()
    shown = Messages(blinking, [Message(0, 128, "door")], lambda _message, _is_on: None)
    for n in range(40):
        shown.poll(float(n))
    assert [each.at_s for each in shown.history] == [30.0, 32.0, 34.0, 36.0, 38.0]
