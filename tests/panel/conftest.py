"""Panels for tests: a station driven by hand, a server in real time, a server driven by hand."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.panel.bench import HandStation, Served


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[HandStation]:
    """A station with the virtual mill; time passes only when the test lets it."""
    station = HandStation(tmp_path)
    yield station
    station.close()


@pytest.fixture
def panel(tmp_path: Path) -> Iterator[Served]:
    """A server with the virtual mill in real time, the sample part loaded."""
    served = Served(tmp_path)
    yield served
    served.close()


@pytest.fixture
def quiet_panel(tmp_path: Path) -> Iterator[Served]:
    """A server whose machine moves only in `step`."""
    served = Served(tmp_path, by_hand=True)
    yield served
    served.close()
