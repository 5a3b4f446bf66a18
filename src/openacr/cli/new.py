"""`openacr new`: a first project from questions or options."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from openacr.cli.conversions import given_quantity
from openacr.cli.printing import print_json
from openacr.errors import UserError
from openacr.starter.choices import KINDS, UNITS, Homing, Kind, Limits, Unit, choices
from openacr.wording import as_typed

if TYPE_CHECKING:
    from collections.abc import Callable

    from openacr.starter.choices import Choices


def new(
    name: Annotated[Path, typer.Argument(metavar="NAME", help="Folder of the project: a new one.")],
    kind: Annotated[
        Kind | None, typer.Option(help="What the machine is and its program does; default: axis.")
    ] = None,
    axes: Annotated[
        str | None, typer.Option(metavar="XYZ|X,Y,Z", help="Names of the axes, 1 to 8.")
    ] = None,
    units: Annotated[Unit | None, typer.Option(help="Unit of all positions.")] = None,
    travel: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Travel of every axis, in units or as 5cm, 2rev."),
    ] = None,
    limits: Annotated[Limits | None, typer.Option(help="What ends the travel.")] = None,
    homing: Annotated[
        Homing | None,
        typer.Option(help="How an axis finds its zero: switch, or switch and encoder marker."),
    ] = None,
    inputs: Annotated[
        str | None,
        typer.Option(
            metavar="NAME,...", help="Inputs: a start button, and conditions to be on for a start."
        ),
    ] = None,
    plc: Annotated[
        bool | None, typer.Option("--plc/--no-plc", help="Make a PLC as well, for a lamp.")
    ] = None,
    is_asked: Annotated[
        bool | None,
        typer.Option(
            "--ask/--no-ask", help="Ask for what no option gives; default: at a terminal."
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print what was made as one JSON object; ask nothing.")
    ] = False,
) -> None:
    """Make a project: a machine, its set-up, a program, a scenario and a test, all explained.

    What is made runs (`openacr run NAME`), has no errors (`openacr check NAME`) and meets its
    scenario. Nothing is overwritten.
    """
    from openacr.starter.files import require_free, write_project

    require_free(name)
    given: dict[str, Any] = {
        "axes": None if axes is None else _names(axes),
        "unit": units,
        "travel_u": travel,
        "limits": limits,
        "homing": homing,
        "inputs": None if inputs is None else _listed(inputs),
        "has_plc": plc,
    }
    if is_asked or (is_asked is None and not as_json and _is_terminal()):
        kind = kind or Kind(_answer("Kind of machine", Kind.AXIS, _words(Kind)))
        chosen = _asked(kind, given)
    else:
        chosen = _choices(kind or Kind.AXIS, given)
    written = write_project(name, chosen)
    if as_json:
        print_json(_record(name, chosen, written))
        return
    for path in written:
        typer.echo(str(path))
    typer.echo(f"run it: openacr run {as_typed(name)}", err=True)


def _is_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _choices(kind: Kind, given: dict[str, Any]) -> "Choices":
    values = {key: value for key, value in given.items() if value is not None}
    if "travel_u" in values:
        unit = values.get("unit") or KINDS[kind].unit
        values["travel_u"] = given_quantity("--travel", values["travel_u"], unit)
    return choices(kind, **values)


def _names(text: str) -> list[str]:
    """The axes: single letters, or names with commas between them."""
    return _listed(text) if "," in text else list(text.strip())


def _listed(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _words(names: type[Kind] | type[Unit] | type[Limits] | type[Homing]) -> list[str]:
    return [str(name) for name in names]


class _Question(NamedTuple):
    """One choice that is asked for: its key, its default, the answers, how one is read."""

    key: str
    title: str
    default: "Callable[[], str]"
    read: "Callable[[str], Any]"
    allowed: list[str] | None = None


def _questions(kind: Kind, given: dict[str, Any]) -> list[_Question]:
    row = KINDS[kind]
    return [
        _Question("axes", "Axes", lambda: ",".join(row.axes), _names),
        _Question("unit", "Unit", lambda: row.unit, Unit, _words(Unit)),
        _Question("travel_u", "Travel", lambda: f"{UNITS[given['unit']].travel_u:g}", str),
        _Question("limits", "Limits", lambda: row.limits, Limits, _words(Limits)),
        _Question("homing", "Homing", lambda: row.homing, Homing, _words(Homing)),
        _Question("inputs", "Inputs: start button, conditions", lambda: "", _listed),
        _Question("has_plc", "A PLC for a lamp", lambda: "n", lambda word: word == "y", ["y", "n"]),
    ]


def _asked(kind: Kind, given: dict[str, Any]) -> "Choices":
    """Ask for every choice that was not given; a wrong answer is asked again."""
    for question in _questions(kind, given):
        while given[question.key] is None:
            answer = _answer(question.title, question.default(), question.allowed)
            try:
                found = question.read(answer)
                _choices(kind, {**given, question.key: found})
            except UserError as error:
                typer.echo(f"error: {error}", err=True)
            else:
                given[question.key] = found
    return _choices(kind, given)


def _answer(title: str, default: str, allowed: list[str] | None) -> str:
    from rich.console import Console
    from rich.prompt import Prompt

    console = Console(stderr=True, highlight=False)
    try:
        return Prompt.ask(title, console=console, choices=allowed, default=str(default))
    except EOFError:
        raise UserError(f"the answers end before {title!r}; --no-ask takes the defaults") from None


def _record(folder: Path, chosen: "Choices", written: list[Path]) -> dict[str, Any]:
    return {
        "folder": str(folder),
        "files": [path.name for path in written],
        "kind": str(chosen.kind),
        "axes": list(chosen.axes),
        "units": str(chosen.unit),
        "travel": chosen.travel_u,
        "limits": str(chosen.limits),
        "homing": str(chosen.homing),
        "inputs": list(chosen.inputs),
        "plc": chosen.has_plc,
    }
