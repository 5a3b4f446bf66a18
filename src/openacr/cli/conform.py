"""`openacr conform`: what the manuals say, asked of a card."""

import json
import logging
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.live.online import (
    BAUD,
    FAILED,
    SILENCE_S,
    Baud,
    Silence,
    connected,
    progress_bar,
)
from openacr.errors import UserError
from openacr.models import DEFAULT_MODEL, MODELS
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.client import Card
    from openacr.client.identity import Identity
    from openacr.conform.campaign import Outcome
    from openacr.conform.form import Case
    from openacr.conform.moving import Permission

MOST_AXES = 16
MOST_SHOWN = 20  # differences in full


def conform(
    target: Annotated[
        str | None,
        typer.Argument(
            metavar="[HOST]", help="HOST, HOST:PORT or a serial port; without it a virtual card."
        ),
    ] = None,
    model: Annotated[
        str, typer.Option(help="Model of the virtual card.", autocompletion=lambda: list(MODELS))
    ] = DEFAULT_MODEL.name,
    areas: Annotated[
        list[str] | None,
        typer.Option(
            "--area",
            metavar="TEXT",
            help="Sections with this in their name, or ids that begin so (ACR-LIM).",
        ),
    ] = None,
    cases: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Other cases than those supplied.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write all outcomes to a JSON file.")
    ] = None,
    moving: Annotated[
        str | None,
        typer.Option(
            metavar="AXIS",
            help="Also cases that jog this axis (AXIS2 or 2), whose motor must be free.",
        ),
    ] = None,
    setting: Annotated[
        bool, typer.Option("--setting", help="Also cases that set something and put it back.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Compare a card with its manuals: the cases of all sections, and what differs.

    On a card with a HOST only those cases run that ask and change nothing; a card on which a
    program runs or an axis moves is refused. With --moving, after a question, one axis is jogged as
    far and as fast as the question says; Ctrl-C kills its motion. What cases set is put back at the
    end. Exit code 1: something differs.
    """
    from openacr.conform.campaign import chosen, on_virtual_card
    from openacr.conform.moving import Permission
    from openacr.conform.read import supplied

    if model not in MODELS:
        raise UserError(f"--model {model}: the models are {', '.join(MODELS)}")
    if target and model != DEFAULT_MODEL.name:
        raise UserError("--model is that of a virtual card; a card with a HOST has its own")
    if target is None and (moving or setting):
        raise UserError("--moving and --setting are for a card with a HOST; a virtual one runs all")
    permission = Permission(None if moving is None else _axis_of(moving), setting)
    _check_output(report)
    found = chosen(cases or supplied(), areas or [])
    identity = None
    if target is None:
        with _without_warnings():
            outcomes = _watched(on_virtual_card(found, model), len(found))
    else:
        with _asked(target, found, permission, baud, silence) as (identity, running):
            outcomes = _watched(running, len(found))
    record = _record(outcomes, identity, model)
    if report is not None:
        _write(report, record)
    if as_json:
        typer.echo(json.dumps(record, indent=1, ensure_ascii=False))
    else:
        _show(outcomes, record["card"])
    if any(each.result == "differs" for each in outcomes):
        raise typer.Exit(FAILED)


@contextmanager
def _without_warnings() -> Iterator[None]:
    """Cases provoke what a card warns of."""
    logger = logging.getLogger("openacr")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)


def _axis_of(text: str) -> int:
    """The number of an axis; UserError for anything else."""
    digits = text.upper().removeprefix("AXIS")
    if not digits.isdecimal() or int(digits) >= MOST_AXES:
        raise UserError(f"--moving {text}: expected AXIS0 to AXIS{MOST_AXES - 1}")
    return int(digits)


@contextmanager
def _asked(
    target: str, cases: "list[Case]", permission: "Permission", baud: int, silence_s: float
) -> "Iterator[tuple[Identity, Iterator[Outcome]]]":
    """The outcomes of a card that others use; UserError if something runs there.

    What cases set is read before, and put back afterwards, whatever happens.
    """
    from openacr.client.errors import ClientError
    from openacr.client.identity import identify
    from openacr.client.links import link_to
    from openacr.client.options import Options
    from openacr.conform.asking import bar
    from openacr.conform.campaign import on_card_in_use
    from openacr.conform.form import DifferenceError
    from openacr.conform.host import HostCard, occupation

    identity = identify(target, Options(timeout_s=silence_s), baud=baud)
    with connected(target, baud, silence_s) as card:
        if busy := occupation(card):
            raise UserError(f"{target}: {busy}: stop it first, then ask the card")
        allowed = [each for each in cases if not bar(each, permission)]
        before = _read(card, _changed(allowed, permission.axis))
    if permission.axis is not None:
        _confirm(target, permission.axis, [each for each in allowed if each.moves])
    link = link_to(target, baud)
    try:
        link.open()
        yield identity, on_card_in_use(cases, HostCard(link), identity.model, permission)
    except ClientError as lost:
        raise UserError(f"{target}: {lost}") from None
    except DifferenceError as late:
        raise UserError(f"{target}: the axis did not come to rest: {late}") from None
    finally:
        link.close()
        _put_back(target, before, baud, silence_s)


def _changed(cases: "list[Case]", axis: int | None) -> list[str]:
    """What cases set on a card, for those that move on this axis."""
    from openacr.conform.moving import changed, of_axis

    names = changed(cases)
    return names if axis is None else [of_axis(name, axis) for name in names]


def _read(card: "Card", names: list[str]) -> dict[str, float]:
    """The values of parameters and flags."""
    return {
        name: card.read(int(name[1:])) if name[0] == "P" else card.read_bit(int(name[3:]))
        for name in names
    }


def _put_back(target: str, before: dict[str, float], baud: int, silence_s: float) -> None:
    """Set what cases have set to what it was; UserError with the values that could not be."""
    if not before:
        return
    try:
        with connected(target, baud, silence_s) as card:
            for name, value in before.items():
                if name[0] == "P":
                    card.write(int(name[1:]), value)
                else:
                    card.write_bit(int(name[3:]), bool(value))
    except UserError as lost:
        values = ", ".join(f"{name}={value:.9g}" for name, value in before.items())
        raise UserError(f"{lost}; not put back: {values}") from None


def _confirm(target: str, axis: int, cases: "list[Case]") -> None:
    """Ask once whether an axis may move; UserError if there is nothing to ask for."""
    from openacr.conform.moving import reach_of

    if not cases:
        raise UserError(f"--moving AXIS{axis}: none of the cases moves an axis")
    travel_u, speed_ups = reach_of(cases)
    typer.confirm(
        f"{counted(len(cases), 'case')} will jog AXIS{axis} of {target}: up to {travel_u:g} units"
        f" to either side of where it is, at up to {speed_ups:g} units/s. Ctrl-C kills its motion."
        " Is it free to move?",
        abort=True,
        err=True,
    )


def _watched(running: "Iterator[Outcome]", total: int) -> "list[Outcome]":
    """The outcomes of a run, with a bar meanwhile."""
    found = []
    with progress_bar("cases") as progress:
        for outcome in running:
            found.append(outcome)
            progress(len(found), total)
    return found


def _record(outcomes: "list[Outcome]", identity: "Identity | None", model: str) -> dict[str, Any]:
    """What was asked of which card, and what it answered, as JSON data."""
    from openacr.conform.campaign import RESULTS

    card: dict[str, Any] = {"kind": "virtual", "model": model}
    if identity is not None:
        card = {
            "kind": "in use",
            "address": identity.address,
            "model": identity.model or None,
            "version": identity.version,
        }
    counts = Counter(each.result for each in outcomes)
    return {
        "openacr": version("openacr"),
        "card": card,
        "counts": {result: counts[result] for result in RESULTS},
        "cases": [each.data() for each in outcomes],
    }


def _check_output(report: Path | None) -> None:
    from openacr.cli.run import output

    if report is not None:
        if report.suffix.lower() != ".json":
            raise UserError(f"{report}: its name has to end in .json")
        output.require_writable(report)


def _write(report: Path, record: dict[str, Any]) -> None:
    from openacr.cli.run.output import write_whole

    text = json.dumps(record, indent=1, ensure_ascii=False) + "\n"
    write_whole(report, lambda partial: _put(partial, text))


def _put(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def _show(outcomes: "list[Outcome]", card: dict[str, Any]) -> None:
    """A line for each section, what differs, and the sum."""
    from openacr.conform.campaign import RESULTS

    sections: dict[str, Counter[str]] = {}
    for each in outcomes:
        sections.setdefault(each.section, Counter())[each.result] += 1
    width = max(map(len, sections))
    typer.echo(f"{'section':<{width}}  {'  '.join(RESULTS)}")
    for name, counts in sections.items():
        cells = (f"{counts[result] or '-':>{len(result)}}" for result in RESULTS)
        typer.echo(f"{name:<{width}}  {'  '.join(cells)}")
    _show_differences(outcomes)
    count = Counter(each.result for each in outcomes)
    name = card.get("version") or f"virtual {card['model']}"
    typer.echo(
        f"{name}: {counted(len(outcomes), 'case')}, {count['agrees']} agree,"
        f" {count['differs']} differ, {count['not run']} not run,"
        f" {count['not for this model']} not for this model"
    )


def _show_differences(outcomes: "list[Outcome]") -> None:
    from openacr.conform.run import report

    different = [each for each in outcomes if each.difference]
    for each in different[:MOST_SHOWN]:
        if each.difference:
            text = f"{report(each.case, each.difference)}\n  rests on: {each.case.rests}"
            typer.secho(f"{text} ({each.case.source})", fg=typer.colors.RED, err=True)
    if len(different) > MOST_SHOWN:
        typer.echo(f"and {len(different) - MOST_SHOWN} more: --report FILE has them all", err=True)
