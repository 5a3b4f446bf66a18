"""Words, labels, statements, comments: what a line may say."""

from pathlib import Path

import pytest
from tests.cnc.programs import STORE, Bench, errors, made, run

from openacr.cnc.canonical import Line, Sync
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.loading.load import load
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.reading.text import Text


def test_an_axis_that_is_not_configured_is_refused() -> None:
    assert errors("F10 U5", axes=3) == ["E207"]


def test_there_are_at_most_a_million_labels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("openacr.cnc.loading.targets.MOST_LABELS", 3)
    assert errors("F10\nN1 X1\nN2 X2\nN3 X3") == []
    assert errors("F10\nN1 (a) X1\nN2 (b) X2\nN3 (c) X3\nN4 (d) X4") == ["E270"]
    plain = "F10\n" + "".join(f"N{n} X{n}\n" for n in range(1, 40))
    assert errors(plain) == ["E270"]


def test_labels_and_cycles_that_are_missing_are_found_before_anything_moves() -> None:
    for call in ("G65 P7 X1", "G66 P7 X1", "GOSUB 7", "IF P200=1 THEN GOTO 7"):
        found = made(f"F10 X1\n{call}\nM2\nN8 RET").interpreter.program.errors
        assert [(finding.code, finding.line) for finding in found] == [("E220", 2)]
    found = made("F10 X1\nG81 X1 Z-1 R.1\nX2\nM2").interpreter.program.errors
    assert [(finding.code, finding.line) for finding in found] == [("E251", 2)]


@pytest.mark.req("MILL-WORD-N")
def test_t_p_knows_what_a_card_has() -> None:
    assert [f.code for f in run("P150=7\nT P150").interpreter.warnings] == ["W406"]
    assert [f.code for f in run("T P99\nT P3").interpreter.warnings] == []
    refused = run("T P95").error
    assert refused is not None
    assert (refused.code, refused.line) == ("E212", 1)


@pytest.mark.req("MILL-WORD-T")
def test_t_p_transfers_a_parameter_to_the_card() -> None:
    assert run("P3=55555\nT P3").story == ["P3=55555", "end"]
    assert run("P150=7\nT #150").story == ["P150=7", "end"]
    assert run("P150=3 P3=9\nT PP150").story == ["P3=9", "end"]


@pytest.mark.req("MILL-WORD-NUMFMT")
@pytest.mark.parametrize(
    ("word", "x"),
    [("x\t3", 3), ("X - 4", -4)],
)
def test_numbers_may_be_written_in_many_forms(word: str, x: float) -> None:
    assert run(f"G1F10{word}").ends[0][0] == x


@pytest.mark.parametrize("text", ["G1X\u2212\u22121 F10", "G1X\u20131 F10", "G1X--1 F10"])
def test_printed_minus_signs_count_as_one_with_a_warning(text: str) -> None:
    done = run(text)
    assert done.moves == ["L X-1"]
    assert "W102" in done.codes


@pytest.mark.req("MILL-WORD-COMMENT")
@pytest.mark.parametrize(
    "text",
    ["F10 X1(Y(5)", "F10 X1\nREM X5",
     "O1234\nF10 X1", "%\nF10 X1\n%\nX5", "F10 X1\n\x1aX5", "F\x0010 X\x7f1", "\ufeffF10 X1"],
)  # fmt: skip
def test_comments_and_marks_are_left_out(text: str) -> None:
    assert run(text).moves == ["L X1"]


@pytest.mark.parametrize(
    ("text", "code", "column"),
    [
        ("X1 (open", "E103", 4),
        ("G1 X", "E105", 5),
        ("G1 XY", "E105", 5),
        ("X5-3", "E104", 3),
        ("?", "E104", 1),
        ("PRINT hello", "E109", 7),
        ("IF P1=1 GOTO 5", "E108", 9),
        ("GOTO", "E108", 5),
        ("N1 GOTO 1 X5", "E108", 11),
        ("X1 GOTO 1", "E108", 4),
        ("N X1", "E105", 3),
        ("N-1 X1", "E105", 2),
        ("X" + "1" * 256, "E101", 257),
        ("P20488=1", "E211", 1),
        ("X P1003425", "E211", 1),
        ("P100000=1", "E212", 1),
        ("P95=1", "E212", 1),
    ],
)
def test_an_error_has_its_code_and_column(text: str, code: str, column: int) -> None:
    (error,) = load(text, STORE, name="BAD.NC").errors
    assert (error.code, error.line, error.column) == (code, 1, column)
    assert str(error).startswith(f"BAD.NC:1:{column}: {code} ")


@pytest.mark.req("MILL-LOAD-ERR")
def test_all_errors_are_found_at_most_a_hundred() -> None:
    assert len(load("X1 X2\n" * 7, STORE).errors) == 7
    assert len(load("X1 X2\n" * 500, STORE).errors) == 100


# --- flow ---------------------------------------------------------------------------------


def test_if_calls_and_returns() -> None:
    text = "F10\nIF P200>0 THEN GOSUB 5\nX9\nM2\nN5 X1\nIF P200>0 THEN RET\nX2\nRET"
    assert run(text, {200: 1}).moves == ["L X1", "L X9"]


@pytest.mark.parametrize("text", ["IF P1=1 THEN GOTO 100", "IF (#1)=1 THEN GOTO 100"])
def test_other_forms_are_no_input_test(text: str) -> None:
    program = f"F10\n{text}\nX1\nN100 X2"
    assert run(program, machine=Bench(bits={1})).moves == ["L X1", "L X2"]
    assert run(program, {1: 1}).moves == ["L X2"]


@pytest.mark.req("MILL-FLOW-IF-INPUT")
@pytest.mark.parametrize("n", [0, 1, 31])
def test_the_form_of_the_guide_tests_an_input(n: int) -> None:
    for level in (0, 1):
        text = f"F10\nIF #{n}={level} THEN GOTO 100\nX1\nN100 X2"
        found = [run(text, {n: 1}, machine=Bench(bits=bits)).moves for bits in (set(), {n})]
        assert found[level] == ["L X2"]
        assert found[1 - level] == ["L X1", "L X2"]


def test_the_input_test_can_be_switched_off() -> None:
    program = "F10\nIF #1=1 THEN GOTO 100\nX1\nN100 X2"
    done = run(program, {700_001: 0, 1: 1})
    assert done.moves == ["L X2"]
    assert run("F10\nIF INP(1)=1 THEN GOTO 9\nX1\nN9", machine=Bench(bits={1})).moves == []


@pytest.mark.parametrize(
    "assignment", ["#1=0", "P1=0", "P(3-2)=0", 'INPUT "one", P1', "G4 F1 #1=0"]
)
def test_an_input_test_is_doubted_where_the_parameter_was_assigned(assignment: str) -> None:
    text = f"F10\n{assignment}\nN5 IF #1=0 THEN GOTO 9\nX1\nN9 #2=1\nM2"
    (warning,) = run(text, machine=Bench(answers={1: 0.0})).interpreter.warnings
    assert str(warning) == (
        "PROGRAM:3:4: W211 input test form:"
        " tests input 1, not parameter 1 that was assigned: that is IF (#1)=..."
    )


@pytest.mark.parametrize(
    ("text", "more"),
    [
        ("IF #1=1 THEN GOTO 9\nX1\nN9", {}),  # as the guide tests inputs
        ("#2=1\nIF #1=1 THEN GOTO 9\nX1\nN9", {}),
        ("#1=0\nIF (#1)=0 THEN GOTO 9\nX1\nN9", {}),
        ("#1=0\nIF #1=0 THEN GOTO 9\nX1\nN9", {700_001: 0.0}),
        ("G65 P100 X1\nM2\nN100 IF #1=0 THEN GOTO 9\n#1=0\nIF #1=0 THEN GOTO 9\nN9 RET", {}),
        ("G65 P100\nIF #1=1 THEN GOTO 9\nX1\nN9\nM2\nN100 #1=0\nRET", {}),  # a local of a macro
    ],
)  # fmt: skip
def test_an_input_test_is_not_doubted_elsewhere(text: str, more: dict[int, float]) -> None:
    assert "W211" not in run(f"F10\n{text}\nM2", more).codes


def test_what_was_assigned_is_forgotten_when_a_program_starts_anew() -> None:
    done = run("F10\nIF #1=1 THEN GOTO 9\n#1=0\nN9")
    assert [finding.code for finding in done.interpreter.warnings] == []
    list(done.interpreter.entries())
    assert [finding.code for finding in done.interpreter.warnings] == []


@pytest.mark.req("MILL-FLOW-NEST10")
@pytest.mark.parametrize(("depth", "codes"), [(10, []), (11, ["E260"])])
@pytest.mark.parametrize("call", ["GOSUB", "G65 P"])
def test_ten_levels_may_be_nested(depth: int, codes: list[str], call: str) -> None:
    subs = [f"N{k}\n{call}{k + 1}\nRET" for k in range(1, depth)]
    text = "\n".join([f"{call}1", "M2", *subs, f"N{depth} P200=1", "RET"])
    assert errors(text) == codes


def test_a_jump_out_of_a_sub_keeps_its_level() -> None:
    text = "F10\nGOSUB 5\nX2\nM2\nN5 X1\nGOTO 6\nN6 X3\nRET"
    assert run(text).moves == ["L X1", "L X3", "L X2"]


def test_an_endless_loop_is_stopped() -> None:
    assert errors("N1 P200=1\nGOTO 1") == ["A62"]


@pytest.mark.req("MILL-MATH-REALTIME")
def test_values_of_the_card_wait_for_the_motion() -> None:
    done = made("F10 X1\nX(P6144)\nX3")
    kinds = [type(entry).__name__ for entry in done.interpreter.entries()]
    assert kinds == ["Line", "Sync", "Line", "Line", "End"]


def test_a_value_of_the_card_is_read_after_the_sync() -> None:
    done = made("F10 X1\nX(P6144)")
    ends = []
    for entry in done.interpreter.entries():
        if isinstance(entry, Sync):
            done.machine.parameters[6144] = 7.0
        if isinstance(entry, Line):
            ends.append(entry.end[0])
    assert ends == [1, 7]


def test_block_skip_leaves_out_slashed_lines() -> None:
    text = "F10\n/X1\n/3 X2\nX3"
    assert run(text).moves == ["L X1", "L X2", "L X3"]
    assert run(text, machine=Bench(is_skipping=True)).moves == ["L X3"]


def test_texts_for_the_operator() -> None:
    done = run('(MSG, hello there)\nP200=2.5\nPRINT "a="; P200; ";b"\n(DEBUG, p is P200)')
    assert done.story == ["say hello there", "say a=2.5;b", "say p is 2.5", "end"]


def test_input_asks_and_stores() -> None:
    text = 'INPUT "how many", P200\nG0 X(P200)'
    done = run(text, machine=Bench(answers={200: 4.0}))
    assert done.moves == ["R X4"]
    assert errors(text) == ["A61"]


def test_block_ends_are_marked_where_wanted() -> None:
    done = run("F10 X1\n\nN5\n(c)\nX2 M8", options=Options(has_block_ends=True))
    assert done.story == ["L X1", "BlockEnd", "coolant 01", "L X2", "BlockEnd", "end"]


# --- added texts ----------------------------------------------------------------------------


def test_added_texts_stand_as_if_written_there(tmp_path: Path) -> None:
    (tmp_path / "MAIN.NC").write_text("F10\nGOSUB 5\nM2\n$I sub.txt\nX3\nRET")
    (tmp_path / "SUB.TXT").write_text("N5 X1\nX2\n")
    done = made("M2")
    program = load(tmp_path / "MAIN.NC", STORE)
    assert not program.errors
    run_ = type(done.interpreter)(program, done.cells, Bench())
    ends = [entry.end[0] for entry in run_.entries() if hasattr(entry, "end")]
    assert ends == [1, 2, 3]


@pytest.mark.parametrize("text", ["$I CYCLES.TXT\nM2", "M2\n$I NOTHERE.TXT"])
def test_added_texts_have_to_be_there_and_after_m2(text: str) -> None:
    assert errors(text) == ["E262"]


def test_texts_added_in_a_circle_are_refused(tmp_path: Path) -> None:
    (tmp_path / "A.NC").write_text("M2\n$I A.NC\n")
    assert {e.code for e in load(tmp_path / "A.NC", STORE).errors} == {"E262"}


def test_a_line_longer_than_a_window_is_an_error_not_a_crash() -> None:
    text = Text.of("X1\n" + "A" * 3_000_000 + "\nX2", "LONG")
    offset, lengths = text.begin, []
    while (taken := text.line(offset)) is not None:
        lengths.append(len(taken[0]))
        offset = taken[1]
    assert lengths == [2, 3_000_000, 2]


def test_windows_cut_after_whole_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    for size in range(1, 12):
        monkeypatch.setattr("openacr.cnc.reading.text.WINDOW", size)
        text = Text.of(b"X1\r\nY2\rZ3\n\nA4\r\n\rB5")
        offset, lines = text.begin, []
        while (taken := text.line(offset)) is not None:
            lines.append(taken[0])
            offset = taken[1]
        assert lines == [b"X1", b"Y2", b"Z3", b"", b"A4", b"", b"B5"], size


def test_an_error_at_run_time_leaves_the_block_undone() -> None:
    done = made("F10 X1\nM3 X2 G30 P(9)\nX3")
    story = []
    with pytest.raises(BlockError) as caught:
        for entry in done.interpreter.entries():
            story.append(type(entry).__name__)
    assert story == ["Line"]
    assert (caught.value.finding.line, caught.value.finding.code) == (2, "E242")
    assert caught.value.finding.block == "M3 X2 G30 P(9)"


@pytest.mark.req("MILL-SYS-CTL-INPOL")
@pytest.mark.parametrize(
    ("inverted", "read"),
    [({}, [1, 0, 1, 0, 5]), ({251_001: 1, 251_002: 1, 252_040: 1, 252_041: 1}, [0, 1, 0, 1, 6])],
)
def test_inverted_inputs_and_outputs_read_as_they_act(
    inverted: dict[int, float], read: list[float]
) -> None:
    text = (
        "P200=INP(1) P201=INP(2) P202=OUT(40) P203=OUT(41) P204=5 P205=BIT(1)\n"
        "IF #2 = 0 THEN GOTO 9\nP204=6\nN9 M2"
    )
    done = run(text, inverted, machine=Bench(bits={1, 40}))
    assert [done.p(n) for n in range(200, 205)] == read
    assert done.p(205) == 1


def test_an_answer_goes_to_the_local_of_a_macro_where_it_is_asked_for_by_hash() -> None:
    text = 'G65 P5 X9\nM2\nN5 INPUT "how many", #1\nP200=#1\nINPUT "and", P1\nP201=#1\nRET'
    done = run(text, machine=Bench(answers={1: 7.0}))
    assert (done.p(200), done.p(201)) == (7.0, 7.0)
    assert done.machine.parameters == {1: 7.0}
    done = run('G65 P5 X9\nM2\nN5 INPUT "n", P1\nP200=#1\nRET', machine=Bench(answers={1: 7.0}))
    assert done.p(200) == 9.0


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
@pytest.mark.parametrize(
    "number", ["0", "00", "1000000", "12345678901", "1.5", "10.", "999999.0", "2.0"]
)
@pytest.mark.parametrize("rest", ["G1 X1 F10", " G1 X1 F10 (remark)"])
def test_line_numbers_of_other_systems_are_accepted(number: str, rest: str, dialect: str) -> None:
    done = run(f"N{number}{rest}", dialect=dialect)
    assert done.moves == ["L X1"]
    assert done.interpreter.program.findings == []


@pytest.mark.parametrize(("label", "code"), [(1, []), (999_999, []), (1_000_000, ["E220"])])
def test_only_labels_are_targets(label: int, code: list[str]) -> None:
    assert errors(f"F10\nGOTO {label}\nX5\nN{label} G1 X1") == code
    assert errors("F10\nGOTO 2\nN2.5 G1 X1\nN0 X2") == ["E220"]


TEXT = "(remark)\nPost Process Timed at; 32 Min"


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        (f"G1 F10 X1\nM30\n{TEXT}\n{TEXT}", ["4 W222"]),  # once
        (f"G1 F10 X1\nM2\nG1 X2\n{TEXT}", ["5 W222"]),
        (f"G1 F10 X1\n{TEXT}\nM30", ["3 E104"]),
        (f"G1 F10 X1\n/M30\n{TEXT}", ["4 E104"]),  # the block may be skipped
        (f"M98 P5\nM30\nO5\n{TEXT}\nM99", ["5 E104"]),  # what can be called
        (f"o<s> call\nM30\no<s> sub\n{TEXT}\no<s> endsub", ["5 E104"]),
    ],
)
def test_text_after_the_end_of_a_program_is_doubtful(text: str, codes: list[str]) -> None:
    found = made(text, dialect="rs274ngc").interpreter.program.findings
    assert [f"{each.line} {each.code}" for each in found] == codes


@pytest.mark.parametrize("lines", ["N100 G1 X2", "N90 G1 X1\nN100 G1 X2", "RET"])
def test_text_after_what_may_be_called_is_an_error(lines: str) -> None:
    text = f"N5 G1 F10 X1\nN6 X3 Y1\nN7 X4 Y5\nM2\n{lines}\nPost Process"
    codes = [each.code for each in made(text).interpreter.program.findings]
    assert codes == ["E105"]
    assert run("G1 F10 X1\nM2\nPost Process").codes == ["W222"]
