"""Hosts, cards and lines that fail while a real process runs a part over TCP."""

import sys
from functools import partial

import pytest
from tests.mill.live import FLOOD, LINK_TIMEOUT, LONG, SPINDLE, Plant, Process
from tests.proxy import Proxy
from tests.waiting import until

from openacr.client import Card

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

SHORT_S = 2.5


def test_a_kill_of_another_terminal_ends_a_run_over_a_link(plant: Plant) -> None:
    run = plant.mill("run", plant.part(LONG), "--quiet")
    until(lambda: plant.is_moving)
    with Card.open(plant.address) as other:
        other.kill_all()
    assert run.ended() == 1
    assert "alarm 14: Card killed moves" in run.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)


def test_a_line_that_freezes_for_long_ends_the_program_at_rest(plant: Plant) -> None:
    plant.wire({LINK_TIMEOUT: SHORT_S})
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.freeze()
        until(lambda: "alarm 3: Link lost" in run.text)
        line.thaw()
        assert run.ended() != 0
    assert "Traceback" not in run.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)


def is_in_use(line: Proxy, before: int, run: Process) -> bool:
    """Whether the line is in use again, or the part is finished."""
    return line.passed > before or not run.is_alive


def test_a_line_that_is_reset_again_and_again_goes_on_with_the_part(plant: Plant) -> None:
    with Proxy(plant.address) as line:
        part = plant.part("M3 S500\nF120\n" + "G1 X.2\nY.2\nX0\nY0\n" * 6 + "X.5\nM2\n")
        run = plant.mill("run", part, "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        for _ in range(4):
            before = line.passed
            line.reset()
            until(partial(is_in_use, line, before, run), about=run.text)
        assert (run.ended(), run.text) == (0, "")
    assert (plant.outputs(SPINDLE), plant.places()) == ([False], [5000, 0, 0])


def test_a_line_that_stays_cut_is_reported_and_given_up(plant: Plant) -> None:
    plant.wire({LINK_TIMEOUT: SHORT_S})
    with Proxy(plant.address) as line:
        run = plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.cut()
        assert run.ended() == 2
    assert run.text.startswith("alarm 3: Link lost; trying to reach the card\n")
    assert "its watchdog stops it" in run.text
    assert "Traceback" not in run.text
