"""A store of the defaults, as the machine that part programs are checked against."""

from pathlib import Path

import pytest

from openacr.sysvar import Store


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "store" / "sysvar.db"
    path.parent.mkdir()
    Store(path).close()
    return path
