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
        ("LV0 = P12288", [("PROG3 LV0", "writes"), ("P12288", "reads")]),
        (
            "SA0(LV1+(2)) = DV2*LA1(3)",
            [
                ("PROG3 SA0", "writes"),
                ("PROG3 LV1", "reads"),
                ("PROG3 DV2", "reads"),
                ("PROG3 LA1", "reads"),
            ],
        ),
        ("IF (LV0 = 1) THEN SET 130", [("PROG3 LV0", "reads"), ("BIT130", "writes")]),
        ("DIM SA0(20)", [("PROG3 SA0", "defines")]),
        ("DIM LV(2)", []),
        ("SPEED = P(LV3)", [("SPEED", "writes"), ("PROG3 LV7", "writes"), ("PROG3 LV3", "reads")]),
        ("REM P10", []),
    ],
)
def test_a_line_of_a_program_reads_and_writes(text: str, expected: list[tuple[str, str]]) -> None:
    assert found(text, SPEED="LV7") == expected


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


def test_a_count_of_variables_defines_those_that_its_program_names() -> None:
    texts = {
        "PROG3": [(10, "DIM LV(2)"), (20, "LV1 = LV2"), (30, "DIM SA(1)"), (40, "SA0(1)=1")],
        "PROG4": [(10, "LV1 = 5")],
    }
    defined = [each for each in uses(texts, {}) if each.access == "defines"]
    assert [(each.name, each.line, each.column, each.text) for each in defined] == [
        ("PROG3 LV1", 10, 4, "DIM LV(2)"), ("PROG3 SA0", 30, 4, "DIM SA(1)"),
    ]  # fmt: skip
