"""`openacr loop`: the servo loop of the axes of a card, from their offsets to their outputs."""

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.monitor import AXES, axes_on
from openacr.cli.online import Baud, Silence, Target, connected
from openacr.cli.silence import why_silent
from openacr.map import numbers as at

if TYPE_CHECKING:
    from rich.table import Table

    from openacr.client import Card

# Names shown, in the order in which the signals flow, and their rows in the block of an axis.
PATH = {
    "current position": at.AX_CURRENT_POSITION,
    "gear offset": at.AX_GEAR_OFFSET,
    "jog offset": at.AX_JOG_OFFSET,
    "cam offset": at.AX_CAM_OFFSET,
    "primary setpoint": at.AX_PRIMARY_SETPOINT,
    "ballscrew offset": at.AX_BALLSCREW_OFFSET,
    "backlash offset": at.AX_BACKLASH_OFFSET,
    "secondary setpoint": at.AX_SECONDARY_SETPOINT,
    "actual position": at.AX_ACTUAL_POSITION,
    "following error": at.AX_FOLLOWING_ERROR,
}
GAINS = {
    "PGAIN": at.AX_PROPORTIONAL_GAIN,
    "IGAIN": at.AX_INTEGRAL_GAIN,
    "ILIMIT": at.AX_INTEGRAL_LIMIT,
    "IDELAY": at.AX_INTEGRAL_DELAY,
    "DGAIN": at.AX_DERIVATIVE_GAIN,
    "DWIDTH": at.AX_DERIVATIVE_WIDTH,
    "FFVEL": at.AX_FEEDFORWARD_VELOCITY,
    "FFACC": at.AX_FEEDFORWARD_ACCEL,
    "FBVEL": at.AX_FBVEL_GAIN_SETTING,
}
OUTPUT = {
    "summation point": at.AX_SUMMATION_POINT,
    "filter output": at.AX_FILTER_OUTPUT_SIGNAL,
    "output signal": at.AX_OUTPUT_SIGNAL,
}
ROWS = PATH | GAINS | OUTPUT


@dataclass(frozen=True, slots=True)
class Loop:
    """One axis: what is asked of it [pulses], its gains, and what it puts out [V]."""

    axis: int
    path_cnt: dict[str, int]
    gains: dict[str, float]
    output_v: dict[str, float]
    no_output: str  # why, empty while nothing cuts the output


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
    """Ask the card for one axis, all values of the path of one moment."""
    first = at.AX_BASE + at.AX_STRIDE * axis
    values = dict(zip(ROWS, card.read_many([first + row for row in ROWS.values()]), strict=True))
    return Loop(
        axis,
        {name: int(values[name]) for name in PATH},
        {name: float(values[name]) for name in GAINS},
        {name: float(values[name]) for name in OUTPUT},
        why_silent(card, axis),
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
    if any(one.no_output for one in found):
        table.add_row("no output", *(one.no_output for one in found))
    return table
