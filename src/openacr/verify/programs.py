"""The part programs of a folder."""

from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

from openacr.errors import UserError, unreadable

PATTERNS = ("*.nc", "*.ngc", "*.cnc", "*.tap", "*.gcode")


def programs(folder: Path, patterns: Sequence[str] = PATTERNS) -> list[Path]:
    """The files of a folder and its subfolders whose names fit a pattern, in their order.

    Capitals and small letters are the same; hidden files and folders are left out. UserError
    for a folder that cannot be read or that holds none.
    """
    if not folder.is_dir():
        raise UserError(f"{folder}: {'not a folder' if folder.exists() else 'no such folder'}")
    wanted = [pattern.lower() for pattern in patterns]
    try:
        found = sorted(
            path
            for path in folder.rglob("*")
            if any(fnmatch(path.name.lower(), pattern) for pattern in wanted)
            and not any(part.startswith(".") for part in path.relative_to(folder).parts)
            and (not path.is_dir() or path.is_symlink())
        )
    except OSError as error:
        raise unreadable(folder, error) from None
    if not found:
        raise UserError(
            f"{folder}: no part programs ({', '.join(patterns)}; --files names other patterns)"
        )
    return found
