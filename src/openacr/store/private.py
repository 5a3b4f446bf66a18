"""Files readable only by their owner, since a card's data includes programs and a password."""

import os
from pathlib import Path
from typing import BinaryIO

OWNER_ONLY = 0o600


def create(path: Path) -> None:
    """Create a file if absent; the permissions of an existing one are kept."""
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, OWNER_ONLY))


def open_to_write(path: Path) -> BinaryIO:
    """Open an empty file for unbuffered writing."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, flags, OWNER_ONLY), "wb", buffering=0)
