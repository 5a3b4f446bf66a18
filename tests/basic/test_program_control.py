"""RUN, HALT and their kin: whom they mean and what they refuse."""

from unittest.mock import Mock

import pytest
from tests.basic.machine import Machine


@pytest.fixture
def bench() -> Machine:
    bench = Machine()
    bench.system.control = bench.control = Mock(wraps=bench.control)
    bench.type("PROG 0", "10 DWL 1", "PROG 2", "10 DWL 1", "20 VER", "SYS")
    return bench


def calls(bench: Machine) -> list[tuple[object, ...]]:
    """What programs and PLCs were given."""
    assert isinstance(bench.control, Mock)
    return [(name, *args) for name, args, _ in bench.control.mock_calls if name != "is_running"]


def test_without_target_the_program_of_the_prompt_is_meant(bench: Machine) -> None:
    assert bench.type("PROG 2", "RUN", "HALT", "RUN 20") == "P02>" * 4
    assert calls(bench) == [("run", 2, None), ("halt", 2), ("run", 2, 20)]
    bench.type("PLC 4", "HALT")
    assert calls(bench)[-1] == ("halt", 20)


def test_halt_alone_at_sys_halts_everything(bench: Machine) -> None:
    bench.type("HALT")
    assert calls(bench) == [("halt", owner) for owner in range(24)]


def test_run_all_starts_what_is_stored_and_not_running(bench: Machine) -> None:
    bench.type("RUN PROG2", "RUN ALL")
    assert calls(bench) == [("run", 2, None), ("run", 0, None)]


def test_an_empty_program_is_started_silently(bench: Machine) -> None:
    assert bench.type("PROG 7", "RUN", "LRUN") == "P07>" * 3
    assert calls(bench) == []


def test_stepping_commands_reach_their_program(bench: Machine) -> None:
    bench.type("PROG 1", "BLK", "STEP", "AUT", "TRON", "TROFF PROG3")
    assert calls(bench) == [
        ("block", 1), ("step", 1), ("auto", 1), ("trace", 1, True), ("trace", 3, False),
    ]  # fmt: skip


def test_inside_a_program_its_own_program_is_meant(bench: Machine) -> None:
    bench.type("PROG 3", "10 RUN PROG2", "20 PAUSE", "RUN")
    bench.advance()
    assert calls(bench)[:3] == [("run", 3, None), ("run", 2, None), ("pause", 3)]


def test_new_of_a_running_program_erases_nothing(bench: Machine) -> None:
    bench.type("RUN PROG2")
    assert bench.type("NEW PROG2", "NEW ALL") == "Program is running|SYS>" * 2
    assert bench.type("PROG 0", "LIST") == "P00>10 DWL 1|P00>"


def test_lists_of_an_empty_program_print_nothing(bench: Machine) -> None:
    assert bench.type("PROG 9", "LIST") == "P09>P09>"
