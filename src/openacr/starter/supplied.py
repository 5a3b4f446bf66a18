"""The example projects that come with the package.

In an installed package they are a folder of it, which the build (`setup.py`) copies from
`examples` and `parts` of the source tree; in a source tree they are read where they are.
"""

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from openacr.errors import UserError, unreadable
from openacr.starter.folders import make_whole

PACKAGE = Path(__file__).parents[1]
INSTALLED = PACKAGE / "example_projects"
SOURCE_TREE = PACKAGE.parents[1]
PART_PROGRAMS = "parts"
README = "README.md"


@dataclass(frozen=True, slots=True)
class Example:
    """One example: its name, what it is, and where it is."""

    name: str
    title: str
    folder: Path

    @property
    def is_project(self) -> bool:
        """Whether `openacr run` takes it; part programs are for `openacr mill`."""
        return (self.folder / "machine.toml").exists()

    @property
    def files(self) -> list[str]:
        """The names of its files."""
        return sorted(path.name for path in self.folder.iterdir() if path.is_file())


def examples() -> list[Example]:
    """All examples in the order of their names."""
    return [example_named(name) for name in names()]


def names() -> list[str]:
    """The names of all examples; their files are not read."""
    return sorted(folder.name for folder in _folders())


def example_named(name: str) -> Example:
    """The example of a name; UserError with the names there are."""
    for folder in _folders():
        if folder.name == name:
            return Example(name, _title(folder), folder)
    raise UserError(f"{name}: there is no such example; there are {', '.join(names())}")


def copy_example(example: Example, folder: Path) -> list[Path]:
    """Copy an example into a new folder, whole or not at all; UserError if something is there."""
    if folder.exists() or folder.is_symlink():
        raise UserError(f"{folder} is there already; nothing is replaced")
    if not folder.parent.is_dir():
        raise UserError(f"{folder}: there is no folder {folder.parent}")

    def fill(partial: Path) -> None:
        for name in example.files:
            shutil.copyfile(example.folder / name, partial / name)

    make_whole(folder, fill)
    return [folder / name for name in example.files]


def _folders() -> Iterator[Path]:
    installed = INSTALLED.is_dir()
    roots = [INSTALLED] if installed else [SOURCE_TREE / "examples"]
    try:
        for root in roots:
            yield from (entry for entry in root.iterdir() if (entry / README).is_file())
        if not installed:
            yield SOURCE_TREE / PART_PROGRAMS
    except OSError as failure:
        raise unreadable(roots[0], failure) from None


def _title(folder: Path) -> str:
    with (folder / README).open(encoding="utf-8") as text:
        return text.readline().lstrip("# ").rstrip()
