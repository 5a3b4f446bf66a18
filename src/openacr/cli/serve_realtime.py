"""A served card on the wall clock: its loop, and the line that says how it keeps time."""

import asyncio
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.controller.realtime_card import RealtimeCard

LINE_S = 1.0


def agreed_realtime(
    *, is_on: bool, core: int | None, silence_s: float | None, speed: float, has_bus: bool
) -> None:
    """UserError for options that do not go together."""
    if not is_on:
        if core is not None or silence_s is not None:
            raise UserError("--core and --silence are for --realtime")
        return
    if speed != 1.0:
        raise UserError(f"--speed {speed:g}: a card with --realtime runs in real time, 1.0")
    if has_bus:
        raise UserError(
            "--realtime: the bus of machine.toml is not exchanged in the real-time loop yet"
            " (without --realtime it is served, with --bus none all is modelled)"
        )


class ServedInRealTime:
    """The real-time loop of a served card."""

    def __init__(self, card: "Controller", core: int | None, silence_s: float | None) -> None:
        from openacr.controller.realtime_card import SILENCE_S
        from openacr.io.realtime_rights import RealtimeRights

        self._rights = RealtimeRights(core)
        silence_s = SILENCE_S if silence_s is None else silence_s
        self.card: RealtimeCard = card.real_time(silence_s)

    def begin(self) -> None:
        """Let the loop live, and say what it lacks; on a terminal a line follows it."""
        self.card.start(self._rights.take)
        for sentence in self._rights.missing:
            typer.secho(f"warning: {sentence}", fg=typer.colors.YELLOW, err=True)
        if sys.stderr.isatty():
            self._line = asyncio.get_running_loop().create_task(self._follow())

    async def _follow(self) -> None:
        while True:
            await asyncio.sleep(LINE_S)
            typer.echo(f"\r\x1b[K{self.card.figures()}", nl=False, err=True)

    def close(self) -> None:
        """Bring all axes to rest, end the loop and say how it has kept time."""
        self.card.close()
        self._rights.give_back()
        start = "\r\x1b[K" if sys.stderr.isatty() else ""
        typer.echo(f"{start}real time: {self.card.figures()}", err=True)


@contextmanager
def in_real_time(
    card: "Controller", core: int | None, silence_s: float | None
) -> Iterator[ServedInRealTime]:
    """A served card in real time; it is brought to rest at the end, whatever has happened."""
    served = ServedInRealTime(card, core, silence_s)
    try:
        yield served
    finally:
        served.close()
