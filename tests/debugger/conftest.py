"""What several files of this folder need."""

from collections.abc import Iterator

import pytest
from tests.debugger.client import Client


@pytest.fixture
def client() -> Iterator[Client]:
    """A debugger of its own process."""
    client = Client()
    yield client
    client.close()
