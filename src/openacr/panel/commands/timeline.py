"""Commands of the timeline: the time of a virtual card still, fast or slow, back, in branches."""

import math
from typing import Annotated, Literal

from msgspec import Meta

from openacr.panel.commands.registry import command
from openacr.panel.control.times import Times
from openacr.panel.roles import Role
from openacr.timeline import Kind

Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]
Number = Annotated[int, Meta(ge=0, lt=1 << 31)]
Text = Annotated[str, Meta(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]*$")]


@command("timeline.pause", Role.SERVICE)
def pause(times: Times) -> None:
    """Let no more time of the card pass."""
    times.pause()


@command("timeline.run", Role.SERVICE, is_motion=True)
def run(times: Times, now_s: float, *, speed: float | None = 1.0) -> None:
    """Let time pass, 0.01 to 100 times as fast as real, or as fast as it goes."""
    times.run(math.inf if speed is None else speed, now_s)


@command("timeline.step", Role.SERVICE, is_motion=True)
def step(
    times: Times,
    *,
    what: Literal["tick", "back", "line", "move"] = "tick",
    number: Annotated[int, Meta(ge=0, le=15)] = 0,
) -> None:
    """Go on by one tick, one line of a program or one move of a master, or a tick back."""
    times.step(what, number)


@command("timeline.seek", Role.SERVICE)
def seek(times: Times, *, tick: Tick) -> dict[str, int]:
    """Show the card at a tick of the present branch; the panel leaves it before."""
    times.seek(tick)
    return {"tick": tick}


@command("timeline.branch", Role.SERVICE)
def branch(times: Times) -> dict[str, int]:
    """Begin another branch at the present moment; what followed stays on the one before."""
    return {"number": times.branch()}


@command("timeline.switch", Role.SERVICE)
def switch(times: Times, *, number: Number, tick: Tick | None = None) -> None:
    """Change to another branch, to a tick of it or its end."""
    times.switch(number, tick)


@command("timeline.name", Role.SERVICE)
def name(times: Times, *, number: Number, name: Text) -> None:
    """Name a branch."""
    history = times.history
    history.names[history.timeline.branches.named(number).number] = name.strip()


@command("timeline.forget", Role.SERVICE)
def forget(times: Times, *, number: Number) -> None:
    """Forget a branch that is not the present one."""
    times.history.forget(number)


@command("timeline.mark", Role.SERVICE)
def mark(times: Times, *, text: Text) -> dict[str, int]:
    """Set a bookmark at the present tick."""
    history = times.history
    history.mark(Kind.HAND, text.strip())
    return {"tick": history.lived_tk}


@command("timeline.unmark", Role.SERVICE)
def unmark(times: Times, *, tick: Tick) -> None:
    """Remove the bookmarks of a tick of the present branch."""
    history = times.history
    history.bookmarks.remove(history.timeline.branch.number, tick)


@command("timeline.operate", Role.SERVICE)
def operate(times: Times, now_s: float) -> dict[str, int]:
    """Operate the machine from the present moment on, in real time."""
    tick = times.history.lived_tk
    times.operate(now_s)
    return {"tick": tick}
