"""A card on for weeks: ticks beyond 2**31 and 2**32 are ticks like all others, on both builds."""

import os
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from tests.kernel.rig import Rig
from tests.parity.long_life import BEFORE, card, live, paced

from openacr import compiled
from openacr.controller import Controller, engine_run
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.kernel.sources import clock_cy
from openacr.map.rows import system

ROOT = Path(__file__).parents[2]
CROSSINGS = [2**31, 2**32, 3 * 2**31]
BUILDS = [clock_cy.clock_step, compiled.pick(clock_cy.clock_step)]


@cache
def young() -> list[tuple[object, ...]]:
    """The life of a card that has just been switched on."""
    return list(live(card(0)))


def test_the_life_is_waiting_for_everything_when_it_crosses() -> None:
    """DWL in loops and typed, INH and IHPOS with and without timeout, a timer, a jog, moves."""
    at_100_ms = next(seen for seen in young() if seen[1] == 176)
    *_, last = young()
    assert at_100_ms[3:9] == (3.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert last[3:9] == (11.0, 114.0, 165.0, 189.0, 300.0, 300.0)
    assert (at_100_ms[-1], last[-1]) == (0, 2 + 256)  # outputs of the PLC and of the program


@pytest.mark.parametrize("crossing", CROSSINGS)
def test_programs_plcs_waits_jogs_and_moves_cross_the_tick(crossing: int) -> None:
    made = card(crossing - BEFORE)
    assert list(live(made)) == young()
    assert made.tick == crossing - BEFORE + young()[-1][1]  # type: ignore[operator]


@pytest.mark.skipif(not compiled.is_compiled, reason="needs both builds")
@pytest.mark.parametrize("crossing", CROSSINGS)
def test_the_other_build_crosses_it_alike(crossing: int) -> None:
    pure = subprocess.run(
        [sys.executable, "-m", "tests.parity.long_life", str(crossing - BEFORE)],
        env=os.environ | {"OPENACR_PURE": "1", "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT}"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert pure.stdout.splitlines() == [str(seen) for seen in young()]


@pytest.mark.parametrize("step", BUILDS)
@pytest.mark.parametrize("crossing", CROSSINGS)
def test_the_clock_counts_on(step: Callable[..., None], crossing: int) -> None:
    rig = Rig()
    rig.I[system.tick_high] = (crossing - 2) >> 31
    rig.I[system.tick_low] = (crossing - 2) & 2**31 - 1
    seen = []
    for _ in range(4):
        step(rig.F, rig.I, rig.card.clock.period_s)
        seen.append((rig.card.clock.tick, rig.F[system.time_s]))
    assert seen == [(crossing + past, (crossing + past) * 0.0005) for past in (-1, 0, 1, 2)]


@pytest.mark.parametrize("crossing", CROSSINGS)
def test_a_journal_is_replayed_across_it(crossing: int, tmp_path: Path) -> None:
    made = card(crossing - BEFORE)
    made.recorder = Recorder(made, tmp_path / "a.journal")
    list(live(made))
    made.advance(seconds=1.1)  # one digest of every second
    made.close()
    journal = read_journal(tmp_path / "a.journal")
    assert journal.header.tick == crossing - BEFORE
    replay = Replay(journal)
    replay.run()
    assert replay.difference is None
    assert (replay.card.lived_tk, replay.card.digest()) == (made.lived_tk, made.digest())


@pytest.mark.parametrize("crossing", CROSSINGS)
def test_pacing_keeps_its_course_across_it(crossing: int) -> None:
    assert paced(card(crossing - BEFORE)) == paced(card(0))


def test_time_can_pass_in_runs_longer_than_one_of_the_engine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(engine_run, "LONGEST_RUN_TK", 100)
    made = Controller()
    made.advance(350)
    assert made.tick == 350
    assert not made.until(5, timeout_s=1.0)
    assert made.tick == 2350


def test_a_wait_for_a_flag_may_be_longer_than_2_to_the_31_ticks() -> None:
    made = Controller()
    assert made.until(82, timeout_s=3e6)
    assert made.time_s < 1.1
