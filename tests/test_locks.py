"""Locks of files: who holds one, seen by the process itself and by another one."""

import subprocess
import sys
from pathlib import Path

import pytest

from openacr.locks import FileLock, InUseError, is_taken

ASK = "import sys; from pathlib import Path; from openacr.locks import is_taken;"
ASK += "print(is_taken(Path(sys.argv[1])))"


def seen_by_another(path: Path) -> str:
    return subprocess.run(
        [sys.executable, "-c", ASK, str(path)], capture_output=True, text=True, check=True
    ).stdout.strip()


def test_a_lock_is_taken_as_long_as_it_is_held(tmp_path: Path) -> None:
    path = tmp_path / "it"
    assert (is_taken(path), path.exists()) == (False, False)
    lock = FileLock(path, "taken by another")
    assert (is_taken(path), seen_by_another(path)) == (True, "True")
    with pytest.raises(InUseError, match="taken by another"):
        FileLock(path, "taken by another")
    lock.release()
    assert (is_taken(path), seen_by_another(path)) == (False, "False")
    FileLock(path, "taken by another").release()


def test_what_is_no_lock_is_not_taken(tmp_path: Path) -> None:
    path = tmp_path / "it"
    path.write_text("some other file")
    assert not is_taken(path)
