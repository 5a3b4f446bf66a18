"""Commands of the service: terminal, scope, gains, parameters and programs of the card."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.client import Level
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.mill.card.setup import GAIN_WORDS
from openacr.mill.config.settings import GAINS
from openacr.mill.manual.profile import parse
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.later import LATER, Later, answer_with
from openacr.panel.control.orders import Order
from openacr.panel.control.presses import End
from openacr.panel.control.scope import Trigger
from openacr.panel.control.station import Station
from openacr.panel.control.watches import watched
from openacr.panel.roles import Role
from openacr.sysvar.lookup import known
from openacr.sysvar.tabs import CELLS
from openacr.sysvar.values import checked

Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
QUERIES = frozenset(
    {"DIM", "MEM", "CPU", "LIST", "VER", "ATTACH", "CONFIG", "STREAM", "FSTAT", "AUT", "PLC"}
)

OF_ANY_LEVEL = frozenset({"CPU"})  # nothing changes for a program that runs


class OfLine(Args, frozen=True):
    """A line for the card, at a program where it is named."""

    text: Annotated[str, Meta(max_length=255)]


class OfKey(Args, frozen=True):
    """A control key."""

    key: Literal["esc", "ctrl-c", "ctrl-x", "ctrl-y", "ctrl-z"]


class Query(Args, frozen=True):
    """A line that only reads; at a program, a PLC program, or SYS."""

    line: Annotated[str, Meta(max_length=80)]
    program: Annotated[int, Meta(ge=0, le=15)] | None = None
    plc: Annotated[int, Meta(ge=0, le=7)] | None = None


class OfTrigger(Args, frozen=True):
    """When a capture begins."""

    channel: Annotated[int, Meta(ge=0, le=3)] = 0
    level: Finite = 0.0
    slope: Literal[-1, 1] = 1
    mode: Literal["auto", "normal", "single"] = "auto"
    before: Annotated[float, Meta(ge=0.0, le=0.9)] = 0.1


class Arm(Args, frozen=True):
    """What the scope samples: parameters by number or name."""

    channels: tuple[int | str, ...]
    period_ms: Annotated[float, Meta(ge=0.1, le=1000.0)] = 1.0
    samples: Annotated[int, Meta(ge=10, le=100_000)] = 5000
    trigger: OfTrigger | None = None


class OfIndex(Args, frozen=True):
    """A profile that is run, and what is sampled meanwhile."""

    profile: Annotated[str, Meta(max_length=2000)]
    channels: tuple[int | str, ...]
    period_ms: Annotated[float, Meta(ge=0.1, le=1000.0)] = 5.0
    samples: Annotated[int, Meta(ge=10, le=100_000)] = 5000


class OfGain(Args, frozen=True):
    """A gain of an axis, by its name on the SERVO page."""

    axis: str
    gain: str
    value: Finite
    store: bool = True


class Written(Args, frozen=True):
    """A parameter of the card and its value."""

    parameter: int
    value: Finite


class OfButton(Args, frozen=True):
    """A virtual push button."""

    number: Annotated[int, Meta(ge=0, le=31)]
    pressed: bool


class OfLength(Args, frozen=True):
    """The number of a tool length."""

    h: Annotated[int, Meta(ge=1, le=999)]


# --- terminal -------------------------------------------------------------------------


@command("term.open", Role.SERVICE)
def term_open(station: Station, order: Order, args: NoArgs) -> Later:
    """Open the terminal of the card; what it prints comes as events `term`."""
    answer_with(order, station.terminal.open(order.person.client), lambda _opened: None)
    return LATER


@command("term.line", Role.SERVICE)
def term_line(station: Station, order: Order, args: OfLine) -> None:
    """Type a line; while the machine moves only those that begin with ?."""
    station.terminal.line(args.text, is_busy=station.machine.runner.is_busy)


@command("term.key", Role.SERVICE)
def term_key(station: Station, order: Order, args: OfKey) -> None:
    """Press a control key at the terminal."""
    station.terminal.key(args.key)


@command("term.close", Role.SERVICE, needs_control=False)
def term_close(station: Station, order: Order, args: NoArgs) -> None:
    """Close the terminal."""
    station.terminal.close(order.person.client)


@command("card.query", Role.SETUP, needs_control=False)
def query(station: Station, order: Order, args: Query) -> dict[str, list[str]]:
    """Ask the card with a line that only reads: DIM, MEM, CPU, LIST, ?P12288 ..."""
    line = args.line.strip().upper()
    if line not in QUERIES and not line.startswith("?"):
        raise UserError(f"{args.line}: only {', '.join(sorted(QUERIES))} and lines with ? are sent")
    session = station.machine
    if line in OF_ANY_LEVEL:
        return {"lines": session.card.command(line)}
    if session.runner.is_busy and not line.startswith("?"):
        raise UserError("the machine moves: only lines that begin with ? are sent")
    if args.plc is not None:
        session.card.go(Level.plc(args.plc))
        return {"lines": session.card.command(line)}
    if args.program is None:
        session.card.go(Level())
    return {"lines": session.card.command(line, program=args.program)}


# --- scope, gains, parameters ---------------------------------------------------------


@command("scope.arm", Role.SERVICE, needs_control=False)
def scope_arm(station: Station, order: Order, args: Arm) -> dict[str, object]:
    """Begin to sample up to four parameters; the samples are the topic `scope`."""
    trigger = args.trigger
    chosen = None
    if trigger is not None:
        chosen = Trigger(
            trigger.channel, trigger.level, trigger.slope, trigger.mode, trigger.before
        )
    station.scope.arm(watched(args.channels), args.period_ms / 1000.0, args.samples, chosen)
    capture = station.scope.capture
    return capture.data() if capture is not None else {}


@command("scope.index", Role.SERVICE, is_motion=True)
def scope_index(station: Station, order: Order, args: OfIndex) -> dict[str, object]:
    """Run an index profile (ACC, DEC, STP, JRK, F, RES, a move) and sample it from its start."""
    runner = station.machine.runner
    found = parse(args.profile, list(runner.settings.names()))
    parameters = watched(args.channels)
    station.hand_motion.presses.end_all(End.MODE, "an index profile was started")
    station.scope.arm(parameters, args.period_ms / 1000.0, args.samples, None)
    try:
        runner.jog(lambda jogging: jogging.index(found))
    except BaseException:
        station.scope.stop()
        raise
    return {"time_s": found.time_s}


@command("scope.stop", Role.SERVICE, needs_control=False)
def scope_stop(station: Station, order: Order, args: NoArgs) -> None:
    """End the capture."""
    station.scope.stop()


@command("gain.set", Role.SERVICE)
def gain(station: Station, order: Order, args: OfGain) -> dict[str, float | bool]:
    """Set a gain on the card at once, and store it; while the machine moves, once it rests."""
    session = station.machine
    axis = session.runner.settings.named(args.axis.upper()).index
    names = {known(cells[axis]).name.lower(): k for k, cells in enumerate(GAINS)}
    place = names.get(args.gain.lower())
    if place is None:
        raise UserError(f"{args.gain}: gains are {', '.join(names)}")
    store, cell = station.installation.store, known(GAINS[place][axis])
    checked(cell, args.value, store.is_metric, store.letter_of(cell))
    session.machine.type([f"AXIS{axis} {GAIN_WORDS[place]} {number_text(args.value)}"])
    if args.store:
        station.store_at_rest(cell.number, args.value)
    return {"value": args.value, "is_stored": store.read(cell.number) == args.value}


@command("card.write", Role.SERVICE)
def card_write(station: Station, order: Order, args: Written) -> dict[str, float]:
    """Set a parameter of the card."""
    session = station.machine
    session.machine.write(args.parameter, args.value)
    return {"value": session.machine.read(args.parameter)}


# --- buttons, lengths -----------------------------------------------------------------


@command("button")
def button(station: Station, order: Order, args: OfButton) -> None:
    """Press or release a virtual push button."""
    client = order.person.client
    station.buttons.press(station.machine, args.number, client, is_pressed=args.pressed)


@command("teach.length", Role.SETUP)
def teach_length(station: Station, order: Order, args: OfLength) -> dict[str, float]:
    """Make the machine position of Z the length of a tool."""
    session = station.machine
    session.runner.alarms.require_none()
    if session.runner.is_busy:
        raise UserError("the machine is moving: a length can be taught only at rest")
    axis = session.runner.settings.named("Z").index
    value = session.runner.stream.host.position()[axis]
    session.cells.write(CELLS.h_length[args.h], value)
    return {"value": value}
