"""Panels whose time passes by hand; libraries of other systems that leave sockets open."""

import gc
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.panel.bench import Served

LEAVING = ("test_epics", "test_opcua", "test_sparkplug")


@pytest.fixture
def quiet_panel(tmp_path: Path) -> Iterator[Served]:
    """A panel whose machine moves only in `step`."""
    served = Served(tmp_path, by_hand=True)
    yield served
    served.close()


@pytest.fixture(autouse=True)
def swept(request: pytest.FixtureRequest) -> Iterator[None]:
    """Collect what libraries leave open at the end of a test, before other tests are blamed."""
    yield
    if request.module.__name__.rpartition(".")[2].startswith(LEAVING):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResourceWarning)
            gc.collect()
