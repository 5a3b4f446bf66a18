"""pytest makes a test of each case, and reports a difference with file, line and both texts."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEAD = "source: 000 L7\nrests on: manual\n"


def pytest_in(folder: Path, *words: str) -> str:
    """What pytest prints in a folder where something fails."""
    command = [sys.executable, "-m", "pytest", "-c", "pytest.ini", "-p", "no:cacheprovider", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two cases, one of which fails, and a file that cannot be read."""
    folder = tmp_path_factory.mktemp("cases")
    shutil.copyfile(ROOT / "conformance" / "conftest.py", folder / "conftest.py")
    rows = "> ?{n}\n1\ntable:\nn\n1\n2\n"
    (folder / "a.txt").write_text(f"[case Row {{n}}]\nproves: ACR-A\n{HEAD}{rows}")
    (folder / "b.txt").write_text(f"[case B]\n{HEAD}wait\n")
    (folder / "pytest.ini").write_text("[pytest]\nmarkers = req\n")
    return folder


@pytest.fixture(scope="module")
def shown(folder: Path) -> str:
    return pytest_in(folder, "-v")


def test_each_row_is_a_test_and_a_difference_names_file_line_and_both_texts(shown: str) -> None:
    assert "a.txt::Row 1 PASSED" in shown
    assert "a.txt::Row 2 FAILED" in shown
    assert 'a.txt:6: in "Row 2"' in shown
    assert "\nexpected: 1\nshown:    2\n" in shown
    assert "2 failed, 1 passed" in shown


def test_a_file_that_cannot_be_read_is_one_failure_and_keeps_no_other_from_running(
    shown: str,
) -> None:
    assert "b.txt::the file can be read FAILED" in shown
    assert "b.txt:4: wait: expected wait TIME or wait until CONDITION within TIME" in shown


def test_cases_are_chosen_by_having_ids(folder: Path) -> None:
    done = pytest_in(folder, "-m", "req", "-v")
    assert "1 failed, 1 passed, 1 deselected" in done
