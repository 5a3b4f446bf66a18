"""What is remembered of homing, and what the card has forgotten."""

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from openacr.client import Card
from openacr.controller import Controller
from openacr.mill.card import homed
from openacr.mill.card.driver import MachineDriver
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.card.setup import prepare
from openacr.mill.config.settings import HOMED, Settings
from openacr.sysvar import Store


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store(tmp_path / "sysvar.db") as one:
        yield one


def connected(controller: Controller, store: Store) -> MachineIo:
    """What every start of the host does."""
    card = Card.open(controller)
    homed.agree(card, store)
    settings = Settings(store)
    prepare(card, settings)
    return MachineIo(MachineDriver(card, [axis.index for axis in settings.axes]), settings)


@pytest.mark.req("MILL-HOME-POWERCYCLE")
def test_homed_axes_stay_homed_as_long_as_the_card_is_on(store: Store) -> None:
    card = Controller()
    io = connected(card, store)
    homed.note(io, 0, True)
    homed.note(io, 2, True)
    assert store.read(HOMED) == 5
    assert connected(card, store).settings.is_homed(2)  # another start of the host
    homed.lose(io, "Z")
    assert store.read(HOMED) == 1
    after_power = connected(Controller(), store)
    assert store.read(HOMED) == 0
    assert not after_power.settings.is_homed(0)


@pytest.mark.req("MILL-HOME-POWERCYCLE")
def test_a_card_whose_battery_keeps_its_variables_loses_its_position_all_the_same(
    store: Store, tmp_path: Path
) -> None:
    with closing(Controller("ACR8020", data=tmp_path / "card")) as card:
        io = connected(card, store)
        io.machine.write(50, 7.0)
        homed.note(io, 0, True)
        assert connected(card, store).settings.is_homed(0)
        card.advance(seconds=3)
    with closing(Controller("ACR8020", data=tmp_path / "card")) as card:
        after_power = connected(card, store)
        assert after_power.machine.read(50) == 7.0
        assert not after_power.settings.is_homed(0)
