"""Where the store lies when nobody says so."""

import os
from pathlib import Path

VARIABLE = "OPENACR_STORE"
FILE_NAME = "sysvar.db"


def default_path() -> Path:
    """The file named by OPENACR_STORE, else one in the data folder of the user."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named).expanduser()
    import platformdirs

    return platformdirs.user_data_path("openacr") / FILE_NAME
