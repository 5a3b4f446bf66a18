"""DIM, CLEAR and MEM as they are typed."""

import pytest
from tests.basic.machine import Machine

from openacr.models import ACR9000


@pytest.fixture
def bench() -> Machine:
    return Machine()


def shares(first: int = 0) -> str:
    """The factory allocation of the programs from one number on."""
    return "".join(f"DIM PROG{program}(65536)\n" for program in range(first, 8))


def answer(text: str, prompt: str = "SYS>") -> str:
    return text.replace("\n", "|") + prompt


def test_hosts_may_leave_the_parentheses_out(bench: Machine) -> None:
    assert bench.type("DIM PROG 15 16384", "DIM P 100", "dim def 20", "DIM PLC2 2000") == "SYS>" * 4
    listed = f"{shares()}DIM PROG15(16384)\nDIM PLC2(2000)\nDIM P(100)\nDIM DEF(20)\n"
    assert bench.type("DIM") == answer(listed)


def test_clear_waits_for_running_programs(bench: Machine) -> None:
    bench.type("PROG 3", "10 DWL 1", "RUN")
    assert bench.type("SYS", "CLEAR") == answer("SYS>Program in memory\n")


@pytest.mark.parametrize(
    "line", ["CLEAR PROG3", "CLEAR PLC0", "CLEAR DEF", "CLEAR STREAM", "CLEAR COM", "CLEAR LV(1)"]
)
def test_clear_with_anything_it_does_not_know_changes_nothing(bench: Machine, line: str) -> None:
    bench.type("DIM PROG0(8192)", "DIM P(10)", "DIM DEF(3)", "#DEFINE A P0", "PROG 3", "DIM LV(5)")
    kept = bench.type("SYS", "DIM", "MEM", "DEF", "PROG 3", "DIM")
    message = "Unknown command" if line == "CLEAR COM" else "Syntax error"
    assert bench.type("SYS", line) == f"SYS>{message}|SYS>"
    assert bench.type("PROG 3", line) == f"P03>{message}|P03>"
    assert bench.type("SYS", "DIM", "MEM", "DEF", "PROG 3", "DIM") == kept


def test_a_channel_the_model_lacks_is_an_invalid_device() -> None:
    bench = Machine(ACR9000)
    assert bench.type("CLEAR FIFO", "DIM DPCB(100)") == "Invalid device|SYS>" * 2
    assert bench.type("CLEAR STREAM2") == "SYS>"


@pytest.mark.parametrize("line", ["DIM LV(5)", "DIM $V(1,10)", "DIM MBUF(2)"])
def test_locals_need_a_program(bench: Machine, line: str) -> None:
    assert bench.type(line) == answer("Not valid at this level\n")


@pytest.mark.parametrize("line", ["DIM PROG1(100)", "DIM P(5)", "DIM DEF(5)", "DIM COM1(300)"])
def test_system_memory_is_dimensioned_at_sys(bench: Machine, line: str) -> None:
    assert bench.type("PROG 0", line) == answer("P00>Not valid at this level\n", "P00>")


@pytest.mark.parametrize("line", ["DIM PROG16(100)", "DIM PLC8(100)", "DIM P(4097)", "DIM P(0)"])
def test_sizes_and_numbers_out_of_range_are_invalid(bench: Machine, line: str) -> None:
    assert bench.type(line) == answer("Invalid argument\n")


@pytest.mark.parametrize("line", ["DIM PROG", "DIM $V(5)", "DIM P"])
def test_malformed_dims_are_syntax_errors(bench: Machine, line: str) -> None:
    assert bench.type("PROG 0", line) == answer("P00>Syntax error\n", "P00>")


def test_sizes_may_be_expressions(bench: Machine) -> None:
    bench.type("DIM P(10)")
    bench.card.memory.write(3, 7)
    assert bench.type("PROG 0", "DIM LV(P3+1)", "DIM") == "P00>P00>DIM LV(8)|P00>"


def test_a_running_program_may_repeat_its_dims(bench: Machine) -> None:
    bench.type("PROG 0", "10 DIM LV(4)", "20 DIM $V(2,10)", "30 DIM DA(1)", "40 DIM DA0(5)")
    for _ in range(2):
        assert bench.type("LRUN") == ""
        bench.advance()
        assert bench.sent() == "P00>"
    assert bench.type("PROG 0", "DIM LV(4)") == answer("P00>Re-dimensioned block\n", "P00>")
