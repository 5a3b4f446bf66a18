"""The files of a first project, from the templates of this package."""

import re
from pathlib import Path

from openacr.configure import code_files, parse_answers
from openacr.errors import UserError, unreadable, unwritable
from openacr.starter.choices import Choices
from openacr.starter.facts import facts_of
from openacr.starter.folders import make_whole
from openacr.starter.render import render

TEMPLATES = Path(__file__).parent / "templates"
SUFFIX = ".template"
COMMENT_COLUMN = 36
_COMMENT = re.compile(r"^(\S.*?) {2,}# ", re.MULTILINE)
ANSWERS = "configure.toml"
# Files that not every project has, and the fact that decides.
CONDITIONS = {"plc0.8k": "has_plc", "settings.toml": "cuts_parts", "part.nc": "cuts_parts"}
NAME = re.compile(r"[^\W_](?:[\w .+-]{0,60}[\w+])?")


def project_files(name: str, chosen: Choices) -> dict[str, str]:
    """The texts of a project by file name; `name` is that of its folder."""
    facts = facts_of(name, chosen)
    omitted = {each for each, condition in CONDITIONS.items() if not facts[condition]}
    templates = {path.name.removesuffix(SUFFIX): path for path in TEMPLATES.glob(f"*{SUFFIX}")}
    files = {
        each: render(path.read_text("utf-8"), facts)
        for each, path in sorted(templates.items())
        if each not in omitted
    }
    files[".gitignore"] = files.pop("gitignore")
    files = {
        name: _aligned(text) if name.endswith(".toml") else text for name, text in files.items()
    }
    answers = files[ANSWERS]
    return files | code_files(parse_answers(answers, ANSWERS), answers, is_explained=True)


def _aligned(text: str) -> str:
    """Put the comments at the ends of lines below each other."""
    return _COMMENT.sub(lambda found: f"{found[1]:<{COMMENT_COLUMN}}# ", text)


def require_free(folder: Path) -> None:
    """Refuse a folder that cannot become a project; UserError says why."""
    if not NAME.fullmatch(folder.resolve().name):
        raise UserError(
            f"{str(folder)!r}: a project is called by letters, digits, blanks, dots, + and -"
        )
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise UserError(
                f"{folder} is there already, and not an empty folder; nothing is replaced"
            )
    except OSError as failure:
        raise unreadable(folder, failure) from None
    if not folder.parent.is_dir():
        raise UserError(f"{folder}: there is no folder {folder.parent}")


def write_project(folder: Path, chosen: Choices) -> list[Path]:
    """Write a project into a new or empty folder; UserError if something is there.

    A new folder appears whole or not at all.
    """
    require_free(folder)
    files = project_files(folder.resolve().name, chosen)
    if not folder.exists():
        make_whole(folder, lambda partial: _fill(partial, files))
    else:
        try:
            _fill(folder, files)
        except OSError as failure:
            raise unwritable(folder, failure) from None
    return [folder / each for each in sorted(files)]


def _fill(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        with (folder / name).open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
