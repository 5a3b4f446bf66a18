"""Commands that move axes by hand: jog, increments, hand wheel, home, zero; and stops."""

from collections.abc import Callable
from typing import Annotated, Literal

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.config.settings import Settings
from openacr.mill.run.lifecycle import State
from openacr.mill.run.runner import Runner
from openacr.mill.session import MillSession
from openacr.mill.zeroing import clear_all, goto_blocks, preset, reader, set_zero
from openacr.panel.commands.registry import command
from openacr.panel.control.machine.link import Link
from openacr.panel.control.operator.hand_motion import HandMotion
from openacr.panel.control.operator.orders import Order
from openacr.panel.control.operator.people import People, Person
from openacr.panel.control.operator.presses import End, Key
from openacr.panel.control.operator.typed import Typed
from openacr.panel.control.station import Station
from openacr.panel.helps import Page
from openacr.panel.roles import Role

PressNumber = Annotated[int, Meta(ge=0, le=2**53)]
Direction = Literal[-1, 1]
Speed = Annotated[float, Meta(gt=0.0, le=1e6)]  # units of the axis a second
Mode = Literal["auto", "manual", "mdi", "home", "setup", "diagnose"]
Position = dict[str, dict[str, float]]


def indices(machine: MillSession, names: str) -> list[int]:
    """The axes of these names; all configured ones without a name."""
    settings = machine.runner.settings
    return [settings.named(name).index for name in names.upper() or settings.names()]


def jogged_axis(link: Link, name: str, speed: float | None) -> int:
    """The number of an axis that is to be jogged; UserError for a speed it lacks or cannot have."""
    settings = Settings(link.installation.store)
    is_own = name.upper() in settings.names()
    index = link.machine.runner.settings.named(name.upper()).index if is_own else None
    if index is None:
        index = link.installation.axis(name)
        is_own = link.required.is_set_up and any(each.index == index for each in settings.axes)
    if is_own and speed is not None:
        raise UserError(f"axis {name.upper()} is AcroMill's: its speeds are SLOW and FAST of JOG")
    if not is_own and speed is None:
        raise UserError(f"axis {name.upper()} is not AcroMill's: give its speed in units/s")
    return index


# --- jog ------------------------------------------------------------------------------


@command(
    "jog.press",
    is_motion=True,
    page=Page(
        "jog",
        "JOG",
        "An axis moves while its key is held and stops when it is released, when the connection"
        " falls silent for 200 ms, and at every stop, alarm or change of screen. SLOW is Jog"
        " Feedrate, FAST is Jog Rapid. An increment is made whole at one press.",
        de=(
            "TIPPEN",
            "Eine Achse bewegt sich, solange ihre Taste gedrückt ist; sie hält an beim"
            " Loslassen, wenn die Verbindung 200 ms schweigt, und bei jedem Halt, Alarm"
            " oder Wechsel des Bildschirms. LANGSAM ist Jog Feedrate, SCHNELL ist Jog"
            " Rapid. Ein Schrittmaß wird mit einem Druck ganz gefahren.",
        ),
    ),
)
def press(
    order: Order,
    client: int,
    link: Link,
    hand_motion: HandMotion,
    now_s: float,
    *,
    press: PressNumber,
    axis: str,
    direction: Direction,
    tick: float,
    first: Literal[True],
    fast: bool = False,
    speed: Speed | None = None,
) -> None:
    """Jog an axis while the key is held.

    `first` says that this is a new press, not a keep-alive. An axis that is not AcroMill's is
    named as its master names it, or AXISn; `speed` is in its units a second.
    """
    index = jogged_axis(link, axis, speed)
    hand_motion.press(
        Key(client, press),
        index,
        direction,
        fast=fast,
        speed_ups=speed,
        tick_ms=tick,
        received_s=order.received_s,
        now_s=now_s,
    )


@command("jog.release", Role.VIEW, needs_control=False)
def release(client: int, hand_motion: HandMotion, *, press: PressNumber) -> None:
    """Release a jog key; accepted without control."""
    hand_motion.release(Key(client, press))


@command("jog.increment", is_motion=True)
def increment(
    order: Order,
    link: Link,
    hand_motion: HandMotion,
    *,
    axis: str,
    direction: Direction,
    tick: float,
    preset: Annotated[int, Meta(ge=0, le=5)] = 0,
    distance: Annotated[float, Meta(ge=0.0, le=1e6)] = 0.0,
    fast: bool = False,
    speed: Speed | None = None,
) -> None:
    """Move an axis by one increment: a preset of the store (1 to 5), or a distance.

    An axis that is not AcroMill's has no presets; `speed` is in its units a second.
    """
    index = jogged_axis(link, axis, speed)
    if bool(preset) == bool(distance):
        raise UserError("an increment is a preset from 1 to 5 or a distance above 0")
    if preset and speed is not None:
        raise UserError(f"axis {axis.upper()} is not AcroMill's: give a distance, no preset")
    hand_motion.require_fresh(tick, order.received_s)
    hand_motion.increment(
        index, direction, preset=preset, distance_u=distance, fast=fast, speed_ups=speed
    )


@command("jog.stop", Role.VIEW, needs_control=False, is_stop=True)
def stop_jogs(hand_motion: HandMotion) -> None:
    """Ramp everything that is moved by hand to rest."""
    hand_motion.stop()


@command(
    "handwheel",
    is_motion=True,
    page=Page(
        "handwheel",
        "HANDWHEEL",
        "The wheel of each chosen axis moves it, by its ratio per click.",
        de=("HANDRAD", "Das Rad jeder gewählten Achse bewegt sie, um ihr Verhältnis je Raste."),
    ),
)
def handwheel(link: Link, hand_motion: HandMotion, *, axes: str = "") -> dict[str, str]:
    """Connect the hand wheel with axes; without a name it is disconnected."""
    hand_motion.presses.end_all(End.MODE, "the hand wheel was chosen")
    machine = link.machine
    machine.runner.turn(indices(machine, axes) if axes else [])
    return {"axes": axes.upper()}


@command("mode", needs_control=False)
def mode(client: int, people: People, hand_motion: HandMotion, *, mode: Mode) -> None:
    """Say which screen the operator is on; a change ends every held key."""
    if people.holder not in (None, client):
        return  # the screens of others change nothing
    if mode != people.mode:
        hand_motion.presses.end_all(End.MODE, "another screen was chosen")
        people.mode = mode


# --- home and zero --------------------------------------------------------------------


@command(
    "home.start",
    is_motion=True,
    en="START HOME",
    de="REFERENZFAHRT STARTEN",
    page=Page(
        "home",
        "HOME",
        "Choose all axes or some, then START HOME. Each axis runs fast to its switch, slowly off"
        " it, then to the marker of its encoder; there its position becomes Home Preset. Axes of"
        " priority 1 go first, those of priority 0 are never homed.\n\nSTOP ends homing with"
        " alarm 34: the axes that were under way are not homed.",
        de=(
            "REFERENZ",
            "Alle Achsen oder einige wählen, dann REFERENZFAHRT STARTEN. Jede Achse"
            " fährt schnell zu ihrem Schalter, langsam wieder herunter, dann zur"
            " Nullmarke ihres Gebers; dort wird ihre Position Home Preset. Achsen mit"
            " Priorität 1 fahren zuerst, solche mit Priorität 0 nie.\n\nSTOP beendet die"
            " Referenzfahrt mit Alarm 34: Achsen, die unterwegs waren, sind nicht"
            " referenziert.",
        ),
    ),
)
def home(machine: MillSession, *, axes: str = "") -> dict[str, list[str]]:
    """HOME: find the reference points of axes, all that have a priority without a name."""
    settings = machine.runner.settings
    wanted = indices(machine, axes)
    chosen = [axis for axis in wanted if settings.home(axis).priority > 0]
    if not chosen:
        names = axes.upper() or "any axis"
        raise UserError(f"{names} has no homing priority: set Home Priority on the HOME page")
    machine.runner.home(chosen)
    return {"axes": [settings.axis(axis).name for axis in chosen]}


def _position(machine: MillSession, point: tuple[float, ...]) -> Position:
    axes = machine.runner.settings.axes
    return {"position": {axis.name: point[axis.index] for axis in axes}}


@command(
    "zero.set",
    page=Page(
        "setzero",
        "SET ZERO",
        "The chosen axes read 0 where they are, as by G92. The shift counts in every work system"
        " and is kept until CLR ZERO. Nothing moves.",
        de=(
            "NULL SETZEN",
            "Die gewählten Achsen zeigen dort 0, wo sie sind, wie mit G92. Die"
            " Verschiebung gilt in jedem Werkstücksystem und bleibt bis NULL LÖSCHEN."
            " Nichts bewegt sich.",
        ),
    ),
)
def zero_set(machine: MillSession, *, axes: str = "") -> Position:
    """SET ZERO: axes read 0 where they are."""
    set_zero(machine, indices(machine, axes))
    return _position(machine, reader(machine).position)


@command("zero.preset")
def zero_preset(
    machine: MillSession, *, values: dict[str, Annotated[float, Meta(ge=-1e9, le=1e9)]]
) -> Position:
    """Set the floating zero so that axes read these values where they are."""
    settings = machine.runner.settings
    wanted = {settings.named(name.upper()).index: value for name, value in values.items()}
    return _position(machine, preset(machine, wanted))


@command(
    "zero.clear",
    page=Page(
        "clrzero",
        "CLR ZERO",
        "No axis has a floating zero any more: positions count from the zero of the work system"
        " again. Nothing moves.",
        de=(
            "NULL LÖSCHEN",
            "Keine Achse hat mehr einen verschobenen Nullpunkt: Positionen zählen wieder"
            " vom Nullpunkt des Werkstücksystems. Nichts bewegt sich.",
        ),
    ),
)
def zero_clear(machine: MillSession) -> Position:
    """CLR ZERO: no axis has a floating zero."""
    return _position(machine, clear_all(machine))


@command("zero.blocks", Role.VIEW, needs_control=False)
def zero_blocks(machine: MillSession, *, axes: str = "") -> dict[str, list[str]]:
    """The blocks of GOTO ZERO in the order they would be run; nothing moves."""
    return {"blocks": goto_blocks(machine, indices(machine, axes))}


@command(
    "zero.goto",
    is_motion=True,
    page=Page(
        "gotozero",
        "GOTO ZERO",
        "Rapids to the floating zero; Z first if that is up, else last.",
        de=(
            "ZUM NULLPUNKT",
            "Eilgang zum verschobenen Nullpunkt; Z zuerst, wenn das aufwärts ist, sonst zuletzt.",
        ),
    ),
)
def zero_goto(machine: MillSession, typed: Typed, *, axes: str = "") -> None:
    """GOTO ZERO: rapids to the floating zero, Z first where that is upward, else last."""
    typed.put(goto_blocks(machine, indices(machine, axes)), is_shown=False)


# --- set-up ---------------------------------------------------------------------------


@command("card.setup")
def set_up(station: Station, session: MillSession) -> None:
    """Set the card up for AcroMill: it attaches its axes and sends its settings.

    Until this is agreed on, a card at the end of a link stays as it was found.
    """
    if session.is_set_up:
        raise UserError("AcroMill has set this card up already")
    station.interlocks.require_unmeasured()
    station.set_up(station.now_s)
    if station.installation.lacks or station.link.session is None:
        raise UserError(station.installation.lacks or station.link.lost)


# --- stops ----------------------------------------------------------------------------


@command(
    "stop.hold",
    Role.VIEW,
    needs_control=False,
    is_stop=True,
    en="feed hold",
    de="Vorschub-Halt",
    page=Page(
        "stop",
        "STOP",
        "The program is held. RESUME continues where the path was left; axes that were jogged away"
        " return first. ABORT ends the program. The path can be traced back and forward.\n\nA stop"
        " by software is no emergency stop.",
        de=(
            "STOP",
            "Das Programm ist angehalten. WEITER geht dort weiter, wo die Bahn verlassen"
            " wurde; Achsen, die weggetippt wurden, fahren zuerst zurück. ABBRUCH beendet"
            " das Programm. Die Bahn kann rückwärts und vorwärts verfolgt werden.\n\nEin"
            " Halt durch Software ist kein Not-Halt.",
        ),
    ),
)
def hold(station: Station) -> dict[str, list[str]]:
    """STOP: everything that moves on the card comes to rest, at any time.

    Masters are held, jogs ramp down, gears and cams end, homing ends, programs pause: RESUME goes
    on with moves and programs. PLCs and the watchdog go on.
    """
    return _stop(station, lambda runner: _hold(runner), ends=False)


def _hold(runner: Runner) -> None:
    if runner.is_busy and runner.state not in (State.PAUSED, State.HOLD, State.ALARM):
        try:
            runner.stop()
        except UserError:
            if runner.state in (State.RUN, State.WAIT, State.HOMING):
                raise


@command("stop.all", Role.VIEW, needs_control=False, is_stop=True)
def stop_all(station: Station) -> dict[str, list[str]]:
    """End everything on the card: programs, moves, jogs, homing; spindle and coolant off."""
    return _stop(station, lambda runner: runner.bring_to_rest(), ends=True)


@command("stop.estop", Role.VIEW, needs_control=False, is_stop=True)
def estop(station: Station, person: Person) -> dict[str, list[str]]:
    """Kill all motion, spindle, coolant, beam and all drives of the card off, by software.

    It is no emergency stop. AcroMill's drives go on again before its next motion, those of other
    axes by DRIVE ON.
    """
    return _all_off(station, person)


@command("stop.drives", Role.VIEW, needs_control=False, is_stop=True, en="ALL OFF", de="ALLE AUS")
def drives_off(station: Station, person: Person) -> dict[str, list[str]]:
    """As `stop.estop`."""
    return _all_off(station, person)


def _all_off(station: Station, person: Person) -> dict[str, list[str]]:
    """Spindle, coolant and beam off, then all drives; the card is reached by the other step, too.

    The second step acts where AcroMill is not set up or has given the card up.
    """
    name = station.people.name_of(person)
    return _stop(station, lambda runner: runner.kill(name), station.stopping.kill, ends=True)


def _stop(
    station: Station,
    stop_part: Callable[[Runner], object],
    *acts: Callable[[], object],
    ends: bool,
) -> dict[str, list[str]]:
    """Do every step of a stop, whichever fails; the first error is raised at the end."""
    found: list[str] = []
    steps: list[Callable[[], object]] = [
        *acts,
        station.hand_motion.end_held,
        station.typed.drop,
        lambda: station.tuning.stop(station.link.session),
        lambda: found.extend(station.stopping.stop(station.now_s, ends=ends)),
    ]
    if station.link.session is not None and station.link.session.is_set_up:
        steps.insert(0, lambda: stop_part(station.link.machine.runner))
    failures: list[Exception] = []
    for step in steps:
        try:
            step()
        except Exception as error:
            failures.append(error)
    if failures:
        raise failures[0]
    return {"stopped": found}
