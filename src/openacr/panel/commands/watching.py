"""Commands of the connection itself: keep-alives of held keys, subscriptions of values."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.map import numbers as n
from openacr.panel.commands.registry import Args, command
from openacr.panel.control.orders import Order, PanelError
from openacr.panel.control.presses import Key
from openacr.panel.control.station import Station
from openacr.panel.control.watches import INPUTS, Wish, watched
from openacr.panel.roles import Role

WORDS = range(n.FLAG_WORD_BASE, 8192)
MOST_STATES_HZ = 10.0  # all states of the programs are read at once


class Keep(Args, frozen=True):
    """A sign of a held key, with the newest tick its browser has drawn."""

    press: int
    tick: float


class Watched(Args, frozen=True):
    """What is watched: parameters, flag words, the programs of the card, or the world."""

    topic: Literal["flags", "watch", "programs", "world"]
    hz: Annotated[float, Meta(ge=0.1, le=60.0)] = 10.0
    parameters: tuple[int | str, ...] = ()
    words: tuple[int, ...] = ()
    inputs: bool = False


class Unwatched(Args, frozen=True):
    """A topic that is watched no more."""

    topic: Literal["flags", "watch", "programs", "world"]


@command("jog.keep", needs_control=False)
def keep(station: Station, order: Order, args: Keep) -> None:
    """Keep a held key alive; it never begins motion."""
    station.hand_motion.keep(Key(order.person.client, args.press), args.tick, order.received_s)


@command("watch.begin", Role.VIEW, needs_control=False)
def begin(station: Station, order: Order, args: Watched) -> dict[str, object]:
    """Watch parameters, flag words, the world (frames) or the programs (events `programs`)."""
    if args.topic == "programs":
        station.on_card.programs.watch(order.person.client, min(args.hz, MOST_STATES_HZ))
        return {"topic": args.topic, "hz": min(args.hz, MOST_STATES_HZ)}
    if args.topic == "world":
        station.world.watch(order.person.client, args.hz)
        return {"topic": args.topic, "hz": args.hz}
    if args.topic == "flags":
        chosen = [*args.words, *(INPUTS if args.inputs else ())]
        for word in chosen:
            if word not in WORDS:
                raise PanelError("bad", f"P{word} is no flag word: {WORDS[0]} to {WORDS[-1]} are")
    else:
        chosen = watched(args.parameters)
    if not chosen:
        raise PanelError("bad", f"{args.topic}: nothing to watch was named")
    station.watches.begin(Wish(order.person.client, args.topic), chosen, args.hz)
    return {"topic": args.topic, "hz": args.hz, "parameters": chosen}


@command("watch.end", Role.VIEW, needs_control=False)
def end(station: Station, order: Order, args: Unwatched) -> None:
    """Watch a topic no more."""
    if args.topic == "programs":
        station.on_card.programs.forget(order.person.client)
        return
    if args.topic == "world":
        station.world.forget(order.person.client)
        return
    station.watches.end(Wish(order.person.client, args.topic))
