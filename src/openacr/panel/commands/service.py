"""Commands of the service: terminal, scope, gains, parameters and programs of the card."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.client import Level
from openacr.client.names import named
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.mill.card.setup import GAIN_WORDS
from openacr.mill.config.settings import GAINS
from openacr.mill.manual.profile import parse
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.orders import LATER, Later, Order, answer_with
from openacr.panel.control.presses import End
from openacr.panel.control.scope import CHANNELS, LEAST_SAMPLES, MOST_SAMPLES, Capture, Trigger
from openacr.panel.control.station import Station
from openacr.panel.control.terminal import TERMINALS
from openacr.panel.roles import Role
from openacr.sysvar.lookup import known
from openacr.sysvar.tabs import CELLS
from openacr.sysvar.values import checked

Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
QUERIES = frozenset(
    {"DIM", "MEM", "CPU", "LIST", "VER", "ATTACH", "CONFIG", "STREAM", "FSTAT", "AUT", "PLC"}
)

OF_ANY_LEVEL = frozenset({"CPU"})  # nothing changes for a program that runs


class OfTerminal(Args, frozen=True):
    """A terminal of the card; each is a stream of its own."""

    terminal: Annotated[int, Meta(ge=0, lt=TERMINALS)] = 0


class OfLine(OfTerminal, frozen=True, kw_only=True):
    """A line for the card."""

    text: Annotated[str, Meta(max_length=255)]


class OfKey(OfTerminal, frozen=True, kw_only=True):
    """A control key."""

    key: Literal["esc", "ctrl-c", "ctrl-x", "ctrl-y", "ctrl-z"]


class Query(Args, frozen=True):
    """A line that only reads; at a program, a PLC program, or SYS."""

    line: Annotated[str, Meta(max_length=80)]
    program: Annotated[int, Meta(ge=0, le=15)] | None = None
    plc: Annotated[int, Meta(ge=0, le=7)] | None = None


class OfTrigger(Args, frozen=True):
    """When a capture begins."""

    channel: Annotated[int, Meta(ge=0, lt=CHANNELS)] = 0
    level: Finite = 0.0
    slope: Literal[-1, 0, 1] = 1
    mode: Literal["auto", "normal", "single"] = "auto"
    before: Annotated[float, Meta(ge=0.0, le=0.9)] = 0.1


class Arm(Args, frozen=True):
    """What the scope samples: parameters and flags by name, P12290, BIT516 or number.

    A sweep has the time of `sweep_ms` where that is above 0, else `samples`. A card at the end
    of a link records into LA0 to LA7 and SA0 to SA7 of `program` (SAMP); else it is polled.
    A capture of another client is replaced only with `take`.
    """

    channels: tuple[int | str, ...]
    period_ms: Annotated[float, Meta(ge=0.0, le=1000.0)] = 1.0
    samples: Annotated[int, Meta(ge=LEAST_SAMPLES, le=MOST_SAMPLES)] = 5000
    sweep_ms: Annotated[float, Meta(ge=0.0, le=1e7)] = 0.0
    program: Annotated[int, Meta(ge=0, le=15)] | None = None
    trigger: OfTrigger | None = None
    take: bool = False


class OfIndex(Args, frozen=True):
    """A profile that is run, and what is sampled meanwhile."""

    profile: Annotated[str, Meta(max_length=2000)]
    channels: tuple[int | str, ...]
    period_ms: Annotated[float, Meta(ge=0.0, le=1000.0)] = 5.0
    samples: Annotated[int, Meta(ge=LEAST_SAMPLES, le=MOST_SAMPLES)] = 5000
    sweep_ms: Annotated[float, Meta(ge=0.0, le=1e7)] = 0.0
    program: Annotated[int, Meta(ge=0, le=15)] | None = None
    take: bool = False


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


class Switched(Args, frozen=True):
    """A flag of the card and its state."""

    flag: Annotated[int, Meta(ge=0)]
    on: bool


class OfButton(Args, frozen=True):
    """A virtual push button."""

    number: Annotated[int, Meta(ge=0, le=31)]
    pressed: bool


class OfLength(Args, frozen=True):
    """The number of a tool length."""

    h: Annotated[int, Meta(ge=1, le=999)]


# --- terminal -------------------------------------------------------------------------


@command("term.open", Role.SERVICE)
def term_open(station: Station, order: Order, args: OfTerminal) -> Later:
    """Open a terminal of the card; what it prints comes as events `term`."""
    opening = station.terminals[args.terminal].open(order.person.client)
    answer_with(order, opening, lambda _opened: None)
    return LATER


@command("term.line", Role.SERVICE)
def term_line(station: Station, order: Order, args: OfLine) -> None:
    """Type a line; while the machine moves only those that begin with ?."""
    terminal = station.terminals[args.terminal]
    terminal.line(args.text, is_busy=station.interlocks.is_moved)


@command("term.key", Role.SERVICE)
def term_key(station: Station, order: Order, args: OfKey) -> None:
    """Press a control key at a terminal."""
    station.terminals[args.terminal].key(args.key)


@command("term.close", Role.SERVICE, needs_control=False)
def term_close(station: Station, order: Order, args: OfTerminal) -> None:
    """Close a terminal."""
    station.terminals[args.terminal].close(order.person.client)


@command("card.query", Role.SETUP, needs_control=False)
def query(station: Station, order: Order, args: Query) -> dict[str, list[str]]:
    """Ask the card with a line that only reads: DIM, MEM, CPU, LIST, ?P12288 ..."""
    line = args.line.strip().upper()
    if line not in QUERIES and not line.startswith("?"):
        raise UserError(f"{args.line}: only {', '.join(sorted(QUERIES))} and lines with ? are sent")
    session = station.link.required
    if line in OF_ANY_LEVEL:
        return {"lines": session.card.command(line)}
    if station.interlocks.is_moved and not line.startswith("?"):
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
    """Begin to sample up to eight parameters and flags; the samples are the topic `scope`."""
    trigger = args.trigger
    chosen = None
    if trigger is not None:
        chosen = Trigger(
            trigger.channel, trigger.level, trigger.slope, trigger.mode, trigger.before
        )
    return _armed(station, order, args, chosen).data()


def _armed(
    station: Station, order: Order, args: "Arm | OfIndex", trigger: Trigger | None
) -> Capture:
    """Begin the capture that a command asks for; UserError for a sweep too short or too long."""
    if not args.take:
        station.captures.require_free(order.person.client)
    channels = [named(str(each)) for each in args.channels]
    sampling = station.captures.source(args.program)
    period_s = sampling.period_s(args.period_ms / 1000.0)
    samples = args.samples
    if args.sweep_ms > 0.0:
        samples = round(args.sweep_ms / 1000.0 / period_s)
        if not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
            raise UserError(
                f"a sweep of {args.sweep_ms:g} ms has {samples} samples of {1000 * period_s:g} ms:"
                f" {LEAST_SAMPLES} to {MOST_SAMPLES} are possible"
            )
    return station.captures.arm(sampling, channels, period_s, samples, trigger, order.person.client)


@command("scope.index", Role.SERVICE, is_motion=True)
def scope_index(station: Station, order: Order, args: OfIndex) -> dict[str, object]:
    """Run an index profile (ACC, DEC, STP, JRK, F, RES, a move) and sample it from its start."""
    runner = station.link.machine.runner
    found = parse(args.profile, list(runner.settings.names()))
    station.hand_motion.presses.end_all(End.MODE, "an index profile was started")
    capture = _armed(station, order, args, None)
    try:
        runner.jog(lambda jogging: jogging.index(found))
    except BaseException:
        station.captures.stop()
        raise
    return {"time_s": found.time_s, **capture.data()}


@command("scope.stop", Role.SERVICE, needs_control=False)
def scope_stop(station: Station, order: Order, args: NoArgs) -> None:
    """End the capture, unless it is that of another client."""
    station.captures.require_free(order.person.client)
    station.captures.stop()


@command("gain.set", Role.SERVICE)
def gain(station: Station, order: Order, args: OfGain) -> dict[str, float | bool]:
    """Set a gain on the card at once, and store it; while the machine moves, once it rests."""
    session = station.link.required
    is_stored = args.store and session.is_set_up  # else the axis is not that of the parameters
    axis = station.installation.axis(args.axis, is_stored=is_stored)
    names = {known(cells[axis]).name.lower(): k for k, cells in enumerate(GAINS)}
    place = names.get(args.gain.lower())
    if place is None:
        raise UserError(f"{args.gain}: gains are {', '.join(names)}")
    store, cell = station.installation.store, known(GAINS[place][axis])
    checked(cell, args.value, store.is_metric, store.letter_of(cell))
    session.machine.type([f"AXIS{axis} {GAIN_WORDS[place]} {number_text(args.value)}"])
    if is_stored:
        station.settings.store_at_rest(cell.number, args.value)
    return {"value": args.value, "is_stored": store.read(cell.number) == args.value}


@command("card.write", Role.SERVICE)
def card_write(station: Station, order: Order, args: Written) -> dict[str, float]:
    """Set a parameter of the card; at a moment of its history, this begins another branch."""
    if station.link.is_away:
        station.times.write(args.parameter, args.value, is_flag=False)
        return {"value": station.link.read([args.parameter])[0]}
    session = station.link.required
    session.machine.write(args.parameter, args.value)
    return {"value": session.machine.read(args.parameter)}


@command("card.flag", Role.SERVICE, is_motion=True)
def card_flag(station: Station, order: Order, args: Switched) -> dict[str, bool]:
    """Set or clear a flag of the card; at a moment of its history, this begins another branch."""
    if station.link.is_away:
        station.times.write(args.flag, args.on, is_flag=True)
        return {"on": args.on}
    card = station.link.required.card
    card.write_bit(args.flag, args.on)
    return {"on": card.read_bit(args.flag)}


# --- buttons, lengths -----------------------------------------------------------------


@command("button")
def button(station: Station, order: Order, args: OfButton) -> None:
    """Press or release a virtual push button."""
    client = order.person.client
    station.buttons.press(station.link.machine, args.number, client, is_pressed=args.pressed)


@command("teach.length", Role.SETUP)
def teach_length(station: Station, order: Order, args: OfLength) -> dict[str, float]:
    """Make the machine position of Z the length of a tool."""
    session = station.link.machine
    session.runner.alarms.require_none()
    if station.interlocks.is_moved:
        raise UserError("the machine is moving: a length can be taught only at rest")
    axis = session.runner.settings.named("Z").index
    value = session.runner.stream.host.position()[axis]
    session.cells.write(CELLS.h_length[args.h], value)
    return {"value": value}
