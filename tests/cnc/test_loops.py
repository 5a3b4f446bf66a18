"""Loops that move without end: a check ends with the line, programs that end are not touched."""

from pathlib import Path

import pytest
from tests.cnc.programs import STORE, made
from tests.cnc.test_many_blocks import one_by_one

from openacr.cnc.canonical import Line
from openacr.cnc.interpreter import execution
from openacr.cnc.interpreter.by_block import loops
from openacr.cnc.interpreter.survey import Survey, survey
from openacr.cnc.loading.load import load
from openacr.cnc.state.shadow import Shadow

SAME = "endless loop: the same moves again and again"
HINT = "it does not end by itself; a machine runs it until it is ended"


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """1,000 lines without motion end a check, in place of 100,000."""
    monkeypatch.setattr(execution, "MOST_IDLE", 1000)


def of(text: str, dialect: str = "acromill", cells: dict[int, float] | None = None) -> Survey:
    shadow = Shadow(STORE)
    for n, value in (cells or {}).items():
        shadow.write(n, value)
    return survey(load(text.replace("|", "\n"), shadow, dialect), shadow, dialect)


def found(survey: Survey) -> list[tuple[str, int, str]]:
    return [(each.text, each.line, each.hint) for each in survey.errors]


@pytest.mark.parametrize(
    ("text", "line", "dialect"),
    [
        ("F10|N10 G1 X1|X0|GOTO 10", 4, "acromill"),
        ("F10|N10 G1 X1|X0|IF 1=1 THEN GOTO 10|M2", 4, "acromill"),
        ("F10|N10 G1 X1|X0|GOTO (5*2)", 4, "acromill"),
        ("F10|N10 G1 X1|GOSUB 20|GOTO 10|M2|N20 G1 X0|RET", 4, "acromill"),
        # the state comes back every third pass only
        ("F10|P200=0|N10 P200=(P200+1) MOD 3|G1 X(P200)|GOTO 10", 5, "acromill"),
        ("F10|N10 P50=1-P50|G1 X(P50)|GOTO 10", 4, "acromill"),
        ("F10|O1 while [1]|G1 X1|X0|O1 endwhile", 5, "rs274ngc"),
        ("F10|O1 do|G1 X1|X0|O1 while [1]", 5, "rs274ngc"),
        ("F10|#40=0|O1 while [1]|#40=[1-#40]|G1 X#40|O1 endwhile", 6, "rs274ngc"),
        ("F10|O1 while [1]|G4 P1|O1 endwhile", 4, "rs274ngc"),
    ],
)
def test_a_loop_that_moves_without_end_is_an_error(text: str, line: int, dialect: str) -> None:
    assert found(of(text, dialect)) == [(SAME, line, HINT)]


@pytest.mark.parametrize("target", ["10", "(5*2)"])
@pytest.mark.parametrize("period", range(1, 10))
def test_a_loop_ends_when_the_state_of_pass_1_2_4_8_comes_back(target: str, period: int) -> None:
    text = f"F10|P200=0|N10 P200=(P200+1) MOD {period}|G1 X(P200+1)|X0|GOTO {target}"
    kept = next(2**k for k in range(5) if 2**k >= period)
    assert of(text).move_cnts["feed"] == 2 * (kept + period)


@pytest.mark.parametrize(
    ("text", "line", "dialect"),
    [
        ("P200=0|N10 P200=P200+1|G90|GOTO 10", 4, "acromill"),
        ("P200=0|N10 P200=P200+1|P201=1|P202=1|IF P200>0 THEN GOTO 10|M2", 5, "acromill"),
        ("#1=0|O1 while [1]|#1=[#1+1]|#2=1|#3=1|O1 endwhile", 6, "rs274ngc"),
        ("GOTO 10|N10 P200=P200+1|P201=1|P202=1|IF 1=1 THEN GOTO 10|M2", 5, "acromill"),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("few")
def test_a_loop_without_motion_ends_at_the_line_that_jumps(
    text: str, line: int, dialect: str
) -> None:
    assert found(of(text, dialect)) == [("endless loop", line, "")]


ENDED = pytest.mark.parametrize(
    ("text", "line", "less"),
    [
        # the loop has ended: 1 + 2*(half - 1) lines, then two more
        ("P200=0|N10 P200=P200+1|IF P200<{} THEN GOTO 10|P201=1|P202=1|P203=1|G0 X1|M2", 5, 1),
        # the loop has ended, and the jump back around it was one: 6 + 2*(half - 4), then three more
        ("P200=0|N10 P201=1|P202=1|P203=1|P200=P200+1|N20 P204=P204+1|IF P204<{} THEN GOTO 20|"
         "GOTO 10|M2", 4, 4),
    ],
)  # fmt: skip


@ENDED
@pytest.mark.usefixtures("few")
def test_lines_without_motion_after_a_loop_are_named_themselves(
    monkeypatch: pytest.MonkeyPatch, text: str, line: int, less: int
) -> None:
    one_by_one(monkeypatch)
    assert found(of(text.format(500 - less))) == [("endless loop", line, "")]


@pytest.mark.soak
@ENDED
def test_they_are_named_by_the_core_too(text: str, line: int, less: int) -> None:
    assert found(of(text.format(50_000 - less))) == [("endless loop", line, "")]


def test_lines_without_motion_and_without_a_jump_are_named_themselves(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(execution, "MOST_IDLE", 3)
    assert found(of("P201=1|P202=1|M2")) == []
    assert found(of("P201=1|P202=1|P203=1|M2")) == [("endless loop", 4, "")]


@pytest.mark.usefixtures("few")
def test_a_loop_in_another_file_is_not_that_of_the_program(tmp_path: Path) -> None:
    idle = "".join(f"P{n}=1\n" for n in range(201, 221))
    (tmp_path / "IDLE.TXT").write_text(f"N50 P200=1\n{idle}RET\n")
    main = (
        "\n" * 29 + "P100=0\nN10 P210=P210+1\nIF P210<490 THEN GOTO 10\nGOSUB 50\nM2\n$I IDLE.TXT\n"
    )
    shadow = Shadow(STORE)
    errors = survey(load(main, shadow, folder=tmp_path), shadow).errors
    assert [(each.file, each.text) for each in errors] == [("IDLE.TXT", "endless loop")]


@pytest.mark.parametrize("target", ["10", "(5*2)"])  # read by the core, and without it
def test_a_loop_that_changes_for_ever_ends_too(
    monkeypatch: pytest.MonkeyPatch, target: str
) -> None:
    monkeypatch.setattr(loops, "MOST_PASSES", 1000)
    text = f"F10|P200=0|N10 P200=P200+.001|G1 X(P200)|{{}}GOTO {target}|M2"
    more = "endless loop: more than 1,000 passes"
    assert found(of(text.format(""))) == [(more, 5, HINT)]
    assert found(of(text.format("IF P200<1.0005 THEN "))) == []  # 1000 jumps
    assert found(of(text.format("IF P200<1.0015 THEN "))) == [(more, 5, HINT)]


@pytest.mark.parametrize(
    ("text", "moves", "dialect"),
    [
        ("F10|P200=0|N10 P200=P200+1|G1 X1|X0|IF P200<40 THEN GOTO 10", 80, "acromill"),
        ("F10|P50=0|N10 P50=P50+1|G1 X1|X0|IF P50<40 THEN GOTO 10", 80, "acromill"),
        ("F10|N10 G91 G1 X1|IF P101<0 THEN GOTO 10|M2", 1, "acromill"),
        # one place and state, reached from several lines
        ("F10|GOSUB 20|GOSUB 20|GOSUB 20|M2|N20 G1 X1|X0|IF 1=1 THEN GOTO 30|N30 RET", 6,
         "acromill"),
        ("F10|G65 P20|G65 P20|M2|N20 G1 X1|X0|#1=#1+1|IF #1<3 THEN GOTO 20|RET", 12, "acromill"),
        ("F10|O1 repeat [40]|G1 X1|X0|O1 endrepeat", 80, "rs274ngc"),
        ("F10|O1 repeat [3]|O2 repeat [3]|G1 X1|X0|O2 endrepeat|O1 endrepeat", 18, "rs274ngc"),
        ("F10|#<a>=0|O1 while [#<a> LT 5]|#<a>=[#<a>+1]|G1 X1|X0|O1 endwhile", 10, "rs274ngc"),
        ("F10|#<_n>=0|O1 while [#<_n> LT 5]|#<_n>=[#<_n>+1]|G1 X1|X0|O1 endwhile", 10, "rs274ngc"),
        ("F10|#40=0|O1 do|#40=[#40+1]|G1 X1|X0|O1 while [#40 LT 5]", 10, "rs274ngc"),
        ("F10|O9 sub|#1=0|O1 while [#1 LT 3]|#1=[#1+1]|G1 X1|X0|O1 endwhile|O9 endsub|O9 call|"
         "O9 call", 12, "rs274ngc"),
    ],
)  # fmt: skip
def test_a_loop_that_ends_is_read_to_its_end(text: str, moves: int, dialect: str) -> None:
    data = of(text, dialect)
    assert found(data) == []
    assert data.move_cnts["feed"] == moves


def test_a_machine_runs_an_endless_loop_until_it_is_ended() -> None:
    entries = made("F10\nN10 G1 X1\nX0\nGOTO 10").interpreter.entries()
    lines = [entry for entry, _ in zip(entries, range(5000), strict=False)]
    assert sum(isinstance(each, Line) for each in lines) == 5000
