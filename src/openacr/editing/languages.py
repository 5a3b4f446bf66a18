"""The languages an editor meets, each with the same questions, and which one a file is in."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Protocol

from openacr.editing.completions import Completion, Signature
from openacr.editing.document import Document, Edit, Place
from openacr.editing.marks import Mark, Symbol
from openacr.editing.outlines import Entry, Fold
from openacr.editing.symbols import Finding

STEP_LINES = 500  # read ahead at once
CONTROLLER_SUFFIX = ".8k"
CONTROLLER_NAMES = frozenset(("acrobasic", "acroplc", "8k"))


class Files(Protocol):
    """The texts of files: those that are being edited, others from the disk."""

    @property
    def unsaved(self) -> Mapping[Path, Document]:
        """The texts that are being edited."""

    def document(self, path: Path) -> Document | None:
        """The text of a file; None if there is no such file, or none that can be read."""

    def beside(self, path: Path) -> Iterator[Path]:
        """The files in the folder of a file."""


class Language(Protocol):
    """What an editor asks of a document in one language."""

    @property
    def longest(self) -> int:
        """The characters a line may have."""

    def marks(
        self, document: Document, lines: Iterable[int]
    ) -> Iterator[tuple[int, tuple[Mark, ...]]]:
        """The parts of lines."""

    def symbol(self, document: Document, line: int, mark: Mark) -> Symbol | None:
        """What the name of a mark stands for; None: it has no definition."""

    def related(self, document: Document) -> Iterable[Document]:
        """The documents in which the names of this one may stand, itself included."""

    def mentions(self, document: Document, symbol: Symbol) -> Iterator[int]:
        """The lines that may hold a name."""

    def refusal(self, document: Document, symbol: Symbol, new: str) -> str:
        """Why a name may not be given to a symbol; empty if it may."""

    def describe(self, document: Document, line: int, mark: Mark) -> str:
        """What a part of a line is, as Markdown; empty if nothing is known."""

    def hint(self, document: Document, mark: Mark) -> str:
        """The name of what a number in a line stands for; empty if it needs none."""

    def complete(self, document: Document, place: Place) -> Completion:
        """Proposals for what is being typed."""

    def signature(self, document: Document, place: Place) -> Signature | None:
        """How the command or function at a place is written."""

    def entries(self, document: Document) -> list[Entry]:
        """The outline."""

    def folds(self, document: Document) -> Iterator[Fold]:
        """Lines that belong together."""

    def format(self, document: Document) -> list[Edit]:
        """The changes that make a text look as it is listed."""

    def subject(self, document: Document) -> Path:
        """What is checked when a document has changed: the file, or the folder of its project."""

    def findings(
        self, subject: Path, documents: Mapping[Path, Document]
    ) -> dict[Path, list[Finding]]:
        """What is wrong with a subject, by file."""

    def prepare(self, document: Document) -> Iterator[None]:
        """Read ahead what the first keys would wait for, in steps of some milliseconds."""

    def forget(self, path: Path) -> None:
        """Forget what is kept of a file, which is closed."""


def in_steps(read: Callable[[str], object], lines: list[str]) -> Iterator[None]:
    """Have lines read by a function that keeps what it finds, some at a time."""
    for first in range(0, len(lines), STEP_LINES):
        for text in lines[first : first + STEP_LINES]:
            read(text)
        yield


def is_controller(document: Document) -> bool:
    """Whether a document is a controller file; otherwise it is a part program."""
    if document.language:
        return document.language.lower() in CONTROLLER_NAMES
    return document.path.suffix.lower() == CONTROLLER_SUFFIX
