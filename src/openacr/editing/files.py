"""The files an editor works with: texts that are open, and others as they are on the disk."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from openacr.editing.document import Document
from openacr.project import decode

MOST_BYTES = 4_000_000  # of a file that is not open


class OpenFiles:
    """Documents by path; those on the disk are read once, until `forget`."""

    def __init__(self) -> None:
        self._open: dict[Path, Document] = {}
        self._read: dict[Path, Document | None] = {}
        self._folders: dict[Path, tuple[Path, ...]] = {}

    @property
    def unsaved(self) -> Mapping[Path, Document]:
        """The texts that are open."""
        return self._open

    def put(self, document: Document) -> None:
        """Open a document, or another text of it."""
        self._open[document.path] = document
        self.forget()

    def remove(self, path: Path) -> None:
        """Close a document."""
        self._open.pop(path, None)
        self.forget()

    def forget(self) -> None:
        """Look at the disk again when a file is asked for."""
        self._read.clear()
        self._folders.clear()

    def document(self, path: Path) -> Document | None:
        """The text of a file; None if there is no such file, or none that can be read."""
        if path in self._open:
            return self._open[path]
        if path not in self._read:
            self._read[path] = _read(path)
        return self._read[path]

    def beside(self, path: Path) -> Iterator[Path]:
        """The files in the folder of a file, open ones that are not on the disk included."""
        folder = path.parent
        if folder not in self._folders:
            there = {each for each in self._open if each.parent == folder}
            self._folders[folder] = tuple(sorted(there | set(_entries(folder))))
        yield from self._folders[folder]


def _read(path: Path) -> Document | None:
    try:
        if path.stat().st_size > MOST_BYTES:
            return None
        return Document.of(path, decode(path.read_bytes()))
    except OSError:
        return None


def _entries(folder: Path) -> list[Path]:
    try:
        return [entry for entry in folder.iterdir() if entry.is_file()]
    except OSError:
        return []
