"""Flags, waits and masks: what programs and terminals do with bits."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    return Console()
