"""Two programs never drive one machine, also while the first one only waits."""

from pathlib import Path

import pytest

from openacr.client import Card
from openacr.cnc.load import load
from openacr.controller import Controller
from openacr.errors import OpenacrError
from openacr.mill.owner import HEARTBEAT, Owner
from openacr.mill.states import State
from openacr.mill.workshop import Start, Workshop
from openacr.sysvar import Store


def opened(controller: Controller, store: Store) -> Workshop:
    return Workshop.real(controller, store, lambda _text: None)


def dwelling(controller: Controller, store: Store) -> Workshop:
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


def test_programs_of_other_stores_hear_that_somebody_drives_the_card(
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


def test_a_program_that_was_killed_bars_nobody(tmp_path: Path) -> None:
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
