"""What failures of the system are called in the sentences of this program."""

import socket
from pathlib import Path

import pytest

from openacr.errors import UserError, read_bytes, reason


def test_a_failure_is_said_without_its_number() -> None:
    failure = ConnectionRefusedError(111, "Connection refused")
    assert reason(failure) == "Connection refused"


def test_a_name_that_is_not_known_keeps_its_own_words() -> None:
    failure = socket.gaierror(-2, "Name or service not known")
    assert reason(failure) == "Name or service not known"
    assert reason(ValueError("no such speed")) == "no such speed"


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=f"^{tmp_path}: cannot be read: is a directory$"):
        read_bytes(tmp_path)
