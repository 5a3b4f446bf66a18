"""M codes that switch nothing, because the store has nothing wired to them."""

import pytest
from tests.cnc.programs import made

CODES = "M3 S100\nM4 S100\nM7\nM8\nM12\nM24\nM595\nM597\nM598\n"


def doubts(text: str, cells: dict[int, float] | None = None) -> list[str]:
    findings = made(text, cells or {}).interpreter.program.findings
    return [f"{each.line} {each.text}" for each in findings if each.code == "W405"]


def test_each_code_with_nothing_wired_is_warned_of_once() -> None:
    nothing = "nothing is wired to the code:"
    assert doubts(CODES + CODES + "M5\nM9\nM25\nM596\nM599\nM2") == [
        f"1 {nothing} M3 (P800005 or P800002)",
        f"2 {nothing} M4 (P800006 or P800002)",
        f"3 {nothing} M7 (P800009)",
        f"4 {nothing} M8 (P800010)",
        f"5 {nothing} M12 (P400101)",
        f"6 {nothing} M24 (P400113)",
        f"7 {nothing} M595 (P250112)",
        f"8 {nothing} M597 (P250112)",
        f"9 {nothing} M598 (P250112)",
    ]


@pytest.mark.parametrize(
    ("cells", "silent"),
    [
        ({800_005: 40.0}, ["M3"]),
        ({800_006: 40.0}, ["M4"]),
        ({800_002: 0.0}, ["M3", "M4"]),  # a DAC alone turns it, number 0 as well
        ({800_009: 40.0}, ["M7"]),
        ({800_010: 40.0}, ["M8"]),
        ({400_101: 40.0}, ["M12"]),
        ({400_113: 40.0}, ["M24"]),
        ({250_112: 0.0}, ["M595", "M597", "M598"]),
    ],
)
def test_what_is_wired_is_not(cells: dict[int, float], silent: list[str]) -> None:
    everything = ["M3", "M4", "M7", "M8", "M12", "M24", "M595", "M597", "M598"]
    found = [text.split(": ")[1].split(" ")[0] for text in doubts(CODES, cells)]
    assert found == [code for code in everything if code not in silent]
