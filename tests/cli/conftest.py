"""What all tests of commands need."""

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def own_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The store that commands work on: one for each test, empty."""
    path = tmp_path / "sysvar.db"
    monkeypatch.setenv("OPENACR_STORE", str(path))
    return path
