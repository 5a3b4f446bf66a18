"""Coverage of PLCs in closed examples: what contacts and outputs were, and were never."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.testing.bench import Bench
from openacr.testing.coverage import Coverage
from openacr.testing.coverage_report import lcov, table, write_html
from openacr.testing.machine import Machine

RUN = "SYS\rPLC0\rRUN\rSYS\r"
RUNG = "REM a lamp\nLD 128 AND NOT 129\nLD 130\nOR LD\nOUT 140\nEND\nLD 131\n"


class Shop:
    """A project of one PLC and the coverage of the tests that ran on it."""

    def __init__(self, folder: Path, text: str) -> None:
        self.folder = folder / "shop"
        self.folder.mkdir()
        (self.folder / "setup.8k").write_text("SYS\nDIM PLC0(4000)\n")
        (self.folder / "plc0.8k").write_text(f"PROGRAM\n{text}ENDP\n")
        self.file = str(self.folder / "plc0.8k")
        self._bench = Bench(covers=True)
        assert self._bench.coverage is not None
        self.coverage: Coverage = self._bench.coverage

    def test(self, *typed: str) -> Machine:
        """A test that types texts, each followed by some scans."""
        machine = self._bench.machine("test_shop", self.folder)
        for text in typed:
            machine.send(text)
            machine.advance(seconds=0.02)
        self._bench.finish(machine)
        return machine

    def branches(self) -> dict[int, list[int | None]]:
        return {line: covered.branches for (_, line), covered in self.coverage.lines.items()}

    def counts(self) -> dict[int, int]:
        return {line: covered.count for (_, line), covered in self.coverage.lines.items()}

    def remarks(self) -> list[str]:
        return [remark for line in self.coverage.lines.values() for remark in line.remarks]


def test_a_plc_that_was_not_run_has_lines_and_branches_without_an_outcome(tmp_path: Path) -> None:
    shop = Shop(tmp_path, RUNG)
    shop.test("SET 128\r")
    assert shop.counts() == {3: 0, 4: 0, 5: 0, 6: 0, 8: 0}
    assert shop.branches() == {3: [None] * 4, 4: [None] * 2, 5: [], 6: [None] * 2, 8: [None] * 2}
    assert shop.remarks() == []


def test_contacts_and_outputs_have_a_branch_for_each_state(tmp_path: Path) -> None:
    shop = Shop(tmp_path, RUNG)
    shop.test("CLR 129\r", RUN, "SET 128\r")
    assert shop.counts() == {3: 1, 4: 1, 5: 1, 6: 1, 8: 0}
    assert shop.branches() == {3: [1, 1, 1, 0], 4: [0, 1], 5: [], 6: [1, 1], 8: [None, None]}
    assert shop.remarks() == ["AND NOT 129 was always on", "LD 130 was never on"]


def test_reports_name_what_was_never_and_what_was_always_on(tmp_path: Path) -> None:
    shop = Shop(tmp_path, RUNG)
    shop.test(RUN, "SET 128\r")
    rows = list(table(shop.coverage))
    assert rows[1].split()[1:] == ["5", "1", "10", "4", "67%", "8"]
    assert rows[2:] == [
        f"{shop.file}:3: AND NOT 129 was always on",
        f"{shop.file}:4: LD 130 was never on",
    ]
    assert lcov(shop.coverage) == (
        f"SF:{shop.file}\n"
        "DA:3,1\nBRDA:3,0,0,1\nBRDA:3,0,1,1\nBRDA:3,1,0,1\nBRDA:3,1,1,0\n"
        "DA:4,1\nBRDA:4,0,0,0\nBRDA:4,0,1,1\n"
        "DA:5,1\nDA:6,1\nBRDA:6,0,0,1\nBRDA:6,0,1,1\n"
        "DA:8,0\nBRDA:8,0,0,-\nBRDA:8,0,1,-\n"
        "BRF:10\nBRH:6\nLF:5\nLH:4\nend_of_record\n"
    )
    write_html(shop.coverage, tmp_path / "pages")
    page = (tmp_path / "pages" / "0_plc0.html").read_text()
    assert (
        "<tr class='part'><td>4</td><td>1</td><td>1/2</td><td><pre>LD 130</pre></td>"
        "<td>LD 130 was never on</td></tr>" in page
    )
    assert "<tr class='hit'><td>5</td><td>1</td><td></td><td><pre>OR LD</pre></td>" in page
    assert "<tr class='miss'><td>8</td><td>0</td><td>0/2</td>" in page


@pytest.mark.parametrize(
    ("output", "on", "clock", "reset"),
    [
        ("CNT 3 5", 128, "CNT 3 5 (clock) was always on", "CNT 3 5 (reset) was never on"),
        ("CNT 3 5", 129, "CNT 3 5 (clock) was never on", "CNT 3 5 (reset) was always on"),
        ("KR 3", 128, "KR 3 (set) was always on", "KR 3 (reset) was never on"),
        ("KR 3", 129, "KR 3 (set) was never on", "KR 3 (reset) was always on"),
    ],
)
def test_both_inputs_of_counters_and_latches_have_branches(
    tmp_path: Path, output: str, on: int, clock: str, reset: str
) -> None:
    shop = Shop(tmp_path, f"LD 128\nLD 129\n{output}\n")
    shop.test(f"SET {on}\r", RUN)
    assert shop.remarks()[2:] == [clock, reset]
    shop.test(f"SET {257 - on}\r", RUN)
    assert shop.remarks() == []


def test_outcomes_of_several_tests_add_up(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nTIM 3 20\n")
    shop.test(RUN)
    assert shop.branches() == {2: [0, 1], 3: [0, 1]}
    shop.test("SET 128\r", RUN)
    assert shop.branches() == {2: [1, 1], 3: [1, 1]}
    shop.test()
    assert shop.counts() == {2: 1, 3: 1}


def test_what_was_scanned_before_another_run_counts(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nOUT 140\n")
    shop.test("SET 128\r", RUN, "CLR 128\r", "SET 128\r", "PLC0\rHALT\rRUN\r")
    assert shop.branches() == {2: [1, 1], 3: [1, 1]}


def test_a_line_that_was_typed_is_not_that_of_the_file(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nOUT 140\nLD 129\nOUT 141\n")
    shop.test(RUN, "SET 128\rPLC0\rHALT\r20 LD NOT 129\rRUN\r")
    assert shop.branches() == {2: [0, 1], 3: [1, 1], 4: [0, 1], 5: [0, 1]}


def test_code_goes_on_to_be_noted_where_run_refuses_a_changed_text(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nOUT 140\n")
    shop.test("PLC0\rRUN\r20 OR LD\rRUN\r", "SET 128\r")
    assert shop.branches() == {2: [1, 1], 3: [1, 1]}


def test_a_plc_that_the_project_starts_is_noted(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "PBOOT\nLD 128\nOUT 140\n")
    shop.test("")
    assert shop.branches() == {3: [0, 1], 4: [0, 1]}


def test_code_that_was_halted_before_the_test_is_not_scanned(tmp_path: Path) -> None:
    card = Controller.from_project(Shop(tmp_path, "LD 128\nOUT 140\n").folder)
    card.send("PLC0\rRUN\rHALT\r")
    card.advance(seconds=0.02)
    coverage = Coverage()
    coverage.begin(card)
    card.advance(seconds=0.02)
    coverage.end(card)
    assert [line.count for line in coverage.lines.values()] == [0, 0]


def test_code_that_is_not_the_stored_text_is_not_counted(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nOUT 140\nLD 129\nOUT 141\n")
    card = Controller.from_project(shop.folder)
    card.send("PLC0\rRUN\r20 LD 129\r")
    card.advance(seconds=0.02)
    coverage = Coverage()
    coverage.begin(card)
    card.advance(seconds=0.02)
    coverage.end(card)
    assert {line: covered.count for (_, line), covered in coverage.lines.items()} == {
        3: 0, 4: 0, 5: 0,
    }  # fmt: skip


def test_a_restart_keeps_what_was_noted_and_notes_on(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "PBOOT\nLD 128\nOUT 140\n")
    (shop.folder / "machine.toml").write_text('[card]\nmodel = "ACR8020"\n')  # has a battery
    shop.test("SET 128\rPLC0\rHALT\rRUN\r", "ESAVE\r", "SYS\rREBOOT\r", "")
    assert shop.branches() == {3: [1, 1], 4: [1, 1]}


def test_scans_note_nothing_before_and_after_a_covered_test(tmp_path: Path) -> None:
    shop = Shop(tmp_path, "LD 128\nOUT 140\n")
    machine = shop.test(RUN)
    machine.advance(seconds=0.02)
    assert machine.card.plcs.is_running(0)
    assert [machine.card.plcs.seen(0), shop.branches()] == [[0, 0], {2: [0, 1], 3: [0, 1]}]
