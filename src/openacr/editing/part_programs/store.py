"""The store of the machine that part programs are checked against."""

from pathlib import Path

from openacr.cnc.codes.table import DIALECTS
from openacr.editing.document import Document
from openacr.errors import OpenacrError
from openacr.mill.config.dialects import choose_for
from openacr.sysvar import Store
from openacr.sysvar.location import open_to_read

DEFAULT = "acromill"


class StoreOfMachine:
    """Opens the store for each question, so that what changes in it counts at once."""

    def __init__(self, path: Path | None = None, dialect: str | None = None) -> None:
        self._path, self._wanted = path, dialect
        self._known: dict[Path, tuple[Document, int, str]] = {}

    @property
    def dialect(self) -> str | None:
        """The dialect that was asked for; None: as each file says."""
        return self._wanted

    def open(self) -> Store:
        """The store for reading; UserError or another OpenacrError if it cannot be read."""
        return open_to_read(self._path)

    def dialect_of(self, document: Document) -> str:
        """The dialect of a program, chosen again when its text has changed by lines."""
        known = self._known.get(document.path)
        size = len(document.lines)
        if known is None or known[0] is not document or known[1] != size:
            known = document, size, self._chosen(document)
            self._known[document.path] = known
        return known[2]

    def forget(self, path: Path) -> None:
        """Choose the dialect of a file anew when it is asked for."""
        self._known.pop(path, None)

    def _chosen(self, document: Document) -> str:
        try:
            with self.open() as cells:
                return choose_for(document.data, cells, self._wanted).name
        except OpenacrError:  # found when the program is checked
            return self._wanted if self._wanted in DIALECTS else DEFAULT
