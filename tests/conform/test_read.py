"""Files of cases: what they hold, and what is said of lines that are wrong."""

from pathlib import Path

import pytest
from tests.conform.one_case import HEAD

from openacr.conform import Claim, files, read
from openacr.conform.ids import by_id, main
from openacr.errors import FaultyFileError, UserError


def faults(folder: Path, text: str) -> list[str]:
    """What is wrong in a file, as `line: text`."""
    path = folder / "cases.txt"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FaultyFileError) as caught:
        read(path)
    assert all(each.path == str(path) for each in caught.value.errors)
    return [f"{each.line}: {each.text}" for each in caught.value.errors]


def cases(folder: Path, text: str) -> list[str]:
    path = folder / "cases.txt"
    path.write_text(text, encoding="utf-8")
    return [case.name for case in read(path)]


def test_a_case_has_its_line_its_ids_with_clauses_and_its_source(tmp_path: Path) -> None:
    path = tmp_path / "cases.txt"
    path.write_text(
        "# A chapter\nrests on: manual\n\n[case One]\nproves: ACR-X-1 (first, second), ACR-Y\n"
        "source: 001 L12-15\nonly: virtual\nmoves: 2.5 units at 1 units/s\n"
        "changes: P12348, BIT128\n> VER\n"
    )
    (case,) = read(path)
    assert (case.name, case.line, case.source) == ("One", 4, "001 L12-15")
    assert case.proves == (Claim("ACR-X-1", "first, second"), Claim("ACR-Y"))
    assert (case.rests, case.only) == ("manual", "virtual")
    assert (case.moves, case.changes) == ((2.5, 1.0), ("P12348", "BIT128"))


def test_lines_above_the_first_case_hold_where_a_case_says_nothing(tmp_path: Path) -> None:
    path = tmp_path / "cases.txt"
    two = "[case A]\n> X\n[case B]\nsource: 000 L2\nrests on: client: a host\n#\n> Y\n"
    path.write_text("source: 000 L1\nrests on: manual\n" + two)
    found = [(case.source, case.rests) for case in read(path)]
    assert found == [("000 L1", "manual"), ("000 L2", "client: a host")]


def test_an_answer_in_bars_is_never_a_step(tmp_path: Path) -> None:
    path = tmp_path / "cases.txt"
    path.write_text(HEAD + "> X\n|wait 1 s\n| > Y|\n")
    (case,) = read(path)
    assert [len(step.below) for step in case.steps] == [2]


def test_each_row_of_a_table_is_a_case_with_its_values_in_every_line(tmp_path: Path) -> None:
    path = tmp_path / "cases.txt"
    table = "table:\na | id\n1 | ACR-A\n2 | ACR-B\n"
    path.write_text(HEAD + "proves: {id} ({a})\n> ?{a}\n{a}\n" + table)
    first, second = read(path)
    assert [first.name, second.name] == ["A [1, ACR-A]", "A [2, ACR-B]"]
    assert second.proves == (Claim("ACR-B", "2"),)
    (step,) = second.steps
    assert step.at.text == "> ?2"
    assert [line.text for line in step.below] == ["2"]
    path.write_text(HEAD.replace("A]", "Of {a} and {b}]") + "> ?1\ntable:\na | b\n1 | 2\n3 | 4\n")
    assert [case.name for case in read(path)] == ["Of 1 and 2", "Of 3 and 4"]


def test_a_line_that_is_empty_in_a_row_is_no_line(tmp_path: Path) -> None:
    path = tmp_path / "cases.txt"
    path.write_text(HEAD + "> ?1\n{answer}\ntable:\nn | answer {n}\n".replace(" {n}", "") + "1 |\n")
    assert faults(tmp_path, path.read_text()) == ["7: n: no line above has {n}"]
    path.write_text(HEAD + "> ?{n}\n{answer}\ntable:\nn | answer\n1 |\n2 | 2\n")
    assert [len(case.steps[0].below) for case in read(path)] == [0, 1]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("> X\n" + HEAD + "> X", "1: > X: expected [case NAME] before the first step"),
        ("[case]\n> X", "1: [case]: expected [case NAME]"),
        (HEAD, "1: A: expected steps below"),
        (HEAD + "> X\n[case A]\nsource: 000 L7\nrests on: manual\n> X",
         "5: A: the case in line 1 has the same name"),
        (HEAD + "source: 000 L8\n> X", "4: source: there is such a line above"),
        (HEAD.replace("000 L7", "a page") + "> X",
         "2: source: a page: expected a manual and its line, 000 L2011"),
        ("[case A]\nrests on: manual\n> X",
         "1: source: : expected a manual and its line, 000 L2011"),
        (HEAD.replace("manual", "hearsay") + "> X",
         "3: rests on: hearsay: expected manual | oracle: what | client: what | inferred: what"),
        (HEAD.replace("manual", "oracle") + "> X",
         "3: rests on: oracle: expected manual | oracle: what | client: what | inferred: what"),
        ("[case A]\nsource: 000 L7\n> X",
         "1: rests on: : expected manual | oracle: what | client: what | inferred: what"),
        ("[case A]\nrests on: oracle: scipy\n> X",
         "1: source: : expected a manual and its line, 000 L2011"),
        (HEAD + "only: real\n> X", "4: only: real: expected virtual"),
        (HEAD + "proves: ACR-1, acr-2\n> X",
         "4: proves: acr-2: expected ID or ID (clause), ID ..."),
        (HEAD + "wait 1 s\nX", "5: X: expected a step here"),
        (HEAD + "wait 1 s\n  X", "5:   X: expected a step here"),
        (HEAD + "wait 1 second",
         "4: wait 1 second: expected wait TIME or wait until CONDITION within TIME or wait for MODE"
         " (an answer that begins so: |wait ...)"),
        (HEAD + "? P1",
         "4: ? P1: expected ? WHAT -> RESULT or ? WHAT -> RESULT +- TOLERANCE"
         " (an answer that begins so: |? ...)"),
        (HEAD + "? P1 -> 5 +- 1",
         "4: ? P1 -> 5 +- 1: a tolerance has its reason after it: ` # why`"),
        (HEAD + "took 1 s +- 1 periods",
         "4: took 1 s +- 1 periods: a tolerance has its reason after it: ` # why`"),
        (HEAD + ">> 0G", "4: >> 0G: '0G': expected 2A, ??, \"text\" or i32=..., u32=..., f32=...,"
         " f64=..., i16=..., u16=..."),
        (HEAD + ">> u16=65536", "4: >> u16=65536: 65536 is too large for u16"),
        (HEAD + "program 0:\n> X", "4: program 0:: expected indented lines below"),
        (HEAD + "> {a}\ntable:\na\n",
         "5: table: expected a line of columns and lines of values below"),
        (HEAD + "> {a}{b}\ntable:\na | b\n1\n", "7: expected 2 values (a | b)"),
        (HEAD + "> {a}{c}\ntable:\na\n1\n", "4: {c}: the columns are a"),
    ],
)  # fmt: skip
def test_a_wrong_line_is_named_with_what_belongs_there(
    tmp_path: Path, text: str, fault: str
) -> None:
    assert faults(tmp_path, text) == [fault]


def test_a_machine_that_does_not_exist_is_named_with_those_that_do(tmp_path: Path) -> None:
    (tmp_path / "machines" / "one-axis").mkdir(parents=True)
    (tmp_path / "machines" / "mill").mkdir()
    found = faults(tmp_path, HEAD + "machine: two axes\n> X")
    assert found == ["4: machine: two axes: the machines are mill, one axis"]
    assert cases(tmp_path, HEAD + "machine: one axis\n> X") == ["A"]


def test_everything_wrong_in_a_file_is_found(tmp_path: Path) -> None:
    found = faults(tmp_path, HEAD + "wait\n" + HEAD.replace("A]", "B]") + "took\n")
    assert [each.split(":")[0] for each in found] == ["4", "8"]


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "cases.txt").write_bytes(b"\xff\xfe")
    with pytest.raises(UserError, match=r"cases\.txt: not UTF-8"):
        read(tmp_path / "cases.txt")


def test_ids_are_listed_with_the_count_of_their_cases_and_their_clauses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = "table:\na\n1\n2\n"
    (tmp_path / "02.txt").write_text(HEAD + "proves: ACR-B (row {a}), ACR-A\n> ?{a}\n" + table)
    (tmp_path / "01.txt").write_text(HEAD + "proves: ACR-B\n> X\n")
    (tmp_path / "machines").mkdir()
    (tmp_path / "machines" / "notes.txt").write_text("no cases")
    found = by_id(case for path in files(tmp_path) for case in read(path))
    assert {name: [clause for _, clause in each] for name, each in found.items()} == {
        "ACR-A": ["", ""], "ACR-B": ["", "row 1", "row 2"],
    }  # fmt: skip
    main([str(tmp_path)])
    shown = capsys.readouterr().out.splitlines()
    assert shown == [
        f"ACR-A  2  {tmp_path / '02.txt'}:1",
        f"ACR-B  3  {tmp_path / '01.txt'}:1  (row 1, row 2)",
        "2 ids in 3 cases",
    ]
