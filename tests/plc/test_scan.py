"""What each instruction does to flags, and when."""

from itertools import product

import pytest
from tests.plc.rack import Rack

from openacr.map import numbers as at

TIMER_INPUT, TIMER_OUTPUT = 1553, 1552
COUNTER_OUTPUT, COUNTER_CLOCK, COUNTER_RESET = 1556, 1557, 1558
LATCH_OUTPUT, LATCH_SET, LATCH_RESET = 1564, 1565, 1566
TICK_PRELOAD, TICK_COUNT = 6656, 6657
TIMER_PRELOAD, TIMER_COUNT, COUNTER_PRELOAD, COUNTER_COUNT = 6660, 6661, 6662, 6663
RUNNING, FIRST_SCAN = 1536, 1537
MS = 2  # ticks


@pytest.fixture
def rack() -> Rack:
    return Rack()


# logic


@pytest.mark.parametrize(
    ("lines", "truth"),
    [
        (("LD 0",), lambda a, b, c, d: a),
        (("LD NOT 0",), lambda a, b, c, d: not a),
        (("LD 0", "AND 1"), lambda a, b, c, d: a and b),
        (("LD 0", "AND NOT 1"), lambda a, b, c, d: a and not b),
        (("LD 0", "OR 1"), lambda a, b, c, d: a or b),
        (("LD 0", "OR NOT 1"), lambda a, b, c, d: a or not b),
        (("LD 0", "AND 1", "NOT"), lambda a, b, c, d: not (a and b)),
        (("LD 0", "OR 1", "LD 2", "OR 3", "AND LD"), lambda a, b, c, d: (a or b) and (c or d)),
        (("LD 0", "AND 1", "LD 2", "AND 3", "OR LD"), lambda a, b, c, d: (a and b) or (c and d)),
        (("LD 0", "LD 1", "LD 2", "AND LD", "OR LD"), lambda a, b, c, d: a or (b and c)),
        (("LD 0", "LD NOT 1", "NOT", "ANDB"), lambda a, b, c, d: a and b),
    ],
)
def test_a_rung_is_its_logic(rack: Rack, lines: tuple[str, ...], truth: object) -> None:
    rack.program(*lines, "OUT 32")
    assert callable(truth)
    for inputs in range(16):
        expected = truth(*(bool(inputs >> bit & 1) for bit in range(4)))
        assert rack.after(inputs) == expected


def test_the_result_goes_on_after_an_output(rack: Rack) -> None:
    rack.program("LD 0", "OUT 32", "OUT NOT 33", "AND 1", "OUT 34", "LD 2", "OUT 35")
    for a, b, c in product((0, 1), repeat=3):
        rack.after(a | b << 1 | c << 2)
        expected = [bool(a), not a, bool(a and b), bool(c)]
        assert [rack.on(bit) for bit in (32, 33, 34, 35)] == expected


def test_set_and_clr_act_only_on_a_true_result_and_last(rack: Rack) -> None:
    rack.program("LD 0", "SET 32", "LD 1", "CLR 32")
    assert [rack.after(inputs) for inputs in (0, 1, 0, 2, 0)] == [False, True, True, False, False]


@pytest.mark.parametrize("bit", [31, 63, 8191])
def test_the_last_flag_of_a_word_is_like_any_other(rack: Rack, bit: int) -> None:
    rack.program(f"LD 0 OUT {bit}", f"LD {bit} OUT 40")
    for state in (1, 0, 1):
        rack.put(bool(state), 0)
        rack.step()
        assert rack.on(bit) == rack.on(40) == bool(state)
    rack.put(False, 0)
    rack.step()
    assert rack.memory.I[4096 + bit // 32] == 0


def test_later_instructions_see_what_earlier_ones_have_written(rack: Rack) -> None:
    rack.program("LD 32", "OUT 33", "LD 0", "OUT 32", "LD 32", "OUT 34")
    rack.put(True, 0)
    rack.step()
    assert [rack.on(bit) for bit in (32, 33, 34)] == [True, False, True]
    rack.step()
    assert rack.on(33)


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
    rack.memory.F[at.SYSF_BASE + at.SYSF_PERIOD_S] = period_s
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


def test_clearing_the_input_reloads_a_timer_and_clears_its_output(rack: Rack) -> None:
    rack.write(TIMER_PRELOAD, 5)
    rack.put(True, TIMER_INPUT)
    rack.step(2 * MS + 1)
    rack.put(False, TIMER_INPUT)
    rack.step()
    assert rack.p(TIMER_COUNT) == 5
    rack.put(True, TIMER_INPUT)
    rack.step(5 * MS - 1)
    assert not rack.on(TIMER_OUTPUT)
    rack.step()
    assert rack.on(TIMER_OUTPUT)
    rack.put(False, TIMER_INPUT)
    rack.step()
    assert not rack.on(TIMER_OUTPUT)


def test_part_of_a_millisecond_is_forgotten_with_the_input(rack: Rack) -> None:
    rack.write(TIMER_PRELOAD, 1)
    rack.step()
    for _ in range(3):
        rack.put(True, TIMER_INPUT)
        rack.step()
        rack.put(False, TIMER_INPUT)
        rack.step()
    assert not rack.on(TIMER_OUTPUT)


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


def test_a_clock_that_stays_counts_once(rack: Rack) -> None:
    rack.write(COUNTER_PRELOAD, 3)
    rack.put(True, COUNTER_CLOCK)
    rack.step(5)
    assert rack.p(COUNTER_COUNT) == 2


def test_reset_blocks_the_clock_and_its_end_is_no_edge(rack: Rack) -> None:
    rack.write(COUNTER_PRELOAD, 2)
    rack.put(True, COUNTER_RESET, COUNTER_CLOCK)
    rack.step(2)
    rack.put(False, COUNTER_RESET)
    rack.step(2)
    assert rack.p(COUNTER_COUNT) == 2
    rack.put(False, COUNTER_CLOCK)
    rack.step()
    clock(rack, 2)
    assert rack.on(COUNTER_OUTPUT)
    rack.put(True, COUNTER_RESET)
    rack.step()
    assert not rack.on(COUNTER_OUTPUT) and rack.p(COUNTER_COUNT) == 2


def test_a_counter_never_reset_begins_at_its_preload(rack: Rack) -> None:
    rack.write(COUNTER_PRELOAD, 2)
    clock(rack, 1)
    assert (rack.p(COUNTER_COUNT), rack.on(COUNTER_OUTPUT)) == (1, False)
    clock(rack, 1)
    assert rack.on(COUNTER_OUTPUT)


def test_a_latch_keeps_what_set_it_until_reset_which_is_stronger(rack: Rack) -> None:
    seen = []
    for inputs in ((), (LATCH_SET,), (), (LATCH_SET, LATCH_RESET), (), (LATCH_SET,)):
        rack.put(False, LATCH_SET, LATCH_RESET)
        rack.put(True, *inputs)
        rack.step()
        seen.append(rack.on(LATCH_OUTPUT))
    assert seen == [False, True, True, False, False, True]


def test_objects_of_other_numbers_are_untouched(rack: Rack) -> None:
    before = rack.memory.snapshot()
    rack.step(3)
    assert rack.memory.snapshot() == before
