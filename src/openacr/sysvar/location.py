"""The default location of the store, and opening a store there or elsewhere."""

import os
from pathlib import Path

from openacr.errors import StoreError
from openacr.sysvar.store import Store

VARIABLE = "OPENACR_STORE"
FILE_NAME = "sysvar.db"


def default_path() -> Path:
    """The file named by OPENACR_STORE, else `sysvar.db` in the user's data folder."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named).expanduser()
    import platformdirs

    return platformdirs.user_data_path("openacr") / FILE_NAME


def open_to_write(path: Path | None) -> Store:
    """Open a store for writing; a missing file is created."""
    return Store(path or default_path())


def open_to_read(path: Path | None) -> Store:
    """Open a store for reading; no file is created.

    Without a default store all cells have the values of a new one; a file that was named has
    to exist.
    """
    meant = path or default_path()
    if meant.exists():
        return Store(meant)
    if path is not None:
        raise StoreError(f"{path} does not exist (`openacr sysvar set --store` creates a store)")
    return Store()
