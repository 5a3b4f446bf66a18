"""Hosts, cards and lines that fail while a real process runs a part over TCP."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.mill.live import Plant, until
from tests.proxy import Proxy

from openacr.client import Card

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

SPINDLE, FLOOD = 40, 41
CELLS = {800_005: SPINDLE, 800_010: FLOOD, 800_002: 3, 800_001: 0.01}
LINK_TIMEOUT, SHORTEST_S = 250_126, 1.5
PATIENT_S = 20.0  # for hosts that have to live on a busy computer
LONG = "M3 S500\nM8\nF60\nG1 X100\nM2\n"


@pytest.fixture
def plant(tmp_path: Path) -> Iterator[Plant]:
    made = Plant(tmp_path)
    made.wire(CELLS)
    yield made
    made.close()


def test_a_kill_of_another_terminal_ends_a_run_over_a_link(plant: Plant) -> None:
    run = plant.mill("run", plant.part(LONG), "--quiet")
    until(lambda: plant.is_moving)
    with Card.open(plant.address) as other:
        other.kill_all()
    assert run.ended() == 1
    assert "alarm 14: Card killed moves" in run.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)


def test_a_line_that_freezes_for_long_ends_the_program_at_rest(plant: Plant) -> None:
    plant.wire({LINK_TIMEOUT: SHORTEST_S})
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.freeze()
        until(lambda: "alarm 3: Link lost" in run.text)
        line.thaw()
        assert run.ended() != 0
    assert "Traceback" not in run.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)


def test_a_line_that_is_reset_again_and_again_goes_on_with_the_part(plant: Plant) -> None:
    plant.wire({LINK_TIMEOUT: PATIENT_S})
    with Proxy(plant.address) as line:
        part = plant.part("M3 S500\nF60\n" + "G1 X.2\nY.2\nX0\nY0\n" * 6 + "X.5\nM2\n")
        run = plant.mill("run", part, "--quiet", host=line.address)
        for _ in range(4):
            until(lambda: plant.is_moving)
            line.reset()
        assert (run.ended(), run.text) == (0, "")
    assert (plant.outputs(SPINDLE), plant.places()) == ([False], [5000, 0, 0])


def test_a_line_that_stays_cut_is_reported_and_given_up(plant: Plant) -> None:
    plant.wire({LINK_TIMEOUT: SHORTEST_S})
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.cut()
        assert run.ended() == 2
    assert run.text.startswith("alarm 3: Link lost; trying to reach the card\n")
    assert "its watchdog stops it" in run.text
    assert "Traceback" not in run.text
