import pytest
from tests.plc.rack import numbered

from openacr.errors import CardError
from openacr.plc.compile import PlcCompileError, compile_plc
from openacr.plc.scan_cy import OP_LOAD, OP_OUT, OP_START


def compiled(*lines: str) -> list[tuple[int, int]]:
    return compile_plc(numbered(*lines)).code


@pytest.mark.parametrize(
    ("lines", "text"),
    [
        (("LD 0", "AND LD", "OUT 32"), "PLC error line 20: Stack underflow"),
        (("LD 0", "LD 1", "OR LD", "OR LD"), "PLC error line 40: Stack underflow"),
        (("LD 0", "CNT 0 5"), "PLC error line 20: Stack underflow"),
        (("LD 0", "KR 0"), "PLC error line 20: Stack underflow"),
        (("LD 0", "OUT 1", "LD 1", "OR LD"), "PLC error line 40: Stack underflow"),
        (("LD 0",) * 18, "PLC error line 180: Stack overflow"),
        (("AND 0",), "PLC error line 10: LD expected"),
        (("OUT 32",), "PLC error line 10: LD expected"),
        (("PBOOT", "NOT"), "PLC error line 20: LD expected"),
    ],
)
def test_a_rung_that_does_not_add_up_is_named_with_its_line(
    lines: tuple[str, ...], text: str
) -> None:
    with pytest.raises(PlcCompileError) as caught:
        compiled(*lines)
    assert caught.value.text == text


def test_sixteen_results_can_be_saved() -> None:
    assert len(compiled(*("LD 0",) * 17, *("AND LD",) * 16, "OUT 32")) == 34


def test_an_output_ends_a_rung_and_unused_blocks_are_dropped() -> None:
    saved = ("LD 0",) * 17
    code = compiled(*saved, "OUT 32", *saved, "OUT 33")
    assert [operation for operation, _ in code] == [
        *(OP_START, *(OP_LOAD,) * 16, OP_OUT),
        *(OP_START, *(OP_LOAD,) * 16, OP_OUT),
    ]


def test_the_scan_ends_at_end_endp_or_the_last_line() -> None:
    scanned = compiled("LD 0", "OUT 32")
    assert compiled("LD 0", "OUT 32", "END", "OUT 33", "AND LD") == scanned
    assert compiled("PROGRAM", "PBOOT", "REM x", "LD 0", "OUT 32", "ENDP", "OUT 33") == scanned


def test_two_hundred_instructions_are_the_most() -> None:
    fitting = ("LD 0 OUT 32 " * 10,) * 10
    assert len(compiled(*fitting, "END")) == 200
    with pytest.raises(CardError, match="PLC too long"):
        compiled(*fitting, "OUT 33")
