"""Commands of MDI and TEACH."""

from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.manual.teaching import teach
from openacr.panel.commands.motion import indices
from openacr.panel.commands.registry import Args, command
from openacr.panel.control.orders import Order
from openacr.panel.control.station import Station
from openacr.panel.roles import Role

Line = Annotated[str, Meta(max_length=256)]
Lines = Annotated[tuple[Line, ...], Meta(max_length=10_000)]


class Typed(Args, frozen=True):
    """One block, or several that run one after the other; `kept`: the text of MDI has them."""

    line: Line = ""
    lines: Lines = ()
    kept: bool = False


class Buffer(Args, frozen=True):
    """The text of MDI, without lines as it is; `on`: what is executed becomes part of it."""

    lines: Lines | None = None
    on: bool | None = None


class Taught(Args, frozen=True):
    """A work system and the axes that read 0 in it from now on."""

    system: str
    axes: str = ""


@command("mdi.execute", is_motion=True)
def execute(station: Station, order: Order, args: Typed) -> None:
    """EXECUTE: run blocks that were typed."""
    blocks = [line for line in (args.line, *args.lines) if line.strip()]
    if not blocks:
        raise UserError("no block was typed")
    station.typed.put(blocks, is_shown=not args.kept)


@command("mdi.buffer", needs_control=False)
def buffer(station: Station, order: Order, args: Buffer) -> dict[str, object]:
    """Read the text of MDI, or replace it, or switch its buffer."""
    if args.lines is not None:
        station.typed.text = list(args.lines)
    if args.on is not None:
        station.typed.is_buffer_on = args.on
    return {"lines": list(station.typed.text), "on": station.typed.is_buffer_on}


@command("teach.work", Role.SETUP)
def teach_work(station: Station, order: Order, args: Taught) -> None:
    """TEACH: where the machine is becomes the zero of a work system."""
    session = station.link.machine
    session.runner.alarms.require_none()
    if station.interlocks.is_moved:
        raise UserError("the machine is moving: a work system can be taught only at rest")
    here = session.runner.stream.host.position()
    teach(session.cells, session.runner.settings, args.system, here, indices(station, args.axes))
