"""What a line costs by its shape: as much as its tokens, whatever the shape leaves open."""

import random

import pytest

from openacr.basic.memory.known_lines import line_cost
from openacr.basic.memory.memory_cost import line_bytes
from openacr.lang.lexer import LexError, tokens
from openacr.lang.shape import shape

PIECES = [
    "X", "5", "1.5", ".25", "2.", "1E5", "1.e3", "1E+7", "3.1415926535", "1.2.3", "000000001", "0",
    "REM", "rem at 5.5 ", "5REM 7", "Rem", '"ab"', '"a""b"', '"5.5 x"', '"open', "'", "'1.5 \"q\"",
    '_a1"open rem 5', "_a1", "_ b4", "GOTO b2", "GOTO _c35", "GOSUB", " ", ":", "=", "P0",
    "5E", "$V1", "(", "#",
]  # fmt: skip


def drawn(chance: random.Random) -> str:
    return "".join(
        chance.choice(PIECES) + chance.choice(["", " "]) for _ in range(chance.randrange(1, 6))
    )


def test_lines_cost_by_their_shape_what_their_tokens_cost() -> None:
    chance = random.Random(1)
    known, compared = {}, dict.fromkeys([None, "_remark", "_strings", "_floats", "_length"], 0)
    for _ in range(25_000):
        line = drawn(chance)
        try:
            found = tokens(line)
        except LexError:
            continue
        kind = shape(line)
        if kind not in known:
            known[kind] = line_cost(line, kind, found)
        elif (cost := known[kind]) is not None:
            assert cost.bytes(line) == line_bytes(found), (line, kind)
            compared[getattr(cost.varying, "__name__", None)] += 1
    assert min(compared.values()) > 100


@pytest.mark.parametrize(
    ("line", "other"),
    [
        ("X1 REM a", "X22 REM longer"),
        ('PRINT "a"', 'PRINT "longer"'),
        ("X1.5 Y2.25", "X1.123456789 Y2.5"),
        ("GOTO part1", "GOTO part1234"),
        ("_part1 REM a", "_part1234 REM longer"),
    ],
)
def test_what_differs_in_lines_of_a_shape_needs_no_tokens(line: str, other: str) -> None:
    cost = line_cost(line, shape(line), tokens(line))
    assert cost is not None
    assert shape(other) == shape(line)
    assert cost.bytes(line) < cost.bytes(other) == line_bytes(tokens(other))
