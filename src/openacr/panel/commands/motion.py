"""Commands that move axes by hand: jog, increments, hand wheel, home, zero; and stops."""

from collections.abc import Callable
from typing import Annotated, Literal

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.mill.zeroing import clear_all, goto_blocks, reader, set_zero
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.desk import Desk
from openacr.panel.control.orders import Order
from openacr.panel.control.presses import End, Key
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


class Mode(Args, frozen=True):
    """The screen the operator is on."""

    mode: Literal["auto", "manual", "mdi", "home", "setup", "diagnose"]


def indices(desk: Desk, names: str) -> list[int]:
    """The axes of these names; all configured ones without a name."""
    settings = desk.machine.runner.settings
    return [settings.named(name).index for name in names.upper() or settings.names()]


# --- jog ------------------------------------------------------------------------------


@command("jog.press", is_motion=True)
def press(desk: Desk, order: Order, args: Press) -> None:
    """Jog an axis while the key is held."""
    axis = desk.machine.runner.settings.named(args.axis.upper()).index
    desk.hands.press(
        Key(order.person.client, args.press),
        axis,
        args.direction,
        fast=args.fast,
        tick_ms=args.tick,
        received_s=order.received_s,
        now_s=desk.now_s,
    )


@command("jog.release", Role.VIEW, needs_control=False)
def release(desk: Desk, order: Order, args: Release) -> None:
    """Release a jog key; accepted without control."""
    desk.hands.release(Key(order.person.client, args.press))


@command("jog.increment", is_motion=True)
def increment(desk: Desk, order: Order, args: Increment) -> None:
    """Move an axis by one increment."""
    axis = desk.machine.runner.settings.named(args.axis.upper()).index
    if bool(args.preset) == bool(args.distance):
        raise UserError("an increment is a preset from 1 to 5 or a distance above 0")
    desk.hands.require_fresh(args.tick, order.received_s)
    desk.hands.increment(
        axis, args.direction, preset=args.preset, distance_u=args.distance, fast=args.fast
    )


@command("jog.stop", Role.VIEW, needs_control=False, is_stop=True)
def stop_jogs(desk: Desk, order: Order, args: NoArgs) -> None:
    """Ramp everything that is moved by hand to rest."""
    desk.hands.stop()


@command("handwheel", is_motion=True)
def handwheel(desk: Desk, order: Order, args: OfAxes) -> dict[str, str]:
    """Connect the hand wheel with axes; without a name it is disconnected."""
    desk.hands.presses.end_all(End.MODE, "the hand wheel was chosen")
    desk.machine.runner.turn(indices(desk, args.axes) if args.axes else [])
    return {"axes": args.axes.upper()}


@command("mode", needs_control=False)
def mode(desk: Desk, order: Order, args: Mode) -> None:
    """Say which screen the operator is on; a change ends every held key."""
    if desk.people.holder not in (None, order.person.client):
        return  # the screens of others change nothing
    if args.mode != desk.mode:
        desk.hands.presses.end_all(End.MODE, "another screen was chosen")
        desk.mode = args.mode


# --- home and zero --------------------------------------------------------------------


@command("home.start", is_motion=True)
def home(desk: Desk, order: Order, args: OfAxes) -> dict[str, list[str]]:
    """HOME: find the reference points of axes, all that have a priority without a name."""
    settings = desk.machine.runner.settings
    axes = indices(desk, args.axes)
    chosen = [axis for axis in axes if settings.home(axis).priority > 0]
    if not chosen:
        names = args.axes.upper() or "any axis"
        raise UserError(f"{names} has no homing priority: set Home Priority on the HOME page")
    desk.machine.runner.home(chosen)
    return {"axes": [settings.axis(axis).name for axis in chosen]}


def _position(desk: Desk, point: tuple[float, ...]) -> dict[str, dict[str, float]]:
    axes = desk.machine.runner.settings.axes
    return {"position": {axis.name: point[axis.index] for axis in axes}}


@command("zero.set")
def zero_set(desk: Desk, order: Order, args: OfAxes) -> dict[str, dict[str, float]]:
    """SET ZERO: axes read 0 where they are."""
    shop = desk.machine
    set_zero(shop, indices(desk, args.axes))
    return _position(desk, reader(shop).position)


@command("zero.clear")
def zero_clear(desk: Desk, order: Order, args: NoArgs) -> dict[str, dict[str, float]]:
    """CLR ZERO: no axis has a floating zero."""
    return _position(desk, clear_all(desk.machine))


@command("zero.goto", is_motion=True)
def zero_goto(desk: Desk, order: Order, args: OfAxes) -> None:
    """GOTO ZERO: rapids to the floating zero, Z first where that is upward, else last."""
    desk.typed.put(goto_blocks(desk.machine, indices(desk, args.axes)), is_shown=False)


# --- stops ----------------------------------------------------------------------------


@command("stop.hold", Role.VIEW, needs_control=False, is_stop=True)
def hold(desk: Desk, order: Order, args: NoArgs) -> None:
    """STOP: hold the feed, ramp jogs to rest, end homing; from every screen at any time."""
    _each(lambda: desk.hands.presses.end_all(End.STOP), lambda: _hold(desk), desk.typed.drop)


def _hold(desk: Desk) -> None:
    runner = desk.machine.runner
    if runner.is_busy and runner.state not in (State.PAUSED, State.HOLD, State.ALARM):
        try:
            runner.stop()
        except UserError:
            if runner.state in (State.RUN, State.WAIT, State.HOMING):
                raise


@command("stop.all", Role.VIEW, needs_control=False, is_stop=True)
def stop_all(desk: Desk, order: Order, args: NoArgs) -> None:
    """End everything: the program, jogs, homing; spindle and coolant off."""
    _each(
        lambda: desk.machine.runner.bring_to_rest(),
        lambda: desk.hands.presses.end_all(End.STOP),
        desk.typed.drop,
    )


@command("stop.estop", Role.VIEW, needs_control=False, is_stop=True)
def estop(desk: Desk, order: Order, args: NoArgs) -> None:
    """Kill all motion and switch the drives off, by software: it is no emergency stop."""
    _each(
        lambda: desk.machine.runner.kill(desk.people.name_of(order.person)),
        lambda: desk.hands.presses.end_all(End.STOP),
        desk.typed.drop,
    )


def _each(*steps: Callable[[], object]) -> None:
    """Do every step of a stop, whichever fails; the first error is raised at the end."""
    failures: list[Exception] = []
    for step in steps:
        try:
            step()
        except Exception as error:
            failures.append(error)
    if failures:
        raise failures[0]
