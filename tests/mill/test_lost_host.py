"""The watchdog on the card, when the process that drives a real machine is killed or stopped."""

import signal
import sys
import time
from pathlib import Path

import pytest
from tests.mill.live import (
    FLOOD,
    LINK_TIMEOUT,
    LONG,
    PATIENT_S,
    SPINDLE,
    SPINDLE_CELLS,
    Plant,
    serial_line,
)
from tests.proxy import Proxy
from tests.waiting import until

from openacr.cnc.occupied import TRIPPED

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

DAC3 = 6448
WATCHDOG_RUNS = 1248
SHORT_S = 3.0


def require_stopped(plant: Plant) -> None:
    """What the watchdog does within its time; the hold ends a moment later."""
    plant.trip()
    until(lambda: plant.outputs(SPINDLE, FLOOD) == [False, False])
    until(lambda: plant.is_at_rest)
    assert plant.card.read(DAC3) == 0.0
    assert 0 < plant.places()[0] < 950_000


def test_a_host_that_is_killed_is_noticed_by_the_card_and_reported_to_the_next(
    plant: Plant,
) -> None:
    run = plant.mill("run", plant.part(LONG), "--quiet")
    until(lambda: plant.is_moving)
    assert plant.card.read_bit(WATCHDOG_RUNS)
    run.signal(signal.SIGKILL)
    run.ended()
    require_stopped(plant)
    place = plant.places()
    plant.card.write_bit(SPINDLE, True)  # until an operator has acknowledged it stays off
    until(lambda: not plant.card.read_bit(SPINDLE))

    plant.wire({LINK_TIMEOUT: SHORT_S})  # as long as a new host listens for others
    again = plant.mill("run", plant.part(LONG), "--quiet")
    assert again.ended() == 2
    assert "the watchdog has stopped the machine: host silent for 60 s: feed hold" in again.text
    assert "alarm 5: Watchdog of the card stopped the machine: its host was lost" in again.text
    assert plant.places() == place

    cleared = plant.mill("acknowledge")
    assert cleared.ended() == 0
    assert (plant.card.read_bit(TRIPPED), plant.card.read_bit(WATCHDOG_RUNS)) == (False, False)
    assert plant.card.command("LIST", program=7) == []

    plant.wire({LINK_TIMEOUT: PATIENT_S})
    third = plant.mill("run", plant.part("G90 F600\nG1 X0\nM2\n"), "--quiet")
    assert (third.ended(), third.text) == (0, "")
    assert plant.places() == [0, 0, 0]


def test_a_host_that_was_stopped_for_long_does_not_go_on(plant: Plant) -> None:
    run = plant.mill("run", plant.part(LONG), "--quiet")
    until(lambda: plant.is_moving)
    run.signal(signal.SIGSTOP)
    require_stopped(plant)
    place = plant.places()
    run.signal(signal.SIGCONT)
    assert run.ended() == 1
    assert "alarm 5: " in run.text
    assert (plant.places(), plant.outputs(SPINDLE, FLOOD)) == (place, [False, False])


def test_a_line_that_is_cut_for_good_is_noticed_by_the_card(plant: Plant) -> None:
    with Proxy(plant.address) as line:
        plant.mill("run", plant.part(LONG), "--quiet", host=line.address)
        until(lambda: plant.is_moving)
        line.cut()
        require_stopped(plant)


def test_a_host_on_a_serial_line_that_is_killed_is_noticed_by_the_card(tmp_path: Path) -> None:
    with serial_line() as (near, far):
        plant = Plant(tmp_path, "--serial", far)
        try:
            plant.wire(SPINDLE_CELLS)
            run = plant.mill("run", plant.part(LONG), "--quiet", host=near)
            until(lambda: plant.is_moving)
            run.signal(signal.SIGKILL)
            run.ended()
            require_stopped(plant)
        finally:
            plant.close()


def test_a_host_that_is_signalled_to_end_switches_off_and_takes_its_watchdog_away(
    plant: Plant,
) -> None:
    for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
        run = plant.mill("run", plant.part(LONG), "--quiet")
        until(lambda: plant.is_moving)
        run.signal(number)
        assert run.ended() == 130
        assert "interrupted: the machine is at rest at X" in run.text
        assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)
        assert (plant.card.read_bit(WATCHDOG_RUNS), plant.card.ask("P96")) == (False, 0)


def test_a_machine_is_stopped_that_another_program_drives(plant: Plant) -> None:
    """Also a host that is stopped itself, and that finds everything barred when it goes on."""
    run = plant.mill("run", plant.part(LONG), "--quiet")
    until(lambda: plant.is_moving)
    stopped = plant.mill("stop")
    assert stopped.ended() == 0
    assert "switched off: output 40\nswitched off: output 41\nswitched off: DAC3\n" in stopped.text
    assert "the machine is at rest at X" in stopped.text
    assert (plant.outputs(SPINDLE, FLOOD), plant.is_at_rest) == ([False, False], True)
    assert run.ended() == 1
    # The kill stays while the host sends more; one that wakes late finds the axes elsewhere.
    assert run.text.startswith(("alarm 14: Card killed moves", "alarm 16: Machine was moved by"))
    assert plant.mill("acknowledge").ended() == 0


def test_a_jog_whose_host_is_killed_comes_to_rest(plant: Plant) -> None:
    plant.wire({200_007: 0})
    jog = plant.mill("jog", "X17")
    until(lambda: plant.places()[0] > 100)
    jog.signal(signal.SIGKILL)
    jog.ended()
    plant.trip()
    until(lambda: plant.is_at_rest)
    assert plant.places()[0] < 120_000


def test_a_drip_that_is_interrupted_comes_to_rest_and_closes_its_line_last(
    plant: Plant,
) -> None:
    with serial_line() as (near, far):
        drip = plant.mill("drip", "--port", near)
        until(lambda: plant.card.read_bit(WATCHDOG_RUNS))
        with open(far, "wb", buffering=0) as sender:
            for _ in range(100):
                if plant.is_moving:
                    break
                sender.write(b"M8\nF60\n" + b"G1 X50\nX0\n" * 30)
                time.sleep(0.1)
            until(lambda: plant.is_moving)
            drip.signal(signal.SIGINT)
            assert drip.ended() == 130
    assert "Traceback" not in drip.text
    assert "interrupted: the machine is at rest at X" in drip.text
    assert (plant.outputs(FLOOD), plant.is_at_rest) == ([False], True)
