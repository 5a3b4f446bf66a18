"""`openacr monitor`: parameters, flags and axes of a card, live."""

import json
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.conversions import given_quantity
from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence, Target, connected
from openacr.errors import UserError

if TYPE_CHECKING:
    from rich.table import Table

    from openacr.client import Card
    from openacr.client.values import Number

AXES = 16
_SCALE = "ppu"


def monitor(
    target: Target,
    items: Annotated[
        list[str] | None,
        typer.Argument(help='P12288, BIT516 or names such as "axis0.actual position".'),
    ] = None,
    axis: Annotated[list[int] | None, typer.Option(min=0, max=AXES - 1, help="An axis.")] = None,
    every: Annotated[float, typer.Option(min=0.0, help="Time between samples [s].")] = 0.2,
    duration_text: Annotated[
        str | None, typer.Option("--for", metavar="TIME", help="End after this time: 5, 10min.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object per sample.")] = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Show parameters, flags and axes of a card, live.

    Without items and axes all axes that are on are shown. Positions of axes are in units.
    """
    duration = given_quantity("--for", duration_text, "s") if duration_text is not None else None
    if duration is not None and not 0.0 <= duration < float("inf"):
        raise UserError(f"--for {duration:g}: give a number of seconds, 0 for one sample")
    with connected(target, baud, silence) as card:
        axes = axis or []
        if not items and not axes:
            axes = axes_on(card)
        samples = _samples(card, Sampler(card, items or [], axes), every, duration)
        if as_json:
            for sample in samples:
                sys.stdout.write(json.dumps(sample) + "\n")
                sys.stdout.flush()
        else:
            _show(samples)


class Sampler:
    """Reads the chosen things, all parameters and all flags together."""

    def __init__(self, card: "Card", items: list[str], axes: list[int]) -> None:
        from openacr.client.panels import AXES

        self.card = card
        self.axes = axes
        self.parameters: dict[str, int] = {}
        self.flags: dict[str, int] = {}
        for item in items:
            self._add(item)
        for axis in axes:
            for name in (*(row.name for row in AXES.columns), _SCALE):
                self._add(f"axis{axis}.{name}")

    def _add(self, item: str) -> None:
        """A parameter if there is one of this name, else a flag."""
        from openacr.client.names import named
        from openacr.map import Flag

        found = named(item)
        chosen = self.flags if isinstance(found, Flag) else self.parameters
        chosen[item] = found.number

    def sample(self) -> dict[str, object]:
        """The present values by name; an axis is a table of its own."""
        numbers = dict(zip(self.parameters, self._numbers(), strict=True))
        flags = dict(zip(self.flags, self.card.read_bits(self.flags.values()), strict=True))
        found: dict[str, object] = {**numbers, **flags}
        axes = {f"axis{axis}": self._axis(axis, found) for axis in self.axes}
        return {**found, **axes}

    def _numbers(self) -> "list[Number]":
        return self.card.read_many(self.parameters.values())

    def _axis(self, axis: int, found: dict[str, object]) -> dict[str, object]:
        """Take the values of one axis out of all, positions in units."""
        from openacr.client.panels import AXES

        scale = float(str(found.pop(f"axis{axis}.{_SCALE}"))) or 1.0
        values = {row.column: found.pop(f"axis{axis}.{row.name}") for row in AXES.columns}
        return {
            name: value if isinstance(value, bool) else float(str(value)) / scale
            for name, value in values.items()
        }


def axes_on(card: "Card") -> list[int]:
    """The axes that are on; the card refuses to tell about axes it does not have."""
    from openacr.client import RefusedError

    found = []
    for axis in range(AXES):
        try:
            if card.command(f"AXIS{axis}") == ["ON"]:
                found.append(axis)
        except RefusedError:
            break
    return found


def _samples(
    card: "Card", sampler: Sampler, every_s: float, duration_s: float | None
) -> Iterator[dict[str, object]]:
    """One sample after the other, the first at once, until time is up."""
    begin_s = card.now_s()
    number = 0
    while True:
        now_s = card.now_s() - begin_s
        yield {"time_s": round(now_s, 3), **sampler.sample()}
        number += 1
        if duration_s is not None and max(number * every_s, now_s) > duration_s:
            return
        card.pause(number * every_s - (card.now_s() - begin_s))


def _show(samples: Iterator[dict[str, object]]) -> None:
    from rich.live import Live

    with Live(auto_refresh=False) as live:
        for sample in samples:
            live.update(_table(sample), refresh=True)
    if not live.console.is_terminal:
        live.console.line()  # on a terminal the display ends its last line itself


def _table(sample: dict[str, object]) -> "Table":
    """Axes side by side with their values, other items below each other."""
    from rich.table import Table

    from openacr.client.panels import AXES

    columns = [row.column for row in AXES.columns]
    axes = {name: value for name, value in sample.items() if isinstance(value, dict)}
    table = Table(box=None)
    table.add_column(f"{sample['time_s']} s")
    for name in columns if axes else ("value",):
        table.add_column(name.replace("_", " "), justify="right")
    for name, values in axes.items():
        table.add_row(name, *(_text(values[column]) for column in columns))
    for name, value in sample.items():
        if name != "time_s" and name not in axes:
            table.add_row(name, _text(value))
    return table


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
