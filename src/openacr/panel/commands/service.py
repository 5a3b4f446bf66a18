"""Commands of the service: terminal, scope, gains, parameters and programs of the card."""

from dataclasses import dataclass
from typing import Annotated, Literal

from msgspec import Meta, structs

from openacr.client import Level
from openacr.client.names import named
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.mill.card.setup import GAIN_WORDS
from openacr.mill.config.settings import GAINS
from openacr.mill.manual.profile import parse
from openacr.mill.session import MillSession
from openacr.panel.commands.registry import Args, command
from openacr.panel.control.engineer.captures import Captures
from openacr.panel.control.engineer.gain_sets import GainSets
from openacr.panel.control.engineer.scope import (
    CHANNELS,
    LEAST_SAMPLES,
    MOST_SAMPLES,
    Capture,
    Trigger,
)
from openacr.panel.control.engineer.terminal import TERMINALS, Terminals
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.buttons import Buttons
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.orders import LATER, Later, Order, answer_with
from openacr.panel.control.operator.presses import End
from openacr.panel.control.settings import StoredSettings
from openacr.panel.control.times import Times
from openacr.panel.helps import Page
from openacr.panel.roles import Role
from openacr.sysvar.lookup import known
from openacr.sysvar.tabs import CELLS
from openacr.sysvar.values import checked

Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
QUERIES = frozenset(
    {"DIM", "MEM", "CPU", "LIST", "VER", "ATTACH", "CONFIG", "STREAM", "FSTAT", "AUT", "PLC"}
)

TerminalNumber = Annotated[int, Meta(ge=0, lt=TERMINALS)]
CardProgram = Annotated[int, Meta(ge=0, le=15)]
PeriodMs = Annotated[float, Meta(ge=0.0, le=1000.0)]
SweepMs = Annotated[float, Meta(ge=0.0, le=1e7)]
Count = Annotated[int, Meta(ge=LEAST_SAMPLES, le=MOST_SAMPLES)]
OF_ANY_LEVEL = frozenset({"CPU"})  # nothing changes for a program that runs


class OfTrigger(Args, frozen=True):
    """When a capture begins."""

    channel: Annotated[int, Meta(ge=0, lt=CHANNELS)] = 0
    level: Finite = 0.0
    slope: Literal[-1, 0, 1] = 1
    mode: Literal["auto", "normal", "single"] = "auto"
    before: Annotated[float, Meta(ge=0.0, le=0.9)] = 0.1


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a capture samples: one of another client is replaced only with `take`."""

    channels: tuple[int | str, ...]
    period_ms: float
    samples: int
    sweep_ms: float
    program: int | None
    take: bool


# --- terminal -------------------------------------------------------------------------


@command("term.open", Role.SERVICE)
def term_open(
    order: Order,
    client: int,
    terminals: Terminals,
    *,
    terminal: TerminalNumber = 0,
) -> Later:
    """Open a terminal of the card; what it prints comes as events `term`."""
    opening = terminals[terminal].open(client)
    answer_with(order, opening, lambda _opened: None)
    return LATER


@command(
    "term.line",
    Role.SERVICE,
    page=Page(
        "terminal",
        "TERMINAL",
        "A direct line to the card: what is typed is sent as it is, what the card prints is shown,"
        " for example ?P3. While the machine moves only lines that begin with ? are sent.",
        de=(
            "TERMINAL",
            "Eine direkte Leitung zur Karte: Was eingegeben wird, geht unverändert hin,"
            " was die Karte ausgibt, wird gezeigt, zum Beispiel ?P3. Solange sich die"
            " Maschine bewegt, werden nur Zeilen gesendet, die mit ? beginnen.",
        ),
    ),
)
def term_line(
    terminals: Terminals,
    interlocks: Interlocks,
    *,
    text: Annotated[str, Meta(max_length=255)],
    terminal: TerminalNumber = 0,
) -> None:
    """Type a line; while the machine moves only those that begin with ?."""
    terminals[terminal].line(text, is_busy=interlocks.is_moved)


@command("term.key", Role.SERVICE)
def term_key(
    terminals: Terminals,
    *,
    key: Literal["esc", "ctrl-c", "ctrl-x", "ctrl-y", "ctrl-z"],
    terminal: TerminalNumber = 0,
) -> None:
    """Press a control key at a terminal."""
    terminals[terminal].key(key)


@command("term.close", Role.SERVICE, needs_control=False)
def term_close(client: int, terminals: Terminals, *, terminal: TerminalNumber = 0) -> None:
    """Close a terminal."""
    terminals[terminal].close(client)


@command("card.query", Role.SETUP, needs_control=False)
def query(
    link: Link,
    interlocks: Interlocks,
    *,
    line: Annotated[str, Meta(max_length=80)],
    program: CardProgram | None = None,
    plc: Annotated[int, Meta(ge=0, le=7)] | None = None,
) -> dict[str, list[str]]:
    """Ask the card with a line that only reads: DIM, MEM, CPU, LIST, ?P12288 ..."""
    asked = line.strip().upper()
    if asked not in QUERIES and not asked.startswith("?"):
        raise UserError(f"{line}: only {', '.join(sorted(QUERIES))} and lines with ? are sent")
    card = link.required.card
    if asked in OF_ANY_LEVEL:
        return {"lines": card.command(asked)}
    if interlocks.is_moved and not asked.startswith("?"):
        raise UserError("the machine moves: only lines that begin with ? are sent")
    if plc is not None:
        card.go(Level.plc(plc))
        return {"lines": card.command(asked)}
    if program is None:
        card.go(Level())
    return {"lines": card.command(asked, program=program)}


# --- scope, gains, parameters ---------------------------------------------------------


@command(
    "scope.arm",
    Role.SERVICE,
    needs_control=False,
    page=Page(
        "scope",
        "SCOPE",
        "Up to four parameters of the card, sampled in its time, on ten by ten divisions. Every"
        " channel has its source, units per division and offset; the sweep is in ms per division."
        "\n\nWith INDEX the profile is run and recorded from its start: ACC, DEC, STP, JRK, F, RES"
        " and the move of one axis, for example X15. The axis really moves.",
        de=(
            "SCOPE",
            "Bis zu vier Parameter der Karte, in ihrer Zeit abgetastet, auf zehn mal"
            " zehn Teilen. Jeder Kanal hat seine Quelle, Einheiten je Teil und"
            " Verschiebung; die Ablenkung ist in ms je Teil.\n\nMit INDEX wird das Profil"
            " gefahren und von seinem Beginn an aufgezeichnet: ACC, DEC, STP, JRK, F, RES"
            " und die Bewegung einer Achse, zum Beispiel X15. Die Achse bewegt sich"
            " wirklich.",
        ),
    ),
)
def scope_arm(
    client: int,
    captures: Captures,
    *,
    channels: tuple[int | str, ...],
    period_ms: PeriodMs = 1.0,
    samples: Count = 5000,
    sweep_ms: SweepMs = 0.0,
    program: CardProgram | None = None,
    trigger: OfTrigger | None = None,
    take: bool = False,
) -> dict[str, object]:
    """Begin to sample up to eight parameters and flags; the samples are the topic `scope`.

    They are named by name, P12290, BIT516 or number. A sweep has the time of `sweep_ms` where
    that is above 0, else `samples`. A card at the end of a link records into LA0 to LA7 and SA0
    to SA7 of `program` (SAMP), else it is polled; its capture is replaced by that of another
    client only with `take`.
    """
    wanted = Wanted(channels, period_ms, samples, sweep_ms, program, take)
    chosen = None if trigger is None else Trigger(**structs.asdict(trigger))
    return _armed(captures, client, wanted, chosen).data()


def _armed(captures: Captures, client: int, wanted: Wanted, trigger: Trigger | None) -> Capture:
    """Begin the capture that a command asks for; UserError for a sweep too short or too long."""
    if not wanted.take:
        captures.require_free(client)
    channels = [named(str(each)) for each in wanted.channels]
    period_s = captures.period_s(wanted.period_ms / 1000.0, wanted.program)
    samples = wanted.samples
    if wanted.sweep_ms > 0.0:
        samples = round(wanted.sweep_ms / 1000.0 / period_s)
        if not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
            raise UserError(
                f"a sweep of {wanted.sweep_ms:g} ms has {samples} samples of"
                f" {1000 * period_s:g} ms: {LEAST_SAMPLES} to {MOST_SAMPLES} are possible"
            )
    return captures.arm(client, channels, period_s, samples, trigger, wanted.program)


@command("scope.index", Role.SERVICE, is_motion=True, en="INDEX", de="INDEX")
def scope_index(
    client: int,
    machine: MillSession,
    hand_motion: HandMotion,
    captures: Captures,
    *,
    profile: Annotated[str, Meta(max_length=2000)],
    channels: tuple[int | str, ...],
    period_ms: PeriodMs = 5.0,
    samples: Count = 5000,
    sweep_ms: SweepMs = 0.0,
    program: CardProgram | None = None,
    take: bool = False,
) -> dict[str, object]:
    """Run an index profile (ACC, DEC, STP, JRK, F, RES, a move) and sample it from its start."""
    runner = machine.runner
    found = parse(profile, list(runner.settings.names()))
    hand_motion.presses.end_all(End.MODE, "an index profile was started")
    wanted = Wanted(channels, period_ms, samples, sweep_ms, program, take)
    capture = _armed(captures, client, wanted, None)
    try:
        runner.jog(lambda jogging: jogging.index(found))
    except BaseException:
        captures.stop(client)
        raise
    return {"time_s": found.time_s, **capture.data()}


@command("scope.stop", Role.SERVICE, needs_control=False, en="STOP SCOPE", de="SCOPE HALT")
def scope_stop(client: int, captures: Captures) -> None:
    """End the own capture; of a card at the end of a link the one there is, if it is free."""
    captures.require_free(client)
    captures.stop(client)


@command("scope.resume", Role.SERVICE, needs_control=False)
def scope_resume(
    client: int, captures: Captures, *, number: Annotated[int, Meta(ge=1)]
) -> dict[str, object]:
    """Go on with the capture that this browser began before its connection was cut.

    `number` is that of the event `scope`; refused where it is another client's, or gone.
    """
    return captures.resume(client, number).data()


@command(
    "gain.set",
    Role.SERVICE,
    page=Page(
        "gain",
        "GAIN",
        "The gains of an axis. A value reaches the card when ENTER is pressed in its field, and"
        " acts at once; with the check set it is stored as well.",
        de=(
            "REGLER",
            "Die Verstärkungen einer Achse. Ein Wert erreicht die Karte, wenn in seinem"
            " Feld EINGABE gedrückt wird, und wirkt sofort; mit dem Haken wird er auch"
            " gespeichert.",
        ),
    ),
)
def gain(
    session: MillSession,
    installation: Installation,
    settings: StoredSettings,
    gain_sets: GainSets,
    now_s: float,
    *,
    axis: str,
    gain: str,
    value: Finite,
    store: bool = True,
) -> dict[str, float | bool]:
    """Set a gain on the card at once, and store it; while the machine moves, once it rests."""
    is_stored = store and session.is_set_up  # else the axis is not that of the parameters
    index = installation.axis(axis, is_stored=is_stored)
    names = {known(cells[index]).name.lower(): k for k, cells in enumerate(GAINS)}
    place = names.get(gain.lower())
    if place is None:
        raise UserError(f"{gain}: gains are {', '.join(names)}")
    cells, cell = installation.store, known(GAINS[place][index])
    checked(cell, value, cells.is_metric, cells.letter_of(cell))
    gain_sets.look(session, index, now_s)  # what others have changed is not of this change
    session.machine.type([f"AXIS{index} {GAIN_WORDS[place]} {number_text(value)}"])
    gain_sets.expect(index)
    gain_sets.look(session, index, now_s)
    if is_stored:
        settings.store_at_rest(cell.number, value)
    return {"value": value, "is_stored": cells.read(cell.number) == value}


@command(
    "card.write",
    Role.SERVICE,
    page=Page(
        "board",
        "BOARD PARAMETERS",
        "Every parameter of the card with its number, name and value, live. A touch on a value that"
        " can be written sets it.",
        de=(
            "KARTENPARAM",
            "Jeder Parameter der Karte mit Nummer, Name und Wert, laufend. Ein Druck auf"
            " einen Wert, der geschrieben werden kann, setzt ihn.",
        ),
    ),
)
def card_write(link: Link, times: Times, *, parameter: int, value: Finite) -> dict[str, float]:
    """Set a parameter of the card; at a moment of its history, this begins another branch."""
    if link.is_away:
        times.write(parameter, value, is_flag=False)
        return {"value": link.read([parameter])[0]}
    session = link.required
    session.machine.write(parameter, value)
    return {"value": session.machine.read(parameter)}


@command("card.flag", Role.SERVICE, is_motion=True)
def card_flag(
    link: Link, times: Times, *, flag: Annotated[int, Meta(ge=0)], on: bool
) -> dict[str, bool]:
    """Set or clear a flag of the card; at a moment of its history, this begins another branch."""
    if link.is_away:
        times.write(flag, on, is_flag=True)
        return {"on": on}
    card = link.required.card
    card.write_bit(flag, on)
    return {"on": card.read_bit(flag)}


# --- buttons, lengths -----------------------------------------------------------------


@command("button")
def button(
    client: int,
    link: Link,
    buttons: Buttons,
    *,
    number: Annotated[int, Meta(ge=0, le=31)],
    pressed: bool,
) -> None:
    """Press or release a virtual push button."""
    buttons.press(link.machine, number, client, is_pressed=pressed)


@command("teach.length", Role.SETUP, en="TOOL LENGTH H", de="LÄNGE H")
def teach_length(
    machine: MillSession, interlocks: Interlocks, *, h: Annotated[int, Meta(ge=1, le=999)]
) -> dict[str, float]:
    """Make the machine position of Z the length of a tool."""
    machine.runner.alarms.require_none()
    if interlocks.is_moved:
        raise UserError("the machine is moving: a length can be taught only at rest")
    axis = machine.runner.settings.named("Z").index
    value = machine.runner.stream.host.position()[axis]
    machine.cells.write(CELLS.h_length[h], value)
    return {"value": value}
