"""Contours under compensation, many elements at once: what each element by itself gives."""

import math
import random
from itertools import islice

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.cnc.programs import Run, made, unrolled
from tests.cnc.test_many_blocks import one_by_one
from tests.search import search

from openacr.cnc.canonical import Arc, Line, Moves
from openacr.cnc.compensation import chain, chain_cy, pieces
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.reading.findings import BlockError
from openacr.compiled import is_compiled

MOST = 3000
WORDS = {"G17": (*"XYZ", "IJ"), "G18": (*"ZXY", "KI"), "G19": (*"YZX", "JK")}
BETWEEN = """\
M8
M9
G90
F12
(remark)
G40
G41
G42
D2
D1
G17
G18
G20
G21
G61
G64
M0
S500 M3
G54
G43 H1
G49
#1=#1+1
X#1
P1998=.2
G81 X1 Y1 Z-1 R1 F5
M7 F3
T2
G28 X0
G2 X0 Y0 R1
G92 X1
G1 X1 Y1 Z1 A5
G4 P.1
G4 F.1
G1
N5
""".splitlines()


def contour(chance: random.Random, plane: str, count: int, *, is_wild: bool) -> list[str]:
    """Lines and arcs, sharp and smooth corners, and between them what the parts say."""
    first, second, across, centres = WORDS[plane]
    x = y = 0.0
    heading, lines = chance.uniform(-3, 3), []

    def word(axis: str, value: float) -> str:
        return f"{axis}{value:.{chance.choice((2, 4, 6))}f}"

    for _ in range(count):
        if is_wild and chance.random() < 0.04:
            lines.append(chance.choice(BETWEEN))
            continue
        heading += chance.choice([chance.uniform(-0.6, 0.6), chance.uniform(-3.1, 3.1), 0.0])
        length = chance.choice([chance.uniform(0.01, 0.3), chance.uniform(0.2, 3), 0.5])
        rise = f" {word(across, chance.uniform(-1, 0))}" if chance.random() < 0.1 else ""
        kind = chance.random()
        if kind < 0.7:
            x, y = x + length * math.cos(heading), y + length * math.sin(heading)
            code = "G1" if chance.random() < 0.9 else "G0"
            feed = f" F{chance.randrange(1, 99)}" if chance.random() < 0.1 else ""
            lines.append(f"{code} {word(first, x)} {word(second, y)}{rise}{feed}")
        elif kind < 0.97:
            turn, sweep = chance.choice([-1, 1]), chance.choice([chance.uniform(0.05, 6), 1.5])
            radius = chance.choice([chance.uniform(0.02, 0.4), chance.uniform(0.3, 3)])
            i, j = -turn * radius * math.sin(heading), turn * radius * math.cos(heading)
            heading += turn * sweep
            wrong = 0.01 if is_wild and chance.random() < 0.05 else 0.0
            x += i + turn * radius * math.sin(heading)
            y += j - turn * radius * math.cos(heading)
            ends = f"{word(first, x + wrong)} {word(second, y)}{rise}"
            code = "G3" if turn > 0 else "G2"
            lines.append(f"{code} {ends} {centres[0]}{i:.6f} {centres[1]}{j:.6f}")
        else:
            lines.append(f"G1 {word(chance.choice((first, across)), y)}")
    return lines


def program(chance: random.Random, dialect: str) -> str:
    """One or two compensated contours."""
    is_wild = chance.random() < 0.4
    lines = ["F10", "G91.1 G20" if dialect == "rs274ngc" else "G200 F1 G20"]
    for _ in range(chance.randrange(1, 3)):
        plane = chance.choice(["G17", "G17", "G17", "G18", "G19"])
        a, b = WORDS[plane][:2]
        lines += [plane, f"G0 {a}{chance.uniform(-1, 1):.3f} {b}{chance.uniform(-1, 1):.3f}"]
        lines.append(f"G{chance.choice((41, 42))} D1 G1 {a}0 {b}0")
        lines += contour(chance, plane, chance.choice([3, 8, 30, 100]), is_wild=is_wild)
        if chance.random() < 0.9:
            lines += ["G40", f"G1 {a}{chance.uniform(-2, 2):.3f} {b}9"]
    return "\n".join([*lines, "M2"])


def cells(chance: random.Random) -> dict[int, float]:
    """Radii, wear, and whether the tool stops at gouges."""
    radius = chance.choice([0.1, 0.05, 0.25, 0.5, 0.0, -0.1])
    return {
        910: chance.choice([0.0, 0.125]), 1001: radius, 1002: 0.15, 1501: chance.choice([0, 0.01]),
        2001: 0.5, 250_130: float(chance.random() < 0.6), 400_010: 3.0,
    }  # fmt: skip


def done(text: str, dialect: str, kept: dict[int, float], options: Options) -> Run:
    found = made(text, kept, axes=7, dialect=dialect, options=options)
    if found.interpreter.program.errors:
        return found
    try:
        found.entries.extend(islice(unrolled(found.interpreter.entries()), MOST))
    except BlockError as error:
        found.error = error.finding
    return found


def require_same(seed: int, dialect: str, *, collects_errors: bool) -> None:
    chance = random.Random(seed)
    text, kept = program(chance, dialect), cells(chance)
    options = Options(collects_errors=collects_errors)
    with pytest.MonkeyPatch.context() as patch:
        one_by_one(patch)
        single = done(text, dialect, kept, options)
    many = done(text, dialect, kept, replace(options, has_batches=True))
    assert many.error == single.error, text
    assert many.entries == single.entries, text
    one, other = many.interpreter, single.interpreter
    assert (one.warnings, one.errors) == (other.warnings, other.errors)
    assert many.cells.written == single.cells.written
    if single.error is None and len(single.entries) < MOST:
        assert one.modal == other.modal
        assert (one.position, one.path.target) == (other.position, other.path.target)
        assert one.path.issued == other.path.issued
        assert one.is_rested == other.is_rested


@search(150)
@given(
    seed=st.integers(0, 10**9),
    dialect=st.sampled_from(["acromill", "rs274ngc"]),
    both=st.booleans(),
)
def test_many_elements_do_what_each_does(seed: int, dialect: str, both: bool) -> None:
    require_same(seed, dialect, collects_errors=both)


@pytest.mark.soak
def test_very_many_contours_do_what_each_of_their_elements_does() -> None:
    for seed in range(5_000):
        require_same(seed, ("acromill", "rs274ngc")[seed % 2], collects_errors=seed % 3 == 0)


def moves_of(text: str) -> list[list[tuple[int, str, bool, float, list[float]]]]:
    """Line, kind, whether inserted, feed and end of the moves of each batch."""
    run = made(text, dialect="rs274ngc", options=Options(has_batches=True)).interpreter
    found = [list(each.entries()) for each in run.entries() if isinstance(each, Moves)]
    return [
        [
            (one.source.line, type(one).__name__, one.is_inserted, one.pace.feed_upm,
             [round(value, 9) for value in one.end[:2]])
            for one in many if isinstance(one, Line | Arc) and one.is_compensated
        ]
        for many in found
    ]  # fmt: skip


def test_elements_wait_for_the_next_one_across_codes_and_batches() -> None:
    text = "F10\nG41.1 D.2 G1 X0 Y0\nX1\nY1\n(a remark)\nX0 F20\nM8\nY0\nG40 X-1\nM2\n"
    assert moves_of(text) == [
        [(3, "Line", False, 10.0, [0.9, 0.0]), (4, "Line", False, 10.0, [0.9, 0.9])],
        [(6, "Line", False, 20.0, [0.1, 0.9])],
    ]


def test_the_tool_rolls_about_a_corner_with_the_feed_of_the_next_line() -> None:
    text = "F10\nG42.1 D.2 G1 X0 Y0\nX1\nY1\nX0 F20\nY2\nG40 X-1 Y3\nM2\n"
    assert moves_of(text) == [
        [
            (3, "Line", False, 10.0, [1.1, 0.0]),
            (4, "Line", False, 10.0, [1.1, 1.0]),
            (5, "Arc", True, 20.0, [1.0, 1.1]),
            (5, "Line", False, 20.0, [0.1, 1.1]),
        ]
    ]


def test_entries_before_a_gouge_are_handed_out_before_its_error() -> None:
    text = "F10\nG41.1 D.2 G1 X0 Y0\nX1\nY1\nX.95\nY0\nX0\nG40 X-1\nM2\n"
    many = done(text, "rs274ngc", {}, Options(has_batches=True))
    single = done(text, "rs274ngc", {}, Options())
    assert many.error == single.error
    assert many.error is not None
    assert (many.error.code, many.error.line) == ("E322", 5)
    assert many.entries == single.entries
    assert len(many.entries) == 3


def test_many_elements_left_out_do_not_overwrite_one_that_waits() -> None:
    text = """\
G200 F1 G20
G41 D1 G1 X0 Y0
G1 X-0.51 Y0.7473
G1 X-6.452485 Y-4.8783
G1 X-5.631877 Y-4.3068
G1 X-5.4085 Y-4.241369
G1 X-4.9086 Y-4.231282
G1 X-4.9344 Y-4.22
G1 X-4.9053 Y-4.16 Z-0.31 F89
G1 X-4.494561 Y-3.2433
G1 X-4.6311 Y-3.002432
G1 X-4.877714 Y-2.57
G0 X-4.98 Y-3.0575
G2 X-5.3741 Y-2.7332 I0.109008 J0.539089
G0 X-3.87 Y-0.83
G1 X-1.0098 Y-0.8928
G1 X-4.3405 Y-1.7161 Z-0.328341
G2 X-6.40 Y-2.531667 I-1.439501 J0.623886
G1 X-6.45 Y-2.6467
"""
    found = done(text, "acromill", {1001: 0.25, 250_130: 0.0}, Options(collects_errors=True))
    assert len([each for each in found.interpreter.warnings if each.code == "W322"]) == 11
    ends = [(e.source.line, [round(x, 4) for x in e.end[:2]])
            for e in found.entries if isinstance(e, Line)]  # fmt: skip
    assert ends[:3] == [(2, [0.0, 0.0]), (3, [-0.3381, 0.5657]), (4, [-5.0681, -3.912])]


@pytest.mark.skipif(not is_compiled, reason="only plain Python here")
def test_both_builds_give_the_same_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(30):
        chance = random.Random(seed)
        text, kept = program(chance, "acromill"), cells(chance)
        options = Options(has_batches=True, collects_errors=True)
        compiled = done(text, "acromill", kept, options)
        with monkeypatch.context() as patch:
            for name in chain_cy.__all__:
                place = pieces if name == "chain_lay" else chain
                patch.setattr(place, name.replace("chain", ""), getattr(chain_cy, name))
            plain = done(text, "acromill", kept, options)
        assert plain.entries == compiled.entries
        assert plain.interpreter.warnings == compiled.interpreter.warnings


def require_equal(text: str) -> Run:
    many = done(text, "rs274ngc", {}, Options(has_batches=True))
    single = done(text, "rs274ngc", {}, Options())
    assert many.error == single.error is None
    assert many.entries == single.entries
    return many


def test_a_contour_of_more_moves_than_are_issued_at_once_is_complete() -> None:
    lines = [f"X{k / 10:.1f} Y{k % 2 / 100:.2f}" for k in range(1, 2900)]
    text = "\n".join(["F10", "G41.1 D.02 G1 X0 Y0", *lines, "G40 X300", "M2"])
    found = require_equal(text)
    ends = [e.source.line for e in found.entries if isinstance(e, Line) and not e.is_inserted]
    assert ends == [*range(2, 2 + len(lines) + 2)]


def test_a_hundred_blocks_without_motion_end_the_wait_for_the_next_element() -> None:
    text = "F10\nG41.1 D.2 G1 X0 Y0\nX1\n" + "X1\n" * 99 + "Y1\nX0\nG40 X-1\nM2\n"
    waiting = require_equal(text)
    assert [round(x, 9) for x in waiting.entries[1].end[:2]] == [0.9, 0.0]  # type: ignore[union-attr]
    resting = require_equal(text.replace("Y1\n", "X1\nX1\nY1\n"))
    assert [round(x, 9) for x in resting.entries[1].end[:2]] == [1.0, 0.1]  # type: ignore[union-attr]
