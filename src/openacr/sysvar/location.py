"""Where the store lies when nobody says so, and opening it there."""

import os
from pathlib import Path

from openacr.errors import StoreError
from openacr.sysvar.store import Store

VARIABLE = "OPENACR_STORE"
FILE_NAME = "sysvar.db"


def default_path() -> Path:
    """The file named by OPENACR_STORE, else one in the data folder of the user."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named).expanduser()
    import platformdirs

    return platformdirs.user_data_path("openacr") / FILE_NAME


def open_to_write(path: Path | None) -> Store:
    """The store that is meant; a file that is not there is made."""
    return Store(path or default_path())


def open_to_read(path: Path | None) -> Store:
    """The store that is meant, for looking: nothing is made.

    Where none was made yet, everything is as in a new one; a file that was named has to be
    there.
    """
    meant = path or default_path()
    if meant.exists():
        return Store(meant)
    if path is not None:
        raise StoreError(f"{path} is not there (`openacr sysvar set --store` makes a store)")
    return Store()
