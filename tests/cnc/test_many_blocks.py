"""Many blocks executed together: bit for bit the same as one by one."""

import random
from itertools import islice
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.cnc.programs import Run, made, unrolled
from tests.cnc.test_fuzz import ACROMILL, OTHER, mutated
from tests.search import search

from openacr.cnc.canonical import Arc, Coolant, Line, Moves, Output, Plane, Rapid, Source
from openacr.cnc.codes.fast import Sets
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.interpreter.by_line import fast_plans, lines_cy, scanning
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.loading.load import Loader
from openacr.cnc.loading.skimming import Skimmer
from openacr.cnc.program.labels import Place
from openacr.cnc.reading.blocks import Block
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.rows import modes
from openacr.cnc.rows.moves import ARC, LINE, RAPID, ROW
from openacr.cnc.rows.runs import MOST_IDLE
from openacr.cnc.state.cells import FIXTURES, LENGTH_WEARS, LENGTHS, RADII
from openacr.cnc.state.modal import Modal
from openacr.compiled import is_compiled

MOST = 4000
CELLS = {
    910: 0.125, 921: -3.0, 922: 0.7, 930: 0.3, 938: 30.0, 940: -1.7, 1001: 0.1, 2001: 1.0,
    250_112: 3.0, 400_010: 3.0,
    LENGTHS + 1: 0.6, LENGTHS + 2: -1.1, LENGTH_WEARS + 2: 0.01, RADII + 1: 0.2, FIXTURES + 10: 0.9,
}  # fmt: skip
PLAIN = """\
G0 X1 Y2 Z3
G1 X1.25 Y-2.5 F100
G1 X.5 (to the edge)
N10 G2 X3 Y0 I1 J.5
G3 X1 Y1 R2 F50.5
G3 X1 Y1 R-2
G2 X2 Y1 Z-.5 I.5
G2 I1 J0
G2 I1 J0 P2
G3 X0 Y0 I-1
g3 x.5 y.5 i.25 j.25 ; finish
G18 G2 X1 Z1 I.5 K.5
G2 X0 Z0 R1
G19 G3 Y1 Z1 J.5 K.5
G3 Y0 Z.25 R5
G17
G17 G90
G17 G91 G1 X.1
G90
G91
G20
G21
G21 G1 X10
G20 F30
X1
Y-1 Z-.5
A10
X.1 A20 U1
G1
G0
F200
F0
G98
G99
G40
G40 G49 G17
G64
G61
G0 X1 F5 A0
N7
N8.5 X2
N0 X3

(a remark)
(roughing, tool 3)
(drill 5 mm, then ream) X1
; all of it
X1 (open
M7
M8
M9
M8 X2
X3 M9
F20 M7 G2 X1 Y1 R2
S1000
S1000 M3
S-1
M4 S500 X1
M5
M3 M8
T2
T2.5
T1 M6
M6 X2
M6
G54
G54 X1
G55
G56
G53
H1
H2 X1
H999
D1 X2
D.5
G43
G43 H1
G43 H2 G0 Z1
G43 H1 G55 X.5
G43 H#9
G49
G49 G54 Z0
G59 M8 X1
G92 X1
G2 X1
G2 X9 Y9 I.1 J.1
G2 X1 Y1 I.5 J.5 K1
G2 X1 Y1 I.5 R1
G1 X1 I1
X1 X2
G1 G2 X1
G17 G18
G4 F.5
G4 P1
X(1+1)
X[1+1]
P200=1
#200=1
/X3
""".splitlines()
OWN = {
    "acromill": [
        *("G200 F0", "G200 F1", "G200 F2", "G62", "G63", "G70", "G71", "G9 X1", "M12", "M25 X1"),
        *("G44", "G44 H2 X1", "G101", "G101 X2", "G100", "G59.2"),
    ],
    "rs274ngc": [
        *("G90.1", "G91.1", "G94", "G97", "G80", "G93 G1 X1 F2", "G94 F60", "G64 P.01", "G59.3"),
        *("M62 P1", "M65 P1 X2", "M62 P99", "M61 Q2", "M51 P1", "G43.1 Z.5", "G43.2 H1"),
    ],
}


def one_by_one(patch: pytest.MonkeyPatch) -> None:
    """Every line by itself, at load and in the run."""
    patch.setattr(scanning.Scanner, "is_free", property(lambda _: False))
    patch.setattr(Skimmer, "skim", lambda _, text, offset: (0, offset))


def done(text: str | Path, dialect: str, options: Options, *, is_slow: bool) -> Run:
    """A program run to its end or error, moves by themselves."""
    with pytest.MonkeyPatch.context() as patch:
        if is_slow:
            one_by_one(patch)
        found = made(text, CELLS, axes=7, dialect=dialect, options=options)
        if found.interpreter.program.errors:
            return found
        try:
            found.entries.extend(islice(unrolled(found.interpreter.entries()), MOST))
        except BlockError as error:
            found.error = error.finding
    return found


def require_same(text: str, dialect: str) -> Run:
    options = Options(collects_errors=True)
    single = done(text, dialect, options, is_slow=True)
    many = done(text, dialect, replace(options, has_batches=True), is_slow=False)
    findings = single.interpreter.program.findings
    assert many.interpreter.program.findings == findings
    assert many.interpreter.program.line_cnt == single.interpreter.program.line_cnt
    assert many.error == single.error, text
    for one, other in zip(many.entries, single.entries, strict=len(single.entries) < MOST):
        assert one == other, text
    if len(single.entries) < MOST:
        assert many.interpreter.modal == single.interpreter.modal
        if single.error is None:
            assert many.interpreter.execution.idle_cnt == single.interpreter.execution.idle_cnt
        assert many.interpreter.drilling == single.interpreter.drilling
        assert many.interpreter.position == single.interpreter.position
        assert many.interpreter.path.target == single.interpreter.path.target
        assert many.interpreter.warnings == single.interpreter.warnings
        assert many.interpreter.errors == single.interpreter.errors
        assert many.cells.written == single.cells.written
    return many


def program(chance: random.Random, dialect: str) -> str:
    """Plain lines, here and there a line of all the others, here and there a changed one."""
    others = (ACROMILL if dialect == "acromill" else OTHER).splitlines()
    rare, wrong = chance.choice([(0.0, 0.0), (0.02, 0.0), (0.1, 0.02)])
    lines = ["F10"] if chance.random() < 0.8 else []
    frequent = chance.sample(PLAIN + OWN[dialect], chance.randrange(4, 40))
    for _ in range(chance.randrange(5, 120)):
        chosen = others if chance.random() < rare else frequent
        text = chance.choice(chosen)
        if text in ("M2", "%", "$I CYCLES.TXT", "RET", "M30"):
            continue
        lines.append(mutated(text, chance) if chance.random() < wrong else text)
    if chance.random() < 0.5:
        lines.append("M2")
    return chance.choice(["\n", "\r\n", "\r"]).join(lines)


@search(250)
@given(seed=st.integers(0, 10**9), dialect=st.sampled_from(["acromill", "rs274ngc"]))
def test_many_blocks_do_what_each_does(seed: int, dialect: str) -> None:
    require_same(program(random.Random(seed), dialect), dialect)


@pytest.mark.soak
def test_very_many_blocks_do_what_each_does() -> None:
    for seed in range(20_000):
        chance = random.Random(seed)
        dialect = chance.choice(["acromill", "rs274ngc"])
        require_same(program(chance, dialect), dialect)


def batch(text: str, dialect: str = "rs274ngc") -> list[Moves]:
    run = made(text, dialect=dialect, options=Options(has_batches=True)).interpreter
    return [entry for entry in run.entries() if isinstance(entry, Moves)]


def test_lines_arcs_rapids_and_modal_codes_are_one_batch() -> None:
    text = "F60\nG0 X1 (start)\nG17 G90\nG1 Y1\nN9 G3 X0 Y2 I-1 ; arc\nF30\n\nG1 X5\nM2"
    (moves,) = batch(text)
    rows = [tuple(moves.rows[k : k + 4]) for k in range(0, len(moves.rows), ROW)]
    assert rows == [
        (RAPID, 2, 0, 17),
        (LINE, 4, 0, 17),
        (ARC, 5, 0, 17),
        (LINE, 8, 1, 17),
    ]
    first, second, third, last = moves.entries()
    assert last.source.text == "G1 X5"
    assert first == Rapid(Source("PROGRAM", 2, "G0 X1 (start)"), (1.0, *(0.0,) * 7))
    assert isinstance(second, Line)
    assert second.pace.feed_upm == 60.0
    assert isinstance(third, Arc)
    assert (third.source.text, third.plane, third.centre) == (
        "N9 G3 X0 Y2 I-1 ; arc", Plane.XY, (0.0, 1.0),
    )  # fmt: skip
    assert (third.start_radius, third.end_radius) == (1.0, 1.0)
    assert moves.source == first.source


def test_offsets_are_switched_between_the_moves_of_one_batch() -> None:
    text = "F60 X1\nG55 Y1\nD1\nG43 H1 Z1\nG54\nG49 Z1\nG53 X7\nM2"
    cells = {921: -3.0, LENGTHS + 1: 0.5}
    run = made(text, cells, dialect="acromill", options=Options(has_batches=True)).interpreter
    (moves,) = (entry for entry in run.entries() if isinstance(entry, Moves))
    ends = [moves.end_of(k) for k in range(len(moves))]
    assert [end[:3] for end in ends] == [
        *((1.0, 0.0, 0.0), (1.0, -2.0, 0.0), (1.0, -2.0, 1.5), (1.0, -2.0, 1.0), (7.0, -2.0, 1.0)),
    ]


def test_offsets_that_change_under_compensation_or_in_a_cycle_do_what_they_do_alone() -> None:
    around = "F60\nD1\nG41 G1 X1\nX2\nX3\n{}\nX3 Y2\nX4 Y3\nD2\nX5\nX6 Y5\nG40 X9\nM2"
    for text in ("G55", "H1 Z2", "G43 H2", "D2"):
        require_same(around.format(text), "acromill")
    holes = "F60\nG91 G98 G81 X1 Z-3 R1\nX2\n{}\nX4\nG43 H1\nX6\nG54 X1 L3\nX7\nG80\nM2"
    for text in ("G55", "G55 X2", "G49", "D1"):
        require_same(holes.format(text), "rs274ngc")
        require_same(holes.format(text).replace("G91 ", ""), "rs274ngc")


@pytest.mark.parametrize("text", ["G56 X1 Y0", "G43 Z1", "G43 H999 X1", "G55 Z1"])
def test_a_block_whose_offset_is_not_a_mere_shift_does_what_it_does_by_itself(text: str) -> None:
    for before in ("", "G99 G81 Z-1 R1\n"):
        require_same(f"F60 X1\nT2 M6\n{before}{text}\nX2 Y2\nG54\nX3\nM2", "rs274ngc")


def test_outputs_stand_in_their_places_between_the_moves() -> None:
    found = require_same("F60 X1\nM62 P3\nX2\nM65 P4 X3\nM2", "rs274ngc").entries
    shown = [
        (entry.number, entry.is_on) if isinstance(entry, Output) else entry.end[0] - 0.125
        for entry in found
        if isinstance(entry, Output | Line)
    ]
    assert shown == [1.0, (35, True), 2.0, (36, False), 3.0]


@pytest.mark.parametrize(
    ("good", "wrong"),
    [
        ("S1000000", "S1000001"),
        ("T999 M8", "T999.5 M8"),
        ("M62 P31", "M62 P32"),
        ("T0", "T-1"),
        ("S5 T3", "S5 T1000"),
        ("S5 T4", "S-1 T4"),
        ("S[5] T3", "S[5] T1000"),
    ],
)
def test_words_out_of_their_limits_are_found_among_many_like_them(good: str, wrong: str) -> None:
    text = f"F60\nS1\n{good}\n{good}\nX1\n{wrong}\n{good}\n{wrong}\nX2\nM2"
    program = require_same(text, "rs274ngc").interpreter.program
    errors = [finding for finding in program.findings if finding.is_error]
    assert [finding.line for finding in errors] == [6, 8]
    assert {finding.code for finding in errors} <= {"E204", "E222"}


def test_lines_with_words_within_their_limits_are_read_once_at_load(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    read: list[str] = []
    parsed = Loader._parsed

    def noted(loader: Loader, place: Place, raw: str) -> Block:
        read.append(raw)
        return parsed(loader, place, raw)

    monkeypatch.setattr(Loader, "_parsed", noted)
    made("F60\nX1\nS1\nS2\nT3\nT4\nS5.5\nT6\nM2", dialect="rs274ngc")
    assert read == ["F60", "X1", "S1", "T3", "M2"]


def test_a_wrong_arc_ends_the_batch_before_it() -> None:
    run = made("F60\nX1\nX2\nG3 X9 Y9 I.1 J.1\nX3", dialect="rs274ngc",
               options=Options(has_batches=True)).interpreter  # fmt: skip
    entries = run.entries()
    moves = next(entries)
    assert isinstance(moves, Moves)
    assert len(moves) == 2
    with pytest.raises(BlockError) as caught:
        next(entries)
    assert (caught.value.finding.code, caught.value.finding.line) == ("E230", 4)


def test_feeds_of_one_batch_are_its_paces() -> None:
    (moves,) = batch("F60\nX1\nF30 X2\nX3\nF30\nF90\nX4\nM2")
    assert [pace.feed_upm for pace in moves.paces] == [60.0, 30.0, 90.0]
    assert list(moves.rows[ROW * 0 + 2 :: ROW]) == [0, 1, 1, 2]


def test_units_and_path_modes_have_batches_of_their_own() -> None:
    found = batch("F60 X1\nX2\nG21 X25.4\nX50.8\nG20\nX3\nG61\nX4\nM2")
    assert [len(moves) for moves in found] == [2, 2, 1, 1]
    (same,) = batch("F60 X1\nG20 G64\nX2\nM2", "acromill")
    assert len(same) == 2
    assert [len(moves) for moves in batch("F60 X1\nG61\nX2\nX3\nM2", "acromill")] == [1, 2]


@pytest.mark.soak  # what a check does at the same line is proved by tests/verify in every run
def test_idle_blocks_are_counted_across_batches() -> None:
    text = "F60\nX1\n" + "G90\n" * (MOST_IDLE - 1) + "X2\nM2"
    assert require_same(text, "rs274ngc").error is None
    found = require_same(text.replace("X2", "G90\nX2"), "rs274ngc")
    assert found.error is not None
    assert (found.error.code, found.error.line) == ("A62", MOST_IDLE + 3)


def test_coolant_stands_in_its_place_between_the_moves() -> None:
    text = "F60 X1\nM8 X2\nX3 M9\nM7\nX4 (dry)\nM2"
    found = require_same(text, "acromill").entries
    shown = [entry.end[0] if isinstance(entry, Line) else entry for entry in found[:-1]]
    assert shown == [
        1.125,
        Coolant(Source("PROGRAM", 2, "M8 X2"), mist=False, flood=True),
        2.125,
        3.125,
        Coolant(Source("PROGRAM", 3, "X3 M9"), mist=False, flood=False),
        Coolant(Source("PROGRAM", 4, "M7"), mist=True, flood=False),
        4.125,
    ]
    dry = Options(is_dry=True, has_batches=True)
    assert [len(moves) for moves in made(text, options=dry).interpreter.entries()
            if isinstance(moves, Moves)] == [4]  # fmt: skip


def test_blocks_are_idle_until_one_moves_or_waits() -> None:
    for code, idle_cnt in (("M8", 4), ("G4 P1", 1)):
        many = require_same(f"F60\nX1\n{code}\n{code}\n{code}\nM2", "rs274ngc")
        assert many.interpreter.execution.idle_cnt == idle_cnt


def test_lines_without_motion_leave_the_machine_exactly_where_it_is() -> None:
    found = require_same("F9 X.1\nG92 X.7\nG90\nM8\nX.7\nM2", "rs274ngc")
    ends = [entry.end[0] for entry in found.entries if isinstance(entry, Line)]
    assert ends == [0.225, 0.225 - 2.0**-55]


def test_the_end_of_a_text_is_its_last_line() -> None:
    for text in ("F1\nX1\nX2", "F1\nX1\nX2\n", "F1\nX1\n\n(end)\n", "F1\nM8\nX1\nM9\n"):
        assert require_same(text, "acromill").entries[-1].source.line == len(text.splitlines())


def test_a_blank_line_after_the_last_block_hides_no_doubt() -> None:
    for text in ("F60 X1\nX2\nM30", "F60 X1\nX2\nM30\n\n(end)\n", "F60 X1\nM30\nX2\nM30\n;"):
        program = made(text).interpreter.program
        assert [finding.code for finding in program.findings] == ["W216"]


def test_the_fields_of_fast_forms_are_rows_of_the_core() -> None:
    fields = [name for name in fast_plans.FIELDS if hasattr(Modal(), name)]
    assert len(fields) == modes.FIELDS
    for dialect in DIALECTS.values():
        rows = [*dialect.table.gcodes.values(), *dialect.table.mcodes.values()]
        forms = [form for code in rows for form in code.fast or ()]
        used = {form.field for form in forms if isinstance(form, Sets)}
        assert used <= set(fields)


def test_more_shapes_than_there_is_room_for_are_read_one_by_one() -> None:
    chance = random.Random(3)
    shapes = {" ".join(chance.sample(["G17", "G90", "G40", "X1", "Y2", "Z3", "F9", "A4", "U5"],
                                     chance.randrange(1, 7))) for _ in range(3000)}  # fmt: skip
    assert len(shapes) > 1500
    require_same("G21\nF9\n" + "\n".join(sorted(shapes)) + "\nM2", "rs274ngc")


def require_equal_builds(text: str, dialect: str, patch: pytest.MonkeyPatch) -> None:
    """A program executed many lines at a time, by the compiled core and by plain Python."""
    options = Options(has_batches=True, collects_errors=True)
    compiled = done(text, dialect, options, is_slow=False)
    patch.setattr(scanning, "_run_lines", lines_cy.run_lines)
    plain = done(text, dialect, options, is_slow=False)
    patch.undo()
    assert plain.entries == compiled.entries
    assert plain.interpreter.modal == compiled.interpreter.modal
    assert plain.cells.written == compiled.cells.written


@pytest.mark.skipif(not is_compiled, reason="only plain Python here")
def test_both_builds_skim_and_execute_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(40):
        chance = random.Random(seed)
        dialect = chance.choice(["acromill", "rs274ngc"])
        require_equal_builds(program(chance, dialect), dialect, monkeypatch)


def test_a_run_too_short_is_not_tried_again_at_each_of_its_lines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = made("F60\nX1\nM8\n" + "X2\nX3\n" * 5 + "M9\nM2").interpreter
    tried: list[int] = []
    executed = scanning.Scanner._take_state

    def noted(scanner: scanning.Scanner, *, is_plain: bool) -> None:
        tried.append(1)
        executed(scanner, is_plain=is_plain)

    monkeypatch.setattr(scanning.Scanner, "_take_state", noted)
    list(run.entries())
    assert len(tried) == 5  # at the begin, M8, after it, M9, M2
