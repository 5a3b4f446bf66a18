"""What all tests need."""

import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def _journals(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Journals of cards that tests serve stay out of the folders of the user."""
    os.environ["OPENACR_JOURNALS"] = str(tmp_path_factory.mktemp("journals"))
