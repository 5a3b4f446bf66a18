"""Time: slices of 1 ms, ten statements each, and the waits of DWL, INH and IHPOS."""

import pytest
from tests.basic.rig import Rig

from openacr.basic.execute.language_state import put_back, take
from openacr.basic.vm import scheduler_cy, vm_cy
from openacr.compiled import counterpart, is_compiled

COUNT_FOREVER = ("_a", "P{0}=P{0}+1", "GOTO a")


def start(rig: Rig, program: int, *lines: str) -> None:
    rig.store(program, *lines)
    rig.executor.run_program(program)


def count(rig: Rig, program: int) -> int:
    return int(rig.memory.read(program))


def counting(program: int) -> tuple[str, ...]:
    return tuple(line.format(program) for line in COUNT_FOREVER)


def test_a_slice_lasts_one_millisecond_and_at_least_one_tick() -> None:
    assert [scheduler_cy.slice_ticks(period) for period in (0.0005, 0.0001, 0.002, 0.0)] == [
        2,
        10,
        1,
        1,
    ]


def test_a_program_alone_has_every_second_slice() -> None:
    rig = Rig()
    start(rig, 0, *counting(0))
    rig.advance(400)
    # 200 slices, half of them for communications; two statements per count.
    assert count(rig, 0) == pytest.approx(500, abs=10)


def test_running_programs_share_the_ring_equally() -> None:
    rig = Rig()
    for program in (0, 3, 7):
        start(rig, program, *counting(program))
    rig.advance(800)
    assert [count(rig, program) for program in (0, 3, 7)] == [pytest.approx(500, abs=10)] * 3


def test_programs_8_to_15_share_one_slice() -> None:
    rig = Rig()
    for program in (0, 8, 9):
        start(rig, program, *counting(program))
    rig.advance(1200)
    assert count(rig, 0) == pytest.approx(1000, abs=15)
    assert [count(rig, 8), count(rig, 9)] == [pytest.approx(500, abs=15)] * 2


def test_a_dwell_of_nothing_returns_at_once() -> None:
    rig = Rig()
    start(rig, 0, "DWL 0", "DWL -1", "SET 40")
    rig.advance(4)
    assert rig.bit(40)


def test_channels_are_served_while_programs_run() -> None:
    rig = Rig()
    for program in range(8):
        start(rig, program, *counting(program))
    rig.session.go(rig.session.level, 0)
    rig.type("INH 40 : SET 41")
    rig.advance(10)
    rig.memory.set_bit(40, True)
    rig.advance(2)
    assert rig.bit(41)


def test_the_line_number_is_a_parameter() -> None:
    rig = Rig()
    start(rig, 0, "P0=1", "INH 40")
    rig.advance(10)
    assert rig.memory.I[7168] == 30


def test_a_snapshot_continues_in_the_middle_of_a_program() -> None:
    rig = Rig()
    start(rig, 0, "FOR P0=1 TO 100", "DWL 0.002", "P1=P1+P0", "NEXT", 'PRINT "done"')
    rig.advance(100)
    memory, state = rig.memory.snapshot(), take(rig.system, rig.executor)
    rig.advance(1000)
    expected = rig.memory.digest()
    other = Rig()
    other.memory.restore(memory)
    put_back(other.system, other.executor, state)
    other.advance(1000)
    assert other.memory.digest() == expected
    assert other.value("P1") == "5050"


@pytest.mark.skipif(not is_compiled, reason="no compiled core")
def test_both_builds_of_the_vm_give_the_same_bits() -> None:
    lines = (
        "DIM LV(4)",
        "DIM SV(1)",
        "DIM DA(1)",
        "DIM DA0(9)",
        "FOR LV0=0 TO 8",
        "DA0(LV0)=SIN(LV0*7)**2/3",
        "NEXT",
        "WHILE (P1<40)",
        "P1=P1+1 : P2=P2+RND(1000)",
        "IF (P1 MOD 3 = 0)",
        "GOSUB s",
        "ELSEIF (P1=5)",
        "SV0=1",
        "ELSE",
        "BIT 40 = NOT BIT 40",
        "ENDIF",
        "WEND",
        "END",
        "_s",
        "P3=P3+DA0(P1/5)",
        "RETURN",
    )
    digests = []
    for choose in (lambda f: f, counterpart):
        rig = Rig()
        rig.executor._step = choose(scheduler_cy.scheduler_step)
        rig.executor._advance = choose(scheduler_cy.advance)
        rig.executor.computing._vm_run = choose(vm_cy.vm_run)
        start(rig, 0, *lines)
        rig.advance(1000)
        assert (rig.value("P1"), rig.is_running()) == ("40", False)
        digests.append(rig.memory.digest())
    assert digests[0] == digests[1]
