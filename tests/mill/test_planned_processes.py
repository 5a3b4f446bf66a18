"""Hosts of a planned path that are killed, frozen or cut off: real processes, tick by tick."""

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest
from tests.mill.live import Plant, Process, serial_line
from tests.mill.planned import ACCEL, JERK, SPEED, TOLERANCE, Reals, highest, off_path, wave
from tests.mill.test_planned_lost_host import PULSES, ROUNDING, cells, text_of
from tests.proxy import Proxy
from tests.waiting import until

from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")

SPINDLE, FLOOD = 40, 41
CELLS = {800_005: SPINDLE, 800_010: FLOOD, 800_002: 3, 800_001: 0.01}
LINK_TIMEOUT, PATIENT_S = 250_126, 60.0  # for hosts that have to live on a busy computer
BEGUN_CNT = 100_000
POINTS = wave(5000)  # some 20 s at full speed


@contextmanager
def opened(folder: Path, *words: str) -> Iterator[Plant]:
    """A card whose life is kept, for a machine that plans its paths."""
    plant = Plant(folder, *words, is_journalled=True)
    try:
        plant.wire(CELLS | cells() | {LINK_TIMEOUT: PATIENT_S})
        yield plant
    finally:
        plant.close()


def part_of(plant: Plant) -> str:
    return plant.part("M3 S500\nM8\n" + text_of(POINTS))


def is_beyond(plant: Plant, place_cnt: int) -> bool:
    return plant.places()[0] > place_cnt


def start(plant: Plant, host: str = "", *, begun_cnt: int = BEGUN_CNT) -> Process:
    """A run whose tool has gone as far; it is then at full speed unless another place is named."""
    run = plant.mill("run", part_of(plant), "--dialect", "rs274ngc", "--quiet", host=host)
    until(lambda: plant.places()[0] >= begun_cnt, about=run.text)
    return run


def rest_and_trip(plant: Plant) -> None:
    """The path runs short, or has just run short of a host that was late; then it trips."""
    until(lambda: plant.is_at_rest)
    plant.trip()


def require_rest_on_the_path(plant: Plant) -> None:
    """All off and at rest, and no limit exceeded in any tick on the way."""
    rest_and_trip(plant)
    until(lambda: plant.outputs(SPINDLE, FLOOD) == [False, False])
    places = require_limits(plant)
    assert off_path(places[::20], POINTS[:1000]) <= 3 * TOLERANCE
    assert 10.0 < places[-1][0] < POINTS[-1][0] - 100.0


def require_limits(plant: Plant, *, at_least: float = 0.2 * SPEED) -> Reals:
    """No limit was exceeded in any tick, however late the host was on this computer."""
    rows = [axes.psp_cnt[axis] for axis in range(3)]
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
    with opened(tmp_path) as plant, Proxy(plant.address) as line:
        lose(start(plant, line.address), line)
        require_rest_on_the_path(plant)


@pytest.mark.parametrize("begun_cnt", [1, 20_000])
def test_the_card_rests_within_the_limits_of_a_host_that_is_killed_early(
    tmp_path: Path, begun_cnt: int
) -> None:
    with opened(tmp_path) as plant:
        start(plant, begun_cnt=begun_cnt).signal(signal.SIGKILL)
        rest_and_trip(plant)
        require_limits(plant, at_least=0.0)


def test_a_host_that_is_suspended_again_and_again_goes_on_within_the_limits(tmp_path: Path) -> None:
    with opened(tmp_path) as plant:
        run = start(plant)
        for pause_s in (0.1, 0.3, 0.6, 0.2):
            before = plant.places()[0]
            run.signal(signal.SIGSTOP)
            time.sleep(pause_s)
            run.signal(signal.SIGCONT)
            until(partial(is_beyond, plant, before + BEGUN_CNT), about=run.text)
        assert run.is_alive
        run.signal(signal.SIGKILL)
        rest_and_trip(plant)
        require_limits(plant)


def test_the_card_rests_on_the_path_of_a_host_on_a_serial_line(tmp_path: Path) -> None:
    with serial_line() as (near, far), opened(tmp_path, "--serial", far) as plant:
        start(plant, near).signal(signal.SIGKILL)
        require_rest_on_the_path(plant)
