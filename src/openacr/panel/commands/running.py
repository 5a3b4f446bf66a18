"""Commands of part programs: load, start, hold, retrace, answer; overrides and alarms."""

from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta, field

from openacr.errors import UserError
from openacr.mill.card.alarms import (
    DRIVE_FAULT,
    EMERGENCY_STOP,
    EXCESS_ERROR,
    HARDWARE_LIMIT,
    Alarm,
)
from openacr.mill.config.communications import Line
from openacr.mill.config.dialects import dialect_of
from openacr.mill.config.folders import folders_of
from openacr.mill.config.overrides import Override
from openacr.mill.run.dripping import Drip
from openacr.mill.run.lifecycle import State
from openacr.mill.session import Start
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.orders import LATER, Later, Order
from openacr.panel.control.presses import End
from openacr.panel.control.station import Station
from openacr.panel.files import Folder
from openacr.panel.library import ready
from openacr.panel.roles import Role

PARTS = ".parts"  # folder of library parts that were made, inside that of programs
# What ends the cause of an alarm that stays; {} is its axis.
MENDS = {
    EMERGENCY_STOP: "release the emergency stop",
    EXCESS_ERROR: "its drive has to be on (DRIVE ON {0}); REN {0} takes its position over",
    DRIVE_FAULT: "the drive itself has to be reset",
    HARDWARE_LIMIT: "it has to leave its limit switch",
}
Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]


class OfFile(Args, frozen=True):
    """A file in the folder of programs."""

    path: str
    dialect: Literal["", "auto", "acromill", "rs274ngc"] = ""


class Begin(Args, frozen=True):
    """How a program is started; `confirm` is the token of a rehearsal."""

    line: Annotated[int, Meta(ge=1, le=10**9)] = 1
    dry: bool = False
    skip: bool | None = None
    optional: bool | None = None
    any_tool: bool = False
    safe_z: Finite | None = None
    confirm: str = ""


class Switch(Args, frozen=True):
    """On or off."""

    on: bool


class Trace(Args, frozen=True):
    """Back along the path (-1), forward (1), or rest (0)."""

    direction: Literal[-1, 0, 1]


class Number(Args, frozen=True):
    """An answer to INPUT."""

    value: Finite


class Click(Args, frozen=True):
    """A click of an override."""

    which: Literal["feed", "rapid", "spindle"]
    click: Annotated[int, Meta(ge=0, le=15)]


# --- loading --------------------------------------------------------------------------


def folder_of(station: Station) -> Folder:
    """The folder of programs."""
    return Folder(station.installation.programs)


@command("program.load")
def load(station: Station, order: Order, args: OfFile) -> Later:
    """LOAD PROG: make a file of the folder the program that START starts."""
    file = folder_of(station).file(args.path)
    station.part.load(file, args.path, order, kind="file", dialect=args.dialect)
    return LATER


@command("program.batch")
def batch(station: Station, order: Order, args: OfFile) -> Later:
    """Load all programs of a batch file, which run one after the other."""
    folder = folder_of(station)

    def place(file: Path) -> str:
        return folder.path_of(file)

    station.part.load_batch(folder.file(args.path), order, place)
    return LATER


class OfPart(Args, frozen=True):
    """A part of the library with sizes by cell; the others have their defaults."""

    part: str
    values: dict[str, Finite] = field(default_factory=dict)
    tool: Annotated[int, Meta(ge=0, le=400)] = 0


class OfPort(Args, frozen=True):
    """A serial port; else that of the COMMUNICATIONS page."""

    port: str = ""
    dialect: Literal["", "auto", "acromill", "rs274ngc"] = ""
    dry: bool = False


@command("program.part")
def library_part(station: Station, order: Order, args: OfPart) -> Later:
    """LIBRARY PART: make a part with these sizes the program that START starts."""
    station.part.require_free()
    made = ready(args.part, args.values, station.installation.store, args.tool)
    folder = station.installation.programs / PARTS
    file = folder / f"{made.part.name}.nc"
    try:
        folder.mkdir(exist_ok=True)
        file.write_text(made.program, encoding="utf-8", newline="\n")
    except OSError as error:
        raise UserError(f"{file.name} cannot be stored: {error.strerror}") from None
    station.part.load(file, made.part.name, order, kind="part", dialect="acromill")
    return LATER


@command("program.drip", is_motion=True)
def drip(station: Station, order: Order, args: OfPort) -> None:
    """RS232 DRIP FEED: run a program while it arrives over a serial line."""
    station.part.require_free()
    session = station.link.machine
    session.runner.alarms.require_none()
    name = dialect_of(None, session.cells, args.dialect or None)
    folder = station.installation.store.path.parent if station.installation.store.path else None
    line = Line.of(session.cells, args.port)
    made = Drip(
        line, session.cells, name, is_dry=args.dry, folders=folders_of(session.cells, folder)
    )
    session.keep_drip(made)
    session.start_drip(made, Start(dialect=name, is_dry=args.dry))


@command("program.close")
def close(station: Station, order: Order, args: NoArgs) -> None:
    """Unload the program."""
    station.part.close()


# --- running --------------------------------------------------------------------------


@command("run.begin", is_motion=True)
def begin(station: Station, order: Order, args: Begin) -> dict[str, object] | Later:
    """RUN: start the loaded program; a later line is rehearsed first and confirmed then."""
    part = station.part
    if args.skip is not None:
        part.is_skipping = args.skip
    if args.optional is not None:
        part.stops_optionally = args.optional
    start = Start(
        dialect=part.required.dialect,
        line=args.line,
        is_dry=args.dry,
        is_single=part.is_single,
        is_skipping=part.is_skipping,
        stops_optionally=part.stops_optionally,
        accepts_tool=args.any_tool,
        safe_z=args.safe_z,
    )
    station.hand_motion.presses.end_all(End.MODE, "a program was started")
    if args.line > 1 and not args.confirm:
        part.rehearse(start, order)
        return LATER
    station.typed.drop()
    part.begin(start, args.confirm)
    return {}


@command("run.start", is_motion=True)
def start(station: Station, order: Order, args: NoArgs) -> None:
    """START: go on from a stop or a feed hold."""
    station.link.machine.runner.start()


@command("run.resume", is_motion=True)
def resume(station: Station, order: Order, args: NoArgs) -> None:
    """RESUME: go on with the path where it was held, and with what STOP has held on the card."""
    session = station.link.session
    is_held = station.stopping.holds
    if not is_held or (session and session.runner.state in (State.PAUSED, State.HOLD)):
        station.link.machine.runner.resume()
    if is_held:
        station.stopping.resume()


@command("run.abort")
def abort(station: Station, order: Order, args: NoArgs) -> None:
    """ABORT: end the program; START begins it again."""
    station.typed.drop()
    station.link.machine.runner.abort()


@command("run.block")
def block(station: Station, order: Order, args: Switch) -> None:
    """BLOCK: stop after every block, or not."""
    station.part.is_single = args.on
    station.link.machine.runner.block(args.on)


@command("run.skip")
def skip(station: Station, order: Order, args: Switch) -> None:
    """Leave blocks with a slash out, or not."""
    station.part.is_skipping = args.on
    station.link.machine.runner.stream.host.skips_always = args.on


@command("run.optional")
def optional(station: Station, order: Order, args: Switch) -> None:
    """Stop at M1, or not."""
    station.part.stops_optionally = args.on
    station.link.machine.runner.stop_optionally(args.on)


@command("run.trace", is_motion=True)
def trace(station: Station, order: Order, args: Trace) -> None:
    """Trace the path in a feed hold: back, forward, or rest."""
    station.link.machine.runner.trace(args.direction)


@command("run.answer", is_motion=True)
def answer(station: Station, order: Order, args: Number) -> None:
    """Answer the question of a program."""
    station.link.machine.runner.answer(args.value)


@command("run.confirm", is_motion=True)
def confirm(station: Station, order: Order, args: NoArgs) -> None:
    """Say that the tool is changed."""
    changer = station.link.machine.runner.entry_actions.changer
    if not changer.wants_confirmation:
        raise UserError("no tool change waits")
    changer.confirm()


# --- overrides and alarms -------------------------------------------------------------

OVERRIDES = {"feed": Override.FEED, "rapid": Override.RAPID, "spindle": Override.SPINDLE}


@command("override.choose")
def override(station: Station, order: Order, args: Click) -> None:
    """Choose a click of an override."""
    station.link.machine.runner.overrides.choose(OVERRIDES[args.which], args.click)


@command("alarm.acknowledge", Role.OPERATE)
def acknowledge(station: Station, order: Order, args: NoArgs) -> dict[str, list[str]]:
    """Clear the alarms whose cause is gone; those that stay, with what ends their cause."""
    left = station.link.machine.runner.acknowledge()
    return {"left": [_with_mend(alarm) for alarm in left]}


def _with_mend(alarm: Alarm) -> str:
    """An alarm that stays, and what ends its cause."""
    mend = MENDS.get(alarm.kind, "")
    return f"{alarm.text}: {mend.format(alarm.detail)}" if mend else alarm.text
