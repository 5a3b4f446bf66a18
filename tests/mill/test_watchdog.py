"""The watchdog on a card that has no room for it, and in a program that is in use."""

from collections.abc import Callable

import pytest

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.cnc.occupied import HEARTBEAT, WATCHDOG_PROGRAM
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.card.watchdog import NO_WATCHDOG
from openacr.mill.session import MillSession
from openacr.sysvar import Store

RUNS = 1248  # flag of program 7


def opened(
    controller: Controller, say: Callable[[str], None] = lambda _text: None, **cells: float
) -> MillSession:
    store = Store()
    for name, value in cells.items():
        store.write(int(name.removeprefix("P")), value)
    return MillSession.real(controller, store, say)


def listed(controller: Controller, program: int = WATCHDOG_PROGRAM) -> list[str]:
    with Card.open(controller) as card:
        return card.command("LIST", program=program)


def test_a_program_that_is_in_use_is_left_alone() -> None:
    controller = Controller()
    Card.open(controller).command("10 REM mine", program=7)
    with pytest.raises(UserError) as refused:
        opened(controller)
    assert str(refused.value) == (
        "program 7 of the card is in use (10 REM mine): choose another one for the watchdog"
        " (P250125: 0 to 7, -1 for none)"
    )
    assert listed(controller) == ["10 REM mine"]
    assert controller.p[HEARTBEAT] == 0  # the machine is free again
    shop = opened(controller, P250125=6)
    assert listed(controller, 6)[0] == "10 REM openacr watchdog"
    shop.close()
    assert (listed(controller, 6), listed(controller)) == ([], ["10 REM mine"])


def test_a_watchdog_that_was_left_is_replaced() -> None:
    controller = Controller()
    Card.open(controller).command("10 REM openacr watchdog", program=7)
    Card.open(controller).command("20 GOTO 20", program=7)
    shop = opened(controller)
    assert listed(controller)[1] == "20 DIM LV(3)"
    assert controller.bit[RUNS]
    shop.close()
    assert (listed(controller), controller.bit[RUNS]) == ([], False)


def test_a_program_with_too_little_memory_is_said_and_left_empty() -> None:
    controller = Controller()
    card = Card.open(controller)
    card.command("SYS")
    card.command("DIM PROG7(100)")
    with pytest.raises(UserError) as refused:
        opened(controller)
    text = str(refused.value)
    assert text.startswith("no memory for the watchdog on the card: DIM PROG7(4096): Re-dim")
    assert text.endswith("; free 4096 bytes for program 7, or disable it (P250125 = -1)")
    assert (listed(controller), controller.p[HEARTBEAT]) == ([], 0)
    said: list[str] = []
    opened(controller, said.append, P250125=-1).close()
    assert said == [NO_WATCHDOG]


def test_memory_that_is_too_small_all_the_same_is_said_and_left_empty(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    controller = Controller()
    command: Callable[..., list[str]] = Card.command

    def small(card: Card, line: str, *, program: int | None = None) -> list[str]:
        if program == 7 and line.startswith("50 "):
            raise RefusedError(line, "Out of memory")
        return command(card, line, program=program)

    monkeypatch.setattr(Card, "command", small)
    with pytest.raises(UserError, match="no memory for the watchdog on the card: 50 LV0=P96"):
        opened(controller)
    assert listed(controller) == []


@pytest.mark.parametrize("room", [0, 4])
def test_a_card_whose_programs_have_no_memory_is_given_some(
    monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    """As cards without automatic shares are; also where some lines had room."""
    controller, sent, has_memory = Controller(), list[str](), False
    command: Callable[..., list[str]] = Card.command

    def small(card: Card, line: str, *, program: int | None = None) -> list[str]:
        nonlocal has_memory
        if program == 7:
            sent.append(line)
            number = line.split()[0]
            if number.isdigit() and int(number) > 10 * room and not has_memory:
                raise RefusedError(line, "Out of memory")
        reply = command(card, line, program=program)
        if line == "DIM PROG7(4096)":
            has_memory = True
        return reply

    monkeypatch.setattr(Card, "command", small)
    shop = opened(controller)
    assert (has_memory, controller.bit[RUNS]) == (True, True)
    assert sent.count("10 REM openacr watchdog") == 2
    assert command(shop.card, "SYS") == []
    assert "DIM PROG7(4096)" in command(shop.card, "DIM")
    shop.close()


@pytest.mark.parametrize("master", [0, 7])
def test_the_program_of_the_master_cannot_be_that_of_the_watchdog(master: int) -> None:
    with pytest.raises(UserError, match=f"P250125 {master}: the watchdog cannot be the program"):
        opened(Controller(), P100005=master, P250125=master)


@pytest.mark.parametrize(("timeout_s", "text"), [(2.0, "2 s"), (3.5, "3.5 s")])
def test_it_trips_when_the_heartbeat_stays_for_the_link_timeout(
    timeout_s: float, text: str
) -> None:
    controller = Controller()
    shop = opened(controller, P250126=timeout_s)
    for _ in range(30):
        shop.step()
    controller.advance(seconds=timeout_s - 0.01)  # cut off right after half a second without a beat
    assert not controller.bit[247]
    controller.advance(seconds=0.6)
    assert controller.bit[247]
    assert shop.card.command("?$V0", program=7) == [
        f"host silent for {text}: feed hold, spindle, coolant, beam off"
    ]
    shop.step()
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [5]
    assert shop.runner.acknowledge() == []
    shop.step()
    assert (controller.bit[247], controller.bit[RUNS]) == (False, True)
    shop.close()
