"""A served card on the wall clock: its loop, and the line that says how it keeps time."""

import asyncio
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import typer

from openacr.cli.serve_on_bus import EMULATED
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.controller.realtime_card import RealtimeCard
    from openacr.plant.describe.schema import World

LINE_S = 1.0


def agreed_realtime(
    *, is_on: bool, core: int | None, silence_s: float | None, speed: float
) -> None:
    """UserError for options that do not go together."""
    if not is_on:
        if core is not None or silence_s is not None:
            raise UserError("--core and --silence are for --realtime")
        return
    if speed != 1.0:
        raise UserError(f"--speed {speed:g}: a card with --realtime runs in real time, 1.0")


def served_in_real_time(world: "World | None", bus: str | None, *, is_reported: bool) -> None:
    """UserError for what the real-time loop does not serve."""
    if is_reported or EMULATED in (bus, world and world.bus and world.bus.interface):
        option = "--report-bus" if is_reported else f"--bus {EMULATED}"
        raise UserError(f"{option} is not there with --realtime")
    if world is None:
        return
    if world.canopen is not None and world.canopen.interface is not None:
        raise UserError("--realtime: real CANopen nodes are served without it only")
    if any(drive.serial for drive in world.drive):
        raise UserError("--realtime: drives on serial ports are served without it only")


@dataclass(frozen=True, slots=True)
class RealtimeOptions:
    """How a card lives in real time; without a world it has no bus."""

    core: int | None
    silence_s: float | None
    world: "World | None"
    interface: str
    is_real: bool


class ServedInRealTime:
    """The real-time loop of a served card."""

    def __init__(self, card: "Controller", options: RealtimeOptions) -> None:
        from openacr.controller.realtime_card import SILENCE_S
        from openacr.fieldbus.machine.realtime_bus import RealtimeBus
        from openacr.io.ethercat_link import RawLink
        from openacr.io.realtime_rights import RealtimeRights
        from openacr.plant.describe.real_world import real_world

        self._rights = RealtimeRights(options.core)
        self._bus: RealtimeBus | None = None
        self._link: RawLink | None = None
        if options.world is not None:
            self._link = RawLink(options.interface)
            world = real_world(options.world)
            self._bus = RealtimeBus(card.card, world, self._link, is_real=options.is_real)
        silence_s = SILENCE_S if options.silence_s is None else options.silence_s
        self.card: RealtimeCard = card.real_time(silence_s, self._bus)

    def begin(self) -> None:
        """Let the loop live, and say what it lacks; on a terminal a line follows it."""
        self.card.start(self._rights.take)
        if self._bus is not None:
            typer.echo(self._bus.began(), err=True)
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
        if self._bus is not None and self._link is not None:
            typer.echo(self._bus.ended(), err=True)
            self._link.close()
        start = "\r\x1b[K" if sys.stderr.isatty() else ""
        typer.echo(f"{start}real time: {self.card.figures()}", err=True)


@contextmanager
def in_real_time(card: "Controller", options: RealtimeOptions) -> Iterator[ServedInRealTime]:
    """A served card in real time; it is brought to rest at the end, whatever has happened."""
    served = ServedInRealTime(card, options)
    try:
        yield served
    finally:
        served.close()
