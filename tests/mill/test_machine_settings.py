"""Settings that are kept, sent to the card and written to files."""

from pathlib import Path

import pytest
from tests.mill.shop import Shop
from tests.mill.test_homing import MACHINE, homing_shop

from openacr.client import Card
from openacr.controller import Controller
from openacr.mill.card.setup import prepare
from openacr.mill.config.settings import Settings
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import Store


@pytest.mark.req("MILL-SYS-AXES-ENCMULT")
@pytest.mark.parametrize(
    ("multiplier", "polarity", "state"),
    [(4, 0, State.IDLE), (-4, 0, State.ALARM), (-4, 1, State.IDLE)],
)
def test_a_negative_multiplier_turns_the_counts_round(
    tmp_path: Path, multiplier: int, polarity: int, state: State
) -> None:
    """The loop runs away, until the drive is turned round, too."""
    (tmp_path / "machine.toml").write_bytes(MACHINE.read_bytes())
    world = Controller.from_project(tmp_path)
    shop = homing_shop(world, P200_011=multiplier, P200_005=polarity, P200_004=3.0)
    shop.load("G90 F600\nG1 X5\nM2\n")
    assert shop.until(State.IDLE, State.ALARM) is state
    if state is State.IDLE:
        assert shop.pulses()[0] == 5 * 800


@pytest.mark.req("MILL-SYS-PERSIST")
def test_saved_values_survive_a_restart_and_are_sent_to_the_card(tmp_path: Path) -> None:
    path = tmp_path / "sysvar.db"
    with Store(path) as store:
        store.write(200_006, 4000.0)
        store.write(150_000, 0.005)
        store.write(350_002, 77.0)
    with Store(path) as again:
        card = Card.open(Controller())
        prepare(card, Settings(again))
        asked = [
            float(card.ask(text, program=0)) for text in ("AXIS0 PPU", "AXIS0 PGAIN", "JOG ACC X")
        ]
    assert asked == pytest.approx([4000.0, 0.005, 77.0])


@pytest.mark.req("MILL-HOME-SELECT")
def test_single_axes_can_be_chosen_for_homing() -> None:
    with Store() as store:
        shop = MillSession.virtual(store, say=lambda _text: None)
        chosen: list[list[int]] = []
        shop.runner.home = lambda axes: chosen.append(list(axes))  # type: ignore[method-assign]
        shop.home("XZ", lambda _shop: None)
        shop.home("", lambda _shop: None)
        shop.close()
    assert chosen == [[0, 2], [0, 1, 2]]


@pytest.mark.req("MILL-G88")
@pytest.mark.parametrize(("level", "z"), [("G98", 10000), ("G99", 1000)])
def test_g88_stops_the_spindle_and_waits_for_a_retract_by_hand(level: str, z: int) -> None:
    shop = Shop(P800_005=40)
    shop.load(f"G90 F600 G0 Z1\nM3 S500\n{level} G88 X1 Z-.5 R.1 P.4\nG80\nM0\nM2\n$I CYCLES.TXT\n")
    shop.until(State.WAIT)
    assert shop.runner.reason == "dwell 0.4 s"
    assert shop.outputs((40,)) == [True]
    assert shop.until(State.HOLD) is State.HOLD
    assert shop.pulses() == (10000, 0, -5000)
    assert shop.outputs((40,)) == [False]
    shop.pass_time(1.0)
    assert shop.runner.state is State.HOLD
    shop.runner.jog(lambda jog: jog.move(2, 1.0, fast=True))
    shop.pass_time(2.0)
    shop.runner.start()
    lowest = 9.0
    while shop.runner.is_busy and lowest > -0.2:
        shop.pass_time(0.005)
        lowest = min(lowest, shop.place()[2])
        if shop.runner.state is State.HOLD:  # the M0 after the cycle
            assert shop.pulses() == (10000, 0, z)
            assert shop.outputs((40,)) == [True]
            shop.runner.start()
    shop.until(State.IDLE)
    assert lowest > 0.0  # it is not sent back down
