"""What stops of a program cost on the virtual machine: hardly more than their own time."""

import pytest
from tests.mill.prediction import predicted

from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.mill.config.settings import Settings
from openacr.mill.session import POLL_S, MillSession, Start
from openacr.sysvar import Store

STOPS = 20
LOST_S = 0.0025  # at most for a stop: two or three answers of the card, a millisecond each


def lost_s(between: str) -> float:
    """How much longer than predicted a run takes, for each of its stops."""
    moves = (f"G1 X{k % 2}.{k:02}\n{between}\n" for k in range(STOPS))
    text = "F60\n" + "".join(moves) + "M2\n"
    store = Store()
    shop = MillSession.virtual(store, say=lambda _text: None)
    plan = Interpreter(load(text, store), Shadow(store), VirtualMachine())
    expected_s = predicted(plan.entries(), Settings(store), (0.0,) * 8).time_s
    card = shop.virtual_card
    assert card is not None
    begin_s = card.time_s
    shop.start(load(text, shop.cells), Start())
    while shop.runner.is_busy:
        shop.step()
    assert shop.runner.alarms.active == []
    return (card.time_s - begin_s - expected_s) / STOPS


@pytest.mark.parametrize("between", ["M8", "G4 F.11", "G4 F.119"])
def test_the_virtual_machine_does_not_wait_for_a_poll_at_a_stop(between: str) -> None:
    assert 0.0 < lost_s(between) < LOST_S


def test_a_step_without_a_change_of_motion_takes_a_poll() -> None:
    shop = MillSession.virtual(Store(), say=lambda _text: None)
    card = shop.virtual_card
    assert card is not None
    shop.step()
    begin_s = card.time_s
    shop.step()
    assert POLL_S <= card.time_s - begin_s < 2 * POLL_S
