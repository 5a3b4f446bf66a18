"""Files that only their owner reads: what a card keeps holds programs and their password."""

import os
from pathlib import Path
from typing import BinaryIO

OWNER_ONLY = 0o600


def create(path: Path) -> None:
    """Make a file where there is none; the rights of one that is there stay."""
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, OWNER_ONLY))


def open_to_write(path: Path) -> BinaryIO:
    """An empty file to write into, without a buffer."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, flags, OWNER_ONLY), "wb", buffering=0)
