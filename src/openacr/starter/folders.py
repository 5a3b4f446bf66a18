"""Folders that are made for a user: there as a whole or not at all, or a sentence why not."""

import shutil
from collections.abc import Callable
from pathlib import Path

from openacr.errors import unwritable


def ensure(folder: Path) -> None:
    """Make a folder, and those it is in, unless it is there; UserError if that is impossible."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as failure:
        raise unwritable(folder, failure) from None


def make_whole(folder: Path, fill: Callable[[Path], None]) -> None:
    """Make a new folder that `fill` fills under another name; UserError, and no trace of it."""
    partial = folder.with_name(f".{folder.name}.partial")
    try:
        partial.mkdir()
        try:
            fill(partial)
            partial.rename(folder)
        except BaseException:
            shutil.rmtree(partial, ignore_errors=True)
            raise
    except OSError as failure:
        raise unwritable(folder, failure) from None
