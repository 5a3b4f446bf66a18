"""RUN, HALT and their kin: whom they mean and what they refuse."""

import pytest
from tests.basic.bench import Bench


@pytest.fixture
def bench() -> Bench:
    bench = Bench()
    bench.type("PROG 0", "10 DWL 1", "PROG 2", "10 DWL 1", "20 VER", "SYS")
    return bench


def test_without_target_the_program_of_the_prompt_is_meant(bench: Bench) -> None:
    assert bench.type("PROG 2", "RUN", "HALT", "RUN 20") == "P02>" * 4
    assert bench.control.calls == [("run", 2, None), ("halt", 2), ("run", 2, 20)]
    bench.type("PLC 4", "HALT")
    assert bench.control.calls[-1] == ("halt", 20)


def test_halt_alone_at_sys_halts_everything(bench: Bench) -> None:
    bench.type("HALT")
    assert bench.control.calls == [("halt", owner) for owner in range(24)]


def test_run_all_starts_what_is_stored_and_not_running(bench: Bench) -> None:
    bench.type("RUN PROG2", "RUN ALL")
    assert bench.control.calls == [("run", 2, None), ("run", 0, None)]


def test_an_empty_program_is_started_silently(bench: Bench) -> None:
    assert bench.type("PROG 7", "RUN", "LRUN") == "P07>" * 3
    assert bench.control.calls == []


def test_stepping_commands_reach_their_program(bench: Bench) -> None:
    bench.type("PROG 1", "BLK", "STEP", "AUT", "TRON", "TROFF PROG3")
    assert bench.control.calls == [
        ("block", 1), ("step", 1), ("auto", 1), ("trace", 1, True), ("trace", 3, False),
    ]  # fmt: skip


def test_inside_a_program_its_own_program_is_meant(bench: Bench) -> None:
    bench.execute(3, "PAUSE")
    bench.execute(3, "RUN PROG2")
    assert bench.control.calls == [("pause", 3), ("run", 2, None)]


def test_new_of_a_running_program_erases_nothing(bench: Bench) -> None:
    bench.type("RUN PROG2")
    assert bench.type("NEW PROG2", "NEW ALL") == "Program is running|SYS>" * 2
    assert bench.type("PROG 0", "LIST") == "P00>10 DWL 1|P00>"


def test_lists_of_an_empty_program_print_nothing(bench: Bench) -> None:
    assert bench.type("PROG 9", "LIST") == "P09>P09>"
