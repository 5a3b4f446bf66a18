"""Hosts, cards and lines that fail while a real process runs a part over TCP."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.mill.live import Plant, Proxy, until

from openacr.client import Card

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

SPINDLE, FLOOD = 40, 41
CELLS = {800_005: SPINDLE, 800_010: FLOOD, 800_002: 3, 800_001: 0.01}
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
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.freeze()
        until(lambda: "alarm 3: Link lost" in run.text)
        line.thaw()
        assert run.ended() != 0
    assert "Traceback" not in run.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)


def test_a_line_that_is_reset_goes_on_with_the_part_or_ends_it_at_rest(plant: Plant) -> None:
    """It goes on between two actions; in one of them it is not known what the card has done."""
    with Proxy(plant.address) as line:
        part = plant.part("M3 S500\nF120\n" + "G1 X.2\nY.2\nX0\nY0\n" * 4 + "X.5\nM2\n")
        run = plant.mill("run", part, "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.reset()
        code = run.ended()
    assert (plant.outputs(SPINDLE), plant.is_at_rest) == ([False], True)
    if code == 0:
        assert (run.text, plant.places()) == ("", [5000, 0, 0])
    else:
        assert code == 1
        assert "alarm 3: Link lost" in run.text


def test_a_line_that_stays_cut_is_reported_and_given_up(plant: Plant) -> None:
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.cut()
        assert run.ended() == 2
    assert run.text.startswith("alarm 3: Link lost; trying to reach the card\n")
    assert "its watchdog stops it" in run.text
    assert "Traceback" not in run.text
