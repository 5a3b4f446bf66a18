"""A served card on the wall clock: its loop, and the line that says how it keeps time."""

import asyncio
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import typer

from openacr.cli.bus_report import Reporting
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


def not_in_real_time(world: "World | None", bus: str | None) -> str:
    """Why the real-time loop does not serve a machine; "" if it does."""
    if EMULATED in (bus, world and world.bus and world.bus.interface):
        return f"the devices of --bus {EMULATED} live in the time of the card"
    if world is None:
        return ""
    if world.canopen is not None and world.canopen.interface is not None:
        return "real CANopen nodes are worked on by Python"
    if any(drive.serial for drive in world.drive):
        return "drives on serial ports are worked on by Python"
    return ""


def missing_for_real_time(world: "World", bus: str | None) -> str:
    """Why a machine is not served in real time on this computer; "" if it can be."""
    from openacr.compiled import is_compiled
    from openacr.controller.realtime_card import SHORTEST_S

    if sys.platform != "linux" or not is_compiled:
        return "the loop needs Linux and the compiled core (docs/installation.md)"
    if world.card.period_s < SHORTEST_S:
        return f"the loop takes servo periods of {1e6 * SHORTEST_S:g} us and more"
    return not_in_real_time(world, bus)


@dataclass(frozen=True, slots=True)
class RealtimeOptions:
    """How a card lives in real time; without a world it has no bus."""

    core: int | None
    silence_s: float | None
    world: "World | None"
    interface: str
    is_real: bool
    is_reported: bool


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
        self._is_reported = options.is_reported
        self._reporting: Reporting | None = None
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
        if self._is_reported:
            self._reporting = Reporting(self.card)
        for sentence in self._rights.missing:
            typer.secho(f"warning: {sentence}", fg=typer.colors.YELLOW, err=True)
        if sys.stderr.isatty() and not self._is_reported:
            self._line = asyncio.get_running_loop().create_task(self._follow())

    async def _follow(self) -> None:
        while True:
            await asyncio.sleep(LINE_S)
            typer.echo(f"\r\x1b[K{self.card.figures()}", nl=False, err=True)

    def close(self) -> None:
        """Bring all axes to rest, end the loop and say how it has kept time."""
        if self._reporting is not None:
            self._reporting.end()
        self.card.close()
        self._rights.give_back()
        if self._bus is not None and self._link is not None:
            typer.echo(self._bus.ended(), err=True)
            self._link.close()
        start = "\r\x1b[K" if sys.stderr.isatty() and not self._is_reported else ""
        typer.echo(f"{start}real time: {self.card.figures()}", err=True)


@contextmanager
def in_real_time(card: "Controller", options: RealtimeOptions) -> Iterator[ServedInRealTime]:
    """A served card in real time; it is brought to rest at the end, whatever has happened."""
    served = ServedInRealTime(card, options)
    try:
        yield served
    finally:
        served.close()
