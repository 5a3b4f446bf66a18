"""What several files of this folder need."""

from collections.abc import Iterator

import pytest
from tests.tuning.worlds import WORLD

from openacr.controller import Controller
from openacr.plant.describe.load import parse_world


@pytest.fixture
def host() -> Iterator[Controller]:
    """A card with the modelled axis."""
    found = Controller(world=parse_world(WORLD))
    yield found
    found.close()
