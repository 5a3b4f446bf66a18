"""Which cases only ask: the others stay away from cards that are in use."""

from pathlib import Path

import pytest
from tests.conform.one_case import case_of

from openacr.conform.asking import bar
from openacr.conform.read import supplied


def bar_of(folder: Path, text: str) -> str:
    return bar(case_of(folder, text))


@pytest.mark.parametrize(
    "steps",
    [
        "> ?1+2\n3",
        '> PRINT "A";3,MID$("ABC",2,1)\nA3 B',
        "> ?(NOT 5 AND 3)*-SQRT(4)\n-4",
        "? 1/4; 2**3 -> 0.25; 8",
        "? 1/3 -> 0.333 +- 0.001  # three digits are printed in the guide",
        "SYS> PROG 1\nP01> PLC2\nPLC2> SYS\nSYS>",
        "> REM P0=5",
        "> ?1 : ?2\n1\n2",
    ],
)
def test_a_case_that_prints_what_no_card_stores_only_asks(tmp_path: Path, steps: str) -> None:
    assert bar_of(tmp_path, steps) == ""


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("> P0=5", "line 4: `P0=5` may change the card"),
        ("> ?1 : P0=5\n1", "line 4: `?1 : P0=5` may change the card"),
        ("> X5", "line 4: what the card makes of `X5` is not certain"),
        ("> ATTACH\n...", "line 4: `ATTACH` may change the card"),
        ("> ?P0\n0", "line 4: `?P0` depends on what is stored or sent"),
        ("> ?1+BIT32\n1", "line 4: `?1+BIT32` depends on what is stored or sent"),
        ("> ?SQRT(LV0)\n0", "line 4: `?SQRT(LV0)` depends on what is stored or sent"),
        ("> ?LEN($V1)\n0", "line 4: `?LEN($V1)` depends on what is stored or sent"),
        ("> ?RND(5)\n0", "line 4: `?RND(5)` depends on what is stored or sent"),
        ("> ?INKEY$(0)\n", "line 4: `?INKEY$(0)` depends on what is stored or sent"),
        ('> PRINT #1,"A"', 'line 4: `PRINT #1,"A"` depends on what is stored or sent'),
        ("> ?1\n1\n? 1; P5 -> 1; 0", "line 6: `?P5` depends on what is stored or sent"),
        ("> ?1\n1\nwait 1 s", "line 6: `wait TIME` does more than ask"),
        ("program 0:\n    10 REM", "line 4: `program NUMBER:` does more than ask"),
        (">> 00", "line 4: `>>BYTES` does more than ask"),
        ("press ^Z", "line 4: `press KEY` does more than ask"),
        ("machine:\n    [card]\n> ?1\n1", "it needs a machine that is set up"),
        ("moves: 1 units at 1 units/s\n> ?1\n1", "it moves a motor (--moving AXIS)"),
        ("changes: P5, BIT128\n> ?1\n1", "it sets P5, BIT128 and puts them back (--setting)"),
        ("only: virtual\n> ?1\n1", "it needs the world around a virtual card"),
    ],
)
def test_any_other_case_is_kept_away_with_its_reason(
    tmp_path: Path, text: str, reason: str
) -> None:
    assert bar_of(tmp_path, text) == reason


def test_the_cases_supplied_are_those_of_the_source_tree() -> None:
    assert supplied() == Path(__file__).parents[2] / "conformance"
