"""Hosts of a planned path that are killed, frozen or cut off: real processes, tick by tick."""

import signal
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from tests.mill.live import Plant, Process, serial_line, until
from tests.mill.planned import ACCEL, JERK, SPEED, TOLERANCE, Reals, highest, off_path, wave
from tests.mill.test_planned_lost_host import PULSES, ROUNDING, cells, text_of
from tests.proxy import Proxy

from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map import numbers as n

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

SPINDLE, FLOOD = 40, 41
CELLS = {800_005: SPINDLE, 800_010: FLOOD, 800_002: 3, 800_001: 0.01}
LINK_TIMEOUT, PATIENT_S = 250_126, 4.0
TRIPPED = 247
BEGUN_CNT = 100_000
POINTS = wave(5000)  # some 20 s at full speed


def wire(plant: Plant) -> None:
    plant.wire(CELLS | cells() | {LINK_TIMEOUT: PATIENT_S})


def part_of(plant: Plant) -> str:
    return plant.part("M3 S500\nM8\n" + text_of(POINTS))


def is_beyond(plant: Plant, place_cnt: int) -> bool:
    return plant.places()[0] > place_cnt


def start(plant: Plant, host: str = "") -> Process:
    """A run whose tool is at full speed."""
    run = plant.mill("run", part_of(plant), "--dialect", "rs274ngc", "--quiet", host=host)
    until(lambda: plant.places()[0] > BEGUN_CNT, about=run.text)
    return run


def require_rest_on_the_path(plant: Plant) -> None:
    """All off and at rest, and no limit exceeded in any tick on the way."""
    until(lambda: plant.card.read_bit(TRIPPED))
    until(lambda: plant.outputs(SPINDLE, FLOOD) == [False, False])
    until(lambda: plant.is_at_rest)
    places = require_limits(plant)
    assert off_path(places[::20], POINTS[:1000]) <= 3 * TOLERANCE
    assert 10.0 < places[-1][0] < POINTS[-1][0] - 100.0


def require_limits(plant: Plant, *, at_least: float = 0.2 * SPEED) -> Reals:
    """No limit was exceeded in any tick, however late the host was on this computer."""
    rows = [n.AXF_BASE + axis * n.AXF_STRIDE + n.AXF_PSP_CNT for axis in range(3)]
    period_s = 0.0005
    trace = plant.lived_again(*(Sample(Watched.FP64, row) for row in rows))
    places = trace.values / PULSES
    speed, accel, jerk = highest(places, period_s)
    assert at_least < speed <= SPEED * (1 + 1e-4)
    assert accel <= ACCEL * (1 + 1e-4)
    assert jerk <= JERK * (1 + ROUNDING)
    return places


def kill(run: Process, _line: Proxy) -> None:
    run.signal(signal.SIGKILL)


def freeze(run: Process, _line: Proxy) -> None:
    run.signal(signal.SIGSTOP)


def cut(_run: Process, line: Proxy) -> None:
    line.cut()


def stall(_run: Process, line: Proxy) -> None:
    line.freeze()


@pytest.mark.parametrize("lose", [kill, freeze, cut, stall])
def test_the_card_rests_on_the_path_of_a_host_that_is_lost(
    tmp_path: Path, lose: Callable[[Process, Proxy], None]
) -> None:
    plant = Plant(tmp_path, is_journalled=True)
    try:
        wire(plant)
        with Proxy(plant.address) as line:
            run = start(plant, line.address)
            lose(run, line)
            require_rest_on_the_path(plant)
    finally:
        plant.close()


@pytest.mark.parametrize("begun_cnt", [1, 2_000, 20_000])
def test_the_card_rests_within_the_limits_of_a_host_that_is_killed_early(
    tmp_path: Path, begun_cnt: int
) -> None:
    plant = Plant(tmp_path, is_journalled=True)
    try:
        wire(plant)
        run = plant.mill("run", part_of(plant), "--dialect", "rs274ngc", "--quiet")
        until(lambda: plant.places()[0] >= begun_cnt, about=run.text)
        run.signal(signal.SIGKILL)
        until(lambda: plant.card.read_bit(TRIPPED))
        until(lambda: plant.is_at_rest)
        require_limits(plant, at_least=0.0)
    finally:
        plant.close()


def test_a_host_that_is_suspended_again_and_again_goes_on_within_the_limits(tmp_path: Path) -> None:
    plant = Plant(tmp_path, is_journalled=True)
    try:
        wire(plant)
        plant.wire({LINK_TIMEOUT: 20.0})
        run = start(plant)
        for pause_s in (0.1, 0.3, 0.6, 0.2):
            before = plant.places()[0]
            run.signal(signal.SIGSTOP)
            time.sleep(pause_s)
            run.signal(signal.SIGCONT)
            until(partial(is_beyond, plant, before + BEGUN_CNT), about=run.text)
        assert run.is_alive
        run.signal(signal.SIGKILL)
        until(lambda: plant.card.read_bit(TRIPPED))
        until(lambda: plant.is_at_rest)
        require_limits(plant)
    finally:
        plant.close()


def test_the_card_rests_on_the_path_of_a_host_on_a_serial_line(tmp_path: Path) -> None:
    with serial_line() as (near, far):
        plant = Plant(tmp_path, "--serial", far, is_journalled=True)
        try:
            wire(plant)
            start(plant, near).signal(signal.SIGKILL)
            require_rest_on_the_path(plant)
        finally:
            plant.close()
