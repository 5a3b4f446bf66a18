"""`openacr compare`: what two cards, projects or backups have different."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from msgspec import to_builtins

from openacr.cli.live.online import BAUD, FAILED, PATIENCE_S, Baud, Silence, connected, progress_bar
from openacr.cli.printing import print_json
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.client.compare import Change, Contents, Difference
    from openacr.project import Project

_Side = typer.Argument(help="Card (HOST, HOST:PORT, serial port), project, backup, or one file.")


def compare(
    first: Annotated[str, typer.Argument(metavar="A", help=_Side.help)],
    second: Annotated[str, typer.Argument(metavar="B", help=_Side.help)],
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    baud: Baud = BAUD,
    silence: Silence = PATIENCE_S,
) -> None:
    """Compare settings, variables and programs of two cards, projects or backups.

    Cards are only asked; a project is loaded into a virtual card and asked the same. Exit code 1:
    they differ; 2: one of them cannot be read.
    """
    from openacr.client.compare import changes, differences, not_compared

    found = [_contents(side, baud, silence) for side in (first, second)]
    settings = list(differences(*found))
    lines = list(changes(*found))
    gaps = list(not_compared(*found))
    if as_json:
        print_json(_record(found, settings, lines, gaps))
    else:
        for text in _report(found, settings, lines, gaps):
            typer.echo(text)
    if settings or lines:
        raise typer.Exit(FAILED)


def _contents(side: str, baud: int, silence_s: float) -> "Contents":
    """What one side holds."""
    from openacr.client.compare import contents

    path = Path(side)
    if path.is_dir() or path.is_file():
        return _of_files(path)
    if path.suffix.lower() == ".8k" or ("/" in side and not side.startswith("/dev/")):
        raise UserError(f"{side}: there is no such file or folder, nor such a serial port")
    with connected(side, baud, silence_s) as card, progress_bar(f"reading {side}") as progress:
        return contents(side, card.read_all(progress), levels=_all_levels())


def _of_files(path: Path) -> "Contents":
    """What a project, a backup or one file holds; a file of one program holds only that."""
    from openacr.client.backup import SETUP_FILE
    from openacr.client.compare import contents, is_backup
    from openacr.project import Place, find_project, place_of

    if path.is_file() and place_of(path)[0] is not Place.SETUP:
        return contents(str(path), {path.name.lower(): find_project(path).sources[0].text})
    project = find_project(path)
    levels = _all_levels() if path.is_dir() else ()
    if project.setup is None or is_backup(project.setup.text):
        texts = {source.path.name.lower(): source.text for source in project.sources}
        if path.is_file():
            texts = {SETUP_FILE: texts[path.name.lower()]}
        return contents(str(path), texts, levels=levels)
    return contents(str(path), _loaded(project), levels=levels)


def _loaded(project: "Project") -> dict[str, str]:
    """The files of a backup of a virtual card with a project, before any program has run."""
    from openacr.client import Card
    from openacr.controller import Controller
    from openacr.controller.loading import LoadError

    controller, refused = Controller.load(project)
    if refused:
        raise LoadError(refused)
    controller.send("HALT ALL\r")
    with Card.open(controller) as card:
        return card.read_all()


def _all_levels() -> list[str]:
    from openacr.client.backup import levels

    return [str(level) for level in levels()]


# --- what is shown ------------------------------------------------------------------------


def _report(
    sides: "list[Contents]",
    settings: "list[Difference]",
    lines: "list[Change]",
    gaps: list[str],
) -> Iterator[str]:
    for letter, side in zip("AB", sides, strict=True):
        yield f"{letter}: {side.name}{f' ({side.version})' if side.version else ''}"
    for each in settings:
        yield f"{each.key}: {_shown(each.first)} | {_shown(each.second)}{_named(each.name)}"
    for program in dict.fromkeys(each.program for each in lines):
        yield f"{program}:"
        for change in (each for each in lines if each.program == program):
            yield f"  line {change.line}"
            yield from (f"  A {text}" for text in change.first)
            yield from (f"  B {text}" for text in change.second)
    for gap in gaps:
        yield f"not compared: {gap}"
    if settings or lines:
        yield (
            f"different: {counted(len(settings), 'setting')},"
            f" {counted(len(lines), 'place')} in programs"
        )
    else:
        yield "equal"


def _shown(value: str | None) -> str:
    return "(not there)" if value is None else value


def _named(name: str) -> str:
    return f"   {name}" if name else ""


def _record(
    sides: "list[Contents]",
    settings: "list[Difference]",
    lines: "list[Change]",
    gaps: list[str],
) -> dict[str, Any]:
    return {
        "equal": not settings and not lines,
        **{
            letter: {"name": side.name, "version": side.version}
            for letter, side in zip(("first", "second"), sides, strict=True)
        },
        "settings": [to_builtins(each) for each in settings],
        "programs": [to_builtins(each) for each in lines],
        "not_compared": gaps,
    }
