"""`openacr mill list`: a part program with the moves that compensation inserts."""

from typing import TYPE_CHECKING

import typer

from openacr.cli.mill.check import (
    FAILED,
    AtStore,
    Dialect,
    PartProgram,
    in_folder,
    loaded,
    opened_store,
    printable,
    show_findings,
)

if TYPE_CHECKING:
    from openacr.cnc.program.program import Program
    from openacr.cnc.reading.findings import Finding
    from openacr.sysvar import Store


METRIC = 21


def list_program(file: PartProgram, store: AtStore = None, dialect: Dialect = None) -> None:
    """List a part program; lines with <ins> are moves inserted at corners."""
    from openacr.cnc.reading.text import decoded

    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        inserted, errors = inserted_lines(program, cells, name)
    text = program.main.text
    offset, number = text.begin, 1
    while (taken := text.line(offset)) is not None:
        for line in inserted.get(number, []):  # made before the block that follows the corner
            typer.echo(line)
        typer.echo(printable(decoded(taken[0])))
        offset, number = taken[1], number + 1
    if errors:
        show_findings(in_folder(errors, file))
        raise typer.Exit(FAILED)


def inserted_lines(
    program: "Program", cells: "Store", dialect: str
) -> "tuple[dict[int, list[str]], list[Finding]]":
    """Inserted moves by line, as far as the program can be read."""
    from openacr.cnc.canonical import Arc, Line, Rapid
    from openacr.cnc.compensation import listing
    from openacr.cnc.interpreter.interpreter import Interpreter, Options
    from openacr.cnc.reading.findings import BlockError
    from openacr.cnc.state.hosts import VirtualMachine
    from openacr.cnc.state.shadow import Shadow

    options = Options(collects_errors=True)
    run = Interpreter(program, Shadow(cells), VirtualMachine(), dialect, options)
    found: dict[int, list[str]] = {}
    errors = list(program.errors)
    try:
        for entry in run.entries() if not errors else ():
            if not isinstance(entry, Rapid | Line | Arc) or not entry.is_inserted:
                continue
            text = listing(
                entry,
                run.modal.plane_axes,
                shift=run.path.coordinates.shift,
                scale=run.path.shown(1.0),
                is_metric=run.modal.unit == METRIC,
            )
            lines = found.setdefault(entry.source.line, [])
            if text not in lines:  # a loop inserts the same again
                lines.append(text)
    except BlockError as error:
        errors.append(error.finding)
    return found, [*errors, *run.errors]
