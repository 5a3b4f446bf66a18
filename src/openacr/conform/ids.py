"""Which ids have cases: `python -m openacr.conform.ids FOLDER ...` prints each with its cases.

A line for an id: itself, the count of its cases, the clauses they prove, and where the first is.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from openacr.conform.form import Case
from openacr.conform.read import files, read
from openacr.wording import counted


def by_id(cases: Iterable[Case]) -> dict[str, list[tuple[Case, str]]]:
    """The cases of each id with the clauses they prove, in the order of the ids."""
    found: dict[str, list[tuple[Case, str]]] = {}
    for case in cases:
        for claim in case.proves:
            found.setdefault(claim.id, []).append((case, claim.clause))
    return dict(sorted(found.items()))


def main(folders: list[str]) -> None:
    """Print the ids of the cases in folders."""
    cases = [case for folder in folders for path in files(Path(folder)) for case in read(path)]
    found = by_id(cases)
    for name, proofs in found.items():
        clauses = ", ".join(dict.fromkeys(clause for _, clause in proofs if clause))
        first = proofs[0][0]
        print(
            f"{name}  {len(proofs)}  {first.path}:{first.line}"
            + (f"  ({clauses})" if clauses else "")
        )
    print(f"{counted(len(found), 'id')} in {counted(len(cases), 'case')}")


if __name__ == "__main__":
    main(sys.argv[1:] or ["conformance"])
