"""`openacr probe`: what a card is, and what of this software works with it."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated, Any

import typer
from msgspec import Struct, to_builtins

from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence, Target
from openacr.cli.printing import print_json
from openacr.models import Feature

if TYPE_CHECKING:
    from openacr.client.identity import Identity
    from openacr.models import Model


class Verdict(Struct, frozen=True):
    """One part of this software, and whether it works with a card."""

    what: str
    works: bool | None  # None: unknown, as the model is not in the table
    why: str


def probe(
    target: Target,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Show model, firmware and options of a card, and what of this software works with it.

    Only queries are sent: nothing changes on the card.
    """
    from openacr.client.identity import identify
    from openacr.client.options import Options

    found = identify(target, Options(timeout_s=silence), baud=baud)
    verdicts = list(judged(found))
    if as_json:
        print_json(_record(found, verdicts))
        return
    for line in _lines(found, verdicts):
        typer.echo(line)


def judged(found: "Identity") -> Iterator[Verdict]:
    """What works, from the answers, the model table and the firmware each part needs."""
    from openacr.configure.answers import CARD_LIMITS_SINCE
    from openacr.mill.card.checks import OLDEST_FIRMWARE

    oldest = (OLDEST_FIRMWARE // 10000, OLDEST_FIRMWARE // 100 % 100, OLDEST_FIRMWARE % 100)
    yield Verdict("term, download, upload, backup, restore", True, "they need the terminal alone")
    yield Verdict(
        "monitor and the client at full rate",
        found.has_packets,
        "packets are answered" if found.has_packets else "packets are not answered; text is used",
    )
    is_new = found.firmware >= oldest
    yield Verdict(
        "part programs on the card (mill --host, panel)",
        is_new and found.has_packets,
        f"needs packets and firmware {_dotted(oldest)}",
    )
    yield Verdict(
        "limits watched by the card (configure)",
        found.firmware >= CARD_LIMITS_SINCE,
        f"needs firmware {_dotted(CARD_LIMITS_SINCE)}; for older ones configure writes limit code",
    )
    for what, has in _OF_MODELS:
        model = found.hardware
        yield Verdict(what, None if model is None else has(model), "by the model table")
    yield Verdict(
        "the same card, virtual (run, serve)",
        found.hardware is not None,
        "models of the table can be simulated",
    )


_OF_MODELS: "tuple[tuple[str, Callable[[Model], bool]], ...]" = (
    ("NURBs", lambda model: Feature.NURBS not in model.lacks),
    ("look-ahead", lambda model: Feature.LOOK_AHEAD not in model.lacks),
    ("CANopen nodes", lambda model: model.has_canopen),
    ("memory kept by a battery", lambda model: model.has_battery),
)


def _dotted(version: tuple[int, ...]) -> str:
    return ".".join(f"{part:02d}" if place > 1 else str(part) for place, part in enumerate(version))


def _record(found: "Identity", verdicts: list[Verdict]) -> dict[str, Any]:
    model = found.hardware
    return {
        "address": found.address,
        "version": found.version,
        "model": found.model or None,
        "is_known": model is not None,
        "firmware": found.firmware_text or _dotted(found.firmware),
        "update": found.update,
        "serial_number": found.serial_number,
        "diagnostics": found.diagnostics,
        "has_packets": found.has_packets,
        "axes": None if model is None else model.connected_axes,
        "masters": None if model is None else model.masters,
        "options": found.options,
        "works": [to_builtins(verdict) for verdict in verdicts],
    }


def _lines(found: "Identity", verdicts: list[Verdict]) -> Iterator[str]:
    model = found.hardware
    yield f"card          {found.version}"
    yield f"address       {found.address}"
    yield f"serial        {found.serial_number}"
    yield f"diagnostics   {'no failure' if not found.diagnostics else f'0x{found.diagnostics:X}'}"
    if model is None:
        yield f"model         {found.model or 'unknown'}: not in the table of this software"
    else:
        yield f"model         {model.connected_axes} axes, {model.masters} masters"
    for query, answer in found.options.items():
        for place, line in enumerate(answer or ["-"]):
            yield f"{query if not place else '':<14}{line}"
    yield ""
    words = {True: "yes", False: "no", None: "unknown"}
    width = max(len(verdict.what) for verdict in verdicts)
    for verdict in verdicts:
        yield f"{words[verdict.works]:<9}{verdict.what:<{width}}  {verdict.why}"
