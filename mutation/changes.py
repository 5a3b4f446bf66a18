"""Which lines of which files are to be tried."""

import re
import subprocess
from pathlib import Path

SOURCE = Path("src/openacr")
_HUNK = re.compile(r"^@@ -\S+ \+(\d+)(?:,(\d+))? @@")


def changed(base: str) -> dict[str, set[int]]:
    """Lines of the work tree added or changed since a revision, by file."""
    command = [
        "git",
        "diff",
        "--unified=0",
        "--no-color",
        base,
        "--",
        f"{SOURCE}/**.py",
        f"{SOURCE}/*.py",
    ]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    lines: dict[str, set[int]] = {}
    path = ""
    for line in text.splitlines():
        if line.startswith("+++ "):
            path = line.removeprefix("+++ b/")
        elif match := _HUNK.match(line):
            first, count = int(match[1]), int(match[2] or 1)
            lines.setdefault(path, set()).update(range(first, first + count))
    return {path: numbers for path, numbers in lines.items() if numbers and Path(path).exists()}


def named(places: list[str]) -> dict[str, None]:
    """Files of packages, folders and files named below `src/openacr`."""
    files: dict[str, None] = {}
    for place in places:
        where = SOURCE if place == "all" else Path(place)
        where = where if where.exists() else SOURCE / place
        if not where.exists() or not where.is_relative_to(SOURCE):
            raise SystemExit(f"mutation: {place}: no such file or package in {SOURCE}")
        found = sorted(where.rglob("*.py")) if where.is_dir() else [where]
        files.update(dict.fromkeys(str(path) for path in found))
    return files
