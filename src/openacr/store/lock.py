"""One process at a time owns a folder; the lock ends with the process, however it ends."""

from pathlib import Path

from openacr.locks import FileLock, InUseError

__all__ = ["FolderLock", "InUseError"]

FILE_NAME = "lock"


class FolderLock(FileLock):
    """The ownership of a folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder / FILE_NAME, f"{folder} is in use by another card")
