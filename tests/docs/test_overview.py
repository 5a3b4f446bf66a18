"""Every file and function docs/overview.md names is where the page says."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "openacr"
TEXT = (ROOT / "docs" / "overview.md").read_text(encoding="utf-8")
QUOTED = re.compile(r"`([^`]+)`")
PATH = re.compile(r"[\w./]+/|[\w./]+/\w+\.(?:py|md)")


def steps() -> list[tuple[str, str]]:
    """Of the tables with a column of files: the columns before, and that column."""
    found, has_files = [], False
    for line in TEXT.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|"):
            has_files = False
        elif cells[-1] == "file":
            has_files = True
        elif has_files and QUOTED.search(cells[-1]):
            found.append((" ".join(cells[:-1]), cells[-1]))
    return found


def files_of(column: str) -> list[Path]:
    """The files of a row; one without a folder is in that of the file before it."""
    found: list[Path] = []
    for name in QUOTED.findall(column):
        path = SOURCE / name if "/" in name else found[-1].with_name(name)
        found.append(path)
    return found


def text_of(path: Path) -> str:
    files = path.rglob("*.py") if path.is_dir() else [path]
    return "".join(each.read_text(encoding="utf-8") for each in files)


@pytest.mark.parametrize(("names", "column"), steps())
def test_the_functions_of_a_step_are_in_its_files(names: str, column: str) -> None:
    text = "".join(map(text_of, files_of(column)))
    words = re.findall(r"[A-Za-z_]\w+", " ".join(QUOTED.findall(names)))
    assert [word for word in words if not re.search(rf"\b{word}\b", text)] == []


def test_every_path_of_the_page_exists() -> None:
    named = {each for each in QUOTED.findall(TEXT) if PATH.fullmatch(each)}
    assert len(named) > 80
    found = {each for each in named if (SOURCE / each).exists() or (ROOT / each).exists()}
    assert named - found == set()


def test_the_page_has_its_steps() -> None:
    assert len(steps()) > 35
