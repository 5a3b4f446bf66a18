"""What all tests need."""

import os

import pytest
from hypothesis import settings

# How long an example takes depends on who else computes; pytest-timeout ends what hangs.
settings.register_profile("patient", deadline=None)
settings.load_profile("patient")


@pytest.fixture(scope="session", autouse=True)
def _journals(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Journals of cards that tests serve stay out of the folders of the user."""
    os.environ["OPENACR_JOURNALS"] = str(tmp_path_factory.mktemp("journals"))
