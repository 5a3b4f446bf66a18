"""`openacr mill dialect`: the dialect of a part program, and the reason."""

import json as json_format

import typer

from openacr.cli.mill.check import AsJson, AtStore, Dialect, PartProgram, opened_store


def show_dialect(
    file: PartProgram, store: AtStore = None, dialect: Dialect = None, as_json: AsJson = False
) -> None:
    """Show the dialect in which a part program would be read, and the reason."""
    from openacr.mill.config.dialects import choose
    from openacr.mill.plan.estimate.checking import require_file

    require_file(file)
    with opened_store(store) as cells:
        choice = choose(file, cells, dialect)
    if as_json:
        record = {
            "dialect": choice.name,
            "chosen_by": choice.by,
            "likely": choice.likely,
            "signs": list(choice.reasons),
        }
        typer.echo(json_format.dumps(record, indent=1))
    else:
        typer.echo(f"{file}: {choice.text}")
