"""Holes of canned cycles drilled together: bit for bit the same as block by block."""

import random
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.programs import CYCLES, made
from tests.cnc.test_fuzz import mutated
from tests.cnc.test_many_blocks import done, require_equal_builds, require_same
from tests.search import search

from openacr.cnc.canonical import Dwell, Entry, Line, Moves, Rapid, Source, Sync
from openacr.cnc.interpreter.by_block import loops
from openacr.cnc.interpreter.interpreter import Options
from openacr.compiled import is_compiled

SHARED = """\
G81 X1 Y2 Z-1 R.5 F30
G81 X1.25 Y-.5 Z-1.125 R.3
G82 X1 Z-.5 R.2 P.5
G82 Y1 P0
G83 X2 Y2 Z-2 R.1 Q.3
G73 X-1 Z-1 R.25 Q.125
G73 Z-.4 Q.7
G85 X3 Z-1 R.5
G86 X3.5 Z-1 R.5
G89 X2 Z-1 R.5 P.25
G89 P.05
G84 Z-1 R.1
G74 Z-1 R.1
G81 Z1 R.5
G81 Z.5 R.5
G99
G98
G98 X3
G99 G83 X.5 Y.5 Q.25
G90
G91
G91 X.5 L3
G90 X.5 L2
X1 L1.5
X2 L0
X1
Y1.5
X-1 Y-1
X.1 R.75
X.2 Z-1.5
Z-.75
X1 Q.2
X2 P1.5
X1 I1
A10
X1 A5 F20
F25
G17
G18
G18 G81 Y-1 X1 R0
G19
G19 G82 X-1 Y.5 R.1
G80
G80 X1
G0 Z5
G0 X0 Y0 Z2
G1 Z1 F50
G1 X1
G2 X1 Y1 R2
G80 G0 Z3
G20
G21
G21 G81 X5 Z-3 R1
M3 S100
S200
M8
G54
G55
G92 X.1 Z.7
G43 H1
P200=P253
X(P200)
X[1+1]
#1=2
G81 X#1 Z-1 R.1
N40 X1 ; hole
X2 (hole)
G4 F.5
G4 P.5
G64
G61
G40
""".splitlines()
BEGIN = ["F10 G0 Z2", "F10", "G0 Z2", "F10 G0 Z.2", "F10 G0 X1 Z5\nG99 G81 X0 Z-1 R.5"]


def program(chance: random.Random, dialect: str) -> str:
    frequent = chance.sample(SHARED, chance.randrange(3, 25))
    wrong = chance.choice([0.0, 0.0, 0.03])
    lines = [chance.choice(BEGIN)]
    for _ in range(chance.randrange(3, 60)):
        text = chance.choice(frequent)
        lines.append(mutated(text, chance) if chance.random() < wrong else text)
    return "\n".join(lines) + (CYCLES if dialect == "acromill" else "\nM2\n")


@search(250)
@given(seed=st.integers(0, 10**9), dialect=st.sampled_from(["acromill", "rs274ngc"]))
def test_many_holes_are_what_each_is(seed: int, dialect: str) -> None:
    require_same(program(random.Random(seed), dialect), dialect)


@pytest.mark.soak
def test_very_many_holes_are_what_each_is() -> None:
    for seed in range(20_000):
        chance = random.Random(seed)
        dialect = chance.choice(["acromill", "rs274ngc"])
        require_same(program(chance, dialect), dialect)


def batches_of(text: str) -> list[Entry]:
    run = made(text, dialect="rs274ngc", options=Options(has_batches=True)).interpreter
    return list(run.entries())


def test_holes_are_one_batch_with_the_lines_of_the_cycle() -> None:
    moves, _ = batches_of("F100 G0 Z5\nG99 G81 X1 Z-2 R1\nX2 (last)\nM2")
    assert isinstance(moves, Moves)
    found = [(type(e), e.end[0], e.end[2], e.source.file, e.source.text) for e in moves.entries()]
    assert found == [
        (Rapid, 0.0, 5.0, "PROGRAM", "F100 G0 Z5"),
        (Rapid, 1.0, 5.0, "PROGRAM", "G99 G81 X1 Z-2 R1"),
        (Rapid, 1.0, 1.0, "CYCLES.TXT", "N81000 G0 Z(P253)"),
        (Line, 1.0, -2.0, "CYCLES.TXT", "G1 Z(P252)"),
        (Rapid, 1.0, 1.0, "CYCLES.TXT", "G0 Z(P255)"),
        (Rapid, 2.0, 1.0, "PROGRAM", "X2 (last)"),
        (Line, 2.0, -2.0, "CYCLES.TXT", "G1 Z(P252)"),
        (Rapid, 2.0, 1.0, "CYCLES.TXT", "G0 Z(P255)"),
    ]


def test_dwells_are_entries_between_the_moves_of_a_cycle() -> None:
    first, dwell, second, again, last, _ = batches_of("F100 G0 Z5\nG99 G82 X1 Z-2 R1 P.5\nX2\nM2")
    assert isinstance(first, Moves)
    assert isinstance(second, Moves)
    assert isinstance(last, Moves)
    assert (len(first), len(second), len(last)) == (4, 3, 1)
    assert dwell == again == Dwell(Source("CYCLES.TXT", 45, "G4 F(P257)"), 0.5)


def test_pecks_wait_for_nothing_in_either_dialect() -> None:
    text = "F10 G0 Z2\nG83 X1 Z-1 R.5 Q.1\nX2"
    for dialect, end in (("acromill", CYCLES), ("rs274ngc", "\nM2\n")):
        assert not require_same(text + end, dialect).of(Sync)


def test_passes_of_a_cycle_are_counted_hole_by_hole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loops, "MOST_PASSES", 20)
    holes = "".join(f"X{k}\n" for k in range(30))
    pecks = "F10 G0 Z2\nG83 X1 Z-1 R.5 Q{}\n" + holes + "M2\n"
    assert require_same(pecks.format(".1"), "rs274ngc").error is None
    found = done(pecks.format(".01"), "rs274ngc", Options(collects_errors=True), is_slow=True)
    assert found.error is not None
    assert found.error.code == "A62"


@pytest.mark.parametrize(
    "text",
    [
        "G81 X1 Z1 R.5",  # the bottom above R
        "G81 X1 Z-1",  # no R
        "G83 X1 Z-1 R.1",  # no Q
        "G83 X1 Z-1 R.1 Q0",
        "G73 X1 Z-1 R.1 Q0",
        "G81 X1 Z-1 R.1\nG80\nG81 X2 Z-1",  # R has ended
        "G81 X1 Z-1 R.1\nG80\nG81 X2 R.1",
        "G82 X1 Z-1 R.1 P1000",  # beyond its limit
        "G81 X1 Z-1 R.1 L2\nX2 L.5",
        "P200=999.9\nG82 X1 Z-1 R.1 P(P200)",
        "P200=1000\nG82 X1 Z-1 R.1 P(P200)",
        "P200=-1\nG82 X1 Z-1 R.1 P(P200)",
        "P200=1.5\nG82 X1 Z-1 R.1 L(P200)",
        "G0 Z-3\nG81 X1 Z-9 R0",  # W219
        "G81 Z-1 R.1 X1\nG18",  # W213
        "G81 Z-1 R.1 X1\nX1 I1",
    ],
)
def test_doubtful_and_wrong_cycles_are_found_as_before(text: str) -> None:
    for dialect in ("acromill", "rs274ngc"):
        end = CYCLES if dialect == "acromill" else "\nM2\n"
        require_same(f"F10 G0 Z2\n{text}\nX3{end}", dialect)


def test_a_hole_that_cannot_be_finished_together_is_drilled_by_itself() -> None:
    text = "F10 G0 Z2\nG99 G83 X1 Z-{} R0 Q.001\nX2\nM2"
    for depth in (1, 3, 9):
        require_same(text.format(depth), "rs274ngc")
    # More moves than there is room for, between two holes and within one.
    for many in ("G91 G81 X.01 Z-1 R0 L3000", "G91 G83 X.01 Z-1 R0 Q.01 L40"):
        assert len(require_same(f"F10 G0 Z2\n{many}\nM2", "rs274ngc").entries) == 4000


def test_words_of_a_cycle_last_into_blocks_read_by_themselves() -> None:
    for between in ("M8", "G92 X.1", "X5 L0", "G80\nG0 Z4", "G0 Z3\nG81", "M4", "M5", "S9",
                    "T2 M6"):  # fmt: skip
        text = f"F10 G0 Z2 M3\nG98 G83 X1 Z-1 R.5 Q.3 P1\nX2\n{between}\nX3\nX4{CYCLES}"
        require_same(text, "acromill")


OWN_CYCLE = """\
N81000 G0 Z(P253) ; to R
P400=P400+P259
P268=0
N81001 P268=P268+.25
G1 X(P250+P268) Z(P252)
IF P268<.6 THEN GOTO 81001
X(P250)

(up)
G4 F(P400)
N81002 G0 Z(P255) Y(P251)
RET
"""


def test_cycles_of_the_user_are_drilled_together(tmp_path: Path) -> None:
    text = "F10 G0 Z2\nG3 X0 Y0 I1 J0\nG81 X1 Z-1 R.5\nG99 X2\nG91 X3 L2\nM2\n$I CYCLES.TXT\n"
    changes = [
        ("", ""),
        ("P400=P400+P259", "#5=P400+1\nP400=#5"),
        ("G4 F(P400)", "M8\nG4 F.5"),
        ("G4 F(P400)", "G91"),
        ("G4 F(P400)", "G4 F(P400/50)"),
        ("+.25", "+0."),
        ("RET", ""),
        ("RET", "/RET\nRET"),
        ("G0 Z(P253) ;", "Z(P253) ;"),
        ("G0 Z(P253) ;", "GOTO 81000 ;"),
    ]  # fmt: skip
    for old, new in changes:
        own = OWN_CYCLE.replace(old, new) if old else OWN_CYCLE
        (tmp_path / "CYCLES.TXT").write_text(own)
        path = tmp_path / "PART.NC"
        path.write_text(text)
        single = done(path, "acromill", Options(collects_errors=True), is_slow=True)
        options = Options(collects_errors=True, has_batches=True)
        many = done(path, "acromill", options, is_slow=False)
        assert many.entries == single.entries
        assert many.error == single.error
        assert many.cells.written == single.cells.written


@pytest.mark.skipif(not is_compiled, reason="only plain Python here")
def test_both_builds_drill_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(60):
        chance = random.Random(seed)
        dialect = chance.choice(["acromill", "rs274ngc"])
        require_equal_builds(program(chance, dialect), dialect, monkeypatch)
