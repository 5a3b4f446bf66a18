"""A part program that is ready to run, and what is known of it."""

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from openacr.cnc.canonical import Source
from openacr.cnc.loading.load import load
from openacr.cnc.program.program import Program
from openacr.mill.config.dialects import choose
from openacr.mill.config.folders import folders_of
from openacr.panel.control.operator.listing import Listing
from openacr.panel.work.paths import finding_data
from openacr.sysvar import Store
from openacr.sysvar.tabs import CONTROL

HASH_CHUNK = 1 << 20


@dataclass(slots=True)
class Loaded:
    """A program that is ready to run, and what is known of it."""

    name: str
    path: str  # in the folder of programs
    kind: str
    file: Path
    program: Program
    dialect: str
    listing: Listing
    version: str
    is_drawn: bool  # Default Graphics at the time of the load
    facts: dict[str, Any] = field(default_factory=dict)  # time, extents, tools: known later
    found: list[dict[str, Any]] | None = None  # findings of the whole program: known later
    is_stale: bool = False  # the file was stored again since

    @classmethod
    def read(cls, file: Path, path: str, kind: str, store: Store, dialect: str) -> "Loaded":
        """Load a program from its file; UserError where it cannot be read."""
        choice = choose(file, store, dialect or None)
        folder = store.path.parent if store.path else None
        program = load(file, store, choice.name, folders_of(store, folder))
        return cls(
            file.name,
            path,
            kind,
            file,
            program,
            choice.name,
            Listing(file),
            version_of(file),
            bool(store.read(CONTROL.default_graphics)),
        )

    def has(self, source: str) -> bool:
        """Whether a block with this file name is of the loaded text, not of one it includes."""
        return source == self.program.main.text.name

    def text_of(self, source: Source) -> str:
        """The text of a block that does not carry it."""
        if not self.has(source.file):
            return self.program.text_of(source)
        return "".join(self.listing.lines(source.line, 1))

    def data(self) -> dict[str, Any]:
        """What the screens show of it."""
        findings = self.findings()
        errors = [each for each in findings if each["severity"] == "error"]
        return {
            "name": self.name,
            "path": self.path,
            "kind": self.kind,
            "dialect": self.dialect,
            "lines": self.listing.total,
            "errors": len(errors),
            "warnings": len(findings) - len(errors),
            "checked": self.found is not None,
            "stale": self.is_stale,
            "id": self.version,
            "drawn": self.is_drawn,
            "seconds": self.facts.get("seconds"),
            "extents": self.facts.get("extents"),
            "tools": self.facts.get("tools"),
        }

    def findings(self) -> list[dict[str, Any]]:
        """Errors and warnings: of the load, and of the whole program when it was read."""
        if self.found is not None:
            return self.found
        return [finding_data(each) for each in self.program.findings]


def version_of(file: Path) -> str:
    """The version of a file: a hash of its bytes."""
    found = hashlib.blake2b(digest_size=16)
    with file.open("rb") as opened:
        while chunk := opened.read(HASH_CHUNK):
            found.update(chunk)
    return found.hexdigest()
