"""`openacr examples`: the example projects that come with the package."""

from pathlib import Path
from typing import Annotated

import typer

from openacr.cli.printing import print_json
from openacr.wording import as_typed


def complete_example(incomplete: str) -> list[str]:
    """Names of examples with this beginning, for completion."""
    from openacr.starter.supplied import names

    return [name for name in names() if name.startswith(incomplete)]


def list_examples(
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON array.")] = False,
) -> None:
    """List the examples that come with the package, each with one line."""
    from openacr.starter.supplied import examples

    found = examples()
    if as_json:
        records = [{"name": each.name, "title": each.title, "files": each.files} for each in found]
        print_json(records)
        return
    width = max(len(each.name) for each in found)
    for each in found:
        typer.echo(f"{each.name:<{width}}  {each.title}")


def copy_to(
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", help="Example.", autocompletion=complete_example),
    ],
    folder: Annotated[
        Path | None, typer.Argument(metavar="[DIR]", help="New folder; default: NAME.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print folder and files as one JSON object.")
    ] = False,
) -> None:
    """Copy an example into a new folder, to run and to change it."""
    from openacr.starter.supplied import copy_example, example_named

    example = example_named(name)
    target = folder or Path(name)
    copied = copy_example(example, target)
    if as_json:
        record = {"folder": str(target), "files": [path.name for path in copied]}
        print_json(record)
        return
    for path in copied:
        typer.echo(str(path))
    if example.is_project:
        typer.echo(f"run it: openacr run {as_typed(target)}", err=True)
