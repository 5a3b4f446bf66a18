"""Folders of a machine: its own M codes beside the store, the library of parts."""

from pathlib import Path

from openacr.cnc.loading.load import Folders
from openacr.cnc.parts.library import FOLDER
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import TOOL


def folders_of(cells: Store, folder: Path | None) -> Folders:
    """The folders of a machine whose store lies in `folder`, None in memory."""
    named = cells.read_text(TOOL.custom_m_folder)
    return Folders(library=FOLDER, customs=(folder or Path()) / named if named else None)
