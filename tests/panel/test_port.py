"""The server of a port: how it ends."""

from pathlib import Path

import pytest
from tests.panel.bench import Served

from openacr.panel.server import port


def test_a_server_ends_when_it_is_asked_to_not_at_its_next_tick(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(port, "TICK_S", 3600.0)
    Served(tmp_path, by_hand=True).close()
