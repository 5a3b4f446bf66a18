"""A file with one case, for tests of what cases are and do."""

from pathlib import Path

from openacr.conform import Case, read

HEAD = "[case A]\nsource: 000 L7\nrests on: manual\n"


def case_of(folder: Path, text: str) -> Case:
    """The case of a file `cases.txt` with these lines below its head."""
    path = folder / "cases.txt"
    path.write_text(HEAD + text, encoding="utf-8")
    (case,) = read(path)
    return case
