"""Commands of the connection itself: keep-alives of held keys, subscriptions of values."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.map import numbers as n
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.on_card import OnCard
from openacr.panel.control.engineer.watches import INPUTS, Watches, Wish, watched
from openacr.panel.control.engineer.world import WorldPane
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.orders import Order, PanelError
from openacr.panel.control.operator.presses import Key
from openacr.panel.roles import Role

WORDS = range(n.FLAG_WORD_BASE, 8192)
MOST_STATES_HZ = 10.0  # all states of the programs are read at once


@command("jog.keep", needs_control=False)
def keep(order: Order, client: int, hand_motion: HandMotion, *, press: int, tick: float) -> None:
    """Keep a held key alive; it never begins motion. `tick`: the newest that was drawn."""
    hand_motion.keep(Key(client, press), tick, order.received_s)


@command("watch.begin", Role.VIEW, needs_control=False)
def begin(
    client: int,
    on_card: OnCard,
    world: WorldPane,
    watches: Watches,
    *,
    topic: Literal["flags", "watch", "programs", "world"],
    hz: Annotated[float, Meta(ge=0.1, le=60.0)] = 10.0,
    parameters: tuple[int | str, ...] = (),
    words: tuple[int, ...] = (),
    inputs: bool = False,
) -> dict[str, object]:
    """Watch parameters, flag words, the world (frames) or the programs (events `programs`)."""
    if topic == "programs":
        on_card.programs.watchers.watch(client, min(hz, MOST_STATES_HZ))
        return {"topic": topic, "hz": min(hz, MOST_STATES_HZ)}
    if topic == "world":
        world.watchers.watch(client, hz)
        return {"topic": topic, "hz": hz}
    if topic == "flags":
        chosen = [*words, *(INPUTS if inputs else ())]
        for word in chosen:
            if word not in WORDS:
                raise PanelError("bad", f"P{word} is no flag word: {WORDS[0]} to {WORDS[-1]} are")
    else:
        chosen = watched(parameters)
    if not chosen:
        raise PanelError("bad", f"{topic}: nothing to watch was named")
    watches.begin(Wish(client, topic), chosen, hz)
    return {"topic": topic, "hz": hz, "parameters": chosen}


@command("watch.end", Role.VIEW, needs_control=False)
def end(
    client: int,
    on_card: OnCard,
    world: WorldPane,
    watches: Watches,
    *,
    topic: Literal["flags", "watch", "programs", "world"],
) -> None:
    """Watch a topic no more."""
    if topic == "programs":
        on_card.programs.watchers.forget(client)
        return
    if topic == "world":
        world.watchers.forget(client)
        return
    watches.end(Wish(client, topic))
