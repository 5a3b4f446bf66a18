import pytest
from tests.controller.hosts import Host, at_axes, connected


@pytest.fixture
def host() -> Host:
    """A host of a new card, at SYS."""
    return connected()


@pytest.fixture
def axes() -> Host:
    """A host at P00 with axes X and Y: 1000 pulses per unit, drives on."""
    return at_axes()
