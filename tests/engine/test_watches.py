"""The engine returns after the tick in which something watched has changed."""

from collections.abc import Callable

import pytest

from openacr.compiled import is_compiled, pick
from openacr.controller import Controller
from openacr.engine import watch_cy
from openacr.engine.watches import WATCHES, Watch, Watched, set_watches
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import axes
from openacr.views import F32, F64, I32

Fired = Callable[[F64, I32, F32], bool]
FORMS = (
    [watch_cy.watch_fired, pick(watch_cy.watch_fired)] if is_compiled else [watch_cy.watch_fired]
)


@pytest.fixture(params=FORMS, ids=["plain", "compiled"][: len(FORMS)])
def fired(request: pytest.FixtureRequest) -> Fired:
    form: Fired = request.param
    return form


@pytest.mark.parametrize(
    ("watch", "row", "values", "seen"),
    [
        (
            Watch(Watched.WORD, 4097, 1 << 2),
            4097,
            [3, 4, 5, 12, 8],
            [False, True, False, False, True],
        ),
        (Watch(Watched.WORD, 4097, -(1 << 31)), 4097, [1, -1, 0], [False, True, True]),
        (Watch(Watched.LONG, 12290, bound=9.5), 12290, [9, 10, 11, 9], [False, True, False, True]),
        (Watch(Watched.LONG, 12290, bound=-1.0, is_above=False), 12290, [-1, -2], [False, True]),
    ],
)
def test_it_fires_in_the_tick_of_a_change(
    fired: Fired, watch: Watch, row: int, values: list[int], seen: list[bool]
) -> None:
    memory = Memory()
    set_watches(memory, [watch])
    found = []
    for value in values:
        memory.I[row] = value
        found.append(fired(memory.F, memory.I, memory.S))
    assert found == seen


def test_real_numbers_and_positions_in_units_are_compared(fired: Fired) -> None:
    memory = Memory()
    memory.S[axes.ppu[0]] = 1000.0
    limits = [
        Watch(Watched.FP32, 8192, bound=0.5),
        Watch(Watched.FP64, at.USER_BASE + 7, bound=2.0),
        Watch(Watched.AXIS, axes.parameters[0], bound=1.5),
    ]
    found = []
    for watch in limits:
        set_watches(memory, [watch])
        memory.S[8192], memory.F[at.USER_BASE + 7] = 0.51, 2.0000001
        memory.I[axes.actual_position[0]] = 1501
        found.append(fired(memory.F, memory.I, memory.S))
        found.append(fired(memory.F, memory.I, memory.S))
        memory.S[8192], memory.F[at.USER_BASE + 7] = 0.0, float("nan")
        memory.I[axes.actual_position[0]] = 1500
        fired(memory.F, memory.I, memory.S)
    assert found == [True, False] * 3


def test_a_run_ends_after_the_tick_of_the_change_and_goes_on_from_there() -> None:
    card = Controller()
    card.send("PROG0\rPROGRAM\rDWL 0.1\rSET 33\rDWL 0.1\rCLR 33\rENDP\rRUN\r")
    card.watch([Watch(Watched.WORD, 4097, 1 << 1)])
    ticks = []
    for _ in range(3):
        card.advance(1000)
        ticks.append(card.tick)
    assert card.memory.bit(33) is False
    assert ticks[0] == pytest.approx(200, abs=4)
    assert ticks[1] - ticks[0] == pytest.approx(200, abs=4)
    assert ticks[2] - ticks[1] == 1000


def test_what_is_watched_and_recorded_is_no_part_of_the_state() -> None:
    card, other = Controller(), Controller()
    card.record(7, keep_peaks=True)
    card.watch([Watch(Watched.LONG, 12290, bound=3.0)] * WATCHES, lambda: False)
    for each in (card, other):
        each.send("PROG0\rPROGRAM\rPRINT 1\rENDP\rRUN\r")
        each.advance(500)
    assert card.digest() == other.digest()


def test_recording_and_watching_go_on_after_a_restart_and_a_snapshot() -> None:
    card = Controller()
    before = card.snapshot()
    card.record(1)
    card.watch([Watch(Watched.WORD, 4097, 1 << 1)])
    card.send("SYS\rREBOOT\r")
    card.advance(50)
    card.restore(before)
    card.advance(50)
    assert card.trace().time_s.size >= 100
    card.bit[33] = True
    tick = card.tick
    card.advance(50)
    assert card.tick == tick + 1
