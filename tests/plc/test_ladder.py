import pytest
from tests.plc.rack import numbered

from openacr.plc.compile import PlcCompileError
from openacr.plc.ladder import draw


def drawn(*lines: str) -> str:
    return "\n".join(draw(numbered(*lines)))


def test_contacts_stand_in_series_and_parallel() -> None:
    assert drawn("LD 0", "AND NOT 1", "LD 2", "AND 3", "OR LD", "OUT 32") == (
        "    10 |--+--[0]--[/1]--+--(32)\n"
        "       |  +--[2]--[3]---+\n"
        "       |"
    )  # fmt: skip


def test_every_rung_begins_at_the_rail_with_its_line() -> None:
    assert drawn("REM two lamps", "LD BIT 32 TIM 0 500", "LD TIM0 OUT NOT 33", "END", "OUT 5") == (
        "    20 |--[BIT 32]--[TIM 0 500]\n       |\n    30 |--[TIM0]--(/33)\n       |"
    )


def test_more_branches_and_branches_within_branches() -> None:
    lines = ("LD 0", "OR 1", "OR 2", "LD 3", "LD 4", "OR 5", "AND LD", "OR LD", "NOT", "OUT 32")
    assert drawn(*lines) == (
        "    10 |--+--[0]-------------+--[NOT]--(32)\n"
        "       |  +--[1]-------------+\n"
        "       |  +--[2]-------------+\n"
        "       |  +--[3]--+--[4]--+--+\n"
        "       |          +--[5]--+\n"
        "       |"
    )


def test_counters_and_latches_have_two_inputs() -> None:
    assert drawn("LD 4 AND 7", "LD 5", "CNT 1 10", "LD 6 LD 7 KR 2") == (
        "    10 |--[4]--[7]--C[CNT 1 10]\n"
        "       |--[5]-------R[        ]\n"
        "       |\n"
        "    40 |--[6]--S[KR 2]\n"
        "       |--[7]--R[    ]\n"
        "       |"
    )


def test_outputs_follow_each_other_as_in_the_text() -> None:
    assert drawn("LD 0 OUT 32 SET 33 AND 1 CLR 34") == (
        "    10 |--[0]--(32)--(S 33)--[1]--(R 34)\n"
        "       |"
    )  # fmt: skip


def test_a_plc_that_cannot_run_cannot_be_drawn() -> None:
    with pytest.raises(PlcCompileError):
        drawn("LD 0", "AND LD")


def test_nothing_is_drawn_of_nothing() -> None:
    assert drawn("REM empty") == ""
