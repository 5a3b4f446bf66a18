"""What several files of this folder need."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.mill.live import SPINDLE_CELLS, Plant
from tests.mill.sender import Sender


@pytest.fixture
def sender() -> Iterator[Sender]:
    """The far end of a serial line."""
    one = Sender()
    yield one
    one.close()


@pytest.fixture
def plant(tmp_path: Path) -> Iterator[Plant]:
    """A served card with a spindle and coolant, which is patient with its host."""
    made = Plant(tmp_path)
    made.wire(SPINDLE_CELLS)
    yield made
    made.close()
