"""FSTAT: parameters copied cyclically for a host on the bus."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.compiled import pick
from openacr.kernel.status import fast_status_cy
from openacr.map import numbers as at
from openacr.map import packet_groups
from openacr.map.rows import axes, fast_status
from openacr.map.words import fsf

MS = 2  # ticks


@pytest.fixture
def bench() -> Bench:
    return Bench("X")


@pytest.mark.parametrize("form", [fast_status_cy.group_number, pick(fast_status_cy.group_number)])
def test_groups_are_those_of_binary_packets(form: object) -> None:
    for (code, index), numbers in packet_groups().items():
        for field, number in enumerate(numbers):
            if number is not None:
                assert form(code, index, field) == number  # type: ignore[operator]


@pytest.mark.req("ACR-CMD-FSTAT")
def test_groups_are_copied_every_period_until_off(bench: Bench) -> None:
    bench.all("FSTAT PERIOD 10", "FSTAT0 (48,4,0)", "FSTAT9 (48,16,1)", "FSTAT ON")
    bench.memory.I[axes.parameters[0] + 4] = 77
    bench.memory.I[axes.parameters[7] + 4] = -5
    bench.ticks(1)
    assert bench.memory.I[at.W_FSTAT] == fsf.FSTAT_ON
    assert bench.type("FSTAT0") == "77,0,0,0,0,0,0,-5"
    assert bench.type("FSTAT9") == ",".join(["0.002441406"] * 8)
    bench.memory.I[axes.parameters[0] + 4] = 78
    bench.ticks(10 * MS - 1)
    assert bench.type("FSTAT0").startswith("77,")
    bench.ticks(1)
    assert bench.type("FSTAT0").startswith("78,")
    assert bench.type("?P7057") == "2"
    bench.all("FSTAT OFF")
    bench.memory.I[axes.parameters[0] + 4] = 79
    bench.ticks(100 * MS)
    assert bench.type("FSTAT0").startswith("78,")
    assert bench.type("?P7057") == "2"


@pytest.mark.parametrize(
    "step", [fast_status_cy.fast_status_step, pick(fast_status_cy.fast_status_step)]
)
def test_the_count_of_copies_wraps_as_every_long_does(bench: Bench, step: object) -> None:
    memory = bench.memory
    memory.I[at.P_FSTAT_COUNT] = 2**31 - 2
    memory.I[at.W_FSTAT] |= fsf.FSTAT_ON_REQUEST
    counts = []
    for _ in range(3):
        memory.F[fast_status.phase_ms[0]] = 60.0
        step(memory.F, memory.I, memory.S, 0.0005)  # type: ignore[operator]
        counts.append(memory.I[at.P_FSTAT_COUNT])
    assert counts == [2**31 - 1, -(2**31), -(2**31) + 1]


def test_the_flag_loads_entries_written_as_parameters(bench: Bench) -> None:
    bench.all("P7443=48", "P7444=2", "P7445=0")
    bench.memory.I[axes.parameters[3] + 2] = 9
    bench.memory.I[at.W_FSTAT] |= fsf.FSTAT_ON_REQUEST
    bench.ticks(1)
    assert bench.type("FSTAT1") == "0,0,0,9,0,0,0,0"
    bench.all("P7443=0")  # entries are loaded at a start only
    bench.ticks(60 * MS)
    assert bench.type("?P7057") == "2"


def test_the_report_names_state_period_and_entries(bench: Bench) -> None:
    assert bench.type("FSTAT") == "FSTAT OFF PERIOD 50"
    bench.all("FSTAT2 (48,4,1)", "FSTAT ON")
    assert bench.type("FSTAT") == "FSTAT ON PERIOD 50|FSTAT2 (48,4,1)"
    bench.all("FSTAT CLEAR", "FSTAT PERIOD 20")
    assert bench.type("FSTAT") == "FSTAT ON PERIOD 20"
    assert bench.type("FSTAT PERIOD") == "20"


@pytest.mark.parametrize("line", ["FSTAT10", "FSTAT0 (1,1,0)", "FSTAT0 (48,4,2)",
                                  "FSTAT PERIOD 0"])  # fmt: skip
def test_what_is_not_there_is_refused(bench: Bench, line: str) -> None:
    assert bench.type(line) == "Invalid argument"


def test_the_type_of_a_copy_is_that_of_its_group_unless_given(bench: Bench) -> None:
    bench.all("FSTAT0 (48,2)", "FSTAT1 (48,16)", "FSTAT2 (48,2,1)")
    listed = "FSTAT0 (48,2,0)|FSTAT1 (48,16,1)|FSTAT2 (48,2,1)"
    assert bench.type("FSTAT") == f"FSTAT OFF PERIOD 50|{listed}"
    assert bench.type("FSTAT0 (48)") == "Syntax error"
    assert bench.type("FSTAT0 (1,1)") == "Invalid argument"
