"""Two programs never drive one machine, also while the first one only waits."""

from pathlib import Path

import pytest

from openacr.client import Card
from openacr.cnc.loading.load import load
from openacr.cnc.occupied import HEARTBEAT
from openacr.controller import Controller
from openacr.errors import OpenacrError
from openacr.mill.card.owner import BEAT_S, BEATS, LISTEN_S, SETTLE_S, Owner
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.lookup import known
from openacr.sysvar.tabs import CONTROL


def opened(controller: Controller, store: Store) -> MillSession:
    return MillSession.real(controller, store, lambda _text: None)


def dwelling(controller: Controller, store: Store) -> MillSession:
    shop = opened(controller, store)
    shop.start(load("G4 F100\nM2\n", store), Start())
    for _ in range(50):
        shop.step()
    assert shop.runner.state is State.WAIT
    return shop


def test_programs_of_one_store_are_kept_apart_while_nothing_moves(tmp_path: Path) -> None:
    controller = Controller()
    with Store(tmp_path / "sysvar.db") as store, Store(tmp_path / "sysvar.db") as same:
        first = dwelling(controller, store)
        with pytest.raises(OpenacrError, match="another program drives this machine"):
            opened(controller, same)
        first.step()
        assert first.runner.state is State.WAIT  # nothing was set up under it
        first.close()
        opened(controller, same).close()


def test_programs_of_other_stores_hear_that_another_program_drives_the_card(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    controller = Controller()
    first = dwelling(controller, Store())
    second = Card.open(controller)

    def pause(seconds: float) -> None:
        for _ in range(round(seconds / 0.02)):
            first.step()

    monkeypatch.setattr(second, "pause", pause)
    with pytest.raises(OpenacrError, match="another program drives this machine"):
        Owner(second, None)


def test_a_program_that_was_killed_bars_no_other(tmp_path: Path) -> None:
    controller = Controller()
    with Store(tmp_path / "sysvar.db") as store:
        dwelling(controller, store)._owner._unlock()  # type: ignore[union-attr]
        assert controller.p[HEARTBEAT] > 0
        shop = opened(controller, store)
        shop.close()
        assert controller.p[HEARTBEAT] == 0


def test_a_set_up_that_fails_lets_the_machine_go(tmp_path: Path) -> None:
    controller = Controller()
    with Store(tmp_path / "sysvar.db") as store:
        store.write(950_010, 1)  # a ballscrew table without a file
        for _ in range(2):
            with pytest.raises(OpenacrError, match="has no file"):
                opened(controller, store)


def test_of_two_programs_that_begin_together_one_has_the_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The second one reads the variable before the first one has taken it."""
    controller = Controller()
    first, second = Card.open(controller), Card.open(controller)
    first.command("SYS")
    first.command("DIM P(100)")
    owners = []
    command = second.command

    def late(line: str, *, program: int | None = None) -> list[str]:
        owners.append(Owner(first, None))
        return command(line, program=program)

    monkeypatch.setattr(second, "command", late)
    with pytest.raises(OpenacrError, match="another program drives this machine"):
        Owner(second, None)
    assert owners[0].is_ours()
    assert int(controller.p[HEARTBEAT]) // BEATS == owners[0]._number


def test_a_variable_that_was_left_is_taken_by_one_of_two(monkeypatch: pytest.MonkeyPatch) -> None:
    controller = Controller()
    first, second = Card.open(controller), Card.open(controller)
    first.command("SYS")
    first.command("DIM P(100)")
    first.command("P96=5")
    owners = []
    command = second.command

    def late(line: str, *, program: int | None = None) -> list[str]:
        owners.append(Owner(first, None))
        return command(line, program=program)

    monkeypatch.setattr(second, "command", late)
    with pytest.raises(OpenacrError, match="another program drives this machine"):
        Owner(second, None)
    assert (owners[0].is_ours(), owners[0].found) == (True, 5)


def test_a_program_whose_machine_was_taken_sends_nothing_more() -> None:
    controller = Controller()
    with Store() as store:
        shop = opened(controller, store)
        shop.start(load("G4 F100\nM2\n", store), Start())
        shop.step()
        controller.p[HEARTBEAT] = 7 * BEATS
        controller.set_input(0, False)
        with pytest.raises(OpenacrError, match="alarm 8: Another program has taken the machine"):
            for _ in range(100):
                shop.step()
        state = shop.runner.state
        with pytest.raises(OpenacrError, match="another program drives the machine"):
            shop.machine.set_flag(40, True)
        shop.close()
    assert (state, shop.runner.is_busy) == (State.ALARM, False)
    assert controller.p[HEARTBEAT] == 7 * BEATS
    assert controller.bit[1248]  # the watchdog is that of the other program now


def test_a_host_counts_often_enough_for_others_and_for_the_watchdog() -> None:
    """Others listen for three beats at least, and no link timeout is shorter than that."""
    shortest_s = known(CONTROL.link_timeout).row.low
    assert shortest_s is not None
    assert (BEAT_S, LISTEN_S, SETTLE_S) == (0.5, 1.6, 0.1)
    assert LISTEN_S > 3 * BEAT_S
    assert shortest_s >= 3 * BEAT_S
