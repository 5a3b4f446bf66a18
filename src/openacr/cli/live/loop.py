"""`openacr loop`: the servo loop of the axes of a card, from their offsets to their outputs."""

import json
from typing import TYPE_CHECKING, Annotated

import typer
from msgspec import Struct, to_builtins

from openacr.cli.live.monitor import AXES, axes_on
from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence, Target, connected
from openacr.cli.live.silence import why_silent
from openacr.map.rows import axes

if TYPE_CHECKING:
    from openacr.client import Card

# Names shown, in the order in which the signals flow, and their rows.
PATH = {
    "current position": axes.current_position,
    "gear offset": axes.gear_offset,
    "jog offset": axes.jog_offset,
    "cam offset": axes.cam_offset,
    "primary setpoint": axes.primary_setpoint,
    "ballscrew offset": axes.ballscrew_offset,
    "backlash offset": axes.backlash_offset,
    "secondary setpoint": axes.secondary_setpoint,
    "actual position": axes.actual_position,
    "following error": axes.following_error,
}
GAINS = {
    "PGAIN": axes.proportional_gain,
    "IGAIN": axes.integral_gain,
    "ILIMIT": axes.integral_limit,
    "IDELAY": axes.integral_delay,
    "DGAIN": axes.derivative_gain,
    "DWIDTH": axes.derivative_width,
    "FFVEL": axes.feedforward_velocity,
    "FFACC": axes.feedforward_accel,
    "FBVEL": axes.fbvel_gain_setting,
}
OUTPUT = {
    "summation point": axes.summation_point,
    "filter output": axes.filter_output_signal,
    "output signal": axes.output_signal,
}
ROWS = PATH | GAINS | OUTPUT
NAMES = (*PATH, *GAINS, *(f"{name} [V]" for name in OUTPUT))
LABELS = max(map(len, NAMES))
GAP = 2


class Loop(Struct, frozen=True):
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
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Show offsets, setpoints, gains and outputs of the servo loops of a card.

    The primary setpoint is position plus gear, jog and cam offsets; ballscrew and backlash
    make the secondary one of it, which the loop follows. Without --axis all that are on.
    """
    with connected(target, baud, silence) as card:
        found = [read_loop(card, number) for number in axis or axes_on(card)]
    if as_json:
        typer.echo(json.dumps([to_builtins(one) for one in found]))
        return
    from rich.console import Console

    console = Console()
    for line in lines_of(found, console.width):
        typer.echo(line)


def read_loop(card: "Card", axis: int) -> Loop:
    """Ask the card for one axis, all values of the path of one moment."""
    values = dict(zip(ROWS, card.read_many([row[axis] for row in ROWS.values()]), strict=True))
    return Loop(
        axis,
        {name: int(values[name]) for name in PATH},
        {name: float(values[name]) for name in GAINS},
        {name: float(values[name]) for name in OUTPUT},
        why_silent(card, axis),
    )


def lines_of(found: list[Loop], width: int) -> list[str]:
    """Axes side by side, as many as the terminal has room for; signals in their order."""
    columns = [_column(one) for one in found]
    widths = [max(map(len, column)) + GAP for column in columns]
    lines: list[str] = []
    first = 0
    while first < len(columns):
        stop = first + 1
        while stop < len(columns) and LABELS + sum(widths[first : stop + 1]) <= width:
            stop += 1
        for row, name in enumerate(("", *NAMES)):
            cells = zip(columns[first:stop], widths[first:stop], strict=True)
            shown = "".join(f"{column[row]:>{room}}" for column, room in cells)
            lines.append(f"{name:<{LABELS}}{shown}")
        lines.append("")
        first = stop
    lines += [f"axis {one.axis} has no output: {one.no_output}" for one in found if one.no_output]
    return lines


def _column(one: Loop) -> list[str]:
    """What is shown of an axis, from its title down."""
    return [
        f"axis {one.axis}",
        *(str(value) for value in one.path_cnt.values()),
        *(f"{value:.6g}" for value in one.gains.values()),
        *(f"{value:.4f}" for value in one.output_v.values()),
    ]
