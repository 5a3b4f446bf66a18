"""DIM, CLEAR and MEM as they are typed."""

import pytest
from tests.basic.bench import Bench

from openacr.models import ACR9000

FACTORY_FREE = 1048576 - 524288


@pytest.fixture
def bench() -> Bench:
    return Bench()


def shares(first: int = 0) -> str:
    """The factory allocation of the programs from one number on."""
    return "".join(f"DIM PROG{program}(65536)\n" for program in range(first, 8))


def answer(text: str, prompt: str = "SYS>") -> str:
    return text.replace("\n", "|") + prompt


@pytest.mark.req("ACR-MEM-01")
def test_a_factory_card_reports_its_allocation(bench: Bench) -> None:
    assert bench.type("MEM") == answer(f"{FACTORY_FREE}\n")
    assert bench.type("DIM") == answer(shares())
    for program in range(8):
        assert bench.type(f"MEM PROG{program}") == answer("65536\n")
    for other in ("PROG8", "PROG15", "PLC0", "PLC7"):
        assert bench.type(f"MEM {other}") == answer("0\n")
    assert bench.type("PROG 0", "DIM") == "P00>P00>"
    assert bench.system.storage.stream_size("COM1") == 256
    assert bench.system.storage.global_count == 0


@pytest.mark.req("ACR-MEM-02", "ACR-MEM-03")
@pytest.mark.parametrize("line", ["DIM PROG0(8192)", "DIM PLC3(2000)", "DIM P(100)"])
def test_an_allocation_changes_only_after_clear(bench: Bench, line: str) -> None:
    assert bench.type(line, line) == "SYS>Re-dimensioned block|SYS>"
    assert bench.type("CLEAR", line) == "SYS>SYS>"
    programs = f"{line}\n{shares(1)}" if "PROG" in line else f"{shares()}{line}\n"
    assert bench.type("DIM") == answer(programs)


def test_hosts_may_leave_the_parentheses_out(bench: Bench) -> None:
    assert bench.type("DIM PROG 15 16384", "DIM P 100", "dim def 20", "DIM PLC2 2000") == "SYS>" * 4
    listed = f"{shares()}DIM PROG15(16384)\nDIM PLC2(2000)\nDIM P(100)\nDIM DEF(20)\n"
    assert bench.type("DIM") == answer(listed)


@pytest.mark.req("ACR-MEM-32", "ACR-CMD-DIM")
def test_dim_at_sys_reports_programs_plcs_streams_globals_and_aliases(bench: Bench) -> None:
    bench.type("DIM PROG0(8192)", "DIM PLC1(1000)", "DIM P (100)", "DIM DEF(5)", "DIM COM1(1000)")
    bench.type("DIM FIFO(512)")
    assert bench.type("DIM") == answer(
        f"DIM PROG0(8192)\n{shares(1)}DIM PLC1(1000)\nDIM P(100)\nDIM DEF(5)\n"
        "DIM FIFO(512)\nDIM COM1(1000)\n"
    )


@pytest.mark.req("ACR-MEM-33", "ACR-MEM-10", "ACR-MEM-11", "ACR-CMD-DIM")
def test_dim_at_a_program_reports_its_variables(bench: Bench) -> None:
    bench.type("PROG 1", "DIM LV10", "DIM SV(2)", "DIM DV(3)", "DIM $V(10,80)", "DIM LA(2)")
    bench.type("DIM LA0 10", "DIM LA1(5)", "DIM SA(1)", "DIM SA0(4)", "DIM DA 1", "DIM DA0(6)")
    bench.type("DIM $A(1)", "DIM $A0(2,20)", "DIM MBUF(5)")
    assert bench.type("DIM") == answer(
        "DIM LV(10)\nDIM SV(2)\nDIM DV(3)\nDIM $V(10,80)\nDIM LA(2)\nDIM LA0(10)\nDIM LA1(5)\n"
        "DIM SA(1)\nDIM SA0(4)\nDIM DA(1)\nDIM DA0(6)\nDIM $A(1)\nDIM $A0(2,20)\nDIM MBUF(5)\n",
        "P01>",
    )
    assert bench.type("PROG 2", "DIM") == "P02>P02>"


COSTS = [
    pytest.param("DIM LV(10)", 40, marks=pytest.mark.req("ACR-MEM-14")),
    pytest.param("DIM SV(10)", 40, marks=pytest.mark.req("ACR-MEM-15")),
    pytest.param("DIM DV(10)", 80, marks=pytest.mark.req("ACR-MEM-16")),
    pytest.param("DIM $V(10,80)", 840, marks=pytest.mark.req("ACR-MEM-17")),
    pytest.param("DIM LA(10)", 44, marks=pytest.mark.req("ACR-MEM-18")),
    pytest.param("DIM LA(1) DIM LA0(10)", 8 + 44, marks=pytest.mark.req("ACR-MEM-19")),
    pytest.param("DIM SA(1) DIM SA0(10)", 8 + 44, marks=pytest.mark.req("ACR-MEM-20")),
    pytest.param("DIM DA(1) DIM DA0(10)", 8 + 84, marks=pytest.mark.req("ACR-MEM-21")),
    pytest.param("DIM $A(1) DIM $A0(10,20)", 8 + 200, marks=pytest.mark.req("ACR-MEM-22")),
    pytest.param("DIM MBUF(10)", 1360, marks=pytest.mark.req("ACR-MEM-31")),
    pytest.param("10 PAUSE", 4 + 4, marks=pytest.mark.req("ACR-MEM-23")),
    pytest.param("10 P0 = 1 + 2 - 3", 4 + 4 + 3 * 4 + 4 * 4, marks=pytest.mark.req("ACR-MEM-24")),
    pytest.param("10 DWL 5", 4 + 4 + 4, marks=pytest.mark.req("ACR-MEM-25")),
    pytest.param("10 DWL 0.25", 4 + 4 + 4, marks=pytest.mark.req("ACR-MEM-26")),
    pytest.param("10 DWL 0.123456789", 4 + 4 + 8, marks=pytest.mark.req("ACR-MEM-27")),
    pytest.param('10 PRINT "12345"', 4 + 4 + 4 + 5, marks=pytest.mark.req("ACR-MEM-28")),
]


@pytest.mark.req("ACR-MEM-34", "ACR-CMD-MEM")
@pytest.mark.parametrize(("line", "cost"), COSTS)
def test_mem_shrinks_by_exactly_what_a_thing_costs(bench: Bench, line: str, cost: int) -> None:
    assert bench.type("PROG 0", "MEM") == answer("P00>65536\n", "P00>")
    bench.type(line)
    assert bench.type("MEM") == answer(f"{65536 - cost}\n", "P00>")
    assert bench.type("SYS", "MEM") == answer(f"SYS>{FACTORY_FREE}\n")


@pytest.mark.req("ACR-MEM-30")
def test_alias_space_is_taken_from_the_system(bench: Bench) -> None:
    bench.type("DIM DEF(10)")
    assert bench.type("MEM") == answer(f"{FACTORY_FREE - 10 * 48 - 16}\n")


@pytest.mark.req("ACR-REM-05")
def test_removing_a_remark_frees_memory(bench: Bench) -> None:
    bench.type("PROG 0", "10 REM 1234", "20 DWL 1")
    assert bench.type("MEM") == answer(f"{65536 - (4 + 4 + 5) - 12}\n", "P00>")
    bench.type("10")
    assert bench.type("MEM") == answer(f"{65536 - 12}\n", "P00>")


@pytest.mark.req("ACR-MEM-05")
def test_a_program_longer_than_its_memory_is_refused(bench: Bench) -> None:
    bench.type("DIM PROG0(30)", "PROG 0", "10 DWL 1", "20 DWL 2")
    assert bench.type("30 DWL 3") == answer("Out of memory\n", "P00>")
    assert bench.type("LIST") == answer("10 DWL 1\n20 DWL 2\n", "P00>")


@pytest.mark.req("ACR-MEM-07")
def test_globals_exist_up_to_their_dimension(bench: Bench) -> None:
    bench.type("DIM P(100)")
    assert bench.type("?P99") == answer("0\n")
    assert bench.type("?P100") == answer("Undefined variable\n")


@pytest.mark.req("ACR-MEM-09")
def test_one_alias_more_than_reserved_is_refused(bench: Bench) -> None:
    bench.type("DIM DEF(2)", "#DEFINE One P0", "#DEFINE Two P1")
    assert bench.type("#DEFINE Three P2") == answer("Out of define space\n")
    assert bench.type("DEF") == answer("#DEFINE One P0\n#DEFINE Two P1\n")


@pytest.mark.req("ACR-MEM-35")
def test_programs_are_erased_before_their_memory_is_cleared(bench: Bench) -> None:
    bench.type("DIM PROG0(8192)", "PROG 0", "10 DWL 1", "SYS")
    assert bench.type("CLEAR") == answer("Program in memory\n")
    assert bench.type("NEW ALL", "CLEAR", "MEM PROG0") == "SYS>SYS>65536|SYS>"


def test_clear_waits_for_running_programs(bench: Bench) -> None:
    bench.control.running.add(3)
    assert bench.type("CLEAR") == answer("Program in memory\n")


@pytest.mark.req("ACR-MEM-36", "ACR-CMD-CLEAR", "ACR-SYN-03")
def test_clear_frees_everything_at_sys_and_locals_at_a_program(bench: Bench) -> None:
    bench.type("DIM PROG0(8192)", "DIM PLC0(1000)", "DIM P(10)", "DIM DEF(3)", "#DEFINE A P0")
    bench.type("PROG 1", "DIM LV(10)", "PROG 2", "DIM LV(10)")
    assert bench.type("CLEAR", "MEM", "DIM") == "P02>" + "65536|P02>" + "P02>"
    assert bench.type("PROG 1", "MEM") == answer("P01>65496\n", "P01>")
    assert bench.type("SYS", "CLEAR", "DIM") == "SYS>SYS>" + answer(shares())
    assert bench.type("MEM", "DEF") == f"{FACTORY_FREE}|SYS>SYS>"


@pytest.mark.parametrize(
    "line", ["CLEAR PROG3", "CLEAR PLC0", "CLEAR DEF", "CLEAR STREAM", "CLEAR COM", "CLEAR LV(1)"]
)
def test_clear_with_anything_it_does_not_know_changes_nothing(bench: Bench, line: str) -> None:
    bench.type("DIM PROG0(8192)", "DIM P(10)", "DIM DEF(3)", "#DEFINE A P0", "PROG 3", "DIM LV(5)")
    kept = bench.type("SYS", "DIM", "MEM", "DEF", "PROG 3", "DIM")
    message = "Unknown command" if line == "CLEAR COM" else "Syntax error"
    assert bench.type("SYS", line) == f"SYS>{message}|SYS>"
    assert bench.type("PROG 3", line) == f"P03>{message}|P03>"
    assert bench.type("SYS", "DIM", "MEM", "DEF", "PROG 3", "DIM") == kept


@pytest.mark.req("ACR-MEM-37", "ACR-CMD-CLEAR")
@pytest.mark.parametrize("name", ["COM1", "COM2", "FIFO", "DPCB"])
def test_stream_buffers_can_be_enlarged_and_cleared(bench: Bench, name: str) -> None:
    sizes = bench.system.storage.stream_size
    bench.type("DIM COM1(500)", "DIM COM2(501)", "DIM FIFO(502)", "DIM DPCB(503)")
    before = {each: sizes(each) for each in ("COM1", "COM2", "FIFO", "DPCB")}
    assert before == {"COM1": 500, "COM2": 501, "FIFO": 502, "DPCB": 503}
    bench.type(f"CLEAR {name}")
    assert {each: sizes(each) for each in before} == {**before, name: 256}


def test_a_channel_the_model_lacks_is_an_invalid_device() -> None:
    bench = Bench(ACR9000)
    assert bench.type("CLEAR FIFO", "DIM DPCB(100)") == "Invalid device|SYS>" * 2
    assert bench.type("CLEAR STREAM2") == "SYS>"


@pytest.mark.parametrize("line", ["DIM LV(5)", "DIM $V(1,10)", "DIM MBUF(2)"])
def test_locals_need_a_program(bench: Bench, line: str) -> None:
    assert bench.type(line) == answer("Not valid at this level\n")


@pytest.mark.parametrize("line", ["DIM PROG1(100)", "DIM P(5)", "DIM DEF(5)", "DIM COM1(300)"])
def test_system_memory_is_dimensioned_at_sys(bench: Bench, line: str) -> None:
    assert bench.type("PROG 0", line) == answer("P00>Not valid at this level\n", "P00>")


@pytest.mark.parametrize("line", ["DIM PROG16(100)", "DIM PLC8(100)", "DIM P(4097)", "DIM P(0)"])
def test_sizes_and_numbers_out_of_range_are_invalid(bench: Bench, line: str) -> None:
    assert bench.type(line) == answer("Invalid argument\n")


@pytest.mark.parametrize("line", ["DIM PROG", "DIM $V(5)", "DIM P"])
def test_malformed_dims_are_syntax_errors(bench: Bench, line: str) -> None:
    assert bench.type("PROG 0", line) == answer("P00>Syntax error\n", "P00>")


def test_sizes_may_be_expressions(bench: Bench) -> None:
    bench.type("DIM P(10)")
    bench.card.memory.write(3, 7)
    assert bench.type("PROG 0", "DIM LV(P3+1)", "DIM") == "P00>P00>DIM LV(8)|P00>"


def test_a_running_program_may_repeat_its_dims(bench: Bench) -> None:
    for _ in range(2):
        bench.execute(0, "DIM LV(4)")
        bench.execute(0, "DIM $V(2,10)")
        bench.execute(0, "DIM DA(1)")
        bench.execute(0, "DIM DA0(5)")
    assert bench.type("PROG 0", "DIM LV(4)") == answer("P00>Re-dimensioned block\n", "P00>")
