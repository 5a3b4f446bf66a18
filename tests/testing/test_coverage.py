"""Coverage of AcroBASIC in closed examples: which outcomes conditions had, and how often."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.testing.bench import Bench
from openacr.testing.coverage import Coverage
from openacr.testing.coverage_report import lcov, table, write_html

SETUP = "SYS\nDIM PROG0(4000)\nDIM PROG1(2000)\nDIM P(10)\n"


def project(folder: Path, program: str) -> Path:
    """A project of one program."""
    shop = folder / "shop"
    shop.mkdir()
    (shop / "setup.8k").write_text(SETUP)
    (shop / "prog0.8k").write_text(f"PROGRAM\n{program}ENDP\n")
    return shop


def covered(folder: Path, program: str, *typed: str) -> Coverage:
    """The coverage of a program after one test for each of the texts typed."""
    return coverage_of(project(folder, program), *(typed or ("PROG0\rRUN\r",)))


def coverage_of(shop: Path, *typed: str) -> Coverage:
    """The coverage of a project after one test for each of the texts typed."""
    bench = Bench(covers=True)
    for text in typed:
        machine = bench.machine("test_shop", shop)
        machine.send(text)
        machine.advance(seconds=0.2)
        bench.finish(machine)
    assert bench.coverage is not None
    return bench.coverage


def branches(coverage: Coverage) -> dict[int, list[int | None]]:
    """The branches of each line that has any."""
    return {number: line.branches for (_, number), line in coverage.lines.items() if line.branches}


@pytest.mark.parametrize(
    ("condition", "expected"),
    [("P0 < 3", [2, 3]), ("P0 <= 5", [5, 0]), ("P0 > 5", [0, 5]), ("P0 >= 5", [1, 4])],
)
def test_both_outcomes_of_a_condition_on_one_line_are_counted(
    tmp_path: Path, condition: str, expected: list[int]
) -> None:
    text = f"FOR P0 = 1 TO 5 STEP 1\nIF ({condition}) THEN P1 = P1 + 1\nNEXT\n"
    coverage = covered(tmp_path, text)
    file = str(tmp_path / "shop" / "prog0.8k")
    assert coverage.lines[file, 3].count == 5
    assert branches(coverage)[3] == expected


def test_each_condition_of_a_line_has_branches_of_its_own(tmp_path: Path) -> None:
    text = (
        "FOR P0 = 1 TO 5 STEP 1\n"
        "IF (P0 > 2) THEN P1 = 1 : IF (P0 > 3) THEN IF (P0 > 9) THEN P2 = 1\n"
        "NEXT\n"
    )
    coverage = covered(tmp_path, text)
    assert branches(coverage)[3] == [3, 2, 2, 1, 0, 2]
    assert (
        "BRDA:3,0,0,3\nBRDA:3,0,1,2\nBRDA:3,1,0,2\nBRDA:3,1,1,1\nBRDA:3,2,0,0\nBRDA:3,2,1,2\n"
        in (lcov(coverage))
    )


def test_a_condition_that_was_not_computed_has_no_outcome(tmp_path: Path) -> None:
    text = "P0 = 1\nIF (P0 = 2) THEN IF (P0 = 1) THEN P1 = 1\n"
    coverage = covered(tmp_path, text)
    assert branches(coverage) == {3: [0, 1, None, None]}
    file = str(tmp_path / "shop" / "prog0.8k")
    assert lcov(coverage) == (
        f"SF:{file}\nDA:2,1\nDA:3,1\nBRDA:3,0,0,0\nBRDA:3,0,1,1\nBRDA:3,1,0,-\nBRDA:3,1,1,-\n"
        "BRF:4\nBRH:1\nLF:2\nLH:2\nend_of_record\n"
    )
    row = list(table(coverage))[1]
    assert row.split()[1:] == ["2", "0", "4", "3", "50%"]
    write_html(coverage, tmp_path / "pages")
    page = (tmp_path / "pages" / "0_prog0.html").read_text()
    assert "<tr class='part'><td>3</td><td>1</td><td>1/4</td>" in page


def test_a_jump_leaves_the_outcomes_of_its_line_as_they_are(tmp_path: Path) -> None:
    text = (
        "P0 = 0\n_Again\nP0 = P0 + 1\n"
        "IF (P0 < 4) THEN GOSUB Sub : IF (P0 < 3) THEN GOTO Again\n"
        "IF (P0 = 4) THEN END\nEND\n_Sub\nIF (P0 < 9) THEN RETURN\n"
    )
    coverage = covered(tmp_path, text)
    assert branches(coverage) == {5: [3, 0, 2, 1], 6: [0, 1], 9: [3, 0]}


def test_a_program_that_ends_at_a_condition_has_taken_the_branch(tmp_path: Path) -> None:
    assert branches(covered(tmp_path, "IF (P0 = 1) THEN P1 = 1\n")) == {2: [0, 1]}


def test_a_program_without_endp_has_taken_the_branch_of_its_last_line(tmp_path: Path) -> None:
    shop = project(tmp_path, "")
    (shop / "prog0.8k").write_text("PROG0\n10 P1 = 1\n20 IF (P0 = 1) THEN P1 = 2\n")
    assert branches(coverage_of(shop, "PROG0\rRUN\r")) == {3: [0, 1]}


def test_a_condition_that_ends_in_an_error_has_no_outcome(tmp_path: Path) -> None:
    text = "P1 = 1\nIF (P99 = 1) THEN P1 = 2\nP1 = 3\n"
    coverage = covered(tmp_path, text)
    assert branches(coverage) == {3: [None, None]}
    file = str(tmp_path / "shop" / "prog0.8k")
    assert [coverage.lines[file, number].count for number in (2, 3, 4)] == [1, 1, 0]


def test_an_error_after_then_is_a_condition_that_was_true(tmp_path: Path) -> None:
    assert branches(covered(tmp_path, "IF (P0 = 0) THEN P99 = 1\n")) == {2: [1, 0]}


def test_a_program_that_is_started_anew_does_not_follow_its_last_line(tmp_path: Path) -> None:
    text = "P0 = P0 + 1\nIF (P0 > 9)\nP1 = 1\nENDIF\nWHILE (P0 > 7)\nWEND\n"
    again = "PROG0\rRUN\r"
    coverage = covered(tmp_path, text, f"{again}DWL 0.05\r{again}")
    assert branches(coverage) == {3: [1, 0], 6: [0, 0]}


def test_a_remark_after_then_is_no_branch(tmp_path: Path) -> None:
    assert branches(covered(tmp_path, "IF (P0 = 0) THEN REM nothing\n")) == {}


def test_outcomes_of_several_tests_add_up(tmp_path: Path) -> None:
    text = "IF (P1 = 1) THEN P2 = 2\n"
    coverage = covered(tmp_path, text, "PROG0\rP1=1\rRUN\r", "PROG0\rRUN\r", "PROG0\rRUN\r")
    assert branches(coverage) == {2: [1, 2]}


def test_a_program_that_runs_in_the_snapshot_of_a_test_is_followed(tmp_path: Path) -> None:
    card = Controller.from_project(project(tmp_path, "DWL 0.05\nIF (P0 = 0) THEN P1 = 1\n"))
    card.send("PROG0\rRUN\r")
    card.advance(seconds=0.01)
    snapshot, coverage = card.snapshot(), Coverage()
    coverage.prepare(card)
    card.take_over(snapshot)
    coverage.begin(card)
    card.advance(seconds=0.2)
    assert branches(coverage) == {3: [1, 0]}


def test_a_program_that_the_project_starts_is_followed(tmp_path: Path) -> None:
    shop = project(tmp_path, "")
    (shop / "prog0.8k").unlink()
    lines = "PROG0\n10 DWL 0.1\n20 IF (P0 = 0) THEN P1 = 1\nRUN\n"
    (shop / "setup.8k").write_text(f"{SETUP}{lines}")
    assert branches(coverage_of(shop, "")) == {7: [1, 0]}


def test_a_program_that_was_followed_shows_each_line_once(tmp_path: Path) -> None:
    text = "DWL 0.05\nIF (P0 = 0) THEN P1 = 1\nIF (P0 = 1) THEN P1 = 2\n"
    card = Controller.from_project(project(tmp_path, text))
    coverage, printed = Coverage(), []
    coverage.begin(card)
    card.send("PROG0\rRUN\r")
    card.advance(seconds=0.01)
    coverage.end(card)
    card.listen(lambda program, text: printed.append((program, text)))
    card.advance(seconds=0.2)
    assert printed == [(0, "[30]"), (0, "[40]"), (0, "[50]")]


def test_a_line_that_was_typed_during_a_test_is_not_that_of_the_file(tmp_path: Path) -> None:
    line = "IF (P0 = 0) THEN IF (P1 = 0) THEN P2 = 1"
    coverage = covered(
        tmp_path, "P0 = 0\nIF (P0 = 0) THEN P1 = 0\n", f"PROG0\rRUN\rDWL 0.05\r30 {line}\rRUN\r"
    )
    assert branches(coverage) == {3: [1, 0]}


def test_block_mode_holds_before_lines_and_not_after_then(tmp_path: Path) -> None:
    shop = project(tmp_path, "P0 = 1\nIF (P0 = 1) THEN P1 = 1\nP2 = 1\n")
    found = []
    for covers in (False, True):
        bench = Bench(covers=covers)
        machine = bench.machine("test_shop", shop)
        machine.send("PROG0\rBLK\rRUN\r")
        seen = []
        for _ in range(4):
            machine.send("STEP\r")
            machine.advance(seconds=0.05)
            seen.append([machine.card.p[number] for number in range(3)])
        found.append(seen)
        bench.finish(machine)
    assert found[0] == found[1]
    assert found[0][-3:] == [[1, 0, 0], [1, 1, 0], [1, 1, 1]]


def test_a_card_that_is_not_covered_has_the_code_of_a_card(tmp_path: Path) -> None:
    text = "FOR P0 = 1 TO 5 STEP 1\nIF (P0 > 2) THEN IF (P0 > 3) THEN P1 = 1\nNEXT\n"
    shop = project(tmp_path, text)
    codes = []
    for covers in (False, True):
        bench = Bench(covers=covers)
        machine = bench.machine("test_shop", shop)
        machine.send("PROG0\rRUN\r")
        machine.advance(seconds=0.2)
        codes.append(list(machine.card.executor.threads.space.chunks[0].code))
        assert machine.card.p[1] == 1
        bench.finish(machine)
        assert machine.card.system.listeners.follower is None
    assert len(codes[0]) == len(codes[1])
    assert [pair for pair in zip(*codes, strict=True) if pair[0] != pair[1]] == [
        (1, 3), (0, 14), (0, 20),
    ]  # fmt: skip
