"""`openacr bridge`: values of a card for the systems around it."""

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.signals import stop_on_signals

if TYPE_CHECKING:
    from openacr.bridge.publisher import Publisher


def bridge(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Bridge file (TOML).")],
    target: Annotated[
        str, typer.Argument(metavar="HOST[:PORT] | SERIAL", help="A card, virtual or real.")
    ] = "127.0.0.1",
) -> None:
    """Publish values of a card to the systems around it, as a bridge file says.

    The card is read beside other hosts. `openacr panel --bridge FILE` publishes what the CNC side
    knows as well: program, overrides, spindle, alarms. Ctrl-C ends it.
    """
    from openacr.bridge.card_feed import CardFeed
    from openacr.bridge.load import load_bridge
    from openacr.bridge.systems import bridge_of
    from openacr.client.links import wire_to

    settings = load_bridge(file)
    wire_to(target)  # what is no address is refused before anything is opened
    made = bridge_of(settings, file.parent, CardFeed(target, settings.card))
    try:
        begin(made)
        asyncio.run(_until_signalled())
    finally:
        made.stop()


def begin(made: "Publisher") -> None:
    """Start a bridge, and print where its systems are found."""
    made.start()
    for place in made.places:
        print(f"bridge {place}", flush=True)


async def _until_signalled() -> None:
    over = asyncio.Event()
    stop_on_signals(over.set)
    await over.wait()
