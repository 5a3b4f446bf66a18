"""What each instruction does to flags, and when."""

import pytest
from tests.plc.rack import Rack

from openacr.map.rows import system

TIMER_INPUT, TIMER_OUTPUT = 1553, 1552
COUNTER_OUTPUT, COUNTER_CLOCK, COUNTER_RESET = 1556, 1557, 1558
TICK_PRELOAD, TICK_COUNT = 6656, 6657
TIMER_PRELOAD, TIMER_COUNT, COUNTER_PRELOAD, COUNTER_COUNT = 6660, 6661, 6662, 6663
RUNNING, FIRST_SCAN = 1536, 1537
MS = 2  # ticks


@pytest.fixture
def rack() -> Rack:
    return Rack()


# scans


def test_plc_0_scans_before_plc_1_in_the_same_interrupt(rack: Rack) -> None:
    rack.program("LD 128 OUT 129", plc=1)
    rack.program("LD 0 OUT 128", "LD 129 OUT 130", plc=0)
    rack.put(True, 0)
    rack.step()
    assert [rack.on(bit) for bit in (128, 129, 130)] == [True, True, False]
    rack.step()
    assert rack.on(130)


@pytest.mark.parametrize(("preload", "every"), [(1, 1), (2, 2), (7, 7), (0, 1), (-5, 1)])
def test_the_preload_is_the_number_of_ticks_from_scan_to_scan(
    rack: Rack, preload: int, every: int
) -> None:
    rack.write(TICK_PRELOAD, preload)
    rack.program("LD NOT 32 OUT 32")
    scans = []
    before = False
    for tick in range(30):
        rack.step()
        if rack.on(32) != before:
            scans.append(tick)
        before = rack.on(32)
    assert scans == list(range(0, 30, every))


def test_a_new_card_scans_in_every_interrupt(rack: Rack) -> None:
    assert all(rack.p(TICK_PRELOAD + 16 * plc) == 1 for plc in range(8))


def test_the_tick_count_shows_how_long_it_is_to_the_next_scan(rack: Rack) -> None:
    rack.write(TICK_PRELOAD, 4)
    rack.program("LD 0 OUT 32")
    counts = []
    for _ in range(5):
        rack.step()
        counts.append(rack.p(TICK_COUNT))
    assert counts == [4, 3, 2, 1, 4]
    rack.write(TICK_COUNT, -(2**31))
    rack.step()
    assert rack.p(TICK_COUNT) == 4


def test_first_scan_is_set_during_the_first_scan_only(rack: Rack) -> None:
    rack.program(f"LD {FIRST_SCAN} OUT 32", "LD 1537 SET 33")
    assert rack.on(RUNNING) and rack.on(FIRST_SCAN)
    rack.step()
    assert not rack.on(FIRST_SCAN)
    assert rack.on(32) and rack.on(33)
    rack.step()
    assert not rack.on(32) and rack.on(33)
    rack.plcs.run(0)
    rack.step()
    assert rack.on(32)


def test_halt_leaves_outputs_and_ends_scanning(rack: Rack) -> None:
    rack.program("LD 0 OUT 32")
    rack.put(True, 0)
    rack.step()
    rack.plcs.halt(0)
    assert not rack.plcs.is_running(0)
    rack.put(False, 0)
    rack.step(5)
    assert rack.on(32)


def test_a_shorter_text_runs_without_the_rest_of_the_longer_one(rack: Rack) -> None:
    rack.program("LD 0 OUT 32", "LD 0 OUT 33")
    rack.program("LD 0 OUT 32")
    rack.put(True, 0)
    rack.step()
    assert rack.on(32) and not rack.on(33)


def test_a_plc_without_instructions_does_nothing(rack: Rack) -> None:
    rack.program("REM nothing")
    flags = bytes(rack.memory.I[4096:4112])
    rack.step(3)
    assert rack.plcs.is_running(0)
    assert bytes(rack.memory.I[4096:4112]) == flags


# timers


@pytest.mark.parametrize(
    ("period_s", "expected_tk"),
    [(0.0005, 1000), (0.0002, 2500), (0.001, 500), (0.002, 250), (0.0003, 1667)],
)
def test_a_timer_output_comes_half_a_second_after_its_input(
    rack: Rack, period_s: float, expected_tk: int
) -> None:
    rack.memory.F[system.period_s] = period_s
    rack.program("LD 0 OUT 32 TIM 0 500", "LD TIM0 OUT 33")
    rack.step(7)
    rack.put(True, 0)
    rack.step()
    ticks = 0
    while not rack.on(33):
        rack.step()
        ticks += 1
    assert ticks == expected_tk


def test_a_timer_shows_its_milliseconds(rack: Rack) -> None:
    rack.write(TIMER_PRELOAD, 3)
    rack.step()
    assert rack.p(TIMER_COUNT) == 3
    rack.put(True, TIMER_INPUT)
    counts = []
    for _ in range(4 * MS):
        rack.step()
        counts.append((rack.p(TIMER_COUNT), rack.on(TIMER_OUTPUT)))
    assert counts == [
        (3, False), (2, False), (2, False), (1, False), (1, False), (0, True), (0, True), (0, True),
    ]  # fmt: skip


def test_a_timer_of_nothing_follows_its_input(rack: Rack) -> None:
    for on in (True, False, True):
        rack.put(on, TIMER_INPUT)
        rack.step()
        assert rack.on(TIMER_OUTPUT) is on


def test_run_sets_the_preload_and_a_program_may_change_it(rack: Rack) -> None:
    rack.program("LD 0 TIM 7 250", "LD 1 LD 2 CNT 6 12", "LD 0 TIM 5")
    assert rack.p(TIMER_PRELOAD + 16 * 7) == 250
    assert rack.p(COUNTER_PRELOAD + 16 * 6) == 12
    rack.write(TIMER_PRELOAD + 16 * 7, 9)
    rack.step(2)
    assert rack.p(TIMER_COUNT + 16 * 7) == 9


# counters and latches, driven by programs


def clock(rack: Rack, edges: int) -> None:
    for _ in range(edges):
        rack.put(True, COUNTER_CLOCK)
        rack.step()
        rack.put(False, COUNTER_CLOCK)
        rack.step()


def test_a_counter_counts_rising_edges_down_to_its_output(rack: Rack) -> None:
    rack.write(COUNTER_PRELOAD, 3)
    rack.put(True, COUNTER_RESET)
    rack.step()
    rack.put(False, COUNTER_RESET)
    assert rack.p(COUNTER_COUNT) == 3
    seen = []
    for _ in range(4):
        clock(rack, 1)
        seen.append((rack.p(COUNTER_COUNT), rack.on(COUNTER_OUTPUT)))
    assert seen == [(2, False), (1, False), (0, True), (0, True)]


def test_objects_of_other_numbers_are_untouched(rack: Rack) -> None:
    before = rack.memory.snapshot()
    rack.step(3)
    assert rack.memory.snapshot() == before
