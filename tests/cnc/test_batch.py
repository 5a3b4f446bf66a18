"""Batch files name programs; all of them are looked for before the first one starts."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from openacr.cnc.loading.batch import BatchError, read_batch
from openacr.errors import UserError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Some programs."""
    for name in ("A.TXT", "B.TXT", "LONG NAME.TXT", "sub/C.TXT", "L2.TXT"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("G1 X1\nM2\n")
    return tmp_path


def batch(folder: Path, text: str) -> Path:
    path = folder / "DAY.BAT"
    path.write_bytes(text.encode())
    return path


@pytest.mark.req("MILL-BATCH-FORMAT", "MILL-LOAD-BATCH")
def test_each_line_names_a_program_and_blank_lines_and_remarks_count_for_nothing(
    folder: Path,
) -> None:
    path = batch(
        folder,
        "; morning\n\nA.TXT\n  B.TXT   L3 ; three of them\r\n\t\n"
        '"LONG NAME.TXT" l2\nLONG NAME.TXT\nsub/C.TXT;x\nL2.TXT L 4\n',
    )
    read = read_batch(path)
    assert [(entry.path.name, entry.repeat_cnt, entry.line) for entry in read.entries] == [
        ("A.TXT", 1, 3),
        ("B.TXT", 3, 4),
        ("LONG NAME.TXT", 2, 6),
        ("LONG NAME.TXT", 1, 7),
        ("C.TXT", 1, 8),
        ("L2.TXT", 4, 9),
    ]
    assert [run.path.name for run in read.runs()] == [
        *("A.TXT", "B.TXT", "B.TXT", "B.TXT"),
        *("LONG NAME.TXT", "LONG NAME.TXT", "LONG NAME.TXT", "C.TXT"),
        *("L2.TXT", "L2.TXT", "L2.TXT", "L2.TXT"),
    ]
    assert [program.name for program in read.programs] == [
        "A.TXT",
        "B.TXT",
        "LONG NAME.TXT",
        "C.TXT",
        "L2.TXT",
    ]


@pytest.mark.req("MILL-BATCH-MISSING")
def test_all_missing_files_are_reported_with_their_lines(folder: Path) -> None:
    path = batch(folder, "A.TXT\nX.TXT\nsub\nB.TXT L0\nA.TXT L10000\nDAY.BAT\n")
    with pytest.raises(BatchError) as refusal:
        read_batch(path)
    found = [(finding.line, finding.code) for finding in refusal.value.findings]
    assert found == [(2, "E262"), (3, "E262"), (4, "E222"), (5, "E222"), (6, "E262")]
    words = str(refusal.value).splitlines()
    assert words[0] == f"{path}:2:1: E262 missing file: {folder / 'X.TXT'}"
    assert words[2].endswith("E222 value out of range: L0 (1 to 9999)")
    assert words[4].endswith("a batch cannot run itself")


@pytest.mark.parametrize("text", ["", "\n\n", "; nothing\n"])
def test_a_batch_without_programs_is_refused(folder: Path, text: str) -> None:
    with pytest.raises(BatchError, match="no program is named"):
        read_batch(batch(folder, text))


def test_a_name_no_system_allows_is_a_missing_file(folder: Path) -> None:
    with pytest.raises(BatchError, match="missing file"):
        read_batch(batch(folder, "x" * 5000))


def test_files_that_are_no_batch_are_refused(folder: Path) -> None:
    with pytest.raises(UserError, match="cannot be read: No such file"):
        read_batch(folder / "none.BAT")
    with pytest.raises(UserError, match="this is no batch file"):
        read_batch(batch(folder, "A.TXT\0"))


@settings(max_examples=60, deadline=None)
@given(text=st.text(max_size=60))
def test_any_text_is_read_or_refused(text: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "ANY.BAT"
    path.write_text(text, encoding="utf-8", errors="replace")
    with pytest.raises(UserError):
        read_batch(path)
