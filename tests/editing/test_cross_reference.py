"""Who reads and who writes: names in all programs of a card."""

import pytest

from openacr.editing.controller.cross_reference import uses


def found(text: str, program: str = "PROG3", **aliases: str) -> list[tuple[str, str]]:
    return [(each.name, str(each.access)) for each in uses({program: [(10, text)]}, aliases)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("P10 = P11+1 : SET 130", [("P10", "writes"), ("P11", "reads"), ("BIT130", "writes")]),
        ("IF (P10 = 1) THEN P12 = 3", [("P10", "reads"), ("P12", "writes")]),
        ("CLR BIT33", [("BIT33", "writes")]),
        ("INH -517", [("BIT517", "reads")]),
        ("BIT128=P3", [("BIT128", "writes"), ("P3", "reads")]),
        ("SET(P3)", [("P3", "reads")]),
        ("SET 130 : PRINT P3", [("BIT130", "writes"), ("P3", "reads")]),
        ("FOR P0 = P1 TO P2", [("P0", "writes"), ("P1", "reads"), ("P2", "reads")]),
        ("INPUT P3", [("P3", "writes")]),
        ("_more", [("PROG3 more", "defines")]),
        ("GOTO more", [("PROG3 more", "reads")]),
        ("GOSUB 100", []),
        ("LV0 = P12288", [("P12288", "reads")]),
        ("REM P10", []),
    ],
)
def test_a_line_of_a_program_reads_and_writes(text: str, expected: list[tuple[str, str]]) -> None:
    assert found(text) == expected


def test_a_line_of_a_plc_writes_its_outputs_alone() -> None:
    assert found("LD 12 AND NOT 13 OUT 32", "PLC0") == [
        ("BIT12", "reads"), ("BIT13", "reads"), ("BIT32", "writes"),
    ]  # fmt: skip


def test_what_an_alias_stands_for_is_used_where_the_alias_is() -> None:
    assert found("SPEED = LAMP", SPEED="P30", LAMP="BIT32", OTHER="5") == [
        ("SPEED", "writes"), ("P30", "writes"), ("LAMP", "reads"), ("BIT32", "reads"),
    ]  # fmt: skip


def test_a_use_has_its_program_line_column_and_text() -> None:
    (use,) = uses({"PROG2": [(70, "  P10 = 1 ")]}, {})
    assert (use.program, use.line, use.column, use.text) == ("PROG2", 70, 2, "P10 = 1")
