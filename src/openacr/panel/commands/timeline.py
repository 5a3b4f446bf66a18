"""Commands of the timeline: the time of a virtual card still, fast or slow, back, in branches."""

import math
from typing import Annotated, Literal

from msgspec import Meta

from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.orders import Order
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.timeline import Kind

Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]
Number = Annotated[int, Meta(ge=0, lt=1 << 31)]
Text = Annotated[str, Meta(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]*$")]


class OfSpeed(Args, frozen=True):
    """How many times as fast as real; none: as fast as it goes."""

    speed: float | None = 1.0


class OfStep(Args, frozen=True):
    """A tick, a tick back, a line of a program, or a move of a master; `number` names it."""

    what: Literal["tick", "back", "line", "move"] = "tick"
    number: Annotated[int, Meta(ge=0, le=15)] = 0


class OfTick(Args, frozen=True):
    """A tick of the present branch."""

    tick: Tick


class OfBranch(Args, frozen=True):
    """A branch."""

    number: Number


class OfMoment(OfBranch, frozen=True, kw_only=True):
    """A tick of a branch; none: its end."""

    tick: Tick | None = None


class Named(OfBranch, frozen=True, kw_only=True):
    """A branch and its name."""

    name: Text


class Marked(Args, frozen=True):
    """The text of a bookmark."""

    text: Text


@command("timeline.pause", Role.SERVICE)
def pause(station: Station, order: Order, args: NoArgs) -> None:
    """Let no more time of the card pass."""
    station.times.pause()


@command("timeline.run", Role.SERVICE, is_motion=True)
def run(station: Station, order: Order, args: OfSpeed) -> None:
    """Let time pass, 0.01 to 100 times as fast as real, or as fast as it goes."""
    station.times.run(math.inf if args.speed is None else args.speed, station.now_s)


@command("timeline.step", Role.SERVICE, is_motion=True)
def step(station: Station, order: Order, args: OfStep) -> None:
    """Go on by one tick, one line of a program or one move of a master, or a tick back."""
    station.times.step(args.what, args.number)


@command("timeline.seek", Role.SERVICE)
def seek(station: Station, order: Order, args: OfTick) -> dict[str, int]:
    """Show the card at a tick of the present branch; the panel leaves it before."""
    station.times.seek(args.tick)
    return {"tick": args.tick}


@command("timeline.branch", Role.SERVICE)
def branch(station: Station, order: Order, args: NoArgs) -> dict[str, int]:
    """Begin another branch at the present moment; what followed stays on the one before."""
    return {"number": station.times.branch()}


@command("timeline.switch", Role.SERVICE)
def switch(station: Station, order: Order, args: OfMoment) -> None:
    """Change to another branch, to a tick of it or its end."""
    station.times.switch(args.number, args.tick)


@command("timeline.name", Role.SERVICE)
def name(station: Station, order: Order, args: Named) -> None:
    """Name a branch."""
    history = station.times.history
    history.names[history.timeline.branches.named(args.number).number] = args.name.strip()


@command("timeline.forget", Role.SERVICE)
def forget(station: Station, order: Order, args: OfBranch) -> None:
    """Forget a branch that is not the present one."""
    station.times.history.forget(args.number)


@command("timeline.mark", Role.SERVICE)
def mark(station: Station, order: Order, args: Marked) -> dict[str, int]:
    """Set a bookmark at the present tick."""
    history = station.times.history
    history.mark(Kind.HAND, args.text.strip())
    return {"tick": history.lived_tk}


@command("timeline.unmark", Role.SERVICE)
def unmark(station: Station, order: Order, args: OfTick) -> None:
    """Remove the bookmarks of a tick of the present branch."""
    history = station.times.history
    history.bookmarks.remove(history.timeline.branch.number, args.tick)


@command("timeline.operate", Role.SERVICE)
def operate(station: Station, order: Order, args: NoArgs) -> None:
    """Operate the machine from the present moment on, in real time."""
    station.times.operate(station.now_s)
