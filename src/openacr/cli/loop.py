"""`openacr loop`: the servo loop of the axes of a card, from their offsets to their outputs."""

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.monitor import AXES, axes_on
from openacr.cli.online import Baud, Silence, Target, connected

if TYPE_CHECKING:
    from rich.table import Table

    from openacr.client import Card

FIRST_PARAMETER, PARAMETERS_PER_AXIS = 12288, 256
PATH = (
    "current position", "gear offset", "jog offset", "cam offset", "primary setpoint",
    "ballscrew offset", "backlash offset", "secondary setpoint", "actual position",
    "following error",
)  # fmt: skip
GAINS = (
    "PGAIN", "IGAIN", "ILIMIT", "IDELAY", "DGAIN", "DWIDTH", "FFVEL", "FFACC", "FBVEL",
)  # fmt: skip
OUTPUT = ("summation point", "filter output", "output signal")
ROWS = dict(
    zip(
        (*PATH, *GAINS, *OUTPUT),
        (0, 8, 9, 10, 6, 11, 12, 7, 2, 3, 16, 17, 18, 19, 20, 21, 22, 23, 64, 29, 30, 31),
        strict=True,
    )
)


@dataclass(frozen=True, slots=True)
class Loop:
    """One axis: what is asked of it [pulses], its gains, and what it puts out [V]."""

    axis: int
    path_cnt: dict[str, int]
    gains: dict[str, float]
    output_v: dict[str, float]


def loop(
    target: Target,
    axis: Annotated[list[int] | None, typer.Option(min=0, max=AXES - 1, help="An axis.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    baud: Baud = 38400,
    silence: Silence = 5.0,
) -> None:
    """Show offsets, setpoints, gains and outputs of the servo loops of a card.

    The primary setpoint is position plus gear, jog and cam offsets; ballscrew and backlash
    make the secondary one of it, which the loop follows. Without --axis all that are on.
    """
    with connected(target, baud, silence) as card:
        found = [read_loop(card, number) for number in axis or axes_on(card)]
    if as_json:
        typer.echo(json.dumps([asdict(one) for one in found]))
        return
    from rich.console import Console

    Console().print(_table(found))


def read_loop(card: "Card", axis: int) -> Loop:
    """Ask the card for one axis, all values of one moment."""
    first = FIRST_PARAMETER + PARAMETERS_PER_AXIS * axis
    values = dict(zip(ROWS, card.read_many([first + row for row in ROWS.values()]), strict=True))
    return Loop(
        axis,
        {name: int(values[name]) for name in PATH},
        {name: float(values[name]) for name in GAINS},
        {name: float(values[name]) for name in OUTPUT},
    )


def _table(found: list[Loop]) -> "Table":
    """Axes side by side, signals in the order in which they flow."""
    from rich.table import Table

    table = Table(box=None)
    table.add_column("")
    for one in found:
        table.add_column(f"axis {one.axis}", justify="right")
    for name in PATH:
        table.add_row(name, *(str(one.path_cnt[name]) for one in found))
    for name in GAINS:
        table.add_row(name, *(f"{one.gains[name]:.6g}" for one in found))
    for name in OUTPUT:
        table.add_row(f"{name} [V]", *(f"{one.output_v[name]:.4f}" for one in found))
    return table
