"""What a check finds, cut to what an editor shows: it may come from another process."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from pathlib import Path

    from openacr.editing.document import Document
    from openacr.editing.engine import Engine
    from openacr.editing.symbols import Finding

MOST_FINDINGS = 1000  # of a file: editors show no more


class Found(NamedTuple):
    """The findings of a file; of very many the first ones, errors before warnings."""

    shown: list[Finding]
    left_out: int = 0
    next: Finding | None = None  # the first one that is left out

    @classmethod
    def of(cls, findings: list[Finding]) -> Found:
        """What is shown of findings."""
        left_out = len(findings) - MOST_FINDINGS
        if left_out <= 0:
            return cls(findings)
        ordered = sorted(findings, key=lambda each: each.is_warning)
        return cls(ordered[:MOST_FINDINGS], left_out, ordered[MOST_FINDINGS])


NOTHING = Found([])


def found_by(engine: Engine, subject: Path, documents: dict[Path, Document]) -> dict[Path, Found]:
    """What is wrong with a subject, by file."""
    every = engine.findings(subject, documents)
    return {path: Found.of(findings) for path, findings in every.items()}


def found_anew(
    machine: tuple[Path | None, str | None], subject: Path, documents: dict[Path, Document]
) -> dict[Path, Found]:
    """The same in another process, for the store and the dialect of a machine."""
    from openacr.editing.engine import Engine

    return found_by(Engine(*machine), subject, documents)
