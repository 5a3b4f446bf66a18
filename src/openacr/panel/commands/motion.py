"""Commands that move axes by hand: jog, increments, hand wheel, home, zero; and stops."""

from collections.abc import Callable
from typing import Annotated, Literal

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.mill.run.runner import Runner
from openacr.mill.zeroing import clear_all, goto_blocks, preset, reader, set_zero
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.orders import Order
from openacr.panel.control.presses import End, Key
from openacr.panel.control.station import Station
from openacr.panel.roles import Role

PressNumber = Annotated[int, Meta(ge=0, le=2**53)]
Direction = Literal[-1, 1]
MODES = ("auto", "manual", "mdi", "home", "setup", "diagnose")


class Press(Args, frozen=True):
    """A jog key that is pressed; `first` says that this is a new press, not a keep-alive."""

    press: PressNumber
    axis: str
    direction: Direction
    tick: float
    first: Literal[True]
    fast: bool = False


class Release(Args, frozen=True):
    """A jog key that is released."""

    press: PressNumber


class Increment(Args, frozen=True):
    """One increment: a preset of the store (1 to 5), or a distance."""

    axis: str
    direction: Direction
    tick: float
    preset: Annotated[int, Meta(ge=0, le=5)] = 0
    distance: Annotated[float, Meta(ge=0.0, le=1e6)] = 0.0
    fast: bool = False


class OfAxes(Args, frozen=True):
    """Names of axes; none: all of them."""

    axes: str = ""


class Values(Args, frozen=True):
    """What axes are to read, by name, in the unit of the machine."""

    values: dict[str, Annotated[float, Meta(ge=-1e9, le=1e9)]]


class Mode(Args, frozen=True):
    """The screen the operator is on."""

    mode: Literal["auto", "manual", "mdi", "home", "setup", "diagnose"]


def indices(station: Station, names: str) -> list[int]:
    """The axes of these names; all configured ones without a name."""
    settings = station.link.machine.runner.settings
    return [settings.named(name).index for name in names.upper() or settings.names()]


# --- jog ------------------------------------------------------------------------------


@command("jog.press", is_motion=True)
def press(station: Station, order: Order, args: Press) -> None:
    """Jog an axis while the key is held."""
    axis = station.link.machine.runner.settings.named(args.axis.upper()).index
    station.hand_motion.press(
        Key(order.person.client, args.press),
        axis,
        args.direction,
        fast=args.fast,
        tick_ms=args.tick,
        received_s=order.received_s,
        now_s=station.now_s,
    )


@command("jog.release", Role.VIEW, needs_control=False)
def release(station: Station, order: Order, args: Release) -> None:
    """Release a jog key; accepted without control."""
    station.hand_motion.release(Key(order.person.client, args.press))


@command("jog.increment", is_motion=True)
def increment(station: Station, order: Order, args: Increment) -> None:
    """Move an axis by one increment."""
    axis = station.link.machine.runner.settings.named(args.axis.upper()).index
    if bool(args.preset) == bool(args.distance):
        raise UserError("an increment is a preset from 1 to 5 or a distance above 0")
    station.hand_motion.require_fresh(args.tick, order.received_s)
    station.hand_motion.increment(
        axis, args.direction, preset=args.preset, distance_u=args.distance, fast=args.fast
    )


@command("jog.stop", Role.VIEW, needs_control=False, is_stop=True)
def stop_jogs(station: Station, order: Order, args: NoArgs) -> None:
    """Ramp everything that is moved by hand to rest."""
    station.hand_motion.stop()


@command("handwheel", is_motion=True)
def handwheel(station: Station, order: Order, args: OfAxes) -> dict[str, str]:
    """Connect the hand wheel with axes; without a name it is disconnected."""
    station.hand_motion.presses.end_all(End.MODE, "the hand wheel was chosen")
    station.link.machine.runner.turn(indices(station, args.axes) if args.axes else [])
    return {"axes": args.axes.upper()}


@command("mode", needs_control=False)
def mode(station: Station, order: Order, args: Mode) -> None:
    """Say which screen the operator is on; a change ends every held key."""
    if station.people.holder not in (None, order.person.client):
        return  # the screens of others change nothing
    if args.mode != station.people.mode:
        station.hand_motion.presses.end_all(End.MODE, "another screen was chosen")
        station.people.mode = args.mode


# --- home and zero --------------------------------------------------------------------


@command("home.start", is_motion=True)
def home(station: Station, order: Order, args: OfAxes) -> dict[str, list[str]]:
    """HOME: find the reference points of axes, all that have a priority without a name."""
    settings = station.link.machine.runner.settings
    axes = indices(station, args.axes)
    chosen = [axis for axis in axes if settings.home(axis).priority > 0]
    if not chosen:
        names = args.axes.upper() or "any axis"
        raise UserError(f"{names} has no homing priority: set Home Priority on the HOME page")
    station.link.machine.runner.home(chosen)
    return {"axes": [settings.axis(axis).name for axis in chosen]}


def _position(station: Station, point: tuple[float, ...]) -> dict[str, dict[str, float]]:
    axes = station.link.machine.runner.settings.axes
    return {"position": {axis.name: point[axis.index] for axis in axes}}


@command("zero.set")
def zero_set(station: Station, order: Order, args: OfAxes) -> dict[str, dict[str, float]]:
    """SET ZERO: axes read 0 where they are."""
    session = station.link.machine
    set_zero(session, indices(station, args.axes))
    return _position(station, reader(session).position)


@command("zero.preset")
def zero_preset(station: Station, order: Order, args: Values) -> dict[str, dict[str, float]]:
    """Set the floating zero so that axes read these values where they are."""
    settings = station.link.machine.runner.settings
    values = {settings.named(name.upper()).index: value for name, value in args.values.items()}
    return _position(station, preset(station.link.machine, values))


@command("zero.clear")
def zero_clear(station: Station, order: Order, args: NoArgs) -> dict[str, dict[str, float]]:
    """CLR ZERO: no axis has a floating zero."""
    return _position(station, clear_all(station.link.machine))


@command("zero.blocks", Role.VIEW, needs_control=False)
def zero_blocks(station: Station, order: Order, args: OfAxes) -> dict[str, list[str]]:
    """The blocks of GOTO ZERO in the order they would be run; nothing moves."""
    return {"blocks": goto_blocks(station.link.machine, indices(station, args.axes))}


@command("zero.goto", is_motion=True)
def zero_goto(station: Station, order: Order, args: OfAxes) -> None:
    """GOTO ZERO: rapids to the floating zero, Z first where that is upward, else last."""
    station.typed.put(
        goto_blocks(station.link.machine, indices(station, args.axes)), is_shown=False
    )


# --- set-up ---------------------------------------------------------------------------


@command("card.setup")
def set_up(station: Station, order: Order, args: NoArgs) -> None:
    """Set the card up for AcroMill: it attaches its axes and sends its settings.

    Until this is agreed on, a card at the end of a link stays as it was found.
    """
    session = station.link.required
    if session.is_set_up:
        raise UserError("AcroMill has set this card up already")
    station.interlocks.require_unmeasured()
    station.set_up(station.now_s)
    if station.installation.lacks or station.link.session is None:
        raise UserError(station.installation.lacks or station.link.lost)


# --- stops ----------------------------------------------------------------------------


@command("stop.hold", Role.VIEW, needs_control=False, is_stop=True)
def hold(station: Station, order: Order, args: NoArgs) -> dict[str, list[str]]:
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
def stop_all(station: Station, order: Order, args: NoArgs) -> dict[str, list[str]]:
    """End everything on the card: programs, moves, jogs, homing; spindle and coolant off."""
    return _stop(station, lambda runner: runner.bring_to_rest(), ends=True)


@command("stop.estop", Role.VIEW, needs_control=False, is_stop=True)
def estop(station: Station, order: Order, args: NoArgs) -> dict[str, list[str]]:
    """Kill all motion and switch the drives off, by software: it is no emergency stop."""
    if station.link.session is None or not station.link.session.is_set_up:
        station.stopping.kill()
    name = station.people.name_of(order.person)
    return _stop(station, lambda runner: runner.kill(name), ends=True)


def _stop(
    station: Station, stop_part: Callable[[Runner], object], *, ends: bool
) -> dict[str, list[str]]:
    """Do every step of a stop, whichever fails; the first error is raised at the end."""
    found: list[str] = []
    steps: list[Callable[[], object]] = [
        lambda: station.hand_motion.presses.end_all(End.STOP),
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
